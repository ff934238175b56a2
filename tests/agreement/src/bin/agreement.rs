//! Compares everything on this processor: `cargo run -p cobra-agreement --features golden --release`.
//!
//! Release, because that is what ships: the optimiser is part of what must not change a bit.

use cobra_agreement::{SETS, report};
use std::fmt;
use std::process::ExitCode;

struct Stdout;

impl fmt::Write for Stdout {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        print!("{text}");
        Ok(())
    }
}

fn main() -> ExitCode {
    match report::write(&mut Stdout, &SETS, || {}) {
        Ok(true) => ExitCode::SUCCESS,
        _ => ExitCode::FAILURE,
    }
}
