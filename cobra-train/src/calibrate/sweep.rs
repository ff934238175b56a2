//! What every threshold accepts, from the highest confidence down.
//!
//! Owns the treatment of ties: estimates of equal confidence are accepted together or not at all.

use super::Labelled;

/// What a threshold at a confidence that occurs accepts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Step {
    /// The confidence.
    pub(super) confidence: f32,
    /// Wrong estimates of at least this confidence.
    pub(super) wrong: usize,
    /// Right ones.
    pub(super) right: usize,
}

/// A step for each confidence that occurs, from the highest down. The last one has accepted all.
pub(super) fn sweep(labelled: &[Labelled]) -> Vec<Step> {
    let mut sorted = labelled.to_vec();
    sorted.sort_by(|a, b| b.confidence.total_cmp(&a.confidence));
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
pub(super) fn totals(steps: &[Step]) -> (usize, usize) {
    steps.last().map_or((0, 0), |last| (last.wrong, last.right))
}
