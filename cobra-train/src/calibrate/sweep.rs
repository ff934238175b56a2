//! What every threshold accepts, from the highest confidence down.
//!
//! Owns the treatment of ties: estimates of equal confidence are accepted together or not at all.

use super::Labelled;

/// What a threshold at a confidence that occurs accepts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Step<C = f32> {
    /// The confidence.
    pub(super) confidence: C,
    /// Wrong estimates of at least this confidence.
    pub(super) wrong: usize,
    /// Right ones.
    pub(super) right: usize,
}

/// A step for each confidence that occurs, from the highest down. The last one has accepted all.
pub(super) fn sweep<C: Copy + PartialEq + Into<f64>>(labelled: &[Labelled<C>]) -> Vec<Step<C>> {
    let mut sorted = labelled.to_vec();
    let number = |estimate: &Labelled<C>| -> f64 { estimate.confidence.into() };
    sorted.sort_by(|a, b| number(b).total_cmp(&number(a)));
    let (mut wrong, mut right) = (0, 0);
    sorted
        .chunk_by(|a, b| a.confidence == b.confidence)
        .map(|group| {
            let of_group = group.iter().filter(|estimate| estimate.right).count();
            right += of_group;
            wrong += group.len() - of_group;
            Step {
                confidence: group[0].confidence,
                wrong,
                right,
            }
        })
        .collect()
}

/// How many wrong and how many right estimates there are.
pub(super) fn totals<C>(steps: &[Step<C>]) -> (usize, usize) {
    steps.last().map_or((0, 0), |last| (last.wrong, last.right))
}
