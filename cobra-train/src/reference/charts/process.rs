//! The Gaussian process of a chart while charts are being chosen.
//!
//! Owns a fit that is cheap enough to be made again each round, and its leave-one-out residuals
//! (Rasmussen and Williams, Gaussian Processes for Machine Learning, 2006, Eq. 5.12). What a template
//! is made of is fitted by `gp::fit` once the charts stand.

use crate::gp::{
    Cholesky, Coordinates, FitError, Hyperparameters, Optimiser, coordinates, covariances, gram,
    learn,
};
use cobra_infer::{Exponent, Kernel, Metric};
use nalgebra::{Point3, UnitVector3};

/// What charts are judged by, whatever kernel the template will have.
const KERNEL: Kernel = Kernel::RationalQuadratic(Exponent::Half);

/// Samples that hyperparameters are learned on.
const SUBSET: usize = 100;

/// The least noise variance.
const NOISE_FLOOR: f64 = 1e-7;

pub(super) struct Process {
    centre: Point3<f64>,
    hyperparameters: Hyperparameters,
    coordinates: Coordinates,
    solution: Vec<f64>,
    prior_mean: f64,
    /// Of each point that it was fitted to: its distance less what the others predict.
    pub(super) residuals: Vec<f64>,
}

impl Process {
    /// Fits the distances of `points` from `centre`, all of which lie away from it. The first are
    /// those that hyperparameters are learned on, unless they are `known`.
    pub(super) fn fit(
        centre: Point3<f64>,
        points: &[Point3<f64>],
        known: Option<Hyperparameters>,
    ) -> Result<Self, FitError> {
        let (directions, distances): (Vec<UnitVector3<f64>>, Vec<f64>) = points
            .iter()
            .map(|point| UnitVector3::new_and_get(point - centre))
            .unzip();
        let prior_mean = distances.iter().sum::<f64>() / distances.len().max(1) as f64;
        let targets: Vec<f64> = distances.iter().map(|d| d - prior_mean).collect();
        let all = Coordinates::new(Metric::Chord, &directions);
        let hyperparameters = match known {
            Some(known) => known,
            None => {
                let count = targets.len().min(SUBSET);
                let few = Coordinates::new(Metric::Chord, &directions[..count]);
                learn(
                    KERNEL,
                    &few,
                    &targets[..count],
                    &Optimiser::Lbfgs,
                    NOISE_FLOOR,
                )?
                .hyperparameters
            }
        };
        let factor = Cholesky::new(gram(KERNEL, &hyperparameters, &all))?;
        let solution = factor.solve(&targets);
        let inverse = factor.inverse();
        let residuals = solution
            .iter()
            .enumerate()
            .map(|(i, weight)| weight / inverse[(i, i)])
            .collect();
        Ok(Self {
            centre,
            hyperparameters,
            coordinates: all,
            solution,
            prior_mean,
            residuals,
        })
    }

    pub(super) fn hyperparameters(&self) -> Hyperparameters {
        self.hyperparameters
    }

    /// The posterior mean in a direction.
    pub(super) fn mean(&self, direction: &UnitVector3<f64>) -> f64 {
        let query = coordinates(Metric::Chord, direction);
        let row = covariances(KERNEL, &self.hyperparameters, &self.coordinates, query);
        let sum: f64 = row.iter().zip(&self.solution).map(|(k, w)| k * w).sum();
        self.prior_mean + sum
    }

    /// A point's distance from the centre less the posterior mean in its direction.
    pub(super) fn residual(&self, point: &Point3<f64>) -> f64 {
        let (direction, distance) = UnitVector3::new_and_get(point - self.centre);
        distance - self.mean(&direction)
    }
}
