//! How often estimates of a given confidence are right.
//!
//! The confidence is a mean likelihood and not a probability of being right; these shares say what it
//! comes to on the estimates at hand.

use super::{Labelled, Rate};

/// Bins between 0 and 1.
const BINS: usize = 10;

/// The estimates whose confidence lies in one tenth of 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bin {
    /// The least confidence that belongs to it.
    pub low: f64,
    /// The least that does not, but for the last bin, which 1 belongs to.
    pub high: f64,
    /// The mean confidence of its estimates.
    pub confidence: f64,
    /// The right ones among them.
    pub right: Rate,
}

/// The bins that hold something, from low to high. Confidences must be from 0 to 1; others are clamped,
/// and what is no number is left out.
#[must_use]
pub fn reliability(labelled: &[Labelled]) -> Vec<Bin> {
    let mut bins = [(0.0, 0, 0); BINS];
    for estimate in labelled.iter().filter(|one| !one.confidence.is_nan()) {
        let confidence = f64::from(estimate.confidence).clamp(0.0, 1.0);
        let index = ((confidence * BINS as f64) as usize).min(BINS - 1);
        let (sum, right, count) = &mut bins[index];
        *sum += confidence;
        *right += usize::from(estimate.right);
        *count += 1;
    }
    bins.into_iter()
        .enumerate()
        .filter(|(_, (_, _, count))| *count > 0)
        .map(|(index, (sum, right, count))| Bin {
            low: index as f64 / BINS as f64,
            high: (index + 1) as f64 / BINS as f64,
            confidence: sum / count as f64,
            right: Rate {
                count: right,
                total: count,
            },
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_estimate_is_in_one_bin_and_empty_bins_are_left_out() {
        let list = [
            (0.0, false),
            (0.099, true),
            (0.5, true),
            (0.96, true),
            (1.0, false),
            (1.0, true),
        ];
        let labelled = list.map(|(confidence, right)| Labelled { confidence, right });
        let bins = reliability(&labelled);
        let lows: Vec<_> = bins.iter().map(|bin| bin.low).collect();
        assert_eq!(lows, [0.0, 0.5, 0.9]);
        let rights: Vec<_> = bins
            .iter()
            .map(|bin| (bin.right.count, bin.right.total))
            .collect();
        assert_eq!(rights, [(1, 2), (1, 1), (2, 3)]);
        assert!((bins[2].confidence - 2.96 / 3.0).abs() < 1e-6);
        assert_eq!(reliability(&[]), []);
    }

    #[test]
    fn a_bin_s_mean_lies_in_it() {
        let labelled: Vec<_> = (0..=1000)
            .map(|i| Labelled {
                confidence: i as f32 / 1000.0,
                right: i % 3 == 0,
            })
            .collect();
        let bins = reliability(&labelled);
        assert_eq!(bins.len(), 10);
        assert!(
            bins.iter()
                .all(|bin| bin.low <= bin.confidence && bin.confidence <= bin.high)
        );
    }
}
