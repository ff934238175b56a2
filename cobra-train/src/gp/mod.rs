//! Gaussian processes of the distance over directions: likelihood, optimisation, fit.
//!
//! Owns learning. The covariance function itself and the posterior mean belong to `cobra-infer`,
//! so that host and controller compute the same thing.

mod cholesky;
mod fit;
mod gram;
mod likelihood;
mod optimise;

pub use cholesky::{Cholesky, NotPositiveDefinite};
pub use fit::{FitError, FitOptions, FittedGp, LARGEST_GP, PriorMean, explained, fit};
pub use gram::{Coordinates, Hyperparameters, coordinates, covariance, covariances, gram};
pub use likelihood::{LikelihoodAndGradient, negative_log_marginal_likelihood};
pub use optimise::{Learned, NOISE_FLOOR, OptimiserError, StopReason, learn};
