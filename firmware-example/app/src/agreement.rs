//! The recorded vectors, scored here and compared bit by bit.

use crate::Board;
use cobra_agreement::report;
use core::fmt::{self, Write};

/// Compares everything that is recorded and says how many bits differ; whether none do.
///
/// # Errors
/// Those of `out`.
pub fn run(board: &mut impl Board, out: &mut impl Write) -> Result<bool, fmt::Error> {
    report::write(out, || board.feed_watchdog())
}
