//! Correspondence files: CSV with a header, one 2D-3D correspondence a row.

use cobra_infer::Correspondence;
use nalgebra::{Point2, Point3};
use std::path::{Path, PathBuf};

/// What a correspondence weighs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weighting {
    /// All the same: the paper's 1/N.
    Uniform,
    /// The estimator's own confidence, column `conf`.
    Confidence,
}

/// Which rows count, and how much.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CorrespondenceOptions {
    /// What a row weighs.
    pub weighting: Weighting,
    /// Only rows whose column `inlier` is not 0.
    pub inliers_only: bool,
}

/// Why a file holds no correspondences.
#[derive(Debug, thiserror::Error)]
pub enum ReadCorrespondencesError {
    /// The file could not be read.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A column is missing from the header.
    #[error(
        "{}: row 1: column {column:?} is missing; the header is {header:?}",
        path.display()
    )]
    Column {
        /// The file.
        path: PathBuf,
        /// The column.
        column: &'static str,
        /// The header there is.
        header: String,
    },
    /// A row does not have as many fields as the header.
    #[error("{}: row {row}: expected {expected} fields, found {found}", path.display())]
    Fields {
        /// The file.
        path: PathBuf,
        /// The row, from 1, the header being row 1.
        row: u64,
        /// Fields in the header.
        expected: u64,
        /// Fields in the row.
        found: u64,
    },
    /// A field is not a number.
    #[error(
        "{}: row {row}, column {column:?}: expected a number, found {found:?}",
        path.display()
    )]
    Number {
        /// The file.
        path: PathBuf,
        /// The row, from 1, the header being row 1.
        row: u64,
        /// The column.
        column: &'static str,
        /// What stands there.
        found: String,
    },
    /// A row is not text in UTF-8.
    #[error("{}: row {row}: not UTF-8", path.display())]
    NotUtf8 {
        /// The file.
        path: PathBuf,
        /// The row, from 1, the header being row 1.
        row: u64,
    },
    /// The file is not CSV.
    #[error("{}: {source}", path.display())]
    Csv {
        /// The file.
        path: PathBuf,
        /// What is wrong, and where.
        source: csv::Error,
    },
}

/// Reads correspondences: columns `x`, `y` (pixels, pixel centres at integers), `X`, `Y`, `Z`
/// (object frame, template's unit), and where the options need them `inlier` and `conf`; any
/// order, other columns ignored.
///
/// Numbers that are not finite are handed on: the scorer's decision says so.
///
/// # Errors
/// [`ReadCorrespondencesError`] names the file, the row and the column.
pub fn read_correspondences(
    path: &Path,
    options: CorrespondenceOptions,
) -> Result<Vec<Correspondence>, ReadCorrespondencesError> {
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .from_path(path)
        .map_err(|error| csv_error(path, error))?;
    let header = reader
        .headers()
        .map_err(|error| csv_error(path, error))?
        .clone();
    let place = |column: &'static str| {
        header
            .iter()
            .position(|name| name == column)
            .map(|index| (column, index))
            .ok_or_else(|| ReadCorrespondencesError::Column {
                path: path.to_owned(),
                column,
                header: header
                    .iter()
                    .collect::<Vec<_>>()
                    .join(",")
                    .chars()
                    .take(200)
                    .collect(),
            })
    };
    let [x, y] = [place("x")?, place("y")?];
    let [px, py, pz] = [place("X")?, place("Y")?, place("Z")?];
    let inlier = options.inliers_only.then(|| place("inlier")).transpose()?;
    let confidence = match options.weighting {
        Weighting::Uniform => None,
        Weighting::Confidence => Some(place("conf")?),
    };

    let mut correspondences = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| csv_error(path, error))?;
        let row = record.position().map_or(0, csv::Position::line);
        let number = |(column, index): (&'static str, usize)| {
            let field = record.get(index).unwrap_or("");
            field
                .parse::<f32>()
                .map_err(|_| ReadCorrespondencesError::Number {
                    path: path.to_owned(),
                    row,
                    column,
                    found: field.chars().take(60).collect(),
                })
        };
        let correspondence = Correspondence {
            pixel: Point2::new(number(x)?, number(y)?),
            point: Point3::new(number(px)?, number(py)?, number(pz)?),
            weight: confidence.map_or(Ok(1.0), number)?,
        };
        let counts = match inlier {
            Some(column) => number(column)? != 0.0,
            None => true,
        };
        if counts {
            correspondences.push(correspondence);
        }
    }
    Ok(correspondences)
}

fn csv_error(path: &Path, error: csv::Error) -> ReadCorrespondencesError {
    let path = path.to_owned();
    match error.into_kind() {
        csv::ErrorKind::Io(source) => ReadCorrespondencesError::Io { path, source },
        csv::ErrorKind::UnequalLengths {
            pos,
            expected_len,
            len,
        } => ReadCorrespondencesError::Fields {
            path,
            row: pos.map_or(0, |pos| pos.line()),
            expected: expected_len,
            found: len,
        },
        csv::ErrorKind::Utf8 { pos, .. } => ReadCorrespondencesError::NotUtf8 {
            path,
            row: pos.map_or(0, |pos| pos.line()),
        },
        kind => ReadCorrespondencesError::Csv {
            path,
            source: csv::Error::from(std::io::Error::other(format!("{kind:?}"))),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIFORM: CorrespondenceOptions = CorrespondenceOptions {
        weighting: Weighting::Uniform,
        inliers_only: false,
    };
    const GOOD: &str = "inlier,x,y,X,Y,Z,conf\n1.0,10,20,1,2,3,0.5\n0.0,11,21,4,5,6,0.25\n";

    fn read(text: &str, options: CorrespondenceOptions) -> Result<Vec<Correspondence>, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("7_corr.txt");
        std::fs::write(&path, text).unwrap();
        read_correspondences(&path, options).map_err(|error| error.to_string())
    }

    #[test]
    fn all_rows_count_the_same_unless_asked_otherwise() {
        let all = read(GOOD, UNIFORM).unwrap();
        assert_eq!(all.len(), 2);
        assert!(all.iter().all(|c| c.weight == 1.0));
        let some = CorrespondenceOptions {
            weighting: Weighting::Confidence,
            inliers_only: true,
        };
        let inliers = read(GOOD, some).unwrap();
        assert_eq!(inliers.len(), 1);
        assert_eq!(inliers[0].weight, 0.5);
        assert_eq!(inliers[0].point, Point3::new(1., 2., 3.));
    }

    #[test]
    fn columns_come_in_any_order_and_strangers_are_ignored() {
        let text = "Z,Y,X,class,y,x\n3,2,1,driver,20,10\n";
        assert_eq!(
            read(text, UNIFORM).unwrap(),
            read(GOOD, UNIFORM).unwrap()[..1]
        );
    }

    #[test]
    fn what_is_wrong_is_named_with_row_and_column() {
        for (text, expected) in [
            ("x,y,X,Y\n1,2,3,4\n", "column \"Z\" is missing"),
            (
                "x,y,X,Y,Z\n1,2,3,4,5\n1,2,wide,4,5\n",
                "row 3, column \"X\": expected a number, found \"wide\"",
            ),
            ("x,y,X,Y,Z\n1,2,3,4\n", "row 2: expected 5 fields, found 4"),
            ("", "column \"x\" is missing"),
        ] {
            let error = read(text, UNIFORM).unwrap_err();
            assert!(error.contains(expected), "{error}");
            assert!(
                error.contains("7_corr.txt") && !error.contains('\n'),
                "{error}"
            );
        }
        let weighted = CorrespondenceOptions {
            weighting: Weighting::Confidence,
            inliers_only: false,
        };
        let error = read("x,y,X,Y,Z\n1,2,3,4,5\n", weighted).unwrap_err();
        assert!(error.contains("\"conf\""), "{error}");
    }

    #[test]
    fn a_header_without_rows_is_an_empty_list() {
        assert_eq!(read("x,y,X,Y,Z\n", UNIFORM), Ok(vec![]));
    }
}
