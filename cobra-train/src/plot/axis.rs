//! An axis with the ticks that it is given.

/// What runs along one side of a panel. On a logarithmic one range and ticks are in powers of ten.
#[derive(Clone)]
pub(crate) struct Axis<'a> {
    pub(super) label: &'a str,
    pub(super) range: (f64, f64),
    pub(super) ticks: Vec<(f64, String)>,
    logarithmic: bool,
}

/// More steps than this are no axis.
const MOST_STEPS: f64 = 40.0;

impl<'a> Axis<'a> {
    /// From the first of `ticks` to the last, and `beyond` that share of it on both sides.
    pub(crate) fn linear(label: &'a str, ticks: &[f64], beyond: f64) -> Self {
        Self::new(label, ticks, beyond, false)
    }

    /// As [`Axis::linear`], in powers of ten; `ticks` are numbers above 0.
    pub(crate) fn logarithmic(label: &'a str, ticks: &[f64], beyond: f64) -> Self {
        Self::new(label, ticks, beyond, true)
    }

    /// Multiples of `step` around all `values`, no farther than `limits`.
    pub(crate) fn steps(
        label: &'a str,
        values: impl Iterator<Item = f64>,
        step: f64,
        limits: (f64, f64),
    ) -> Self {
        let values = values.filter(|value| value.is_finite());
        let (low, high) = values.fold((limits.1, limits.0), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        let (low, high) = (low.max(limits.0), high.min(limits.1));
        let (low, high) = if low <= high { (low, high) } else { limits };
        let (first, last) = (
            (low / step).floor(),
            (high / step).ceil().max((low / step).floor() + 1.0),
        );
        let count = (last - first).min(MOST_STEPS) as i32;
        let ticks: Vec<f64> = (0..=count)
            .map(|index| (first + f64::from(index)) * step)
            .collect();
        Self::linear(label, &ticks, 0.03)
    }

    /// A place for each name, the first one highest.
    pub(crate) fn names<S: AsRef<str>>(label: &'a str, names: &[S]) -> Self {
        let count = names.len();
        let ticks = names.iter().enumerate();
        Self {
            label,
            range: (-0.6, count as f64 - 0.4),
            ticks: ticks
                .map(|(index, name)| (Self::place(index, count), name.as_ref().to_owned()))
                .collect(),
            logarithmic: false,
        }
    }

    /// Places of width 1 for cells, each with its number in the middle.
    pub(crate) fn bins(label: &'a str, numbers: &[f64]) -> Self {
        let ticks = numbers.iter().enumerate();
        Self {
            label,
            range: (0.0, numbers.len() as f64),
            ticks: ticks
                .map(|(index, value)| (index as f64 + 0.5, number(*value)))
                .collect(),
            logarithmic: false,
        }
    }

    /// Where the name of this index stands among so many.
    pub(crate) fn place(index: usize, count: usize) -> f64 {
        (count - 1 - index) as f64
    }

    /// 1, 2 and 5 times powers of ten around all `values` above 0.
    pub(crate) fn around(label: &'a str, values: impl Iterator<Item = f64>) -> Self {
        let values = values.filter(|value| value.is_finite() && *value > 0.0);
        let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        let (low, high) = if low < high {
            (low, high)
        } else if low.is_finite() {
            (low / 1.5, low * 1.5)
        } else {
            (0.1, 1.0)
        };
        let powers = low.log10().floor() as i32..=high.log10().ceil() as i32;
        let wide = powers.end() - powers.start() > 3;
        let digits: &[f64] = if wide { &[1.0] } else { &[1.0, 2.0, 5.0] };
        let all: Vec<f64> = powers
            .flat_map(|power| digits.iter().map(move |digit| digit * 10_f64.powi(power)))
            .collect();
        let first = all.iter().rposition(|tick| *tick <= low).unwrap_or(0);
        let last = all.iter().position(|tick| *tick >= high);
        Self::logarithmic(label, &all[first..=last.unwrap_or(all.len() - 1)], 0.02)
    }

    fn new(label: &'a str, ticks: &[f64], beyond: f64, logarithmic: bool) -> Self {
        let ticks: Vec<(f64, String)> = ticks
            .iter()
            .map(|tick| {
                let at = if logarithmic { tick.log10() } else { *tick };
                (at, number(*tick))
            })
            .collect();
        let first = ticks.first().map_or(0.0, |tick| tick.0);
        let last = ticks.last().map_or(1.0, |tick| tick.0);
        let room = beyond * (last - first);
        Self {
            label,
            range: (first - room, last + room),
            ticks,
            logarithmic,
        }
    }

    /// Where a value stands; what lies beyond the axis, at its end.
    pub(super) fn at(&self, value: f64) -> f64 {
        let value = if self.logarithmic {
            value.max(f64::MIN_POSITIVE).log10()
        } else {
            value
        };
        value.clamp(self.range.0, self.range.1)
    }
}

/// As few digits as say it, without what arithmetic has rounded.
fn number(value: f64) -> String {
    let rounded = format!("{value:.6}");
    let short = rounded.trim_end_matches('0').trim_end_matches('.');
    short.replace('-', "\u{2212}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_around_values_reach_beyond_them() {
        let texts = |values: &[f64]| -> Vec<String> {
            let axis = Axis::around("", values.iter().copied());
            axis.ticks.into_iter().map(|tick| tick.1).collect()
        };
        assert_eq!(texts(&[0.03, 0.4]), ["0.02", "0.05", "0.1", "0.2", "0.5"]);
        assert_eq!(
            texts(&[0.02, 500.0]),
            ["0.01", "0.1", "1", "10", "100", "1000"]
        );
        assert_eq!(texts(&[3.0]), ["2", "5"]);
        assert_eq!(texts(&[f64::INFINITY, 0.0]), ["0.1", "0.2", "0.5", "1"]);
    }

    #[test]
    fn steps_hold_all_values_and_keep_to_the_limits() {
        let texts = |values: &[f64]| -> Vec<String> {
            let axis = Axis::steps("", values.iter().copied(), 5.0, (0.0, 100.0));
            axis.ticks.into_iter().map(|tick| tick.1).collect()
        };
        assert_eq!(texts(&[84.0, 99.9]), ["80", "85", "90", "95", "100"]);
        assert_eq!(texts(&[90.0]), ["90", "95"]);
        assert_eq!(texts(&[f64::NAN]).len(), 21);
        assert_eq!(texts(&[-1e300, 99.0]).len(), 21);
    }

    #[test]
    fn names_stand_from_above() {
        let axis = Axis::names("", &["a", "b", "c"]);
        assert_eq!(axis.ticks[0], (2.0, "a".to_owned()));
        assert_eq!(axis.ticks[2], (Axis::place(2, 3), "c".to_owned()));
    }

    #[test]
    fn what_lies_beyond_stands_at_the_end() {
        let axis = Axis::linear("", &[0.0, 1.0], 0.0);
        assert_eq!((axis.at(-3.0), axis.at(0.5), axis.at(7.0)), (0.0, 0.5, 1.0));
        assert_eq!(number(-0.25), "\u{2212}0.25");
        assert_eq!(number(0.1 + 0.2), "0.3");
    }
}
