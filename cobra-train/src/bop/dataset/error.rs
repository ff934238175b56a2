//! What is wrong with a data set's files.

use crate::input::ReadCameraError;
use crate::input::json::Misfit;
use crate::surface::ReadMeshError;
use cobra_infer::PoseError;
use std::path::{Path, PathBuf};

/// Why something of a data set is not known. Its `Display` is one line that names the file.
#[derive(Debug, thiserror::Error)]
pub enum DatasetError {
    /// A file or folder could not be read.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file is not JSON; the message holds line and column.
    #[error("{}: not valid JSON: {source}", path.display())]
    Json {
        /// The file.
        path: PathBuf,
        /// What is wrong, and where.
        source: serde_json::Error,
    },
    /// A JSON file does not have its form.
    #[error("{}: {place}: expected {expected}, found {found}", path.display())]
    Form {
        /// The file.
        path: PathBuf,
        /// Where in the document.
        place: String,
        /// What should stand there.
        expected: &'static str,
        /// What does.
        found: String,
    },
    /// A JSON file has nothing under an id.
    #[error("{}: expected an entry for {kind} {id}, found none", path.display())]
    NoEntry {
        /// The file.
        path: PathBuf,
        /// What the id is of.
        kind: &'static str,
        /// The id.
        id: u32,
    },
    /// The numbers of a true pose or of a symmetry are none.
    #[error("{}: {place}: {source}", path.display())]
    Pose {
        /// The file.
        path: PathBuf,
        /// Where in the document.
        place: String,
        /// What is wrong with it.
        source: PoseError,
    },
    /// An image's camera is not known.
    #[error(transparent)]
    Camera(#[from] ReadCameraError),
    /// An image is not what it should be.
    #[error("{}: expected {expected}, found {found}", path.display())]
    Image {
        /// The file.
        path: PathBuf,
        /// What it should be.
        expected: String,
        /// What it is.
        found: String,
    },
    /// Nothing says how large the images are.
    #[error(
        "{}: expected width and height there or an image {image:06} among depth, rgb, gray and \
         mask_visib of {}, as PNG; found neither",
        camera.display(),
        scene.display()
    )]
    UnknownSize {
        /// The data set's `camera.json`.
        camera: PathBuf,
        /// The scene's folder.
        scene: PathBuf,
        /// The image.
        image: u32,
    },
    /// There is no model of an object.
    #[error(
        "{}: expected a model of object {object}, obj_{object:06}.ply, found those of {known}",
        folder.display()
    )]
    UnknownObject {
        /// The models' folder.
        folder: PathBuf,
        /// The object.
        object: u32,
        /// The objects that have one.
        known: String,
    },
    /// A model is a cloud of points, where its surface is needed.
    #[error("{}: expected a mesh, found points without faces", path.display())]
    NoFaces {
        /// The file.
        path: PathBuf,
    },
    /// A model cannot be used.
    #[error(transparent)]
    Model(#[from] ReadMeshError),
}

impl DatasetError {
    /// Whether a file could not be read at all, as opposed to holding something unusable.
    #[must_use]
    pub fn is_io(&self) -> bool {
        match self {
            Self::Io { .. } | Self::Camera(ReadCameraError::Io { .. }) => true,
            Self::Model(error) => error.is_io(),
            _ => false,
        }
    }

    pub(super) fn io(path: &Path, source: std::io::Error) -> Self {
        Self::Io {
            path: path.to_owned(),
            source,
        }
    }

    pub(super) fn form(path: &Path, misfit: Misfit) -> Self {
        Self::Form {
            path: path.to_owned(),
            place: misfit.place,
            expected: misfit.expected,
            found: misfit.found,
        }
    }
}
