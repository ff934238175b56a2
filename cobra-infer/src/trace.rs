//! What this crate tells a logger, by way of `log`, of `defmt`, or of both; of none by default.
//!
//! Owns which events there are and at which level. Without the features these functions are empty,
//! and their callers contain nothing of them.
//!
//! | level | event |
//! |---|---|
//! | warn | a template is refused, with the error; no failure for who tries several places in flash |
//! | info | a template is loaded: name, components, terms |
//! | debug | [`crate::Scorer::finish`], [`crate::depth::DepthCheck::run`]: the report |
//!
//! `defmt` sends numbers as they are: it adds some 3 kB on a Cortex-M4F, and nothing that can panic.
//! `log` links `core`'s formatting of floats, in which a linker finds panics, although none is ever
//! reached. Both let `unsafe` stay forbidden here: what defmt's macros need of it is their own.

#![cfg_attr(
    not(any(feature = "log", feature = "defmt")),
    allow(unused_variables, reason = "without a logger nothing is told")
)]

use crate::depth::DepthReport;
use crate::score::Report;
use crate::template::{Template, TemplateError};

/// What a filter of `log` calls this crate: events are the crate's, whichever module they are in.
#[cfg(feature = "log")]
const TARGET: &str = "cobra_infer";

#[inline]
pub(crate) fn template_refused(error: &TemplateError) {
    #[cfg(feature = "log")]
    log::warn!(target: TARGET, "template refused: {error}");
    #[cfg(feature = "defmt")]
    defmt::warn!("template refused: {}", error);
}

#[inline]
pub(crate) fn template_loaded(template: &Template<'_>) {
    #[cfg(feature = "log")]
    log::info!(
        target: TARGET,
        "template {:?} loaded: components {}, terms {}",
        template.name(),
        template.component_count(),
        template.term_count()
    );
    #[cfg(feature = "defmt")]
    defmt::info!(
        "template {=str} loaded: components {=usize}, terms {=usize}",
        template.name(),
        template.component_count(),
        template.term_count()
    );
}

#[inline]
pub(crate) fn pose_scored(report: &Report) {
    #[cfg(feature = "log")]
    log::debug!(
        target: TARGET,
        "pose: {}, {}; confidence {}, threshold {}, points {}, behind the camera {}, uncovered {}, weight {}, \
         within the tolerance {}",
        report.decision.name(),
        report.decision.reason(),
        report.confidence,
        report.threshold,
        report.points,
        report.behind_camera,
        report.uncovered,
        report.weight_sum,
        report.inlier_share
    );
    #[cfg(feature = "defmt")]
    defmt::debug!("pose: {}", report);
}

#[inline]
pub(crate) fn pose_checked(report: &DepthReport) {
    #[cfg(feature = "log")]
    log::debug!(
        target: TARGET,
        "pose against depth: {}, {}; confidence {}, forward {}, reverse {}, displacement {}, sigma {}, pixels {}, \
         silent {}, visible {}, judged {}, hidden {}, seen through {}",
        report.decision.name(),
        report.decision.reason(),
        report.confidence,
        report.forward,
        report.reverse,
        report.displacement,
        report.noise,
        report.pixels,
        report.silent,
        report.visible,
        report.judged,
        report.hidden,
        report.seen_through
    );
    #[cfg(feature = "defmt")]
    defmt::debug!("pose against depth: {}", report);
}

/// [`defmt::Format`] of what contains types of nalgebra, whose own would show a matrix by columns.
#[cfg(feature = "defmt")]
mod format {
    use crate::camera::{BackProjection, Correspondence};
    use crate::pose::Pose;
    use defmt::{Format, Formatter, write};

    impl Format for Pose {
        fn format(&self, f: Formatter<'_>) {
            let r = self.rotation().matrix();
            let rows = [
                [r.m11, r.m12, r.m13],
                [r.m21, r.m22, r.m23],
                [r.m31, r.m32, r.m33],
            ];
            let t = self.translation();
            write!(
                f,
                "Pose {{ rotation: {}, translation: {} }}",
                rows,
                [t.x, t.y, t.z]
            );
        }
    }

    impl Format for Correspondence {
        fn format(&self, f: Formatter<'_>) {
            let (pixel, point) = (&self.pixel, &self.point);
            write!(
                f,
                "Correspondence {{ pixel: {}, point: {}, weight: {} }}",
                [pixel.x, pixel.y],
                [point.x, point.y, point.z],
                self.weight
            );
        }
    }

    impl Format for BackProjection {
        fn format(&self, f: Formatter<'_>) {
            let point = &self.point;
            write!(
                f,
                "BackProjection {{ point: {}, depth: {} }}",
                [point.x, point.y, point.z],
                self.depth
            );
        }
    }
}
