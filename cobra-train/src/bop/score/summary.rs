//! What the scores of a file are worth, where the truth is known.

use super::{Outcome, Scored};
use crate::calibrate::{Labelled, Roc};
use crate::evaluate::rank_correlation;
use cobra_infer::Decision;

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
        let area = |score: fn(&Outcome, f64) -> f32| {
            let labelled: Vec<Labelled> = known
                .iter()
                .map(|(outcome, truth, own)| Labelled {
                    confidence: score(outcome, *own),
                    right: truth.is_right(),
                })
                .collect();
            let same = labelled
                .windows(2)
                .all(|w| w[0].confidence == w[1].confidence);
            Roc::new(&labelled).filter(|_| !same).map(|roc| roc.area)
        };
        summary.area = area(|outcome, _| outcome.report.confidence);
        summary.own_area = area(|_, own| own as f32);
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
        let mut ratios: Vec<f64> = pairs
            .iter()
            .filter(|(_, error, _)| (0.1..0.5).contains(error))
            .map(|(outcome, error, diameter)| estimated(outcome, *diameter) / error)
            .collect();
        ratios.sort_by(f64::total_cmp);
        summary.error_ratio = ratios.get(ratios.len() / 2).copied();
        summary
    }
}
