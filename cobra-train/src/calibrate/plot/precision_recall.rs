//! The curve of precision against recall as SVG.

use super::super::{PrecisionRecall, Rate, Thresholds};
use super::{BEYOND, Frame, PlotError, curve, dashed, estimates, share, threshold};
use crate::demo::style::QUIET;
use plotters::style::text_anchor::HPos;

/// The curve with the threshold to accept on it; the level line is what accepting all comes to.
///
/// # Errors
/// [`PlotError`] where the picture cannot be drawn.
pub fn precision_recall_svg(
    precision_recall: &PrecisionRecall,
    thresholds: &Thresholds,
) -> Result<String, PlotError> {
    let average = precision_recall.average_precision;
    let frame = Frame {
        title: "Precision against recall",
        subtitle: &format!("average precision {average:.4}; {}", estimates(thresholds)),
        across: "recall: share of right estimates accepted",
        up: "precision: share of accepted estimates that are right",
        room: (BEYOND, BEYOND),
    };
    frame.svg(|chart| {
        let points = &precision_recall.points;
        if let Some(all) = points.last() {
            let share = all.precision.share();
            dashed(chart, [(0.0, share), (1.0, share)], QUIET)?;
        }
        let shares = points
            .iter()
            .map(|point| (point.recall.share(), point.precision.share()));
        curve(chart, shares)?;
        let (wrong, right) = (thresholds.false_accepts, thresholds.true_accepts);
        let precision = Rate {
            count: right.count,
            total: right.count + wrong.count,
        };
        let at = (right.share(), precision.share());
        let lines = [
            format!("accepted from {:.3} on:", thresholds.accept),
            format!("{} are right ({})", share(precision), precision.interval()),
            format!("{} of right ones", share(right)),
        ];
        // Three lines take so much room below a point.
        let place = (at.0, at.1.max(0.2));
        let across = if at.0 < 0.5 { HPos::Left } else { HPos::Right };
        threshold(chart, at, (place, across), lines)
    })
}
