//! The motions that an object's symmetries allow, as `models_info.json` states them.
//!
//! Owns their combination, that of `bop_toolkit`'s `misc.get_symmetry_transformations`. What they
//! excuse is the business of [`crate::pose::mssd`] and [`crate::pose::mspd`].

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, UnitVector3};
use std::f64::consts::{PI, TAU};

/// `max_sym_disc_step` of the BOP challenges: the largest way between two steps of a continuous
/// symmetry, as a share of the object's diameter.
pub const LARGEST_STEP: f64 = 0.01;

/// An object's symmetries, in its own frame, in millimetres.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Symmetries {
    /// Motions of the object onto itself, without the identity.
    pub discrete: Vec<Isometry3<f64>>,
    /// Axes about which the object may be turned by any angle.
    pub continuous: Vec<Axis>,
}

/// A line about which an object is a solid of revolution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// The line's direction.
    pub direction: UnitVector3<f64>,
    /// A point on it.
    pub offset: Point3<f64>,
}

impl Symmetries {
    /// Whether there is none but the identity.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.discrete.is_empty() && self.continuous.is_empty()
    }

    /// The symmetries as finitely many motions, the identity first: each discrete one, and the
    /// identity, followed by each of n turns about each axis, n = ⌈π / `step`⌉, by multiples of 2π/n.
    ///
    /// A turn by 2π/n moves a point at half the diameter from the axis by at most `step` diameters.
    #[must_use]
    pub fn transformations(&self, step: f64) -> Vec<Isometry3<f64>> {
        let steps = (PI / step).ceil().max(1.0) as u32;
        let turns: Vec<Isometry3<f64>> = self
            .continuous
            .iter()
            .flat_map(|axis| {
                (0..steps).map(move |i| axis.turn(TAU * f64::from(i) / f64::from(steps)))
            })
            .collect();
        let identity = Isometry3::identity();
        let discrete = std::iter::once(&identity).chain(&self.discrete);
        if turns.is_empty() {
            return discrete.copied().collect();
        }
        discrete
            .flat_map(|motion| turns.iter().map(move |turn| turn * motion))
            .collect()
    }
}

impl Axis {
    /// The turn by `angle` radians about the line.
    #[must_use]
    pub fn turn(&self, angle: f64) -> Isometry3<f64> {
        let to_line = Translation3::from(self.offset);
        let rotation = UnitQuaternion::from_axis_angle(&self.direction, angle);
        to_line * rotation * to_line.inverse()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    fn upright(x: f64) -> Axis {
        Axis {
            direction: Vector3::z_axis(),
            offset: Point3::new(x, 0.0, 0.0),
        }
    }

    #[test]
    fn without_symmetries_there_is_the_identity() {
        let none = Symmetries::default();
        assert!(none.is_none());
        assert_eq!(none.transformations(LARGEST_STEP), [Isometry3::identity()]);
    }

    #[test]
    fn discrete_ones_come_as_they_are_behind_the_identity() {
        let half = Isometry3::rotation(Vector3::x() * PI);
        let symmetries = Symmetries {
            discrete: vec![half],
            continuous: Vec::new(),
        };
        let found = symmetries.transformations(LARGEST_STEP);
        assert_eq!(found, [Isometry3::identity(), half]);
    }

    #[test]
    fn an_axis_becomes_315_turns_that_leave_its_points_alone() {
        let half = Isometry3::rotation(Vector3::x() * PI);
        let symmetries = Symmetries {
            discrete: vec![half],
            continuous: vec![upright(5.0)],
        };
        let found = symmetries.transformations(LARGEST_STEP);
        assert_eq!(found.len(), 2 * 315);
        let on_axis = Point3::new(5.0, 0.0, 7.0);
        for turn in &found[..315] {
            assert!((turn * on_axis - on_axis).norm() < 1e-12);
        }
        for motion in &found[315..] {
            assert!((motion * on_axis - half * on_axis).norm() < 1e-12);
        }
        let beside = Point3::new(55.0, 0.0, 0.0);
        let way = (found[1] * beside - found[0] * beside).norm();
        assert!(way > 0.9 && way < 1.0, "{way} of a diameter of 100");
    }
}
