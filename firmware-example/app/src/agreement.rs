//! The recorded vectors, scored here and compared bit by bit.

use crate::Board;
use cobra_agreement::{Set, report};
use core::fmt::{self, Write};

/// Compares what is recorded of these sets and says how many bits differ; whether none do.
///
/// # Errors
/// Those of `out`.
pub fn run(board: &mut impl Board, out: &mut impl Write, sets: &[Set]) -> Result<bool, fmt::Error> {
    report::write(out, sets, || board.feed_watchdog())
}
