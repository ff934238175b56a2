//! Learning hyperparameters: minimising the negative log marginal likelihood over a box.
//!
//! Owns the choice of the optimiser and what is told of a search: what it found and why it stopped.
//!
//! Both optimisers move the logarithms of the hyperparameters within [`search_box`], from the same
//! start unless Adam's is said to be another. GPyTorch moves raw values, all from 0, that softplus
//! makes positive. That recipe once ended, on the screwdriver after Adam's 250 iterations, at a mean
//! L/n of -3.169 against -3.182 of logarithms, three of 16 components being equal to four digits; but
//! the start differed as well. What of it is the parametrisation's is not known; the start alone moves
//! the mean by up to 0.005 (`docs/LEARNING.md`).

mod adam;
mod lbfgs;
mod objective;
mod plateau;
mod search_box;
mod start;

pub use adam::AdamOptions;
pub use plateau::PlateauOptions;
pub use search_box::{SearchBox, search_box};
pub use start::Start;

use super::cholesky::NotPositiveDefinite;
use super::gram::{Coordinates, Hyperparameters};
use cobra_infer::kernel::Kernel;
use objective::Objective;

/// The smallest noise variance by default, in units of the unit sphere: below it, weights grow so
/// large that the controller's `f32` sum loses more than a hundredth of σ̂.
pub const NOISE_FLOOR: f64 = 1e-5;

/// A noise floor above this leaves the search no room; the largest noise variance is e⁻².
pub const LARGEST_NOISE_FLOOR: f64 = 0.1;

/// The smallest noise variance of the paper's recipe: GPyTorch's own, in units of the unit sphere.
pub const PAPER_NOISE_FLOOR: f64 = 1e-4;

/// How hyperparameters are searched for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Optimiser {
    /// L-BFGS-B, at most 60 iterations.
    Lbfgs,
    /// Adam, the paper's.
    Adam(AdamOptions),
}

impl Optimiser {
    /// The most iterations it makes.
    #[must_use]
    pub const fn iteration_limit(&self) -> u64 {
        match self {
            Self::Lbfgs => lbfgs::ITERATIONS,
            Self::Adam(options) => options.iterations,
        }
    }
}

/// Why learning stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum StopReason {
    /// No entry of the gradient, projected on the box, is larger than the tolerance.
    GradientSmall,
    /// The likelihood stopped falling, to rounding.
    LikelihoodFlat,
    /// The rate fell below its least: the likelihood stopped falling by more than its threshold.
    RateExhausted,
    /// The iterations were used up.
    IterationLimit,
    /// The line search found no better point.
    LineSearchStalled,
    /// A Gram matrix on the way was not positive definite.
    NotPositiveDefinite,
}

impl StopReason {
    /// Whether the search ended before its own rule said that it was done.
    #[must_use]
    pub const fn is_early(self) -> bool {
        match self {
            Self::GradientSmall | Self::LikelihoodFlat | Self::RateExhausted => false,
            Self::IterationLimit | Self::LineSearchStalled | Self::NotPositiveDefinite => true,
        }
    }

    /// A word for programs.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::GradientSmall => "gradient-small",
            Self::LikelihoodFlat => "likelihood-flat",
            Self::RateExhausted => "rate-exhausted",
            Self::IterationLimit => "iteration-limit",
            Self::LineSearchStalled => "line-search-stalled",
            Self::NotPositiveDefinite => "not-positive-definite",
        }
    }
}

impl std::fmt::Display for StopReason {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::GradientSmall => "converged, the gradient is small",
            Self::LikelihoodFlat => "converged, the likelihood stopped falling",
            Self::RateExhausted => "converged, the plateau scheduler exhausted the rate",
            Self::IterationLimit => "iteration limit",
            Self::LineSearchStalled => "the line search found no better point",
            Self::NotPositiveDefinite => "the Gram matrix became singular",
        })
    }
}

/// What learning found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Learned {
    /// The best hyperparameters that were tried.
    pub hyperparameters: Hyperparameters,
    /// L/n there.
    pub likelihood_per_point: f64,
    /// Iterations used.
    pub iterations: u64,
    /// Why it stopped.
    pub stop: StopReason,
}

/// Why nothing was learned.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum OptimiserError {
    /// The Gram matrix is singular where the search starts.
    #[error("hyperparameters could not be learned: {0}")]
    NotPositiveDefinite(#[from] NotPositiveDefinite),
    /// The optimiser refused the problem; the text is its own.
    #[error("hyperparameters could not be learned: {0}")]
    Refused(String),
}

/// Where an optimiser ended, in logarithms.
struct Found {
    logarithms: Vec<f64>,
    value: f64,
    iterations: u64,
    stop: StopReason,
}

impl Found {
    fn learned(&self, search_box: &SearchBox) -> Learned {
        Learned {
            hyperparameters: search_box.unpack(&self.logarithms),
            likelihood_per_point: self.value,
            iterations: self.iterations,
            stop: self.stop,
        }
    }
}

/// Minimises L(θ)/n over [`search_box`] by L-BFGS-B from hyperparameters that are known to be good,
/// whatever the box: from the start that the targets suggest, a search may end where all is noise.
///
/// # Errors
/// As [`learn`].
pub fn learn_from(
    kernel: Kernel,
    points: &Coordinates,
    y: &[f64],
    known: &Hyperparameters,
    noise_floor: f64,
) -> Result<Learned, OptimiserError> {
    check(points, y, noise_floor)?;
    let search_box = search_box(kernel, noise_floor);
    let start = search_box.pack(known);
    let objective = Objective {
        kernel,
        points,
        y,
        search_box: search_box.clone(),
    };
    let found = lbfgs::minimise(start, objective, lbfgs::ITERATIONS)?;
    Ok(found.learned(&search_box))
}

fn check(points: &Coordinates, y: &[f64], noise_floor: f64) -> Result<(), OptimiserError> {
    if y.is_empty() || y.len() != points.len() {
        return Err(OptimiserError::Refused(format!(
            "{} targets for {} directions",
            y.len(),
            points.len()
        )));
    }
    if !(noise_floor > 0.0 && noise_floor <= LARGEST_NOISE_FLOOR) {
        return Err(OptimiserError::Refused(format!(
            "the noise floor must lie above 0 and be at most {LARGEST_NOISE_FLOOR}, found \
             {noise_floor}"
        )));
    }
    Ok(())
}

/// Minimises L(θ)/n over [`search_box`].
///
/// `points` are the directions, `y` the targets, as many and at least one; `noise_floor` the least
/// noise variance, above 0 and at most [`LARGEST_NOISE_FLOOR`] (unit sphere).
///
/// # Errors
/// [`OptimiserError`].
pub fn learn(
    kernel: Kernel,
    points: &Coordinates,
    y: &[f64],
    optimiser: &Optimiser,
    noise_floor: f64,
) -> Result<Learned, OptimiserError> {
    check(points, y, noise_floor)?;
    let search_box = search_box(kernel, noise_floor);
    let start = |from: Start| from.logarithms(kernel, &search_box, y);
    let objective = Objective {
        kernel,
        points,
        y,
        search_box: search_box.clone(),
    };
    let found = match optimiser {
        Optimiser::Lbfgs => lbfgs::minimise(start(Start::Targets), objective, lbfgs::ITERATIONS)?,
        Optimiser::Adam(options) => {
            let best = adam::minimise(
                start(options.start),
                options,
                |logarithms| objective.at(logarithms),
                |logarithms| search_box.clamp(logarithms),
            )?;
            Found {
                logarithms: best.variables,
                value: best.value,
                iterations: best.iterations,
                stop: best.stop,
            }
        }
    };
    Ok(found.learned(&search_box))
}
