//! The header of the C interface is the one that its source makes.

mod generate;

#[test]
fn the_header_is_that_of_the_source() {
    let written = std::fs::read_to_string(generate::path()).unwrap();
    // A checkout may have turned the ends of lines into Windows'.
    let written = written.replace("\r\n", "\n");
    assert!(
        written == generate::header().unwrap(),
        "make it again: cargo run -p cobra-tests --example make-header"
    );
}
