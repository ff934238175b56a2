//! What the scores of a file are worth, where the truth is known.

use super::{Outcome, Scored, Truth};
use crate::calibrate::{Labelled, area_under_roc};
use crate::evaluate::rank_correlation;
use crate::pose::RIGHT;
use cobra_infer::Decision;

/// The error, as a share of the diameter, below which a wrong estimate is still about the object's place.
const NEAR: f64 = 0.5;

/// Counts, and how well scores tell right from wrong.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Summary {
    /// Rows.
    pub rows: usize,
    /// Rows that were scored.
    pub scored: usize,
    /// Accepted, rejected and undecided ones of these.
    pub decisions: [usize; 3],
    /// Scored rows whose truth is known.
    pub known: usize,
    /// Right ones of these.
    pub right: usize,
    /// The share of pairs of a right and a wrong estimate in which the right one has the higher confidence,
    /// equal ones counted half: the area under the ROC.
    pub area: Option<f64>,
    /// The same of the estimator's own scores; `None` also where these are all the same.
    pub own_area: Option<f64>,
    /// Spearman's correlation of the confidence and the error as a share of the diameter.
    pub correlation: Option<f64>,
    /// The same of the estimated error.
    pub error_correlation: Option<f64>,
    /// The median of the estimated over the true error, of wrong estimates within half a diameter.
    pub error_ratio: Option<f64>,
}

impl Summary {
    /// Of some rows.
    #[must_use]
    pub fn of<'s>(rows: impl IntoIterator<Item = &'s Scored>) -> Self {
        let mut summary = Self::default();
        let mut known = Vec::new();
        for row in rows {
            summary.rows += 1;
            let Ok(outcome) = &row.outcome else {
                continue;
            };
            summary.scored += 1;
            summary.decisions[match outcome.report.decision {
                Decision::Accept => 0,
                Decision::Reject(_) => 1,
                Decision::Undecided(_) => 2,
            }] += 1;
            if let (Some(truth), Some(estimate)) = (row.known_truth(), &row.estimate) {
                known.push((outcome, truth, estimate.score));
            }
        }
        summary.known = known.len();
        summary.right = known
            .iter()
            .filter(|(_, truth, _)| truth.is_right())
            .count();
        summary.area = area(&known, |outcome, _| f64::from(outcome.report.confidence));
        summary.own_area = area(&known, |_, own| own);
        let pairs: Vec<(&Outcome, f64, f64)> = known
            .iter()
            .filter_map(|(outcome, truth, _)| {
                let errors = truth.errors()?;
                Some((*outcome, errors.error() / errors.diameter, errors.diameter))
            })
            .collect();
        let errors: Vec<f64> = pairs.iter().map(|(_, error, _)| *error).collect();
        let against = |score: fn(&Outcome, f64) -> f64| {
            let scores: Vec<f64> = pairs.iter().map(|(o, _, d)| score(o, *d)).collect();
            rank_correlation(&scores, &errors)
        };
        summary.correlation = against(|outcome, _| f64::from(outcome.report.confidence));
        let estimated: fn(&Outcome, f64) -> f64 =
            |outcome, diameter| f64::from(outcome.report.estimated_error) / diameter;
        summary.error_correlation = against(estimated);
        let ratios = pairs
            .iter()
            .filter(|(_, error, _)| (RIGHT..NEAR).contains(error))
            .map(|(outcome, error, diameter)| estimated(outcome, *diameter) / error);
        summary.error_ratio = median(ratios.collect());
        summary
    }
}

/// The area under the ROC of a score; `None` also where it is always the same.
fn area(known: &[(&Outcome, &Truth, f64)], score: fn(&Outcome, f64) -> f64) -> Option<f64> {
    let labelled: Vec<Labelled<f64>> = known
        .iter()
        .map(|(outcome, truth, own)| Labelled {
            confidence: score(outcome, *own),
            right: truth.is_right(),
        })
        .collect();
    let first = labelled.first()?.confidence;
    let differ = labelled.iter().any(|one| one.confidence != first);
    area_under_roc(&labelled).filter(|_| differ)
}

/// The middle one of the numbers, or the mean of the two in the middle.
fn median(mut numbers: Vec<f64>) -> Option<f64> {
    numbers.sort_by(f64::total_cmp);
    let upper = *numbers.get(numbers.len() / 2)?;
    let lower = numbers[(numbers.len() - 1) / 2];
    Some(f64::midpoint(lower, upper))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_of_an_even_count_is_the_mean_of_the_two_in_the_middle() {
        assert_eq!(median(vec![4.0, 1.0, 2.0, 1.5]), Some(1.75));
        assert_eq!(median(vec![3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(vec![7.0]), Some(7.0));
        assert_eq!(median(Vec::new()), None);
    }
}
