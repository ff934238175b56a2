//! Gaussian processes of the distance over directions: likelihood, optimisation, fit, posterior.
//!
//! Owns learning, and the predictive variance that only the host looks at. The covariance function
//! itself and the posterior mean of a template belong to `cobra-infer`, so that host and controller
//! compute the same thing.

mod bake;
mod banded;
mod cholesky;
mod compress;
mod fit;
mod gram;
mod likelihood;
mod optimise;
mod posterior;

pub use bake::{Baked, Sample, bake};
pub use cholesky::{Cholesky, NotPositiveDefinite};
pub use compress::{Compressed, Uncompressed, compress};
pub use fit::{
    FitError, FitOptions, FittedGp, LARGEST_GP, PriorMean, Subset, explained, fit, fit_from,
};
pub use gram::{Coordinates, Hyperparameters, coordinates, covariance, covariances, gram};
pub use likelihood::{LikelihoodAndGradient, negative_log_marginal_likelihood};
pub use optimise::{
    AdamOptions, LARGEST_NOISE_FLOOR, Learned, NOISE_FLOOR, Optimiser, OptimiserError,
    PAPER_NOISE_FLOOR, PlateauOptions, SearchBox, Start, StopReason, learn, learn_from, search_box,
};
pub use posterior::{Posterior, Prediction};
