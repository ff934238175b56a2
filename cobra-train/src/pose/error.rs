//! Pose errors when the truth is known.

use nalgebra::{Isometry3, Point3};

/// ADD: the mean distance between the model's points in the estimated and in the true pose
/// (S. Hinterstoisser et al., Model based training, detection and pose estimation of texture-less
/// 3D objects, ACCV 2012), in the points' unit; 0 without points.
#[must_use]
pub fn add(points: &[Point3<f64>], truth: &Isometry3<f64>, estimate: &Isometry3<f64>) -> f64 {
    let sum: f64 = points
        .iter()
        .map(|point| (truth * point - estimate * point).norm())
        .sum();
    sum / points.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    #[test]
    fn a_shift_is_its_own_length() {
        let points = [Point3::new(1., 2., 3.), Point3::new(-4., 0., 9.)];
        let truth = Isometry3::rotation(Vector3::new(0.1, 0.2, 0.3));
        let shifted = Isometry3::translation(0., 3., 4.) * truth;
        assert!((add(&points, &truth, &shifted) - 5.0).abs() < 1e-12);
        assert_eq!(add(&points, &truth, &truth), 0.0);
        assert_eq!(add(&[], &truth, &shifted), 0.0);
    }
}
