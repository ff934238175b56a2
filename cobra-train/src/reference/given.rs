//! Reference points that somebody chose: a text file with three numbers a line.

use crate::input::read_text;
use nalgebra::Point3;
use std::path::{Path, PathBuf};

/// Why a file holds no reference points.
#[derive(Debug, thiserror::Error)]
pub enum ReadReferencePointsError {
    /// The file could not be read.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A line is not three finite numbers.
    #[error(
        "{}: line {line}: expected three finite numbers x y z, found {found:?}",
        path.display()
    )]
    Line {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What stands there.
        found: String,
    },
    /// There is no line.
    #[error("{}: no reference points in it", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
}

/// Reads reference points: x y z a line, separated by blanks, commas or semicolons, in the mesh's
/// frame and unit; empty lines and lines that start with `#` are skipped.
///
/// # Errors
/// [`ReadReferencePointsError`] names the file and the line.
pub fn read_reference_points(path: &Path) -> Result<Vec<Point3<f64>>, ReadReferencePointsError> {
    let text = read_text(path).map_err(|source| ReadReferencePointsError::Io {
        path: path.to_owned(),
        source,
    })?;
    let mut points = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let content = line.trim();
        if content.is_empty() || content.starts_with('#') {
            continue;
        }
        let numbers: Option<Vec<f64>> = content
            .split(|c: char| c.is_whitespace() || c == ',' || c == ';')
            .filter(|word| !word.is_empty())
            .map(|word| word.parse().ok().filter(|x: &f64| x.is_finite()))
            .collect();
        match numbers.as_deref() {
            Some([x, y, z]) => points.push(Point3::new(*x, *y, *z)),
            _ => {
                return Err(ReadReferencePointsError::Line {
                    path: path.to_owned(),
                    line: index + 1,
                    found: content.chars().take(60).collect(),
                });
            }
        }
    }
    if points.is_empty() {
        return Err(ReadReferencePointsError::Empty {
            path: path.to_owned(),
        });
    }
    Ok(points)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<Point3<f64>>, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("centres.txt");
        std::fs::write(&path, text).unwrap();
        read_reference_points(&path).map_err(|error| error.to_string())
    }

    #[test]
    fn blanks_commas_and_semicolons_separate_alike() {
        let expected = vec![Point3::new(1., -2.5, 3e1)];
        for line in [
            "1 -2.5 3e1",
            "1,-2.5,3e1",
            " 1;\t-2.5 ;3e1\r",
            "# c\n\n1, -2.5 3e1",
        ] {
            assert_eq!(read(line).as_ref(), Ok(&expected), "{line:?}");
        }
    }

    #[test]
    fn a_line_that_is_no_point_is_named() {
        for text in [
            "1 2 3\n4 5\n",
            "1 2 3\n4 5 six\n",
            "1 2 3\n4 5 NaN\n",
            "1 2 3\n4 5 6 7\n",
        ] {
            let error = read(text).unwrap_err();
            assert!(error.contains("centres.txt: line 2"), "{error}");
        }
        assert!(
            read("# nothing\n")
                .unwrap_err()
                .contains("no reference points")
        );
    }
}
