//! L-BFGS-B on the logarithms of the hyperparameters: this project's default.
//!
//! Owns the stopping rule. The method itself is the crate `basin`'s.

use super::objective::Objective;
use super::{Found, OptimiserError, StopReason};
use crate::gp::cholesky::NotPositiveDefinite;
use basin::{
    BoxBounds, ConstraintDescription, ConstraintSet, Constraints, ConvergenceTest, CostFunction,
    Executor, FirstOrderState, Gradient, Lbfgsb, Termination,
};
use std::cell::Cell;
use std::convert::Infallible;

/// The likelihood is flat long before.
pub(super) const ITERATIONS: u64 = 60;

/// Stops when no entry of the projected gradient of L/n exceeds this.
const GRADIENT_TOLERANCE: f64 = 1e-4;

/// What a singular Gram matrix counts as: a wall that the line search turns back from.
const WALL: f64 = 1e10;

pub(super) fn minimise(
    start: Vec<f64>,
    objective: Objective<'_>,
    iterations: u64,
) -> Result<Found, OptimiserError> {
    let wall = Cell::new(None);
    let problem = Problem {
        objective,
        wall: &wall,
    };
    let solver = Lbfgsb::new().with_absolute_projected_gradient_tolerance(GRADIENT_TOLERANCE);
    let result = Executor::new(problem, solver, FirstOrderState::new(start))
        .max_iter(iterations)
        .run()
        .map_err(|error| OptimiserError::Refused(error.to_string()))?;
    if let (Some(wall), true) = (wall.get(), result.best_cost() >= WALL) {
        return Err(wall.into());
    }
    let stop = match &result.report.termination {
        Termination::Converged(convergence) => match convergence.criteria().first() {
            Some(first) if first.test == ConvergenceTest::RelativeCostReduction => {
                StopReason::LikelihoodFlat
            }
            _ => StopReason::GradientSmall,
        },
        Termination::Target { .. } => StopReason::LikelihoodFlat,
        Termination::Limit(_) => StopReason::IterationLimit,
        _ if wall.get().is_some() => StopReason::NotPositiveDefinite,
        _ => StopReason::LineSearchStalled,
    };
    Ok(Found {
        logarithms: result.best_param().clone(),
        value: result.best_cost(),
        iterations: result.iter(),
        stop,
    })
}

struct Problem<'a> {
    objective: Objective<'a>,
    /// The last one that was met.
    wall: &'a Cell<Option<NotPositiveDefinite>>,
}

impl CostFunction for Problem<'_> {
    type Param = Vec<f64>;
    type Output = f64;
    type Error = Infallible;

    fn cost(&self, logarithms: &Vec<f64>) -> Result<f64, Infallible> {
        Ok(self.cost_and_gradient(logarithms)?.0)
    }
}

impl Gradient for Problem<'_> {
    type Gradient = Vec<f64>;

    fn gradient(&self, logarithms: &Vec<f64>) -> Result<Vec<f64>, Infallible> {
        Ok(self.cost_and_gradient(logarithms)?.1)
    }

    fn cost_and_gradient(&self, logarithms: &Vec<f64>) -> Result<(f64, Vec<f64>), Infallible> {
        Ok(self.objective.at(logarithms).unwrap_or_else(|wall| {
            self.wall.set(Some(wall));
            (WALL, vec![0.0; logarithms.len()])
        }))
    }
}

impl Constraints for Problem<'_> {
    type Set = ConstraintSet<BoxBounds<Vec<f64>>>;

    fn constraints(&self) -> <Self::Set as ConstraintDescription>::Borrowed<'_> {
        let bounds = &self.objective.search_box;
        ConstraintSet::new().with_bounds(BoxBounds::new(Some(&bounds.lower), Some(&bounds.upper)))
    }
}
