//! The left end of the roc, enlarged: a small false-accept rate is a hair's breadth of the whole curve.

use super::super::{Interval, Rate};
use super::{Chart, Drawn, style, teal};
use crate::demo::Verdict;
use crate::demo::style::{HAIRLINE, INK, PAPER, QUIET};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

/// Where the enlargement stands, in shares of the whole: below a curve that is any good.
const LOW: (f64, f64) = (0.5, 0.1);
const HIGH: (f64, f64) = (0.97, 0.56);

/// A part that is larger than this shows as well in the whole.
const LARGEST: f64 = 0.2;

/// Height of the heading above the enlargement.
const HEADING: f64 = 0.05;

/// A curve that passes nearer than this above the enlargement leaves no room for it.
const MARGIN: f64 = 0.1;

/// Draws the curve up to some ten times the rate at the threshold, with the rate's interval as a band;
/// nothing where the curve itself is in the way, or shows as much.
pub(super) fn zoom(
    chart: &mut Chart<'_, '_>,
    points: &[(f64, f64)],
    (wrong, right): (Rate, Rate),
) -> Drawn {
    let Interval { low, high } = wrong.interval();
    let reach = reach(wrong.share().max(high / 2.0));
    let crossed = |&(x, y): &(f64, f64)| x > LOW.0 && y < HIGH.1 + MARGIN;
    if reach > LARGEST || points.iter().any(crossed) {
        return Ok(());
    }
    let place = |(x, y): (f64, f64)| {
        let along = |from: f64, to: f64, share: f64| from + share * (to - from);
        (
            along(LOW.0, HIGH.0, (x / reach).min(1.0)),
            along(LOW.1, HIGH.1, y),
        )
    };
    // Room for the heading, which the diagonal would cross.
    let backdrop = [LOW, (HIGH.0, HIGH.1 + HEADING)];
    chart.draw_series([Rectangle::new(backdrop, PAPER.filled())])?;
    let band = [place((low, 0.0)), place((high, 1.0))];
    chart.draw_series([Rectangle::new(band, HAIRLINE.filled())])?;
    let frame = Rectangle::new([LOW, HIGH], QUIET.stroke_width(1));
    chart.draw_series([frame])?;
    for share in [0.0, 0.5, 1.0] {
        let across = format!("{} %", round(100.0 * share * reach));
        let labels = [
            (place((share * reach, 0.0)), (0, 12), across, HPos::Center),
            (
                place((0.0, share)),
                (-6, 0),
                format!("{share:.1}"),
                HPos::Right,
            ),
        ];
        chart.draw_series(labels.map(|(at, offset, text, across)| {
            EmptyElement::at(at) + Text::new(text, offset, style(14, INK, across, VPos::Center))
        }))?;
    }
    let heading = "enlarged; grey: 95 % interval of the false-accept rate";
    let heading = Text::new(
        heading,
        (0, -10),
        style(14, QUIET, HPos::Left, VPos::Center),
    );
    chart.draw_series([EmptyElement::at((LOW.0, HIGH.1)) + heading])?;
    let inside = points.iter().take_while(|point| point.0 <= reach);
    let mut curve: Vec<(f64, f64)> = inside.copied().collect();
    if let (Some(&last), Some(&next)) = (curve.last(), points.get(curve.len())) {
        let share = (reach - last.0) / (next.0 - last.0);
        curve.push((reach, last.1 + share * (next.1 - last.1)));
    }
    let curve = curve.into_iter().map(place);
    chart.draw_series(LineSeries::new(curve, teal().stroke_width(3)))?;
    let at = place((wrong.share(), right.share()));
    chart.draw_series([
        Circle::new(at, 7, PAPER.filled()),
        Circle::new(at, 6, Verdict::Reject.colour().filled()),
    ])?;
    Ok(())
}

/// The first of 1, 2 and 5 times a power of ten that is at least ten times a share, and at most 1.
fn reach(share: f64) -> f64 {
    let steps =
        (-5..0).flat_map(|power: i32| [1.0, 2.0, 5.0].map(|digit| digit / 10_f64.powi(-power)));
    let wanted = 10.0 * share;
    // What multiplying rounds must not ask for the next step.
    steps
        .into_iter()
        .find(|step| *step >= wanted * (1.0 - 1e-9))
        .unwrap_or(1.0)
}

/// Without what multiplying has rounded.
fn round(number: f64) -> f64 {
    (number * 1e6).round() / 1e6
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_enlargement_reaches_to_a_round_number_about_ten_times_as_far() {
        for (share, expected) in [
            (0.0, 1e-5),
            (0.0098, 0.1),
            (0.01, 0.1),
            (0.011, 0.2),
            (0.003, 0.05),
            (0.04, 0.5),
            (0.3, 1.0),
        ] {
            assert!((reach(share) - expected).abs() < 1e-12, "{share}");
        }
    }
}
