//! The reliability curve as SVG.

use super::super::{Bin, Thresholds};
use super::{BEYOND, Drawn, Frame, PlotError, curve, dashed, estimates, style, teal};
use crate::demo::Verdict;
use crate::demo::style::{HAIRLINE, INK, PAPER, QUIET};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

/// Room for numbers below 0, and for the thresholds' names above 1.
const ROOM: (f64, f64) = (0.09, 0.16);

/// The lowest and the highest place in the plot.
const LOW: f64 = -ROOM.0;
const HIGH: f64 = 1.0 + ROOM.1;

/// The share of right estimates in each bin of the confidence with its interval, both thresholds, and
/// how many estimates each bin holds; on the diagonal the confidence would be the probability of being
/// right.
///
/// # Errors
/// [`PlotError`] where the picture cannot be drawn.
pub fn reliability_svg(bins: &[Bin], thresholds: &Thresholds) -> Result<String, PlotError> {
    let frame = Frame {
        title: "How often estimates of a confidence are right",
        subtitle: &format!(
            "{}; bars: Wilson interval at 95 %; small numbers: estimates in each tenth",
            estimates(thresholds)
        ),
        across: "confidence",
        up: "share of estimates that are right",
        room: ROOM,
    };
    frame.svg(|chart| {
        let (accept, reject) = (f64::from(thresholds.accept), f64::from(thresholds.reject));
        let bands = [
            (-BEYOND, reject, Verdict::Reject),
            (accept, 1.0 + BEYOND, Verdict::Accept),
        ];
        chart.draw_series(bands.map(|(from, to, verdict)| {
            let [red, green, blue] = verdict.background();
            let corners = [(from, LOW), (to, HIGH)];
            Rectangle::new(corners, RGBColor(red, green, blue).filled())
        }))?;
        let grid = (0..=5).map(|fifth| f64::from(fifth) / 5.0);
        for share in grid {
            let lines = [
                vec![(-BEYOND, share), (1.0 + BEYOND, share)],
                vec![(share, LOW), (share, HIGH)],
            ];
            chart.draw_series(lines.map(|line| PathElement::new(line, HAIRLINE)))?;
        }
        dashed(chart, [(0.0, 0.0), (1.0, 1.0)], QUIET)?;
        for value in [reject, accept] {
            dashed(chart, [(value, LOW), (value, HIGH)], INK)?;
        }
        // Outwards of its line; where there is no room, inwards, and beyond the other if that is near.
        let near = accept - reject < 0.25;
        let of_reject = match reject {
            reject if reject >= 0.25 => (reject, HPos::Right, -8),
            reject => (if near { accept } else { reject }, HPos::Left, 8),
        };
        let of_accept = match accept {
            accept if accept <= 0.75 => (accept, HPos::Left, 8),
            accept => (if near { reject } else { accept }, HPos::Right, -8),
        };
        for (text, y, (line, across, x)) in [
            (format!("rejected below {reject:.3}"), 40, of_reject),
            (format!("accepted from {accept:.3}"), 14, of_accept),
        ] {
            let label = Text::new(text, (x, y), style(16, INK, across, VPos::Center));
            chart.draw_series([EmptyElement::at((line, HIGH)) + label])?;
        }
        curve(
            chart,
            bins.iter().map(|bin| (bin.confidence, bin.right.share())),
        )?;
        bins.iter().try_for_each(|bin| draw_bin(chart, bin))
    })
}

/// The share with its interval, and below how many estimates there are.
fn draw_bin(chart: &mut super::Chart<'_, '_>, bin: &Bin) -> Drawn {
    let interval = bin.right.interval();
    let at = (bin.confidence, bin.right.share());
    chart.draw_series([ErrorBar::new_vertical(
        bin.confidence,
        interval.low,
        at.1,
        interval.high,
        teal().stroke_width(2),
        10,
    )])?;
    chart.draw_series([
        Circle::new(at, 6, PAPER.filled()),
        Circle::new(at, 5, teal().filled()),
    ])?;
    let middle = f64::midpoint(bin.low, bin.high);
    let count = Text::new(
        bin.right.total.to_string(),
        (0, -10),
        style(14, QUIET, HPos::Center, VPos::Center),
    );
    chart.draw_series([EmptyElement::at((middle, LOW)) + count])?;
    Ok(())
}
