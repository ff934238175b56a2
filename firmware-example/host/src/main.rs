//! The boards' example on this computer: every line but the first must be the boards'.

use cobra_firmware_app::{Board, score};
use std::fmt;
use std::process::ExitCode;

struct Computer;

impl Board for Computer {
    fn name(&self) -> &'static str {
        "this computer"
    }

    fn feed_watchdog(&mut self) {}

    fn instructions(&mut self) -> u64 {
        0
    }
}

struct Stdout;

impl fmt::Write for Stdout {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        print!("{text}");
        Ok(())
    }
}

fn main() -> ExitCode {
    match score::run(&mut Computer, &mut Stdout) {
        Ok(()) => ExitCode::SUCCESS,
        Err(_) => ExitCode::FAILURE,
    }
}
