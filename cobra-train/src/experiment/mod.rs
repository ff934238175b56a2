//! The paper's tables and figures, computed anew on a folder of meshes.
//!
//! Owns what is measured and how: the protocols of the paper's experiments and supplement, the numbers
//! that it prints ([`paper`]), and how results become tables and figures. Everything happens in the unit
//! sphere, as in the paper. What is measured is the business of the modules that train and score.
//!
//! Work is done in units, one object or one setting each. A unit that is done is kept in a journal beside
//! the results, so that a run that was interrupted goes on where it was.

mod bench;
mod correlation;
mod delta;
mod document;
mod error;
mod estimates;
mod findings;
mod journal;
mod judged;
mod kdtree;
mod kernels;
mod learning;
mod noise;
pub mod paper;
mod reference_points;
mod scatter;
mod shape;
mod subject;
mod table;
mod templates;

pub use bench::Bench;
pub use document::{Machine, document};
pub use error::ExperimentError;
pub use estimates::{Estimate, PnpSolver, Protocol, simulate_estimates};
pub use findings::Findings;
pub use subject::{Data, Subject};
pub use table::Table;

/// Raised whenever an experiment measures something else, so that what is kept of it is not taken for that.
pub(crate) const PROTOCOL: u32 = 2;

/// An experiment of the paper.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Experiment {
    /// Table 1: Chamfer distance, precision, recall and F-score.
    Shape,
    /// Table 2: Spearman's ρ between ADD and confidence of simulated estimates.
    Correlation,
    /// The confidence over outlier share and outlier noise.
    Noise,
    /// The thresholds of Eq. 11 over δ, beside the confidences of estimates.
    Delta,
    /// The confidence against ADD.
    Scatter,
    /// The ablation of kernels.
    Kernels,
    /// The ablation of the number of reference points.
    ReferencePoints,
    /// The Gaussian processes against a k-d tree of their input points.
    Kdtree,
    /// Adam against L-BFGS-B, and how many points hyperparameters are learned on.
    Learning,
}

impl Experiment {
    /// All of them, in the order in which a document tells them.
    pub const ALL: [Self; 9] = [
        Self::Shape,
        Self::Correlation,
        Self::Noise,
        Self::Delta,
        Self::Scatter,
        Self::Kernels,
        Self::ReferencePoints,
        Self::Kdtree,
        Self::Learning,
    ];

    /// Its name on the command line and in file names.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Shape => "shape",
            Self::Correlation => "correlation",
            Self::Noise => "noise",
            Self::Delta => "delta",
            Self::Scatter => "scatter",
            Self::Kernels => "kernels",
            Self::ReferencePoints => "reference-points",
            Self::Kdtree => "kdtree",
            Self::Learning => "learning",
        }
    }

    /// Runs it, or what is left of it.
    ///
    /// # Errors
    /// [`ExperimentError`]: the journal cannot be read or written, no object is left, or nothing can be
    /// drawn. Of single objects that fail the bench knows ([`Bench::failures`]).
    pub fn run(self, bench: &Bench<'_>) -> Result<Findings, ExperimentError> {
        match self {
            Self::Shape => shape::run(bench),
            Self::Correlation => correlation::run(bench),
            Self::Noise => noise::run(bench),
            Self::Delta => delta::run(bench),
            Self::Scatter => scatter::run(bench),
            Self::Kernels => kernels::run(bench),
            Self::ReferencePoints => reference_points::run(bench),
            Self::Kdtree => kdtree::run(bench),
            Self::Learning => learning::run(bench),
        }
    }
}
