//! The command `cobra`.
fn main() {}
