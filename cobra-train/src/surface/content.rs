//! What the readers of single formats share: the soup they produce and the way they complain.
//!
//! Owns no format and opens no file; `surface::read` adds the file's name to the complaint.

use std::fmt;

use nalgebra::Point3;

/// Vertices and triangles as a file lists them, before [`super::Mesh::new`] checks them, or
/// [`super::PointCloud::new`] where there are no triangles.
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
    /// A primitive of a glTF file.
    Primitive {
        /// The mesh, counted from 0.
        mesh: usize,
        /// Its primitive, counted from 0.
        primitive: usize,
    },
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(n) => write!(f, "line {n}"),
            Self::Face(n) => write!(f, "face {n}"),
            Self::Facet(n) => write!(f, "facet {n}"),
            Self::Primitive { mesh, primitive } => write!(f, "mesh {mesh}, primitive {primitive}"),
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

/// The words of each line that has any, with its number, counted from 1; `#` begins a comment.
pub(super) fn lines_of_words(text: &str) -> impl Iterator<Item = (usize, Vec<&str>)> {
    text.lines().enumerate().filter_map(|(index, line)| {
        let line = line.split('#').next().unwrap_or_default();
        let separators = |c: char| c.is_whitespace() || matches!(c, ',' | ';');
        let words: Vec<&str> = line.split(separators).filter(|w| !w.is_empty()).collect();
        (!words.is_empty()).then_some((index + 1, words))
    })
}

/// The point that a line begins with; what follows it is ignored.
pub(super) fn leading_point(words: &[&str]) -> Option<Point3<f64>> {
    let mut numbers = words.iter().map_while(|word| word.parse().ok());
    Some(Point3::new(
        numbers.next()?,
        numbers.next()?,
        numbers.next()?,
    ))
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
