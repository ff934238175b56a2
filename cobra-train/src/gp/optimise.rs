//! Learning hyperparameters: L-BFGS-B on the negative log marginal likelihood.
//!
//! Owns the start, the box and the stopping rule. The box keeps the search where the data can say
//! something: a sphere, for one, has no finite best length scale.

use super::gram::{Coordinates, Hyperparameters};
use super::likelihood::negative_log_marginal_likelihood;
use basin::{
    BoxBounds, ConstraintDescription, ConstraintSet, Constraints, CostFunction, Executor,
    FirstOrderState, Gradient, Lbfgsb, Termination,
};
use cobra_infer::kernel::Kernel;
use std::convert::Infallible;

/// The smallest noise variance, in units of the unit sphere: below it, weights grow so large that
/// the controller's `f32` sum loses more than a hundredth of σ̂.
pub const NOISE_FLOOR: f64 = 1e-5;

/// L-BFGS-B iterations; the likelihood is flat long before.
const ITERATIONS: u64 = 60;

/// Stops when no entry of the projected gradient of L/n exceeds this.
const GRADIENT_TOLERANCE: f64 = 1e-4;

const LENGTH_SCALE_LOG: (f64, f64) = (-5.0, 3.0);
const SIGNAL_VARIANCE_LOG: (f64, f64) = (-14.0, 6.0);
const NOISE_VARIANCE_LOG_MOST: f64 = -2.0;

/// Where the search for a kernel's parameter starts, and its box, in logarithms.
struct ParameterRange {
    start: f64,
    lower: f64,
    upper: f64,
}

fn parameter_range(kernel: Kernel) -> Option<ParameterRange> {
    let (start, lower, upper) = match kernel {
        _ if kernel.fixed_parameter().is_some() => return None,
        // One turn, of coordinates that are angles or differ by at most 2.
        Kernel::Periodic => (std::f64::consts::TAU.ln(), -2.0, 5.0),
        Kernel::Polynomial => (0.0, -7.0, 5.0),
        _ => (0.0, -4.0, 3.0),
    };
    Some(ParameterRange {
        start,
        lower,
        upper,
    })
}

/// Why learning stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StopReason {
    /// The gradient vanished or the likelihood stopped falling.
    Converged,
    /// The iterations were used up.
    IterationLimit,
    /// The line search found no better point.
    Stalled,
}

/// What learning found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Learned {
    /// The best hyperparameters.
    pub hyperparameters: Hyperparameters,
    /// L/n there.
    pub likelihood_per_point: f64,
    /// Iterations used.
    pub iterations: u64,
    /// Why it stopped.
    pub stop: StopReason,
}

/// The optimiser refused the problem; the text is its own.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("hyperparameters could not be learned: {0}")]
pub struct OptimiserError(String);

/// Minimises L(θ)/n over the box, from a start that the targets' variance gives.
///
/// `points` are the directions, `y` the targets, at least one.
///
/// # Errors
/// [`OptimiserError`] when the optimiser refuses the problem.
pub fn learn(kernel: Kernel, points: &Coordinates, y: &[f64]) -> Result<Learned, OptimiserError> {
    let n = y.len() as f64;
    let mean_square = (y.iter().map(|y| y * y).sum::<f64>() / n).max(1e-8);
    let mut start = vec![mean_square.ln(), (1e-3 * mean_square).ln()];
    let mut lower = vec![SIGNAL_VARIANCE_LOG.0, NOISE_FLOOR.ln()];
    let mut upper = vec![SIGNAL_VARIANCE_LOG.1, NOISE_VARIANCE_LOG_MOST];
    if kernel.fixed_length_scale().is_none() {
        start.insert(0, 0.5_f64.ln());
        lower.insert(0, LENGTH_SCALE_LOG.0);
        upper.insert(0, LENGTH_SCALE_LOG.1);
    }
    if let Some(range) = parameter_range(kernel) {
        start.push(range.start);
        lower.push(range.lower);
        upper.push(range.upper);
    }
    for ((value, low), high) in start.iter_mut().zip(&lower).zip(&upper) {
        *value = value.clamp(*low, *high);
    }
    let problem = MarginalLikelihood {
        kernel,
        points,
        y,
        lower,
        upper,
    };
    let solver = Lbfgsb::new().with_absolute_projected_gradient_tolerance(GRADIENT_TOLERANCE);
    let result = Executor::new(problem, solver, FirstOrderState::new(start))
        .max_iter(ITERATIONS)
        .run()
        .map_err(|error| OptimiserError(error.to_string()))?;
    Ok(Learned {
        hyperparameters: unpack(kernel, result.best_param()),
        likelihood_per_point: result.best_cost(),
        iterations: result.iter(),
        stop: match result.report.termination {
            Termination::Converged(_) | Termination::Target { .. } => StopReason::Converged,
            Termination::Limit(_) => StopReason::IterationLimit,
            _ => StopReason::Stalled,
        },
    })
}

fn unpack(kernel: Kernel, logarithms: &[f64]) -> Hyperparameters {
    let mut values = logarithms.iter().map(|logarithm| logarithm.exp());
    let mut next = |fixed: Option<f32>| match fixed {
        Some(fixed) => f64::from(fixed),
        None => values.next().unwrap_or(1.0),
    };
    Hyperparameters {
        length_scale: next(kernel.fixed_length_scale()),
        signal_variance: next(None),
        noise_variance: next(None).max(NOISE_FLOOR),
        parameter: next(kernel.fixed_parameter()),
    }
}

struct MarginalLikelihood<'a> {
    kernel: Kernel,
    points: &'a Coordinates,
    y: &'a [f64],
    lower: Vec<f64>,
    upper: Vec<f64>,
}

impl CostFunction for MarginalLikelihood<'_> {
    type Param = Vec<f64>;
    type Output = f64;
    type Error = Infallible;

    fn cost(&self, logarithms: &Vec<f64>) -> Result<f64, Infallible> {
        Ok(self.cost_and_gradient(logarithms)?.0)
    }
}

impl Gradient for MarginalLikelihood<'_> {
    type Gradient = Vec<f64>;

    fn gradient(&self, logarithms: &Vec<f64>) -> Result<Vec<f64>, Infallible> {
        Ok(self.cost_and_gradient(logarithms)?.1)
    }

    fn cost_and_gradient(&self, logarithms: &Vec<f64>) -> Result<(f64, Vec<f64>), Infallible> {
        let n = self.y.len() as f64;
        let hyperparameters = unpack(self.kernel, logarithms);
        Ok(
            match negative_log_marginal_likelihood(
                self.kernel,
                &hyperparameters,
                self.points,
                self.y,
            ) {
                Ok(found) => (
                    found.value / n,
                    found.gradient.iter().map(|g| g / n).collect(),
                ),
                // A wall that the line search turns back from.
                Err(_) => (1e10, vec![0.0; logarithms.len()]),
            },
        )
    }
}

impl Constraints for MarginalLikelihood<'_> {
    type Set = ConstraintSet<BoxBounds<Vec<f64>>>;

    fn constraints(&self) -> <Self::Set as ConstraintDescription>::Borrowed<'_> {
        ConstraintSet::new().with_bounds(BoxBounds::new(Some(&self.lower), Some(&self.upper)))
    }
}
