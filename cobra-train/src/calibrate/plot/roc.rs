//! The roc as SVG.

use super::super::{Roc, Thresholds};
use super::zoom::zoom;
use super::{BEYOND, Frame, PlotError, curve, dashed, estimates, share, threshold};
use crate::demo::style::QUIET;
use plotters::style::text_anchor::HPos;

/// Below any curve that is better than guessing.
const BELOW: (f64, f64) = (0.5, 0.3);

/// The curve with the threshold to accept on it; the diagonal is what guessing comes to.
///
/// # Errors
/// [`PlotError`] where the picture cannot be drawn.
pub fn roc_svg(roc: &Roc, thresholds: &Thresholds) -> Result<String, PlotError> {
    let frame = Frame {
        title: "ROC: right against wrong estimates that are accepted",
        subtitle: &format!("area {:.4}; {}", roc.area, estimates(thresholds)),
        across: "share of wrong estimates accepted (false-accept rate)",
        up: "share of right estimates accepted",
        room: (BEYOND, BEYOND),
    };
    frame.svg(|chart| {
        dashed(chart, [(0.0, 0.0), (1.0, 1.0)], QUIET)?;
        let points: Vec<_> = roc
            .points
            .iter()
            .map(|point| (point.false_accepts.share(), point.true_accepts.share()))
            .collect();
        curve(chart, points.iter().copied())?;
        let (wrong, right) = (thresholds.false_accepts, thresholds.true_accepts);
        let at = (wrong.share(), right.share());
        let lines = [
            format!("accepted from {:.3} on:", thresholds.accept),
            format!("{} of wrong ones ({})", share(wrong), wrong.interval()),
            format!("{} of right ones", share(right)),
        ];
        // Beside a low point the curve rises; below the diagonal there is room.
        let steep = points.iter().any(|&(x, y)| x < 0.1 && y > 0.5);
        let beside = at.0 < 0.5 && (at.1 >= 0.5 || steep);
        let place = if beside { at } else { BELOW };
        zoom(chart, &points, (wrong, right))?;
        threshold(chart, at, (place, HPos::Left), lines)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibrate::{Aim, Labelled, calibrate};

    /// The roc of `count` wrong estimates from 0 to 0.5 and as many right ones from 0.4 to 0.9.
    fn drawn(count: u32, false_accepts: f64) -> String {
        let confidences = |from: f32, right| {
            (0..count).map(move |i| Labelled {
                confidence: from + 0.5 * i as f32 / count as f32,
                right,
            })
        };
        let labelled: Vec<_> = confidences(0.0, false)
            .chain(confidences(0.4, true))
            .collect();
        let aim = Aim {
            false_accepts,
            rejected_right: false_accepts,
        };
        let thresholds = calibrate(&labelled, aim).unwrap();
        roc_svg(&Roc::new(&labelled).unwrap(), &thresholds).unwrap()
    }

    #[test]
    fn a_small_rate_is_enlarged_and_a_large_one_shows_as_it_is() {
        assert!(drawn(1000, 0.01).contains("enlarged"));
        assert!(!drawn(100, 0.05).contains("enlarged"));
    }
}
