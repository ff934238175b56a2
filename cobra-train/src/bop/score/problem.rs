//! Why an estimate has no score.

use crate::bop::dataset::DatasetError;
use crate::bop::results::RowError;
use crate::bop::templates::TemplateFileError;
use cobra_infer::PoseError;
use cobra_infer::depth::DepthError;
use std::sync::Arc;

/// Why. Who reports it adds the results file and the line.
#[derive(Clone, Debug, thiserror::Error)]
pub enum Problem {
    /// The row is no estimate.
    #[error(transparent)]
    Row(RowError),
    /// Its pose is none.
    #[error("{0}")]
    Pose(PoseError),
    /// Something of its image cannot be used.
    #[error(transparent)]
    Image(Arc<DatasetError>),
    /// Its object's template cannot be used.
    #[error(transparent)]
    Template(Arc<TemplateFileError>),
    /// Nobody asked for its object.
    #[error("no template of object {object}")]
    NoTemplate {
        /// The object.
        object: u32,
    },
    /// The check could not be made.
    #[error("{0}")]
    Check(DepthError),
}

impl Problem {
    /// Whether it belongs to more than one row, and to which: it is then told once.
    #[must_use]
    pub fn is_shared(&self) -> bool {
        matches!(
            self,
            Self::Image(_) | Self::Template(_) | Self::NoTemplate { .. }
        )
    }
}
