//! Numbers that look as if they were in another unit than the template's.
//!
//! Owns a guess, for a warning: a pose in metres against a template in millimetres is the commonest
//! mistake of all, and the scorer itself can only answer "reject".

use cobra_infer::{Correspondence, Pose, Template, Unit};

/// A guess at what unit numbers are really in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaleDoubt {
    /// The unit they seem to be in; `None` when none fits.
    pub seems: Option<Unit>,
    /// The unit they are taken to be in.
    pub taken: Unit,
    /// The size that was found, in the unit they are taken to be in.
    pub found: f32,
    /// The size that would be plausible at least.
    pub expected: f32,
}

/// A size this many times smaller or larger than the object is no longer plausible.
const IMPLAUSIBLE: f32 = 5.0;

/// Doubts whether object points are in the template's unit: their extent against the object's.
///
/// Measured from the frame's origin, which is the same in every unit; the object's centre is not.
#[must_use]
pub fn doubt_point_scale(
    template: &Template<'_>,
    correspondences: &[Correspondence],
) -> Option<ScaleDoubt> {
    let centre = nalgebra::Vector3::from(template.centre());
    let mut extents: Vec<f32> = correspondences
        .iter()
        .filter(|c| c.is_finite())
        .map(|c| c.point.coords.norm())
        .collect();
    extents.sort_by(f32::total_cmp);
    // The median, so that a few outliers neither raise nor hide the doubt.
    let found = *extents.get(extents.len() / 2)?;
    let largest = template.radius() + centre.norm();
    let smallest_unit = largest / 100.0;
    let too_small = extents.last().is_some_and(|most| *most < smallest_unit);
    (too_small || found > IMPLAUSIBLE * largest).then(|| ScaleDoubt {
        seems: guess(template.unit(), found, largest),
        taken: template.unit(),
        found,
        expected: template.radius(),
    })
}

/// Doubts whether a translation is in the template's unit: a camera inside the object sees nothing.
#[must_use]
pub fn doubt_pose_scale(template: &Template<'_>, pose: &Pose) -> Option<ScaleDoubt> {
    let [x, y, z] = template.centre();
    let seen = pose.to_camera(&nalgebra::Point3::new(x, y, z));
    let found = seen.coords.norm();
    let expected = template.radius();
    let offset = nalgebra::Vector3::new(x, y, z).norm();
    let far = 1000.0 * expected;
    (pose.translation().norm() < 0.1 * expected.max(offset) || found > far).then(|| ScaleDoubt {
        seems: guess(template.unit(), pose.translation().norm(), 4.0 * expected),
        taken: template.unit(),
        found: pose.translation().norm(),
        expected,
    })
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
            "a size of {:.4} {taken} where the object's radius is {:.1} {taken}",
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
