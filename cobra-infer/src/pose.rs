//! A pose: a checked rotation matrix and a translation, object to camera.
//!
//! Owns the check that a matrix is a rotation, and its repair on request. Estimating poses is the
//! estimator's work.

use crate::error::PoseError;
use crate::math;
use crate::tolerance;
use nalgebra::{Matrix3, Point3, Rotation3, Vector3};

/// Newton's iteration squares the error each time: from [`tolerance::ORTHONORMALISABLE`] five steps
/// reach `f32`'s rounding, and the sixth is for the rounding.
const NEWTON_STEPS: usize = 6;

/// The object's pose in the camera's frame: a point P of the object is seen at RP + t.
///
/// The camera looks along +Z, x to the right and y down (OpenCV, BOP).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    rotation: Rotation3<f32>,
    translation: Vector3<f32>,
}

impl Pose {
    /// From row-major R and t, BOP's `cam_R_m2c` and `cam_t_m2c`.
    ///
    /// # Errors
    /// [`PoseError::NotFinite`]; [`PoseError::NotARotation`] when RᵀR differs from I by more than
    /// [`tolerance::ROTATION`]; [`PoseError::Reflection`] when det R is not positive.
    pub fn from_row_major(r: [f32; 9], t: [f32; 3]) -> Result<Self, PoseError> {
        check(r, t, tolerance::ROTATION)?;
        Ok(Self::unchecked(r, t))
    }

    /// Like [`Pose::from_row_major`], but replaces R by the nearest rotation.
    ///
    /// Newton's iteration R ← R(3I − RᵀR)/2 towards the orthogonal factor of the polar
    /// decomposition, which is the nearest rotation in the Frobenius norm: products and sums only,
    /// no trigonometry. Reference: Å. Björck and C. Bowie, SIAM J. Numer. Anal. 8 (1971).
    ///
    /// # Errors
    /// As [`Pose::from_row_major`], with [`tolerance::ORTHONORMALISABLE`] in place of
    /// [`tolerance::ROTATION`].
    pub fn from_row_major_orthonormalised(r: [f32; 9], t: [f32; 3]) -> Result<Self, PoseError> {
        check(r, t, tolerance::ORTHONORMALISABLE)?;
        let mut r = r;
        for _ in 0..NEWTON_STEPS {
            r = newton_step(r);
        }
        Ok(Self::unchecked(r, t))
    }

    fn unchecked([a, b, c, d, e, f, g, h, i]: [f32; 9], [x, y, z]: [f32; 3]) -> Self {
        Self {
            rotation: Rotation3::from_matrix_unchecked(Matrix3::new(a, b, c, d, e, f, g, h, i)),
            translation: Vector3::new(x, y, z),
        }
    }

    /// R.
    #[must_use]
    pub fn rotation(&self) -> &Rotation3<f32> {
        &self.rotation
    }

    /// t, in the template's unit.
    #[must_use]
    pub fn translation(&self) -> &Vector3<f32> {
        &self.translation
    }

    /// RP + t: from the object's frame to the camera's.
    #[must_use]
    #[inline(always)]
    pub fn to_camera(&self, point: &Point3<f32>) -> Point3<f32> {
        let p = [point.x, point.y, point.z];
        let r = self.rotation.matrix();
        let t = &self.translation;
        Point3::new(
            math::dot([r.m11, r.m12, r.m13], p) + t.x,
            math::dot([r.m21, r.m22, r.m23], p) + t.y,
            math::dot([r.m31, r.m32, r.m33], p) + t.z,
        )
    }

    /// Rᵀ(p − t): from the camera's frame to the object's.
    #[must_use]
    #[inline(always)]
    pub fn to_object(&self, point: &Point3<f32>) -> Point3<f32> {
        let t = &self.translation;
        let p = [point.x - t.x, point.y - t.y, point.z - t.z];
        let r = self.rotation.matrix();
        Point3::new(
            math::dot([r.m11, r.m21, r.m31], p),
            math::dot([r.m12, r.m22, r.m32], p),
            math::dot([r.m13, r.m23, r.m33], p),
        )
    }
}

impl Pose {
    /// The pose that sees the object's points where this one would if they had been moved by
    /// P ↦ Q(P − C) + C + τ the other way round: (R, t)∘A⁻¹ with A that motion, and Q the rotation of Cayley's
    /// parameters ω/2, which turns by about ‖ω‖ (exactly 2·arctan(‖ω‖/2)). `None` where it is not finite.
    #[must_use]
    pub(crate) fn moved_back(
        &self,
        [cx, cy, cz]: [f32; 3],
        [tx, ty, tz]: [f32; 3],
        omega: [f32; 3],
    ) -> Option<Self> {
        let [x, y, z] = omega.map(|w| 0.5 * w);
        let scale = 1.0 / (1.0 + math::dot([x, y, z], [x, y, z]));
        let (xx, yy, zz) = (x * x, y * y, z * z);
        // Rows of Q, of the unit quaternion (1, x, y, z)·√scale.
        let q = [
            [1.0 + xx - yy - zz, 2.0 * (x * y - z), 2.0 * (x * z + y)],
            [2.0 * (x * y + z), 1.0 - xx + yy - zz, 2.0 * (y * z - x)],
            [2.0 * (x * z - y), 2.0 * (y * z + x), 1.0 - xx - yy + zz],
        ]
        .map(|row| row.map(|entry| entry * scale));
        let m = self.rotation.matrix();
        // RQᵀ: a row of R times a row of Q.
        let rows = [
            [m.m11, m.m12, m.m13],
            [m.m21, m.m22, m.m23],
            [m.m31, m.m32, m.m33],
        ];
        let [[a, b, c], [d, e, f], [g, h, i]] =
            rows.map(|row| q.map(|other| math::dot(row, other)));
        let r = newton_step([a, b, c, d, e, f, g, h, i]);
        let centre = self.to_camera(&Point3::new(cx, cy, cz));
        let shifted = [cx + tx, cy + ty, cz + tz];
        let [a, b, c, d, e, f, g, h, i] = r;
        let t = [
            centre.x - math::dot([a, b, c], shifted),
            centre.y - math::dot([d, e, f], shifted),
            centre.z - math::dot([g, h, i], shifted),
        ];
        let finite = r.iter().chain(&t).all(|entry| entry.is_finite());
        finite.then(|| Self::unchecked(r, t))
    }
}

/// The upper triangle of RᵀR, row by row: the products of R's columns.
///
/// Not by nalgebra's product, which states no order of summation.
fn gram([a, b, c, d, e, f, g, h, i]: [f32; 9]) -> [f32; 6] {
    let (x, y, z) = ([a, d, g], [b, e, h], [c, f, i]);
    [
        math::dot(x, x),
        math::dot(x, y),
        math::dot(x, z),
        math::dot(y, y),
        math::dot(y, z),
        math::dot(z, z),
    ]
}

/// R(3I − RᵀR)/2.
fn newton_step(r: [f32; 9]) -> [f32; 9] {
    let [xx, xy, xz, yy, yz, zz] = gram(r);
    let columns = [
        [1.5 - 0.5 * xx, -0.5 * xy, -0.5 * xz],
        [-0.5 * xy, 1.5 - 0.5 * yy, -0.5 * yz],
        [-0.5 * xz, -0.5 * yz, 1.5 - 0.5 * zz],
    ];
    let [a, b, c, d, e, f, g, h, i] = r;
    let [[a, b, c], [d, e, f], [g, h, i]] =
        [[a, b, c], [d, e, f], [g, h, i]].map(|row| columns.map(|column| math::dot(row, column)));
    [a, b, c, d, e, f, g, h, i]
}

fn determinant([a, b, c, d, e, f, g, h, i]: [f32; 9]) -> f32 {
    math::dot([a, b, c], [e * i - f * h, f * g - d * i, d * h - e * g])
}

fn check(r: [f32; 9], t: [f32; 3], tolerance: f32) -> Result<(), PoseError> {
    if !r.iter().chain(&t).all(|entry| entry.is_finite()) {
        return Err(PoseError::NotFinite);
    }
    let identity = [1.0, 0.0, 0.0, 1.0, 0.0, 1.0];
    let deviation = gram(r)
        .iter()
        .zip(identity)
        .fold(0.0, |most, (entry, expected)| {
            let size = math::abs(*entry - expected);
            // Written so that a NaN from an overflow counts as the largest deviation.
            if size <= most { most } else { size }
        });
    if deviation.is_nan() || deviation > tolerance {
        return Err(PoseError::NotARotation {
            deviation,
            tolerance,
        });
    }
    let determinant = determinant(r);
    if determinant.is_nan() || determinant <= 0.0 {
        return Err(PoseError::Reflection { determinant });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Real;

    const QUARTER_TURN: [f32; 9] = [0., -1., 0., 1., 0., 0., 0., 0., 1.];

    #[test]
    fn a_reflection_is_refused_even_when_orthonormalising() {
        let mirror = [1., 0., 0., 0., 1., 0., 0., 0., -1.];
        for build in [Pose::from_row_major, Pose::from_row_major_orthonormalised] {
            assert_eq!(
                build(mirror, [0.; 3]),
                Err(PoseError::Reflection { determinant: -1. })
            );
        }
    }

    #[test]
    fn a_scaled_rotation_is_refused_and_repaired_on_request() {
        let scaled = QUARTER_TURN.map(|entry| entry * 0.99985);
        assert!(matches!(
            Pose::from_row_major(scaled, [0.; 3]),
            Err(PoseError::NotARotation { .. })
        ));
        let pose = Pose::from_row_major_orthonormalised(scaled, [0.; 3]).unwrap();
        let exact = Matrix3::from_row_slice(&QUARTER_TURN);
        assert!((pose.rotation().matrix() - exact).norm() < 1e-6);
    }

    #[test]
    fn the_worst_repairable_matrix_is_repaired_to_rounding() {
        let mut sheared = QUARTER_TURN;
        sheared[0] = 0.19;
        let pose = Pose::from_row_major_orthonormalised(sheared, [0.; 3]).unwrap();
        let r = pose.rotation().matrix();
        assert!((r.transpose() * r - Matrix3::identity()).norm() < 1e-6);
    }

    #[test]
    fn nan_and_overflow_are_refused() {
        let mut r = QUARTER_TURN;
        r[4] = f32::NAN;
        assert_eq!(Pose::from_row_major(r, [0.; 3]), Err(PoseError::NotFinite));
        r[4] = 3e38;
        assert!(matches!(
            Pose::from_row_major(r, [0.; 3]),
            Err(PoseError::NotARotation { .. })
        ));
        assert!(Pose::from_row_major(QUARTER_TURN, [0., f32::INFINITY, 0.]).is_err());
    }

    #[test]
    fn a_pose_moved_back_sees_the_moved_points_where_it_saw_them() {
        let pose = Pose::from_row_major(QUARTER_TURN, [5., 6., 700.]).unwrap();
        let (centre, shift, omega) = ([10., -4., 3.], [0.5, 2., -1.], [0.1, -0.3, 0.2]);
        let moved = pose.moved_back(centre, shift, omega).unwrap();
        let r = moved.rotation().matrix();
        assert!((r.transpose() * r - Matrix3::identity()).norm() < 1e-6);
        // The motion A: a turn about the centre by 2·arctan(‖ω‖/2), then the shift.
        let omega = Vector3::from(omega);
        let angle = 2.0 * (0.5 * omega.norm()).arctangent(1.0);
        let turn = Rotation3::from_axis_angle(&nalgebra::Unit::new_normalize(omega), angle);
        let (centre, shift) = (Point3::from(centre), Vector3::from(shift));
        for point in [Point3::new(1., 2., 3.), Point3::new(-40., 9., 25.)] {
            let there = centre + turn * (point - centre) + shift;
            let seen = pose.to_camera(&point);
            assert!((moved.to_camera(&there) - seen).norm() < 1e-3);
        }
        assert!(
            pose.moved_back([0.; 3], [f32::NAN, 0., 0.], [0.; 3])
                .is_none()
        );
    }

    #[test]
    #[inline(always)]
    fn to_object_undoes_to_camera() {
        let pose = Pose::from_row_major(QUARTER_TURN, [5., 6., 700.]).unwrap();
        let point = Point3::new(1., 2., 3.);
        assert!((pose.to_object(&pose.to_camera(&point)) - point).norm() < 1e-4);
    }
}
