//! Why there is no template.

use super::{LARGEST_TEMPLATE, SurfaceSampling};
use crate::gp::{FitError, NotPositiveDefinite};
use crate::reference::ClusterError;
use crate::surface::SampleError;
use cobra_infer::{EncodeError, ScoreError, TemplateError};
use nalgebra::Point3;

/// Why there is no template.
#[derive(Debug, thiserror::Error)]
pub enum TrainError {
    /// No training or no test point was asked for.
    #[error("at least one training point and one test point are needed")]
    NoPoints,
    /// A point cloud was to be drawn on.
    #[error(
        "{} draws points on faces, and a point cloud has none; its own points are split \
         into training and test points with the default, cameras",
        sampling.name()
    )]
    NeedsFaces {
        /// How points were to be drawn.
        sampling: SurfaceSampling,
    },
    /// More components than the host scores with.
    #[error("{found} components, at most {LARGEST_TEMPLATE} are supported")]
    TooManyComponents {
        /// How many were asked for.
        found: usize,
    },
    /// The overlap is no share.
    #[error("expected an overlap of at least 0, found {found}")]
    Overlap {
        /// What was asked for.
        found: f64,
    },
    /// The surface could not be sampled.
    #[error(transparent)]
    Sample(#[from] SampleError),
    /// The points could not be clustered.
    #[error(transparent)]
    Cluster(#[from] ClusterError),
    /// Points were to be drawn from reference points that are to be placed on them.
    #[error(
        "reference points that place themselves cannot be what points are drawn from: give them, or \
         use clustering"
    )]
    NeedsReferencePoints,
    /// No reference point sees a piece of the surface that is large enough.
    #[error("no reference point sees enough of the surface: use more points, or clustering")]
    NoCharts,
    /// Reference points could not be placed.
    #[error("placing reference points: {source}")]
    Charts {
        /// Why.
        source: FitError,
    },
    /// Compression failed.
    #[error("compressing: {0}")]
    Compress(NotPositiveDefinite),
    /// Compression is of directions on the chord.
    #[error("templates with the metric of angles cannot be compressed: use no budget")]
    BudgetNeedsChord,
    /// Maps hold in verified directions alone.
    #[error("maps hold where components are verified alone: they cannot speak everywhere")]
    MapNeedsValidity,
    /// The components do not fit; of charts, not even one.
    #[error(
        "{budget} bytes are too few for a template of this object: about {least} are needed at least"
    )]
    Budget {
        /// What was asked for.
        budget: usize,
        /// What is needed.
        least: usize,
    },
    /// No component may speak anywhere: what they predict lies beside none of their points.
    #[error("no component reproduces its own points: use more components or more points")]
    NothingVerified,
    /// A given reference point is of no use.
    #[error(
        "reference point {index} at ({}, {}, {}) is the nearest of none of the {points} training \
         points; are the reference points in the mesh's unit and frame?",
        centre.x, centre.y, centre.z
    )]
    UnusedReferencePoint {
        /// Which one, from 0.
        index: usize,
        /// Where it lies.
        centre: Point3<f64>,
        /// How many training points there are.
        points: usize,
    },
    /// A component could not be fitted.
    #[error("component {component}: {source}")]
    Fit {
        /// Which one.
        component: usize,
        /// Why.
        source: FitError,
    },
    /// A cluster's precision does not fit into a template.
    #[error(
        "component {component}: its precision leaves the range of 32-bit numbers; is the object's \
         unit right?"
    )]
    Precision {
        /// Which one.
        component: usize,
    },
    /// The template could not be written.
    #[error(transparent)]
    Encode(#[from] EncodeError),
    /// The template that was written cannot be used.
    #[error(transparent)]
    Template(#[from] TemplateError),
    /// The template could not be measured.
    #[error(transparent)]
    Score(#[from] ScoreError),
}
