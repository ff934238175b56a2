//! When a rate falls: torch's `ReduceLROnPlateau`, in its mode `min` with a relative threshold.
//!
//! Owns the counting. A loss is better when it is less than best·(1 − threshold), as torch has it.
//! For a negative loss that bound lies *above* the best one: a loss that stands still, or rises by
//! less than the threshold, counts as better and becomes the best one. A search among negative
//! losses, such as the likelihoods of a good fit, therefore keeps its rate unless it climbs.

/// What the scheduler is set to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlateauOptions {
    /// What the rate is multiplied by.
    pub factor: f64,
    /// How many losses in a row may be no better before the rate falls.
    pub patience: u32,
    /// The share by which a loss must be better.
    pub threshold: f64,
}

/// The scheduler's state.
#[derive(Clone, Debug)]
pub(super) struct Plateau {
    options: PlateauOptions,
    best: f64,
    bad: u32,
}

impl Plateau {
    pub(super) fn new(options: PlateauOptions) -> Self {
        Self {
            options,
            best: f64::INFINITY,
            bad: 0,
        }
    }

    /// The rate after `loss`.
    pub(super) fn rate_after(&mut self, loss: f64, rate: f64) -> f64 {
        if loss < self.best * (1.0 - self.options.threshold) {
            self.best = loss;
            self.bad = 0;
        } else {
            self.bad += 1;
        }
        if self.bad > self.options.patience {
            self.bad = 0;
            rate * self.options.factor
        } else {
            rate
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rates(losses: &[f64]) -> Vec<f64> {
        let mut plateau = Plateau::new(PlateauOptions {
            factor: 0.5,
            patience: 2,
            threshold: 0.1,
        });
        let mut rate = 8.0;
        losses
            .iter()
            .map(|loss| {
                rate = plateau.rate_after(*loss, rate);
                rate
            })
            .collect()
    }

    #[test]
    fn the_rate_falls_after_more_bad_losses_than_the_patience() {
        // Better is below 9; then below 7.2. The count starts again at each fall.
        let losses = [10.0, 9.5, 9.0, 8.0, 8.0, 7.5, 7.2, 7.3, 7.4, 7.5, 1.0];
        let expected = [8.0, 8.0, 8.0, 8.0, 8.0, 8.0, 4.0, 4.0, 4.0, 2.0, 2.0];
        assert_eq!(rates(&losses), expected);
    }

    #[test]
    fn a_negative_loss_that_stands_still_counts_as_better() {
        // Better is below −9, so −9.5 is the new best; then below −8.55, so −9 is; then below −8.1.
        let losses = [-10.0, -9.5, -9.0, -9.0, -9.0, -9.0];
        assert_eq!(rates(&losses), [8.0; 6]);
    }

    #[test]
    fn a_negative_loss_that_climbs_by_more_than_the_threshold_is_bad() {
        let losses = [-10.0, -8.9, -8.0, -7.0, -9.5, -8.0, -8.1, -8.2];
        let expected = [8.0, 8.0, 8.0, 4.0, 4.0, 4.0, 4.0, 2.0];
        assert_eq!(rates(&losses), expected);
    }
}
