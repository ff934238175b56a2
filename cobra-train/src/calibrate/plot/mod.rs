//! The curves as SVG.
//!
//! Owns the frame that the three share: a plot of shares from 0 to 1 with a heading and a line below it. How
//! pages look is `plot`'s business.

mod precision_recall;
mod reliability;
mod roc;
mod zoom;

pub use precision_recall::precision_recall_svg;
pub use reliability::reliability_svg;
pub use roc::roc_svg;

use super::{Rate, Thresholds};
use crate::demo::Verdict;
use crate::demo::style::{HAIRLINE, INK, PAPER, QUIET};
pub use crate::plot::PlotError;
use crate::plot::{Drawn, headed, style};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

/// Width and height, in pixels.
const SIZE: (u32, u32) = (760, 620);

/// How far the axes reach beyond 0 and 1, so that a curve along an edge can be seen.
const BEYOND: f64 = 0.02;

type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// What stands around the data.
struct Frame<'a> {
    title: &'a str,
    /// What was measured, below the title.
    subtitle: &'a str,
    across: &'a str,
    up: &'a str,
    /// How far the plot reaches below 0 and above 1, where something stands there.
    room: (f64, f64),
}

impl Frame<'_> {
    /// The page as text, with what `draw` puts into the frame.
    fn svg(&self, draw: impl FnOnce(&mut Chart<'_, '_>) -> Drawn) -> Result<String, PlotError> {
        let mut text = String::new();
        self.onto(&mut text, draw)
            .map_err(|error| PlotError(error.to_string()))?;
        Ok(text)
    }

    fn onto(&self, page: &mut String, draw: impl FnOnce(&mut Chart<'_, '_>) -> Drawn) -> Drawn {
        let (page, plot) = headed(page, SIZE, self.title, self.subtitle)?;
        let (below, above) = self.room;
        let mut chart = ChartBuilder::on(&plot)
            .x_label_area_size(56)
            .y_label_area_size(68)
            .build_cartesian_2d(-BEYOND..1.0 + BEYOND, -below..1.0 + above)?;
        chart
            .configure_mesh()
            .bold_line_style(HAIRLINE)
            .light_line_style(TRANSPARENT)
            .axis_style(QUIET)
            .set_all_tick_mark_size(5)
            .x_labels(6)
            .y_labels(6)
            .x_label_formatter(&|share| format!("{share:.1}"))
            .y_label_formatter(&|share| format!("{share:.1}"))
            .label_style(("sans-serif", 16).into_font().color(&INK))
            .axis_desc_style(("sans-serif", 17).into_font().color(&INK))
            .x_desc(self.across)
            .y_desc(self.up)
            .draw()?;
        draw(&mut chart)?;
        drop(chart);
        page.present()?;
        Ok(())
    }
}

/// The colour of what is accepted, and of curves.
fn teal() -> RGBColor {
    Verdict::Accept.colour()
}

fn curve(chart: &mut Chart<'_, '_>, points: impl Iterator<Item = (f64, f64)>) -> Drawn {
    chart.draw_series(LineSeries::new(points, teal().stroke_width(3)))?;
    Ok(())
}

fn dashed(chart: &mut Chart<'_, '_>, ends: [(f64, f64); 2], colour: RGBColor) -> Drawn {
    let style = colour.stroke_width(1);
    chart.draw_series(DashedLineSeries::new(ends, 6, 5, style))?;
    Ok(())
}

/// The threshold to accept where the curve passes it: lines to the axes, a disc, and what it does, which
/// is written below and beside `place`.
fn threshold(
    chart: &mut Chart<'_, '_>,
    at: (f64, f64),
    (place, across): ((f64, f64), HPos),
    lines: [String; 3],
) -> Drawn {
    dashed(chart, [(at.0, -BEYOND), at], INK)?;
    dashed(chart, [(-BEYOND, at.1), at], INK)?;
    chart.draw_series([
        Circle::new(at, 7, PAPER.filled()),
        Circle::new(at, 6, Verdict::Reject.colour().filled()),
    ])?;
    let right = matches!(across, HPos::Right);
    let x = if right { -16 } else { 16 };
    for (line, text) in (0..).zip(lines) {
        let style = style(16, INK, across, VPos::Center);
        let text = Text::new(text, (x, 18 + 22 * line), style);
        chart.draw_series([EmptyElement::at(place) + text])?;
    }
    Ok(())
}

/// A share in percent, with as many digits as a share near 0 or 1 needs.
fn share(rate: Rate) -> String {
    let digits = usize::from(!(0.01..=0.99).contains(&rate.share())) + 1;
    format!("{rate:.digits$}")
}

/// How many estimates a curve is of.
fn estimates(thresholds: &Thresholds) -> String {
    format!(
        "{} right and {} wrong estimates",
        thresholds.true_accepts.total, thresholds.false_accepts.total
    )
}
