//! A template of one's own, on points of its surface: what a controller takes for it, and whether it
//! computes what the host does.
//!
//! Owns the settings that both sides use. Points come as a [`Points`] file, with one pose; what poses are
//! checked against as a [`crate::depth::Scene`].

use crate::vectors::{Points, Unreadable, report_words};
use cobra_infer::depth::DepthSettings;
use cobra_infer::{Scorer, Settings, Sigma, Template};

/// The most components such a template has.
pub const COMPONENTS: usize = 64;

/// The measurement's own standard deviations that are taken in turn, in the template's unit: none,
/// and 1 mm where that is the unit, which makes a scorer look farther around.
pub const NOISES: [f32; 2] = [0.0, 1.0];

/// Pixels of the mask that its poses are checked by.
pub const PIXELS: usize = 500;

/// How they are checked.
pub const CHECKED: DepthSettings = DepthSettings::DEFAULT;

/// Scores the first `count` points and tells `each` the bits of every likelihood, and then
/// the words of the report.
///
/// # Errors
/// [`Unreadable`].
#[inline(never)]
pub fn score(
    template: &Template<'_>,
    points: &Points<'_>,
    noise: f32,
    count: usize,
    mut each: impl FnMut(u32),
) -> Result<(), Unreadable> {
    let (camera, pose) = points
        .camera()
        .zip(points.pose(0, false))
        .ok_or(Unreadable::Points)?;
    let settings = Settings {
        sigma: Sigma::Template { noise },
        ..Settings::for_template(template, 2.0)
    };
    let mut scorer = Scorer::<COMPONENTS>::new(template, &camera, &pose, &settings)
        .map_err(Unreadable::Score)?;
    for correspondence in points.correspondences().take(count) {
        each(scorer.push(&correspondence).likelihood.to_bits());
    }
    for word in report_words(&scorer.finish()) {
        each(word);
    }
    Ok(())
}
