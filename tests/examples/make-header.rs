//! Writes the header of the C interface.
//!
//! `cargo run -p cobra-tests --example make-header`. `tests/tests/header.rs` compares the file with
//! what this would write.

use std::error::Error;

#[path = "../tests/header/generate.rs"]
mod generate;

fn main() -> Result<(), Box<dyn Error>> {
    let header = generate::header()?;
    std::fs::write(generate::path(), header)?;
    println!("{}", generate::path().display());
    Ok(())
}
