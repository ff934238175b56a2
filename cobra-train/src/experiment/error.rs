//! Why an experiment, or one of its objects, gives no result.

use crate::output::WriteError;
use crate::plot::PlotError;
use crate::surface::{ReadMeshError, SampleError};
use crate::train::TrainError;
use cobra_infer::{PoseError, ScoreError, TemplateError};
use std::path::PathBuf;

/// Why an experiment, or one of its objects, gives no result.
#[derive(Debug, thiserror::Error)]
pub enum ExperimentError {
    /// A folder of data cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A folder of data holds no mesh.
    #[error(
        "{}: expected meshes (.ply, .obj, .stl, .off, .glb or .gltf), in it, in folders of classes, or in \
         meshes/CLASS, found none",
        path.display()
    )]
    NoMeshes {
        /// The folder.
        path: PathBuf,
    },
    /// A file is no mesh.
    #[error(transparent)]
    Mesh(#[from] ReadMeshError),
    /// The surface cannot be sampled.
    #[error("{object}: {source}")]
    Sample {
        /// The object.
        object: String,
        /// Why.
        source: SampleError,
    },
    /// There is no template.
    #[error("{object}: {source}")]
    Train {
        /// The object.
        object: String,
        /// Why.
        source: TrainError,
    },
    /// A template that training gave is refused.
    #[error(transparent)]
    Template(#[from] TemplateError),
    /// A template cannot be asked.
    #[error(transparent)]
    Score(#[from] ScoreError),
    /// A simulated pose is none in single precision.
    #[error("a simulated pose: {0}")]
    Pose(#[from] PoseError),
    /// Every object failed.
    #[error("no object is left: each one failed")]
    NothingLeft,
    /// A journal cannot be read or written.
    #[error("{}: {source}", path.display())]
    Journal {
        /// The journal.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file that stands where a journal belongs is none.
    #[error("{}: expected a journal of experiments, found something else: use another folder", path.display())]
    NoJournal {
        /// The file.
        path: PathBuf,
    },
    /// A result cannot be put into the journal.
    #[error("{unit}: cannot be kept: {source}")]
    Row {
        /// The unit.
        unit: String,
        /// Why.
        source: serde_json::Error,
    },
    /// A file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// A figure cannot be drawn.
    #[error(transparent)]
    Plot(#[from] PlotError),
}

impl ExperimentError {
    /// Whether an object is at fault, so that others may do better.
    pub(super) fn is_of_object(&self) -> bool {
        matches!(
            self,
            Self::Mesh(_)
                | Self::Sample { .. }
                | Self::Train { .. }
                | Self::Template(_)
                | Self::Score(_)
                | Self::Pose(_)
        )
    }

    /// Whether reading or writing failed, as opposed to what was read.
    #[must_use]
    pub fn is_io(&self) -> bool {
        match self {
            Self::Folder { .. } | Self::Journal { .. } | Self::Write(_) => true,
            Self::Mesh(error) => error.is_io(),
            _ => false,
        }
    }
}
