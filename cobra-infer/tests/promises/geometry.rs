//! Poses and back-projection: repaired rotations are rotations, and what was projected comes back.

use crate::content::direction;
use crate::scene::camera;
use crate::tolerance::{BACK_PROJECTION, ORTHONORMAL};
use cobra_infer::Pose;
use nalgebra::{Matrix3, Point3, Rotation3};
use proptest::prelude::*;

fn row_major(matrix: &Matrix3<f32>) -> [f32; 9] {
    let mut rows = [0.0; 9];
    rows.iter_mut()
        .zip(matrix.transpose().iter())
        .for_each(|(place, entry)| *place = *entry);
    rows
}

fn rotation() -> impl Strategy<Value = Rotation3<f32>> {
    (direction(), -3.2_f32..3.2).prop_map(|(axis, angle)| Rotation3::from_axis_angle(&axis, angle))
}

proptest! {
    #[test]
    fn whatever_can_be_orthonormalised_becomes_a_rotation(
        rotation in rotation(),
        damage in prop::array::uniform9(-0.06_f32..0.06),
    ) {
        let damaged = rotation.matrix() + Matrix3::from_row_slice(&damage);
        let pose = Pose::from_row_major_orthonormalised(row_major(&damaged), [0.0; 3]);
        if let Ok(pose) = pose {
            let r = pose.rotation().matrix();
            let deviation = (r.transpose() * r - Matrix3::identity()).amax();
            prop_assert!(f64::from(deviation) <= ORTHONORMAL, "{deviation:e}");
            prop_assert!(r.determinant() > 0.0);
            prop_assert!(Pose::from_row_major(row_major(r), [0.0; 3]).is_ok());
        }
    }

    #[test]
    fn a_rotation_is_accepted_and_kept_bit_by_bit(rotation in rotation()) {
        let rows = row_major(rotation.matrix());
        let pose = Pose::from_row_major(rows, [1.0, 2.0, 3.0]).unwrap();
        prop_assert_eq!(row_major(pose.rotation().matrix()), rows);
    }

    #[test]
    fn what_was_projected_comes_back(
        rotation in rotation(),
        t in (-100.0_f32..100.0, -100.0_f32..100.0, 300.0_f32..900.0),
        point in [-100.0_f32..100.0, -100.0_f32..100.0, -100.0_f32..100.0],
    ) {
        let pose = Pose::from_row_major(row_major(rotation.matrix()), [t.0, t.1, t.2]).unwrap();
        let point = Point3::from(point);
        let seen = pose.to_camera(&point);
        let pixel = camera().project(&seen).unwrap();
        let back = camera().back_project(&pose, &pixel, &point);
        let error = f64::from((back.point - point).norm() / seen.coords.norm());
        prop_assert!(error <= BACK_PROJECTION, "{error:e}");
        prop_assert!(back.depth > 0.0);
    }
}

#[test]
fn the_worst_that_can_be_orthonormalised_becomes_a_rotation() {
    // RᵀR − I has every entry at the limit of 0.2: singular values 0.632 or 1.265, and 1 twice.
    for scale in [-0.122_4_f32, 0.088_2] {
        let matrix = Matrix3::identity() + Matrix3::repeat(scale);
        let pose = Pose::from_row_major_orthonormalised(row_major(&matrix), [0.0; 3]).unwrap();
        let r = pose.rotation().matrix();
        let deviation = (r.transpose() * r - Matrix3::identity()).amax();
        assert!(f64::from(deviation) <= ORTHONORMAL, "{deviation:e}");
    }
}
