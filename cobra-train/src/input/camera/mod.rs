//! Camera files: the 3×3 matrix K as text, and BOP's `camera.json` and `scene_camera.json`.
//!
//! Owns which of them a file is, whose camera is asked for, and the errors. The formats are the
//! business of `matrix` and `bop`.

mod bop;
mod matrix;

pub(crate) use bop::image_camera;

use super::image_id::same_image;
use super::json::Misfit;
use super::read_text;
use cobra_infer::{Camera, CameraError};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The cameras of a file.
#[derive(Clone, Debug, PartialEq)]
pub enum CameraFile {
    /// One camera for all images.
    One(ImageCamera),
    /// A camera for each image, by the image's id as the file writes it.
    PerImage(BTreeMap<String, ImageCamera>),
}

/// The camera that took an image, and what the file says beside it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageCamera {
    /// Intrinsics, in pixels.
    pub camera: Camera,
    /// What a depth image's values are multiplied with to become lengths; greater than 0.
    pub depth_scale: Option<f32>,
    /// Width and height of the image.
    pub size: Option<ImageSize>,
}

/// An image's size in pixels; neither is 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImageSize {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl ImageSize {
    /// The most columns or rows. A depth pixel's place has 16 bits, and would hold more; the depths of such an
    /// image take a gigabyte, and of larger ones more than a host may have.
    pub const LARGEST_SIDE: u32 = 16_384;

    /// Whether neither side is 0 or longer than [`ImageSize::LARGEST_SIDE`].
    pub(crate) fn is_held(self) -> bool {
        let sides = [self.width, self.height];
        sides
            .iter()
            .all(|side| (1..=Self::LARGEST_SIDE).contains(side))
    }

    /// Where a pixel stands in a list of all, row by row from the top left; `None` outside of the
    /// image.
    pub(crate) fn index(self, column: u32, row: u32) -> Option<usize> {
        (column < self.width && row < self.height)
            .then_some(row as usize * self.width as usize + column as usize)
    }
}

impl std::fmt::Display for ImageSize {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} x {} pixels", self.width, self.height)
    }
}

impl CameraFile {
    /// The camera of an image: the only one, or the one under the image's id. Zeros before a number
    /// do not count: `000061` is `61`.
    #[must_use]
    pub fn for_image(&self, image: &str) -> Option<&ImageCamera> {
        match self {
            Self::One(camera) => Some(camera),
            Self::PerImage(cameras) => cameras.get(image).or_else(|| {
                let same = cameras.iter().find(|(id, _)| same_image(id, image));
                same.map(|(_, camera)| camera)
            }),
        }
    }
}

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
    /// The file is not JSON; the message holds line and column.
    #[error("{}: not valid JSON: {source}", path.display())]
    Json {
        /// The file.
        path: PathBuf,
        /// What is wrong, and where.
        source: serde_json::Error,
    },
    /// The JSON does not have the form of a camera file.
    #[error("{}: {place}: expected {expected}, found {found}", path.display())]
    Form {
        /// The file.
        path: PathBuf,
        /// The key, below the keys that lead to it.
        place: String,
        /// What should stand there.
        expected: &'static str,
        /// What does.
        found: String,
    },
    /// The numbers are no pinhole camera.
    #[error(
        "{}: {}{source}",
        path.display(),
        place.as_ref().map_or_else(String::new, |place| format!("{place}: "))
    )]
    Camera {
        /// The file.
        path: PathBuf,
        /// Where in a JSON document.
        place: Option<String>,
        /// What is wrong with them.
        source: CameraError,
    },
}

/// Reads a camera file: JSON where the name ends in `.json` or the text begins with a brace, the
/// matrix K elsewhere.
///
/// - **Text**: three rows of three numbers, separated by commas or blanks. Numbers in further rows
///   are distortion coefficients, which must be 0.
/// - **`camera.json`**: `{"fx": …, "fy": …, "cx": …, "cy": …}`, and if known `depth_scale`,
///   `width` and `height`.
/// - **`scene_camera.json`**: `{"IMAGE": {"cam_K": [9 numbers]}, …}`, K row-major, and if known
///   `depth_scale`.
///
/// Other keys are ignored. Numbers are rounded to `f32` once.
///
/// # Errors
/// [`ReadCameraError`] names the file and the row or the key.
pub fn read_camera(path: &Path) -> Result<CameraFile, ReadCameraError> {
    let text = read_text(path).map_err(|source| ReadCameraError::Io {
        path: path.to_owned(),
        source,
    })?;
    let says_json = path
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("json"));
    if says_json || text.trim_start().starts_with('{') {
        return bop::parse(&text, path);
    }
    Ok(CameraFile::One(ImageCamera {
        camera: matrix::parse(&text, path)?,
        depth_scale: None,
        size: None,
    }))
}

impl ReadCameraError {
    fn form(path: &Path, misfit: Misfit) -> Self {
        Self::Form {
            path: path.to_owned(),
            place: misfit.place,
            expected: misfit.expected,
            found: misfit.found,
        }
    }
}

#[cfg(test)]
pub(super) fn read_as(name: &str, text: &str) -> Result<CameraFile, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, text).unwrap();
    read_camera(&path).map_err(|error| {
        let message = error.to_string();
        assert!(
            message.contains(name) && !message.contains('\n'),
            "{message}"
        );
        message
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_or_the_brace_tells_json_from_text() {
        let json = r#" {"fx": 500, "fy": 500, "cx": 320, "cy": 240}"#;
        let text = "500 0 320\n0 500 240\n0 0 1\n";
        let one = read_as("K.txt", text).unwrap();
        for name in ["camera.json", "CAMERA.JSON", "camera", "K.txt"] {
            assert_eq!(read_as(name, json).unwrap(), one);
        }
        assert!(
            read_as("K.json", text)
                .unwrap_err()
                .contains("not valid JSON")
        );
    }

    #[test]
    fn one_camera_is_every_images_and_zeros_before_an_id_do_not_count() {
        let one = read_as("K.txt", "500 0 320\n0 500 240\n0 0 1\n").unwrap();
        assert!(one.for_image("any").is_some());
        let k = |fx: u32| format!("{{\"cam_K\": [{fx},0,320,0,500,240,0,0,1]}}");
        let text = format!("{{\"61\": {}, \"0007\": {}, \"x\": {}}}", k(1), k(2), k(3));
        let file = read_as("scene_camera.json", &text).unwrap();
        let fx = |image: &str| {
            let camera = file.for_image(image)?.camera;
            camera
                .project(&nalgebra::Point3::new(1.0, 0.0, 1.0))
                .map(|p| p.x - 320.0)
        };
        for (image, expected) in [
            ("61", Some(1.0)),
            ("000061", Some(1.0)),
            ("7", Some(2.0)),
            ("x", Some(3.0)),
            ("62", None),
            ("", None),
        ] {
            assert_eq!(fx(image), expected, "{image}");
        }
    }
}
