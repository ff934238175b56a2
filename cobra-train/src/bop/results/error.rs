//! What is wrong with a results file, or with one row of it.

use super::COLUMNS;
use std::path::PathBuf;

/// Why a file holds no results.
#[derive(Debug, thiserror::Error)]
pub enum ReadResultsError {
    /// The file could not be read.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The first line is not the header of BOP's results.
    #[error(
        "{}: line 1: expected the header {}, found {found}",
        path.display(),
        COLUMNS.join(",")
    )]
    Header {
        /// The file.
        path: PathBuf,
        /// What stands there, on one line and cut short.
        found: String,
    },
}

impl ReadResultsError {
    /// Whether the file could not be read at all, as opposed to holding something unusable.
    #[must_use]
    pub fn is_io(&self) -> bool {
        matches!(self, Self::Io { .. })
    }
}

/// Why a row is no estimate. Who reports it adds the file and the line ([`super::Row::line`]).
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RowError {
    /// It does not have seven fields.
    #[error("expected 7 fields, found {found}")]
    Fields {
        /// How many it has.
        found: usize,
    },
    /// An id is no whole number, or too large a one.
    #[error("{column}: expected a whole number, found {found:?}")]
    Id {
        /// The column.
        column: &'static str,
        /// What stands there.
        found: String,
    },
    /// R has not nine numbers, t not three, or score or time not one.
    #[error(
        "{column}: expected {expected} number{}, found {found}",
        if *expected == 1 { "" } else { "s" }
    )]
    Count {
        /// The column.
        column: &'static str,
        /// How many there should be.
        expected: usize,
        /// How many there are.
        found: usize,
    },
    /// What should be a number is none, or not a finite one.
    #[error("{column}: expected a finite number, found {found:?}")]
    Number {
        /// The column.
        column: &'static str,
        /// What stands there.
        found: String,
    },
    /// A field has a carriage return inside, which some programs take for the end of a line.
    #[error("{column}: expected a field on one line, found several")]
    Lines {
        /// The column.
        column: &'static str,
    },
    /// The row is no text.
    #[error("expected text in UTF-8, found other bytes")]
    NotUtf8,
}
