//! Precision against recall, over all thresholds: how many of the accepted estimates are right, where the
//! roc says how many of the wrong ones are accepted. It depends on how many of all are right.

use super::sweep::{sweep, totals};
use super::{Labelled, Rate};

/// What a threshold at a confidence that occurs accepts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrecisionRecallPoint {
    /// The threshold.
    pub threshold: f32,
    /// Right ones among the accepted.
    pub precision: Rate,
    /// Accepted ones among the right.
    pub recall: Rate,
}

/// The curve, and its summary.
#[derive(Clone, Debug, PartialEq)]
pub struct PrecisionRecall {
    /// From the highest threshold that accepts something to the one that accepts all.
    pub points: Vec<PrecisionRecallPoint>,
    /// Σ (R_i − R_{i−1}) P_i with recall R and precision P: the precision at each rise of recall, without
    /// interpolation, which would flatter.
    pub average_precision: f64,
}

impl PrecisionRecall {
    /// `None` without a right estimate.
    #[must_use]
    pub fn new(labelled: &[Labelled]) -> Option<Self> {
        let steps = sweep(labelled);
        let (_, right) = totals(&steps);
        if right == 0 {
            return None;
        }
        let points: Vec<_> = steps
            .iter()
            .map(|step| PrecisionRecallPoint {
                threshold: step.confidence,
                precision: Rate {
                    count: step.right,
                    total: step.right + step.wrong,
                },
                recall: Rate {
                    count: step.right,
                    total: right,
                },
            })
            .collect();
        let mut before = 0.0;
        let mut average_precision = 0.0;
        for point in &points {
            let recall = point.recall.share();
            average_precision += (recall - before) * point.precision.share();
            before = recall;
        }
        Some(Self {
            points,
            average_precision,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labelled(list: &[(f32, bool)]) -> Vec<Labelled> {
        list.iter()
            .map(|&(confidence, right)| Labelled { confidence, right })
            .collect()
    }

    #[test]
    fn average_precision_is_that_of_a_worked_example() {
        // scikit-learn's own: labels 0 0 1 1, scores 0.1 0.4 0.35 0.8.
        let list = labelled(&[(0.1, false), (0.4, false), (0.35, true), (0.8, true)]);
        let curve = PrecisionRecall::new(&list).unwrap();
        assert!((curve.average_precision - 0.833_333_333).abs() < 1e-9);
        let precisions: Vec<_> = curve.points.iter().map(|p| p.precision.share()).collect();
        assert_eq!(precisions, [1.0, 0.5, 2.0 / 3.0, 0.5]);
    }

    #[test]
    fn what_is_told_apart_has_1_and_what_is_all_tied_the_share_of_right_ones() {
        let apart = labelled(&[(0.9, true), (0.8, true), (0.2, false)]);
        let curve = PrecisionRecall::new(&apart).unwrap();
        assert!((curve.average_precision - 1.0).abs() < 1e-12);
        let tied = labelled(&[(0.5, true), (0.5, false), (0.5, false), (0.5, false)]);
        let curve = PrecisionRecall::new(&tied).unwrap();
        assert_eq!((curve.points.len(), curve.average_precision), (1, 0.25));
        assert_eq!(PrecisionRecall::new(&labelled(&[(0.5, false)])), None);
    }
}
