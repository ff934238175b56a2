//! The axis of errors: linear from 0, or logarithmic where the errors span a wide range.
//!
//! Owns the choice between the two and the ticks; `plotters` draws them.

use std::ops::Range;

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};

/// From this ratio of the largest to the smallest error on, the axis is logarithmic.
const LOGARITHMIC_FROM: f64 = 20.0;

/// An axis of errors in millimetres.
pub(super) struct ErrorAxis {
    logarithmic: bool,
    low: f64,
    high: f64,
    ticks: Vec<f64>,
}

impl ErrorAxis {
    /// The axis that shows all of these errors. What is not positive stands at its lower end.
    pub(super) fn spanning(errors: impl Iterator<Item = f64>) -> Self {
        let (least, most) = errors
            .filter(|&error| error > 0.0)
            .fold((f64::INFINITY, 0.0_f64), |(least, most), error| {
                (least.min(error), most.max(error))
            });
        let (least, most) = if most > 0.0 {
            (least, most)
        } else {
            (1.0, 1.0)
        };
        let least = least.max(most / 1e4);
        let logarithmic = most / least >= LOGARITHMIC_FROM;
        let (low, high) = if logarithmic {
            (least / 1.1, most * 1.1)
        } else {
            (0.0, most * 1.05)
        };
        let ticks = if logarithmic {
            one_two_five(low, high).collect()
        } else {
            let step = one_two_five(high / 12.0, high).next().unwrap_or(high);
            (0..=(high / step).floor() as usize)
                .map(|i| i as f64 * step)
                .collect()
        };
        Self {
            logarithmic,
            low,
            high,
            ticks,
        }
    }

    fn scaled(&self, error: f64) -> f64 {
        if self.logarithmic {
            libm::log10(error)
        } else {
            error
        }
    }
}

impl Ranged for ErrorAxis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, error: &f64, (from, to): (i32, i32)) -> i32 {
        let at = |error: f64| self.scaled(error.clamp(self.low, self.high));
        let (low, high) = (at(self.low), at(self.high));
        let share = (at(*error) - low) / (high - low);
        from + (share * f64::from(to - from)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        self.ticks.clone()
    }

    fn range(&self) -> Range<f64> {
        self.low..self.high
    }
}

impl ValueFormatter<f64> for ErrorAxis {
    fn format_ext(&self, error: &f64) -> String {
        // Ticks have few digits: this takes away what multiplying a step has rounded.
        format!("{}", (error * 1e6).round() / 1e6)
    }
}

/// The numbers 1, 2 and 5 times powers of ten within a range.
fn one_two_five(low: f64, high: f64) -> impl Iterator<Item = f64> {
    (-6..=6)
        .flat_map(|power: i32| {
            [1.0, 2.0, 5.0].map(|digit| {
                if power < 0 {
                    digit / 10_f64.powi(-power)
                } else {
                    digit * 10_f64.powi(power)
                }
            })
        })
        .filter(move |&tick| low <= tick && tick <= high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wide_range_of_errors_gets_a_logarithmic_axis_with_round_ticks() {
        let axis = ErrorAxis::spanning([0.3, 60.0].into_iter());
        assert!(axis.logarithmic);
        let labels: Vec<_> = axis.ticks.iter().map(|&t| axis.format_ext(&t)).collect();
        assert_eq!(labels, ["0.5", "1", "2", "5", "10", "20", "50"]);
    }

    #[test]
    fn a_narrow_range_of_errors_starts_at_zero() {
        let axis = ErrorAxis::spanning([2.0, 6.0].into_iter());
        assert!(!axis.logarithmic);
        assert_eq!(axis.low, 0.0);
        assert_eq!(axis.format_ext(&axis.ticks[1]), "1");
        assert!(axis.high > 6.0 && axis.ticks.len() <= 13);
    }

    #[test]
    fn errors_of_zero_still_have_an_axis() {
        let axis = ErrorAxis::spanning([0.0, 0.0].into_iter());
        assert_eq!(axis.map(&0.0, (10, 90)), 10);
        let axis = ErrorAxis::spanning([0.0, 1e-9, 50.0].into_iter());
        assert!(axis.logarithmic);
        assert_eq!(axis.map(&0.0, (10, 90)), 10);
    }
}
