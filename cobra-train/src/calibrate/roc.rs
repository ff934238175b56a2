//! The receiver operating characteristic: what is accepted of the right estimates against what is of the
//! wrong ones, over all thresholds.

use super::sweep::{Step, sweep, totals};
use super::{Labelled, Rate};

/// A threshold's rates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RocPoint {
    /// The threshold: a confidence that occurs, or infinite where nothing is accepted.
    pub threshold: f32,
    /// Wrong estimates that are accepted.
    pub false_accepts: Rate,
    /// Right ones that are.
    pub true_accepts: Rate,
}

/// The curve, and the area below it.
#[derive(Clone, Debug, PartialEq)]
pub struct Roc {
    /// From the threshold that accepts nothing to the one that accepts all.
    pub points: Vec<RocPoint>,
    /// The area below the straight lines between them. It is the probability that a right estimate has
    /// a higher confidence than a wrong one, ties counted half: the Mann-Whitney statistic U divided by
    /// the number of pairs.
    pub area: f64,
}

impl Roc {
    /// `None` without a wrong or without a right estimate.
    #[must_use]
    pub fn new(labelled: &[Labelled]) -> Option<Self> {
        let steps = sweep(labelled);
        let (wrong, right) = totals(&steps);
        if wrong == 0 || right == 0 {
            return None;
        }
        let point = |threshold, accepted_wrong, accepted_right| RocPoint {
            threshold,
            false_accepts: Rate {
                count: accepted_wrong,
                total: wrong,
            },
            true_accepts: Rate {
                count: accepted_right,
                total: right,
            },
        };
        let mut points = vec![point(f32::INFINITY, 0, 0)];
        points.extend(
            steps
                .iter()
                .map(|step| point(step.confidence, step.wrong, step.right)),
        );
        Some(Self {
            points,
            area: area(&steps)?,
        })
    }
}

/// [`Roc::area`] alone, of scores in single or double precision; `None` without a wrong or without a right
/// estimate.
#[must_use]
pub fn area_under_roc<C: Copy + PartialEq + Into<f64>>(labelled: &[Labelled<C>]) -> Option<f64> {
    area(&sweep(labelled))
}

fn area<C>(steps: &[Step<C>]) -> Option<f64> {
    let (wrong, right) = totals(steps);
    if wrong == 0 || right == 0 {
        return None;
    }
    // Twice the area in units of a pair, whole numbers: nothing is rounded but the division.
    let (mut twice, mut before) = (0_u64, (0, 0));
    for step in steps {
        let (width, heights) = (step.wrong - before.0, step.right + before.1);
        twice += width as u64 * heights as u64;
        before = (step.wrong, step.right);
    }
    Some(twice as f64 / (2 * wrong as u64 * right as u64) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// Lists of few distinct confidences, so that there are ties.
    fn lists() -> impl Iterator<Item = Vec<Labelled>> {
        (0..300).map(|seed| {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let distinct = rng.random_range(1..12_u8);
            let count = rng.random_range(1..80);
            (0..count)
                .map(|_| Labelled {
                    confidence: f32::from(rng.random_range(0..=distinct)) / f32::from(distinct),
                    right: rng.random(),
                })
                .collect()
        })
    }

    /// Every pair of a right and a wrong estimate, asked one by one.
    fn mann_whitney(labelled: &[Labelled]) -> f64 {
        let of = |right| labelled.iter().filter(move |one| one.right == right);
        let (mut won, mut pairs) = (0.0, 0.0);
        for right in of(true) {
            for wrong in of(false) {
                pairs += 1.0;
                won += match right.confidence.total_cmp(&wrong.confidence) {
                    std::cmp::Ordering::Greater => 1.0,
                    std::cmp::Ordering::Equal => 0.5,
                    std::cmp::Ordering::Less => 0.0,
                };
            }
        }
        won / pairs
    }

    #[test]
    fn the_area_is_the_mann_whitney_statistic() {
        for labelled in lists() {
            let area = Roc::new(&labelled).map(|roc| roc.area);
            let kinds = [true, false].map(|right| labelled.iter().any(|one| one.right == right));
            assert_eq!(area, (kinds == [true; 2]).then(|| mann_whitney(&labelled)));
        }
    }

    #[test]
    fn scores_in_double_precision_that_single_precision_would_merge_or_overflow_are_told_apart() {
        let near = 1.0 + f64::EPSILON;
        for [low, high] in [[1.0, near], [1e300, 2e300], [-2e300, -1e300]] {
            let apart = [
                Labelled {
                    confidence: high,
                    right: true,
                },
                Labelled {
                    confidence: low,
                    right: false,
                },
            ];
            assert_eq!(area_under_roc(&apart), Some(1.0));
        }
        for labelled in lists() {
            let area = Roc::new(&labelled).map(|roc| roc.area);
            assert_eq!(area_under_roc(&labelled), area);
        }
    }

    #[test]
    fn the_curve_rises_from_nothing_to_all() {
        let shares = |point: &RocPoint| [point.false_accepts.share(), point.true_accepts.share()];
        for Roc { points, .. } in lists().filter_map(|labelled| Roc::new(&labelled)) {
            assert_eq!(shares(&points[0]), [0.0; 2]);
            assert_eq!(points.last().map(shares), Some([1.0; 2]));
            for pair in points.windows(2) {
                assert!(pair[0].threshold > pair[1].threshold);
                let [before, after] = [shares(&pair[0]), shares(&pair[1])];
                assert!(before[0] <= after[0] && before[1] <= after[1]);
            }
        }
    }
}
