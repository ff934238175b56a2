//! What to train, and the numbers that stand unless somebody says otherwise.

use super::{Overlap, ReferencePoints, SurfaceSampling};
use crate::gp::FitOptions;
use cobra_infer::{Exponent, Kernel, Unit};

/// What to train.
#[derive(Clone, Debug, PartialEq)]
pub struct TrainOptions {
    /// The object's name, as it is written into the template.
    pub name: String,
    /// The unit that the mesh's numbers are in.
    pub unit: Unit,
    /// How training points are drawn.
    pub sampling: SurfaceSampling,
    /// Training points.
    pub points: usize,
    /// Test points, for σ̂; always drawn as cameras see the object.
    pub test_points: usize,
    /// Where the reference points come from.
    pub reference_points: ReferencePoints,
    /// How far components reach into each other; charts have a ring of their own instead.
    pub overlap: Overlap,
    /// Whether components speak only where they are verified.
    pub validity: Validity,
    /// What the template says the mean by.
    pub mean: MeanForm,
    /// The most bytes that the template may have, which its terms are compressed into; `None` for the
    /// exact Gaussian process. Of the metric of the chord alone. Of maps, `None` for the finest.
    pub budget: Option<usize>,
    /// Metric and covariance function, and how they are fitted.
    pub fit: FitOptions,
    /// The seed of all randomness.
    pub seed: u64,
}

/// Where components may speak.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Validity {
    /// In the directions in which what they predict lies beside their own points.
    #[default]
    Verified,
    /// Everywhere, as in the paper.
    Everywhere,
}

/// What a template says the posterior mean by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MeanForm {
    /// The terms of the Gaussian process: the reference.
    #[default]
    Process,
    /// A map over the directions, which costs a point the same however many terms there were. For
    /// [`Validity::Verified`] alone.
    Map,
}

/// The most charts unless somebody says otherwise.
pub const MOST_CHARTS: usize = 96;

/// The bytes that a template is compressed into unless somebody says otherwise: 14 KB.
pub const BUDGET: usize = 14_336;

/// As [`BUDGET`], of maps: 24 KB.
pub const MAP_BUDGET: usize = 24_576;

impl TrainOptions {
    /// This project's choices: reference points that place themselves, the rational quadratic with
    /// α = ½, verified directions, 14,336 bytes; 10,000 and 30,000 points, hyperparameters learned
    /// on 300.
    #[must_use]
    pub fn new(name: impl Into<String>) -> Self {
        Self {
            reference_points: ReferencePoints::Auto { most: MOST_CHARTS },
            validity: Validity::Verified,
            budget: Some(BUDGET),
            fit: FitOptions::new(Kernel::RationalQuadratic(Exponent::Half)),
            ..Self::clustered(name, 16)
        }
    }

    /// The paper's template with this project's numbers: k-means components that speak everywhere, the
    /// exact Gaussian process, the rational quadratic with α = 1.
    #[must_use]
    pub fn clustered(name: impl Into<String>, components: usize) -> Self {
        Self {
            name: name.into(),
            unit: Unit::Millimetre,
            sampling: SurfaceSampling::Cameras,
            points: 10_000,
            test_points: 30_000,
            reference_points: ReferencePoints::KMeans { components },
            overlap: Overlap::default(),
            validity: Validity::Everywhere,
            mean: MeanForm::Process,
            budget: None,
            fit: FitOptions::new(Kernel::RationalQuadratic(Exponent::One)),
            seed: 0,
        }
    }
}
