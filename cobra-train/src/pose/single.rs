//! From the host's poses to the scorer's.

use cobra_infer::{Pose, PoseError};
use nalgebra::Isometry3;

/// A pose in double precision as the scorer takes it: R and t rounded to single precision, and R replaced by
/// the rotation nearest to what rounding left.
///
/// # Errors
/// [`PoseError::NotFinite`] where a number is none in single precision, an object more than 3.4·10³⁸ away for
/// instance.
pub fn single_pose(pose: &Isometry3<f64>) -> Result<Pose, PoseError> {
    let matrix = pose.rotation.to_rotation_matrix();
    let rows = std::array::from_fn(|i| matrix[(i / 3, i % 3)] as f32);
    let [x, y, z] = pose.translation.vector.into();
    Pose::from_row_major_orthonormalised(rows, [x as f32, y as f32, z as f32])
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Point3, Vector3};

    #[test]
    fn points_are_where_the_pose_put_them_to_single_precision() {
        let pose = Isometry3::new(
            Vector3::new(30.0, -20.0, 700.0),
            Vector3::new(0.3, -1.1, 2.0),
        );
        let point = Point3::new(12.0, -34.0, 56.0);
        let seen = single_pose(&pose).unwrap().to_camera(&point.cast());
        assert!((seen.cast::<f64>() - pose * point).norm() < 1e-4);
    }

    #[test]
    fn what_single_precision_does_not_hold_is_no_pose() {
        let far = Isometry3::translation(0.0, 0.0, 1e39);
        assert_eq!(single_pose(&far), Err(PoseError::NotFinite));
    }
}
