//! How far motions of an object are from each other.
//!
//! Owns the measure, ADD over some of the mesh's vertices, and the mean of motions. A motion M moves the
//! object in its own frame: at the true pose T it leads to the pose TM.

use crate::bop::symmetry::Axis;
use crate::pose::{RIGHT, add, nearest_pose};
use crate::surface::Mesh;
use cobra_infer::Pose;
use nalgebra::{Isometry3, Matrix3, Point3, UnitQuaternion, UnitVector3, Vector3};

/// ADD is taken over so many vertices at most while motions are compared with each other.
const POINTS: usize = 500;

/// An object as far as its motions are concerned.
pub(super) struct Gauge {
    points: Vec<Point3<f64>>,
    pub(super) middle: Point3<f64>,
    pub(super) diameter: f64,
}

impl Gauge {
    pub(super) fn new(mesh: &Mesh) -> Self {
        let vertices: Vec<Point3<f64>> = mesh.used_vertices().copied().collect();
        let count = vertices.len().min(POINTS);
        Self {
            points: (0..count)
                .map(|i| vertices[i * vertices.len() / count])
                .collect(),
            middle: mesh.bounding_sphere().centre,
            diameter: mesh.diameter(),
        }
    }

    /// ADD between the poses that two motions lead to.
    pub(super) fn apart(&self, a: &Isometry3<f64>, b: &Isometry3<f64>) -> f64 {
        add(&self.points, a, b)
    }

    /// What separates a right pose from a wrong one.
    pub(super) fn limit(&self) -> f64 {
        RIGHT * self.diameter
    }

    /// Whether the one is right where the other is the truth.
    pub(super) fn same(&self, a: &Isometry3<f64>, b: &Isometry3<f64>) -> bool {
        self.apart(a, b) < self.limit()
    }

    /// Whether the pose that a motion leads to is wrong.
    pub(super) fn is_wrong(&self, motion: &Isometry3<f64>) -> bool {
        !self.same(&Isometry3::identity(), motion)
    }

    /// The turn about the object's middle.
    pub(super) fn turn(&self, rotation: UnitQuaternion<f64>) -> Isometry3<f64> {
        Isometry3::rotation_wrt_point(rotation, self.middle)
    }

    /// The mean of motions that are near each other: of their rotations the one nearest to the matrices'
    /// mean, of where they put the middle the mean.
    pub(super) fn mean(&self, motions: &[Isometry3<f64>]) -> Option<Isometry3<f64>> {
        let share = 1.0 / motions.len() as f64;
        let matrix = motions.iter().fold(Matrix3::zeros(), |sum, motion| {
            sum + share * motion.rotation.to_rotation_matrix().into_inner()
        });
        let moved = motions.iter().fold(Vector3::zeros(), |sum, motion| {
            sum + share * (motion * self.middle).coords
        });
        // The mean of rotations is shorter than one, by more than what is taken for a rounded one.
        let length = libm::cbrt(matrix.determinant());
        let matrix = matrix / length;
        let rows = std::array::from_fn(|i| matrix[(i / 3, i % 3)]);
        let rotation = nearest_pose(rows, [0.0; 3]).ok()?.rotation;
        let shift = moved - rotation * self.middle.coords;
        Some(Isometry3::from_parts(shift.into(), rotation))
    }

    /// A motion as a turn about a line, with the shift along it: where nothing turns, about any.
    pub(super) fn screw(&self, motion: &Isometry3<f64>) -> Screw {
        let (direction, angle) = motion
            .rotation
            .axis_angle()
            .unwrap_or((Vector3::z_axis(), 0.0));
        let moved = motion * self.middle - self.middle;
        let along = moved.dot(&direction);
        let across = moved - along * direction.into_inner();
        // The fixed point of a turn by θ in the plane across: ½(δ + cot(θ/2) a × δ) from where δ was taken.
        let half = libm::tan(0.5 * angle);
        let offset = if half.abs() > 1e-9 {
            0.5 * (across + direction.cross(&across) / half)
        } else {
            Vector3::zeros()
        };
        Screw {
            axis: Axis {
                direction: upwards(direction),
                offset: self.middle + offset,
            },
            angle,
            along: along.abs(),
        }
    }
}

/// A motion as a turn about a line and a shift along it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Screw {
    /// The line, its direction with a positive largest component.
    pub axis: Axis,
    /// The turn, from 0 to π.
    pub angle: f64,
    /// The shift along the line.
    pub along: f64,
}

/// Of a direction and its opposite always the same one: that whose largest component is positive.
pub(super) fn upwards(direction: UnitVector3<f64>) -> UnitVector3<f64> {
    if direction[direction.iamax()] < 0.0 {
        -direction
    } else {
        direction
    }
}

/// The angle θ of the turn about a direction for which `from` followed by it comes nearest to `to`, from −π
/// to π: the twist of the rotation between them.
pub(super) fn twist(
    direction: &UnitVector3<f64>,
    from: &Isometry3<f64>,
    to: &Isometry3<f64>,
) -> f64 {
    let between = from.rotation.inverse() * to.rotation;
    let (along, real) = (between.imag().dot(direction), between.w);
    let (along, real) = if real < 0.0 {
        (-along, -real)
    } else {
        (along, real)
    };
    2.0 * libm::atan2(along, real)
}

/// A pose of the scorer in double precision.
pub(super) fn double(pose: &Pose) -> Option<Isometry3<f64>> {
    let matrix = pose.rotation().matrix();
    let rows = std::array::from_fn(|i| f64::from(matrix[(i / 3, i % 3)]));
    let [x, y, z] = (*pose.translation()).into();
    nearest_pose(rows, [f64::from(x), f64::from(y), f64::from(z)]).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::demo::mechanical_part;
    use std::f64::consts::{FRAC_PI_2, PI};

    #[test]
    fn a_turn_about_a_line_is_told_with_its_line() {
        let gauge = Gauge::new(&mechanical_part());
        let axis = Axis {
            direction: UnitVector3::new_normalize(Vector3::new(-0.2, 0.3, 0.9)),
            offset: Point3::new(5.0, -3.0, 0.0),
        };
        for angle in [0.3, FRAC_PI_2, PI] {
            let shift = nalgebra::Translation3::from(2.0 * axis.direction.into_inner());
            let screw = gauge.screw(&(shift * axis.turn(angle)));
            assert!((screw.angle - angle).abs() < 1e-9);
            assert!((screw.along - 2.0).abs() < 1e-9);
            assert!(screw.axis.direction.angle(&axis.direction) < 1e-6);
            let beside = screw.axis.offset - axis.offset;
            assert!(beside.cross(&axis.direction).norm() < 1e-6);
        }
        let still = gauge.screw(&Isometry3::translation(0.0, 0.0, -4.0));
        assert_eq!((still.angle, still.along), (0.0, 4.0));
    }

    #[test]
    fn the_mean_of_motions_lies_between_them() {
        let gauge = Gauge::new(&mechanical_part());
        let turned = |angle: f64| gauge.turn(UnitQuaternion::new(Vector3::y() * angle));
        let mean = gauge.mean(&[turned(3.0), turned(3.4), turned(3.2)]);
        assert!(gauge.apart(&mean.unwrap(), &turned(3.2)) < 1e-9);
    }

    #[test]
    fn the_twist_is_the_angle_of_the_turn_that_follows() {
        let axis = UnitVector3::new_normalize(Vector3::new(0.2, -0.3, 0.9));
        let from = Isometry3::new(Vector3::x(), Vector3::new(1.0, 2.0, 0.5));
        for angle in [-3.0, -0.1, 0.0, 2.5] {
            let turn = UnitQuaternion::from_axis_angle(&axis, angle);
            let found = twist(&axis, &from, &(from * turn));
            assert!((found - angle).abs() < 1e-12, "{found} {angle}");
        }
    }
}
