//! Camera files: the 3×3 matrix K as text.

use super::read_text;
use cobra_infer::{Camera, CameraError};
use std::path::{Path, PathBuf};

/// Why a file holds no camera.
#[derive(Debug, thiserror::Error)]
pub enum ReadCameraError {
    /// The file could not be read.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A row does not hold the numbers it should.
    #[error(
        "{}: row {row}: expected three numbers of the camera matrix, found {found:?}",
        path.display()
    )]
    Row {
        /// The file.
        path: PathBuf,
        /// The row, from 1.
        row: usize,
        /// What stands there.
        found: String,
    },
    /// There are fewer than three rows.
    #[error("{}: expected three rows of three numbers, found {found}", path.display())]
    TooFewRows {
        /// The file.
        path: PathBuf,
        /// How many rows there are.
        found: usize,
    },
    /// The numbers are no pinhole camera.
    #[error("{}: {source}", path.display())]
    Camera {
        /// The file.
        path: PathBuf,
        /// What is wrong with them.
        source: CameraError,
    },
}

/// Reads K from a text file: three rows of three numbers, separated by commas or blanks. Numbers
/// in further rows are distortion coefficients, which must be 0.
///
/// # Errors
/// [`ReadCameraError`] names the file and the row.
pub fn read_camera(path: &Path) -> Result<Camera, ReadCameraError> {
    let owned = || path.to_owned();
    let text = read_text(path).map_err(|source| ReadCameraError::Io {
        path: owned(),
        source,
    })?;
    let mut matrix = [0.0_f32; 9];
    let mut distortion = Vec::new();
    let mut rows = 0;
    for (index, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let numbers: Option<Vec<f32>> = line
            .split(|c: char| c == ',' || c.is_whitespace())
            .filter(|word| !word.is_empty())
            .map(|word| word.parse().ok())
            .collect();
        match (numbers, rows) {
            (Some(numbers), 0..3) if numbers.len() == 3 => {
                matrix[3 * rows..3 * rows + 3].copy_from_slice(&numbers);
                rows += 1;
            }
            (Some(numbers), 3..) => distortion.extend(numbers),
            _ => {
                return Err(ReadCameraError::Row {
                    path: owned(),
                    row: index + 1,
                    found: line.chars().take(60).collect(),
                });
            }
        }
    }
    if rows < 3 {
        return Err(ReadCameraError::TooFewRows {
            path: owned(),
            found: rows,
        });
    }
    Camera::from_matrix(matrix)
        .and_then(|camera| camera.with_distortion(&distortion))
        .map_err(|source| ReadCameraError::Camera {
            path: owned(),
            source,
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Camera, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("K.txt");
        std::fs::write(&path, text).unwrap();
        read_camera(&path).map_err(|error| error.to_string())
    }

    #[test]
    fn commas_and_blanks_separate_alike() {
        let commas = read("400,0,320\n0,410,240\n0,0,1\n").unwrap();
        let blanks = read("# K\n400 0 320\n\n 0 410\t240 \n0 0 1").unwrap();
        assert_eq!(commas, blanks);
        assert_eq!(commas, Camera::new(400., 410., 320., 240.).unwrap());
    }

    #[test]
    fn a_wrong_row_is_named() {
        let error = read("400,0,320\n0,oops,240\n0,0,1\n").unwrap_err();
        assert!(error.contains("row 2") && error.contains("oops"), "{error}");
        let error = read("400,0,320\n0,410,240\n").unwrap_err();
        assert!(error.contains("found 2"), "{error}");
    }

    #[test]
    fn distortion_coefficients_are_refused_with_advice() {
        let error = read("400,0,320\n0,410,240\n0,0,1\n-0.1,0.02,0,0,0\n").unwrap_err();
        assert!(error.contains("undistort"), "{error}");
        assert!(read("400,0,320\n0,410,240\n0,0,1\n0 0 0 0 0\n").is_ok());
    }

    #[test]
    fn a_focal_length_of_zero_is_refused() {
        let error = read("0,0,320\n0,410,240\n0,0,1\n").unwrap_err();
        assert!(error.contains("fx must be positive"), "{error}");
    }
}
