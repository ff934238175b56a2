//! Seeded random streams.
//!
//! Every use of randomness draws from a stream of its own, named by the seed, what it is for, and
//! an index. No stream is shared between threads, so results do not depend on their number.

use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// What a stream of random numbers is for. The order is part of the streams: new ones come last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Surface points for fitting a template, and the held-out ones that measure σ̂.
    Training,
    /// Surface points that a finished template is measured on.
    Evaluation,
    /// Surface points for simulated observations.
    Demonstration,
    /// Where k-means starts.
    Clustering,
    /// Which points placements of reference points are judged by.
    Selection,
    /// Which points hyperparameters are learned on.
    HyperparameterSubset,
    /// Simulated pose errors.
    PoseErrors,
    /// Candidates for Poisson-disk points.
    PoissonDisks,
    /// How the directions of rays from reference points are turned, and which hits are kept.
    RaysFromWithin,
    /// Which points of a cloud a template is fitted to, and which measure σ̂.
    CloudSplit,
    /// Which samples charts are chosen on, and beside which their centres are looked for.
    Charts,
    /// Which samples around a chart it is fitted to besides its own.
    ChartRings,
    /// Where points are moved off the surface.
    OffSurface,
    /// Noise on simulated depth images.
    DepthNoise,
    /// How the views and the candidates of a search for ambiguities are turned.
    Ambiguity,
    /// Scenes of one object, and wrong poses in them.
    SimulatedScenes,
    /// Noise on the pixels of simulated estimates.
    SimulatedEstimates,
}

/// The stream for one purpose and index.
#[must_use]
pub fn stream(seed: u64, purpose: Purpose, index: u64) -> ChaCha8Rng {
    let mut key = [0; 32];
    key[..8].copy_from_slice(&seed.to_le_bytes());
    key[8] = purpose as u8;
    key[16..24].copy_from_slice(&index.to_le_bytes());
    ChaCha8Rng::from_seed(key)
}

/// A standard normal variate by Box and Muller's transform, with `libm` so that every platform
/// draws the same.
pub(crate) fn normal(rng: &mut impl Rng) -> f64 {
    let radius = (-2.0 * libm::log(1.0 - rng.random::<f64>())).sqrt();
    radius * libm::cos(2.0 * std::f64::consts::PI * rng.random::<f64>())
}
