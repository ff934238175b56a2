//! The camera matrix K as text.
//!
//! Owns rows and separators.

use super::ReadCameraError;
use cobra_infer::Camera;
use std::path::Path;

/// Three rows of three numbers; numbers in further rows are distortion coefficients.
pub(super) fn parse(text: &str, path: &Path) -> Result<Camera, ReadCameraError> {
    let owned = || path.to_owned();
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
            place: None,
            source,
        })
}

#[cfg(test)]
mod tests {
    use super::super::{CameraFile, read_as};
    use cobra_infer::Camera;

    fn read(text: &str) -> Result<Camera, String> {
        match read_as("K.txt", text)? {
            CameraFile::One(one) => Ok(one.camera),
            CameraFile::PerImage(_) => panic!("a matrix is one camera"),
        }
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
