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
    /// How far components reach into each other.
    pub overlap: Overlap,
    /// Metric and covariance function, and how they are fitted.
    pub fit: FitOptions,
    /// The seed of all randomness.
    pub seed: u64,
}

impl TrainOptions {
    /// The paper's numbers with this project's decisions: 10,000 and 30,000 points, 16 k-means
    /// components, the rational quadratic with α = 1, hyperparameters learned on 300 points.
    #[must_use]
    pub fn new(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            unit: Unit::Millimetre,
            sampling: SurfaceSampling::Cameras,
            points: 10_000,
            test_points: 30_000,
            reference_points: ReferencePoints::KMeans { components: 16 },
            overlap: Overlap::default(),
            fit: FitOptions::new(Kernel::RationalQuadratic(Exponent::One)),
            seed: 0,
        }
    }
}
