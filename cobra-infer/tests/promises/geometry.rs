//! Poses and back-projection: repaired rotations are rotations, and what was projected comes back.

use crate::content::direction;
use crate::scene::{IDENTITY, camera};
use crate::tolerance::{BACK_PROJECTION, ORTHONORMAL};
use cobra_infer::Pose;
use cobra_infer::gp::direction_and_distance;
use nalgebra::{Matrix3, Point2, Point3, Rotation3};
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
    #![proptest_config(crate::seed::config())]

    #[test]
    fn a_direction_and_a_distance_give_the_point_back(
        point in [-50.0_f32..50.0, -50.0_f32..50.0, -50.0_f32..50.0],
        origin in [-50.0_f32..50.0, -50.0_f32..50.0, -50.0_f32..50.0],
    ) {
        prop_assume!(point != origin);
        let (u, d) = direction_and_distance(point, origin, 0.0).unwrap();
        let back = Point3::from(origin) + u.into_inner() * d;
        let error = f64::from((back - Point3::from(point)).norm() / 50.0);
        prop_assert!(error <= BACK_PROJECTION, "{error:e}");
    }

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

#[test]
fn a_measured_depth_puts_a_pixel_back_where_it_was() {
    let pose =
        Pose::from_row_major([0.6, -0.8, 0., 0.8, 0.6, 0., 0., 0., 1.], [3., -4., 500.]).unwrap();
    for point in [[0.0, 0.0, 0.0], [30.0, -20.0, 12.0], [-5.0, 44.0, -60.0]] {
        let point = Point3::from(point);
        let seen = pose.to_camera(&point);
        let pixel = camera().project(&seen).unwrap();
        let back = camera().back_project_depth(&pose, &pixel, seen.z).unwrap();
        let error = f64::from((back - point).norm() / seen.coords.norm());
        assert!(error <= BACK_PROJECTION, "{error:e}");
        // The depth is along the camera's axis: a point at half of it lies on the same ray.
        let half = camera()
            .back_project_depth(&pose, &pixel, 0.5 * seen.z)
            .unwrap();
        let again = camera().project(&pose.to_camera(&half)).unwrap();
        assert!((again - pixel).norm() < 1e-3);
    }
}

#[test]
fn a_depth_that_was_not_measured_puts_nothing_back() {
    let pose = Pose::from_row_major(IDENTITY, [0.0, 0.0, 500.0]).unwrap();
    let pixel = Point2::new(320.0, 240.0);
    for depth in [0.0, -1.0, f32::NAN, f32::INFINITY, f32::MAX] {
        let found = camera().back_project_depth(&pose, &pixel, depth);
        assert_eq!(found.is_some(), depth == f32::MAX, "{depth}");
    }
    let far = Point2::new(1e9, 240.0);
    assert_eq!(camera().back_project_depth(&pose, &far, f32::MAX), None);
}
