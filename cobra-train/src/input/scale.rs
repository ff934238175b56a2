//! Numbers that look as if they were in another unit than the template's.
//!
//! Owns a guess, for a warning: a pose in metres against a template in millimetres is the commonest
//! mistake of all, and the scorer itself can only answer "reject".

use cobra_infer::{Correspondence, Pose, Template, Unit};
use nalgebra::Vector3;

/// A guess at what unit numbers are really in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaleDoubt {
    /// The unit they seem to be in; `None` when none fits.
    pub seems: Option<Unit>,
    /// The unit they are taken to be in.
    pub taken: Unit,
    /// The distance that was found, in the unit they are taken to be in.
    pub found: f32,
    /// How far the object reaches from the origin of its frame.
    pub expected: f32,
}

/// Points this many times farther out than the object reaches are not on it.
const FAR_POINTS: f32 = 5.0;

/// Points that all lie nearer to the origin than this share of the object's reach are not on it.
const NEAR_POINTS: f32 = 0.01;

/// A translation shorter than this share of the object's reach puts the camera into it.
const NEAR_POSE: f32 = 0.02;

/// An object this many radii away covers less than a pixel.
const FAR_POSE: f32 = 1000.0;

/// Doubts whether object points are in the template's unit: how far they lie from the origin
/// against how far the object reaches.
#[must_use]
pub fn doubt_point_scale(
    template: &Template<'_>,
    correspondences: &[Correspondence],
) -> Option<ScaleDoubt> {
    let mut distances: Vec<f32> = correspondences
        .iter()
        .filter(|c| c.is_finite())
        .map(|c| c.point.coords.norm())
        .collect();
    distances.sort_by(f32::total_cmp);
    let reach = reach(template);
    let largest = *distances.last()?;
    // The median, so that a few outliers neither raise nor hide the doubt.
    let median = distances[distances.len() / 2];
    (largest < NEAR_POINTS * reach || median > FAR_POINTS * reach).then(|| ScaleDoubt {
        seems: guess(template.unit(), median, reach),
        taken: template.unit(),
        found: median,
        expected: reach,
    })
}

/// Doubts whether a translation is in the template's unit: how long it is against how far the
/// object reaches.
#[must_use]
pub fn doubt_pose_scale(template: &Template<'_>, pose: &Pose) -> Option<ScaleDoubt> {
    let found = pose.translation().norm();
    let reach = reach(template);
    (found < NEAR_POSE * reach || found > FAR_POSE * reach).then(|| ScaleDoubt {
        // A camera usually stands a few sizes away.
        seems: guess(template.unit(), found, 4.0 * reach),
        taken: template.unit(),
        found,
        expected: reach,
    })
}

/// The farthest that a point of the object may lie from the origin of its frame.
fn reach(template: &Template<'_>) -> f32 {
    let [x, y, z] = template.centre();
    Vector3::new(x, y, z).norm() + template.radius()
}

/// The unit in which `found` would come nearest to `expected`, if it comes near at all.
fn guess(taken: Unit, found: f32, expected: f32) -> Option<Unit> {
    let off = |unit: Unit| {
        let scaled = found * unit.millimetres() / taken.millimetres();
        (scaled / expected).ln().abs()
    };
    Unit::ALL
        .into_iter()
        .filter(|unit| *unit != taken)
        .min_by(|a, b| off(*a).total_cmp(&off(*b)))
        .filter(|unit| off(*unit) < 10.0_f32.ln())
}

impl std::fmt::Display for ScaleDoubt {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let taken = self.taken.symbol();
        write!(
            f,
            "{:.4} {taken} where the object reaches {:.4} {taken}",
            self.found, self.expected
        )?;
        if let Some(seems) = self.seems {
            write!(
                f,
                ": the numbers look like {}, the template is in {taken}",
                seems.symbol()
            )?;
        }
        Ok(())
    }
}
