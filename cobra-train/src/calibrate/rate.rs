//! Shares that were counted, and what they say of the share behind them.

use super::Labelled;
use cobra_infer::template::MeasuredShare;
use std::fmt;

/// The 97.5 % quantile of the normal distribution: 95 % lie between it and its negative.
const Z: f64 = 1.959_963_984_540_054;

/// Digits of a percentage.
const DIGITS: usize = 2;

/// So many of so many.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rate {
    /// How many.
    pub count: usize,
    /// Of how many.
    pub total: usize,
}

/// Bounds of a share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The lower bound.
    pub low: f64,
    /// The upper one.
    pub high: f64,
}

impl fmt::Display for Rate {
    /// The share in percent, with two digits unless the format asks for others: `0.97 %`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = f.precision().unwrap_or(DIGITS);
        write!(f, "{:.digits$} %", 100.0 * self.share())
    }
}

impl fmt::Display for Interval {
    /// Both bounds in percent, with two digits unless the format asks for others: `0.47 to 1.99 %`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = f.precision().unwrap_or(DIGITS);
        let [low, high] = [self.low, self.high].map(|bound| 100.0 * bound);
        write!(f, "{low:.digits$} to {high:.digits$} %")
    }
}

/// A share that somebody stated as a number of percent, without what the product rounds: 0.07 is 7 and not
/// 7.000000000000001.
#[must_use]
pub fn percent(share: f64) -> f64 {
    (share * 1e10).round() / 1e8
}

impl Rate {
    /// Of the right or of the wrong ones among `labelled` those that reach a threshold.
    #[must_use]
    pub fn of_accepted(labelled: &[Labelled], threshold: f32, right: bool) -> Self {
        let of_kind = labelled.iter().filter(|one| one.right == right);
        let accepted = of_kind.clone().filter(|one| one.confidence >= threshold);
        Self {
            count: accepted.count(),
            total: of_kind.count(),
        }
    }

    /// count/total; 0 of none.
    #[must_use]
    pub fn share(self) -> f64 {
        if self.total == 0 {
            0.0
        } else {
            self.count as f64 / self.total as f64
        }
    }

    /// The Wilson score interval at 95 %: with p = count/total, n = total and z = 1.96
    /// (p + z²/2n ± z√(p(1 − p)/n + z²/4n²)) / (1 + z²/n). Of repeated draws of n estimates about 95 %
    /// have the true share inside; unlike p ± z√(p(1 − p)/n) that holds for small shares too, and of none
    /// in n it reaches up to z²/(n + z²). Of none of none it is 0 to 1.
    ///
    /// Reference: E. B. Wilson, Probable inference, the law of succession, and statistical inference,
    /// J. Am. Stat. Assoc. 22 (1927).
    #[must_use]
    pub fn interval(self) -> Interval {
        if self.total == 0 {
            return Interval {
                low: 0.0,
                high: 1.0,
            };
        }
        let n = self.total as f64;
        let p = self.share();
        let centre = p + Z * Z / (2.0 * n);
        let half = Z * (p * (1.0 - p) / n + Z * Z / (4.0 * n * n)).sqrt();
        let scale = 1.0 + Z * Z / n;
        // Rounding must not put a bound on the wrong side of what was measured.
        Interval {
            low: ((centre - half) / scale).clamp(0.0, p),
            high: ((centre + half) / scale).clamp(p, 1.0),
        }
    }

    /// As a template stores it.
    #[must_use]
    pub fn measured(self) -> MeasuredShare {
        let Interval { low, high } = self.interval();
        MeasuredShare {
            share: self.share() as f32,
            low: low as f32,
            high: high as f32,
        }
    }

    /// The most of `total` that are no larger a share than `share`.
    pub(super) fn at_most(share: f64, total: usize) -> usize {
        // The product may be rounded below a whole number: 0.29 · 100.
        let count = (share * total as f64).floor() as usize;
        let next = Self {
            count: count + 1,
            total,
        };
        if next.share() <= share {
            count + 1
        } else {
            count
        }
    }

    /// The least total of which none at all shows a share of at most `share`: z²/(n + z²) ≤ share.
    pub(super) fn least_total(share: f64) -> usize {
        (Z * Z * (1.0 - share) / share).ceil() as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn interval(count: usize, total: usize) -> [f64; 2] {
        let Interval { low, high } = Rate { count, total }.interval();
        [low, high]
    }

    #[test]
    fn intervals_are_those_of_the_published_examples() {
        // R. G. Newcombe, Two-sided confidence intervals for the single proportion, Statist. Med. 17
        // (1998), Table I, method 3.
        for (count, total, expected) in [
            (81, 263, [0.2553, 0.3662]),
            (15, 148, [0.0624, 0.1605]),
            (0, 20, [0.0, 0.1611]),
            (1, 29, [0.0061, 0.1718]),
        ] {
            for (bound, expected) in interval(count, total).into_iter().zip(expected) {
                assert!((bound - expected).abs() < 6e-5, "{count}/{total}: {bound}");
            }
        }
    }

    #[test]
    fn shares_are_said_in_percent_with_two_digits_or_as_many_as_are_asked_for() {
        let rate = Rate {
            count: 7,
            total: 720,
        };
        assert_eq!(rate.to_string(), "0.97 %");
        assert_eq!(format!("{rate:.1}"), "1.0 %");
        assert_eq!(rate.interval().to_string(), "0.47 to 1.99 %");
        assert_eq!(format!("{:.0}", rate.interval()), "0 to 2 %");
    }

    #[test]
    fn what_reaches_a_threshold_is_counted_of_each_kind() {
        let labelled = [(0.5, true), (0.4, true), (0.5, false), (0.6, false)];
        let labelled = labelled.map(|(confidence, right)| Labelled { confidence, right });
        let counts = [true, false].map(|right| Rate::of_accepted(&labelled, 0.5, right).count);
        assert_eq!(counts, [1, 2]);
        assert_eq!(
            Rate::of_accepted(&labelled, 0.7, true),
            Rate { count: 0, total: 2 }
        );
    }

    #[test]
    fn a_stated_share_is_the_percent_that_was_meant() {
        for (share, said) in [
            (0.07, "7"),
            (0.14, "14"),
            (0.29, "29"),
            (0.005, "0.5"),
            (0.000_05, "0.005"),
            (1e-7, "0.00001"),
        ] {
            assert_eq!(percent(share).to_string(), said);
        }
    }

    #[test]
    fn what_was_measured_lies_inside_and_ends_are_exact() {
        for total in 1..200 {
            for count in 0..=total {
                let [low, high] = interval(count, total);
                let share = Rate { count, total }.share();
                assert!(0.0 <= low && low <= share && share <= high && high <= 1.0);
                let mirrored = interval(total - count, total);
                assert!((1.0 - mirrored[1] - low).abs() < 1e-12);
            }
            assert_eq!(interval(0, total)[0], 0.0);
            assert_eq!(interval(total, total)[1], 1.0);
        }
        assert_eq!(interval(0, 0), [0.0, 1.0]);
    }

    #[test]
    fn the_least_total_shows_the_share_and_one_fewer_does_not() {
        for share in [0.001, 0.01, 0.05, 0.3] {
            let least = Rate::least_total(share);
            assert!(interval(0, least)[1] <= share);
            assert!(interval(0, least - 1)[1] > share);
        }
        assert_eq!(Rate::least_total(0.01), 381);
    }

    #[test]
    fn the_most_that_are_no_larger_a_share_are_found_despite_rounding() {
        for total in 1..300 {
            for hundredths in 1..100 {
                let share = f64::from(hundredths) / 100.0;
                let exact = hundredths as usize * total / 100;
                assert_eq!(Rate::at_most(share, total), exact, "{share} of {total}");
            }
        }
    }
}
