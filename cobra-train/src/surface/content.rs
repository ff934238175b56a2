//! What the readers of single formats share: the soup they produce and the way they complain.
//!
//! Owns no format and opens no file; `surface::read` adds the file's name to the complaint.

use std::fmt;

use nalgebra::Point3;

/// Vertices and triangles as a file lists them, before [`super::Mesh::new`] checks them.
pub(super) type Soup = (Vec<Point3<f64>>, Vec<[u32; 3]>);

/// Longest excerpt of a file that an error repeats, in characters.
const LONGEST_EXCERPT: usize = 160;

/// Where in a file something is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// A line of text, counted from 1.
    Line(usize),
    /// A face of a PLY file, counted from 0.
    Face(usize),
    /// A facet of an STL file, counted from 0.
    Facet(usize),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(n) => write!(f, "line {n}"),
            Self::Face(n) => write!(f, "face {n}"),
            Self::Facet(n) => write!(f, "facet {n}"),
        }
    }
}

/// A file's content is not what its format promises.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct BadContent {
    pub(super) place: Option<Place>,
    pub(super) expected: String,
    pub(super) found: String,
}

impl BadContent {
    pub(super) fn new(
        place: Option<Place>,
        expected: impl Into<String>,
        found: impl fmt::Display,
    ) -> Self {
        Self {
            place,
            expected: expected.into(),
            found: one_line(&found.to_string()),
        }
    }
}

/// The text on one line, control characters removed and cut to [`LONGEST_EXCERPT`]: libraries
/// quote whole lines of a file, and a line of a hostile file may be the whole file.
fn one_line(text: &str) -> String {
    let mut line = String::new();
    for word in text.split(|c: char| c.is_whitespace() || c.is_control()) {
        if word.is_empty() {
            continue;
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(word);
        if let Some((cut, _)) = line.char_indices().nth(LONGEST_EXCERPT) {
            line.truncate(cut);
            line.push('…');
            break;
        }
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_found_is_one_short_line() {
        let hostile = format!("a\n\tb\u{7}c {}", "x".repeat(1_000_000));
        let found = BadContent::new(None, "a number", hostile).found;
        assert!(found.starts_with("a b c xxx"), "{found}");
        assert_eq!(found.lines().count(), 1);
        assert_eq!(found.chars().count(), LONGEST_EXCERPT + 1);
    }
}
