//! Adam with a rate that falls on a plateau: the paper's recipe (its supplement, Optimization).
//!
//! Owns the update of D. P. Kingma and J. Ba, Adam: A Method for Stochastic Optimization, ICLR 2015,
//! algorithm 1, on any function with a gradient. Does not own what the variables mean.

use super::plateau::{Plateau, PlateauOptions};
use super::{Start, StopReason};

/// How Adam searches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdamOptions {
    /// The rate at the start.
    pub rate: f64,
    /// Where the search starts.
    pub start: Start,
    /// Decay of the gradient's running mean, β₁.
    pub first_decay: f64,
    /// Decay of the running mean of its square, β₂.
    pub second_decay: f64,
    /// Added to the root of the mean square, so that a vanishing gradient divides by something.
    pub epsilon: f64,
    /// When the rate falls.
    pub plateau: PlateauOptions,
    /// The search ends when the rate is below this.
    pub least_rate: f64,
    /// The most iterations, one evaluation of the likelihood and its gradient each.
    pub iterations: u64,
}

impl AdamOptions {
    /// The paper's: rate 0.1, times 0.1 after 10 iterations without improvement. What it leaves
    /// open is torch's default, with 250 iterations and an end at a rate of 10⁻⁶.
    ///
    /// Not GPyTorch's is the start: `docs/LEARNING.md` compares the two. In the mean of 16
    /// components of some 600 points they end within 0.005 of each other per point, either ahead;
    /// of 100 points, [`Start::Softplus`] ends 0.014 to 0.054 above [`Start::Targets`].
    #[must_use]
    pub const fn paper() -> Self {
        Self {
            rate: 0.1,
            start: Start::Targets,
            first_decay: 0.9,
            second_decay: 0.999,
            epsilon: 1e-8,
            plateau: PlateauOptions {
                factor: 0.1,
                patience: 10,
                threshold: 1e-4,
            },
            least_rate: 1e-6,
            iterations: 250,
        }
    }
}

/// The best of the points that were visited.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Best {
    pub(super) variables: Vec<f64>,
    pub(super) value: f64,
    pub(super) iterations: u64,
    pub(super) stop: StopReason,
}

/// Minimises `function` (value and gradient) from `start`; `project` brings a step back to where
/// the function may be asked.
///
/// Where the function fails, the search ends with the best point so far.
///
/// # Errors
/// The function's own, where it fails at the start.
pub(super) fn minimise<E>(
    start: Vec<f64>,
    options: &AdamOptions,
    function: impl Fn(&[f64]) -> Result<(f64, Vec<f64>), E>,
    project: impl Fn(&mut [f64]),
) -> Result<Best, E> {
    let (mut value, mut gradient) = function(&start)?;
    let mut best = Best {
        variables: start.clone(),
        value,
        iterations: 0,
        stop: StopReason::IterationLimit,
    };
    let mut variables = start;
    let mut rate = options.rate;
    let mut plateau = Plateau::new(options.plateau);
    let mut moments = vec![(0.0, 0.0); variables.len()];
    let (first, second) = (options.first_decay, options.second_decay);
    // The powers of the decays, by which the running means are too small at first.
    let (mut first_power, mut second_power) = (1.0, 1.0);
    while best.iterations < options.iterations {
        best.iterations += 1;
        first_power *= first;
        second_power *= second;
        for ((x, g), (mean, square)) in variables.iter_mut().zip(&gradient).zip(&mut moments) {
            *mean = first * *mean + (1.0 - first) * g;
            *square = second * *square + (1.0 - second) * g * g;
            let root = (*square / (1.0 - second_power)).sqrt() + options.epsilon;
            *x -= rate * *mean / (1.0 - first_power) / root;
        }
        project(&mut variables);
        rate = plateau.rate_after(value, rate);
        if rate < options.least_rate {
            best.stop = StopReason::RateExhausted;
            break;
        }
        match function(&variables) {
            Ok(found) => (value, gradient) = found,
            Err(_) => {
                best.stop = StopReason::NotPositiveDefinite;
                break;
            }
        }
        if value < best.value {
            best.value = value;
            best.variables.clone_from(&variables);
        }
    }
    Ok(best)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    /// (x − 3)² + 100(y + 1)² + 5
    fn valley(v: &[f64]) -> Result<(f64, Vec<f64>), Infallible> {
        let (x, y) = (v[0] - 3.0, v[1] + 1.0);
        Ok((x * x + 100.0 * y * y + 5.0, vec![2.0 * x, 200.0 * y]))
    }

    #[test]
    fn the_first_step_is_the_rate_against_the_gradients_sign() {
        let options = AdamOptions {
            iterations: 1,
            ..AdamOptions::paper()
        };
        let best = minimise(vec![0.0, 0.0], &options, valley, |_| {}).unwrap();
        assert!((best.variables[0] - 0.1).abs() < 1e-9, "{best:?}");
        assert!((best.variables[1] + 0.1).abs() < 1e-9, "{best:?}");
    }

    #[test]
    fn the_second_step_is_the_one_computed_by_hand() {
        // f = x²/2 from 1 at rate ½ without epsilon: x₁ = ½, then m̂ = (0.09 + 0.05)/0.19 and
        // v̂ = (0.000999 + 0.00025)/0.001999.
        let options = AdamOptions {
            rate: 0.5,
            epsilon: 0.0,
            iterations: 2,
            ..AdamOptions::paper()
        };
        let half_square = |v: &[f64]| Ok::<_, Infallible>((0.5 * v[0] * v[0], vec![v[0]]));
        let best = minimise(vec![1.0], &options, half_square, |_| {}).unwrap();
        let expected = 0.5 - 0.5 * (0.14 / 0.19) / (0.001_249_f64 / 0.001_999).sqrt();
        assert!((best.variables[0] - expected).abs() < 1e-12, "{best:?}");
    }

    #[test]
    fn a_quadratic_is_minimised_until_the_rate_is_exhausted() {
        let options = AdamOptions {
            iterations: 2000,
            ..AdamOptions::paper()
        };
        let best = minimise(vec![0.0, 0.0], &options, valley, |_| {}).unwrap();
        assert_eq!(best.stop, StopReason::RateExhausted);
        assert!(best.iterations < 2000);
        assert!(best.value - 5.0 < 1e-3, "{best:?}");
    }

    #[test]
    fn the_limit_ends_a_search_that_still_falls() {
        let options = AdamOptions {
            iterations: 5,
            ..AdamOptions::paper()
        };
        let best = minimise(vec![0.0, 0.0], &options, valley, |_| {}).unwrap();
        assert_eq!(
            (best.stop, best.iterations),
            (StopReason::IterationLimit, 5)
        );
    }

    #[test]
    fn the_best_point_is_kept_and_not_the_last() {
        // So fast that it overshoots to and fro.
        let options = AdamOptions {
            rate: 10.0,
            iterations: 3,
            ..AdamOptions::paper()
        };
        let start = vec![2.9, -1.0];
        let best = minimise(start.clone(), &options, valley, |_| {}).unwrap();
        assert_eq!(best.variables, start);
    }

    #[test]
    fn no_point_outside_of_the_box_is_asked_for() {
        let asked = |v: &[f64]| {
            assert!(v[0] <= 1.0, "{v:?}");
            valley(v)
        };
        let project = |v: &mut [f64]| v[0] = v[0].min(1.0);
        let best = minimise(vec![0.0, 0.0], &AdamOptions::paper(), asked, project).unwrap();
        assert_eq!(best.variables[0], 1.0);
    }

    #[test]
    fn a_failing_function_ends_the_search_with_the_best_point_so_far() {
        let cliff = |v: &[f64]| {
            if v[0] > 0.55 {
                Err("over the cliff")
            } else {
                Ok(valley(v).unwrap())
            }
        };
        let options = AdamOptions::paper();
        let best = minimise(vec![0.0, -1.0], &options, cliff, |_| {}).unwrap();
        assert_eq!(best.stop, StopReason::NotPositiveDefinite);
        assert!((0.4..=0.55).contains(&best.variables[0]), "{best:?}");
        assert_eq!(
            minimise(vec![1.0, -1.0], &options, cliff, |_| {}),
            Err("over the cliff")
        );
    }
}
