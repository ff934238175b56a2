//! The posterior of a fitted component, mean and variance (Eqs. 4 and 5).
//!
//! Owns the predictive variance. Templates carry none: what a controller scores with is σ̂,
//! measured on test points (Eq. 9), and the mean of `cobra-infer`.

use super::cholesky::{Cholesky, NotPositiveDefinite};
use super::fit::FittedGp;
use super::gram::{Coordinates, Hyperparameters, coordinates, covariance, covariances, gram};
use cobra_infer::Model;
use nalgebra::UnitVector3;

/// A Gaussian process conditioned on training points, in their units.
#[derive(Clone, Debug)]
pub struct Posterior {
    model: Model,
    hyperparameters: Hyperparameters,
    prior_mean: f64,
    points: Coordinates,
    factor: Cholesky,
    solution: Vec<f64>,
}

/// What is known of the distance in one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prediction {
    /// m + kᵀK⁻¹(d − m) (Eq. 5), a length.
    pub mean: f64,
    /// v·k(x, x) − kᵀK⁻¹k (Eq. 5) of the surface's distance itself, a squared length, at least 0.
    pub variance: f64,
}

impl Posterior {
    /// Conditions a process with prior mean m on `targets`, d − m, at `directions`: as many of the
    /// one as of the other, at least one.
    ///
    /// # Errors
    /// [`NotPositiveDefinite`] where K = v·k(X, X) + η·I is numerically singular.
    pub fn new(
        model: Model,
        hyperparameters: &Hyperparameters,
        prior_mean: f64,
        directions: &[UnitVector3<f64>],
        targets: &[f64],
    ) -> Result<Self, NotPositiveDefinite> {
        let points = Coordinates::new(model.metric, directions);
        let factor = Cholesky::new(gram(model.kernel, hyperparameters, &points))?;
        Ok(Self {
            model,
            hyperparameters: *hyperparameters,
            prior_mean,
            solution: factor.solve(targets),
            points,
            factor,
        })
    }

    /// The posterior of a fitted component.
    ///
    /// # Errors
    /// [`NotPositiveDefinite`], which a fit that succeeded rules out.
    pub fn of(fitted: &FittedGp) -> Result<Self, NotPositiveDefinite> {
        Self::new(
            fitted.model,
            &fitted.learned.hyperparameters,
            fitted.prior_mean,
            &fitted.directions,
            &fitted.targets,
        )
    }

    /// Mean and variance of the surface's distance in `direction`.
    ///
    /// Both agree with a dense solve to K's condition times the rounding of `f64`.
    #[must_use]
    pub fn predict(&self, direction: &UnitVector3<f64>) -> Prediction {
        let (kernel, h) = (self.model.kernel, &self.hyperparameters);
        let query = coordinates(self.model.metric, direction);
        let row = covariances(kernel, h, &self.points, query);
        let explained: f64 = row.iter().zip(&self.solution).map(|(k, w)| k * w).sum();
        let prior = covariance(kernel, h, query, query);
        Prediction {
            mean: self.prior_mean + explained,
            // At a training point both terms are nearly v, and rounding may leave less than nothing.
            variance: (prior - self.factor.quadratic_form(&row)).max(0.0),
        }
    }

    /// η: what a measured distance scatters by about the surface's own, a squared length.
    #[must_use]
    pub const fn noise_variance(&self) -> f64 {
        self.hyperparameters.noise_variance
    }

    /// The variance of a measured distance of which `prediction` tells: that of the surface's
    /// distance and η.
    #[must_use]
    pub fn observation_variance(&self, prediction: &Prediction) -> f64 {
        prediction.variance + self.noise_variance()
    }
}
