//! What is said of an estimate in words and numbers.

use super::estimate::OverlayEstimate;
use crate::demo::Verdict;
use crate::demo::style::{Drawn, HAIRLINE, INK, PAPER, Page, QUIET, bold, px, text};
use cobra_infer::Unit;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

/// From one line of figures to the next.
const LINE: i32 = px(25);

/// A length with its unit; one decimal below ten.
pub(super) fn length(length: f32, unit: Unit) -> String {
    let symbol = unit.symbol();
    match unit {
        Unit::Millimetre if length.abs() < 10.0 => format!("{length:.1} {symbol}"),
        Unit::Millimetre => format!("{length:.0} {symbol}"),
        _ => format!("{length:.3} {symbol}"),
    }
}

/// A threshold: two decimals, or two digits of a small one.
fn two_digits(threshold: f32) -> String {
    if threshold == 0.0 || threshold >= 0.1 {
        format!("{threshold:.2}")
    } else {
        let digits = 1 - threshold.log10().floor() as i32;
        format!("{threshold:.*}", digits.clamp(2, 6) as usize)
    }
}

/// `part` of `whole` in percent.
fn percent(part: u32, whole: u32) -> f32 {
    100.0 * part as f32 / whole.max(1) as f32
}

impl OverlayEstimate {
    pub(super) fn verdict(&self) -> Verdict {
        self.report.decision.into()
    }

    /// The reason, in a line.
    pub(super) fn reason(&self) -> String {
        self.cause.in_unit(self.unit).to_string()
    }

    /// The estimated error, which is no more than a bound where nothing fits at all.
    pub(super) fn error(&self) -> String {
        let error = length(self.report.estimated_error, self.unit);
        if self.report.confidence < 1e-30 {
            format!("over {error}")
        } else {
            error
        }
    }

    /// Names and values.
    fn figures(&self) -> Vec<(&'static str, String)> {
        let report = &self.report;
        let looked_at = report.visible;
        let source = if self.masked {
            "of the mask"
        } else {
            "of the silhouette"
        };
        let thresholds = match self.thresholds {
            Some(thresholds) => format!(
                "accept from {}, reject below {}",
                two_digits(thresholds.accept),
                two_digits(thresholds.reject)
            ),
            None => "none: not calibrated".to_owned(),
        };
        vec![
            ("thresholds", thresholds),
            (
                "estimated error",
                format!(
                    "{}, {:.0} % of the diameter",
                    self.error(),
                    100.0 * report.estimated_error / self.diameter
                ),
            ),
            (
                "refinement",
                format!(
                    "moves it by {} on average",
                    length(report.displacement, self.unit)
                ),
            ),
            (
                "likelihoods",
                format!(
                    "forward {:.2}, reverse {:.2}",
                    report.forward, report.reverse
                ),
            ),
            (
                "observed pixels",
                format!(
                    "{} {source}, {:.0} % silent",
                    report.pixels,
                    percent(report.silent, report.pixels)
                ),
            ),
            (
                "visible surface",
                format!(
                    "{:.0} % judged, {:.0} % hidden",
                    percent(report.judged, looked_at),
                    percent(report.hidden, looked_at)
                ),
            ),
            (
                "not measured",
                format!("{:.0} % of it", percent(report.unmeasured, looked_at)),
            ),
            (
                "seen through",
                format!(
                    "{:.0} % of the judged",
                    percent(report.seen_through, report.judged)
                ),
            ),
        ]
    }
}

/// Draws the confidence with its gauge, and the figures below it.
pub(super) fn draw(
    page: &Page<'_>,
    (left, top): (i32, i32),
    width: i32,
    estimate: &OverlayEstimate,
) -> Drawn {
    let value = left + px(140);
    let name = |at: i32, name: &'static str| {
        Text::new(name, (left, at), text(15, QUIET, HPos::Left, VPos::Center))
    };
    let middle = top + px(12);
    page.draw(&name(middle, "confidence"))?;
    page.draw(&Text::new(
        format!("{:.3}", estimate.report.confidence),
        (value, middle),
        bold(17, INK, HPos::Left, VPos::Center),
    ))?;
    gauge(
        page,
        (value + px(64), middle),
        left + width - value - px(64),
        estimate,
    )?;
    for (index, (key, words)) in (1..).zip(estimate.figures()) {
        let at = middle + index * LINE;
        page.draw(&name(at, key))?;
        page.draw(&Text::new(
            words,
            (value, at),
            text(15, INK, HPos::Left, VPos::Center),
        ))?;
    }
    Ok(())
}

/// A bar as long as the confidence, with ticks at the thresholds.
pub(super) fn gauge(
    page: &Page<'_>,
    (left, middle): (i32, i32),
    width: i32,
    estimate: &OverlayEstimate,
) -> Drawn {
    let at = |share: f32| left + (share.clamp(0.0, 1.0) * width as f32).round() as i32;
    let bar = |from: i32, to: i32, half: i32, colour: RGBColor| {
        let corners = [(from, middle - half), (to - 1, middle + half - 1)];
        page.draw(&Rectangle::new(corners, colour.filled()))
    };
    bar(left, left + width, px(5), HAIRLINE)?;
    let end = at(estimate.report.confidence);
    if end > left {
        bar(left, end, px(5), estimate.verdict().colour())?;
    }
    let thresholds = estimate.thresholds;
    for threshold in thresholds.into_iter().flat_map(|t| [t.reject, t.accept]) {
        let tick = at(threshold);
        bar(tick - px(2), tick + px(2), px(8), PAPER)?;
        bar(tick - px(1), tick + px(1), px(8), INK)?;
    }
    Ok(())
}

/// Words in lines no wider than `width`, of which the last is cut where there are more than `most`.
pub(super) fn wrapped(
    page: &Page<'_>,
    words: &str,
    style: &TextStyle<'_>,
    width: i32,
    most: usize,
) -> Vec<String> {
    let fits = |line: &str| {
        page.estimate_text_size(line, style)
            .is_ok_and(|(wide, _)| wide <= width.cast_unsigned())
    };
    let mut lines = vec![String::new()];
    for word in words.split(' ') {
        let full = lines.len() == most;
        let line = lines.last_mut().expect("never empty");
        let longer = if line.is_empty() {
            word.to_owned()
        } else {
            format!("{line} {word}")
        };
        if fits(&longer) || line.is_empty() {
            *line = longer;
        } else if full {
            line.push('…');
            break;
        } else {
            lines.push(word.to_owned());
        }
    }
    lines
}
