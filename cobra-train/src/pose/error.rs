//! Pose errors when the truth is known.
//!
//! Owns the definitions of the BOP benchmark (`bop_toolkit`'s `pose_error.py`). Which poses a
//! symmetry makes the same is the caller's knowledge: `bop` reads it from a data set.

use super::ModelPoints;
use cobra_infer::Camera;
use nalgebra::{Isometry3, Matrix3, Point2, Point3};

/// Right is what is off by less than this share of the object's diameter, in ADD or of symmetric objects in ADD-S
/// (S. Hinterstoisser et al., the source of [`add`]).
pub const RIGHT: f64 = 0.1;

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

/// ADD-S: the mean distance from each of the model's points in the true pose to the nearest of them
/// in the estimated pose, for objects with views that cannot be told apart (the same source; ADI in
/// `bop_toolkit`), in the points' unit; 0 without points.
#[must_use]
pub fn add_s(model: &ModelPoints, truth: &Isometry3<f64>, estimate: &Isometry3<f64>) -> f64 {
    // Distances are the same in the estimate's frame, where the model's points lie still.
    model.mean_distance_to_nearest(&(estimate.inverse() * truth))
}

/// MSSD, maximum symmetry-aware surface distance: min over S in `symmetries` of max over the points
/// P of ‖ÊP − T̄SP‖, Ê the estimate and T̄ the truth (T. Hodaň et al., BOP Challenge 2020 on 6D object
/// localization, ECCVW 2020), in the points' unit; 0 without points.
///
/// `symmetries` move the object onto itself, in its own frame; the identity counts whether it is
/// among them or not.
#[must_use]
pub fn mssd(
    points: &[Point3<f64>],
    truth: &Isometry3<f64>,
    estimate: &Isometry3<f64>,
    symmetries: &[Isometry3<f64>],
) -> f64 {
    let squared = least(symmetries, |symmetry, best| {
        let truth = truth * symmetry;
        largest(points, best, |p| (truth * p - estimate * p).norm_squared())
    });
    squared.sqrt()
}

/// MSPD, maximum symmetry-aware projection distance: min over S in `symmetries` of max over the
/// points P of ‖proj(ÊP) − proj(T̄SP)‖, in pixels (the source of [`mssd`]); 0 without points.
///
/// As there, the identity counts whether it is among the `symmetries` or not. As in `bop_toolkit`, a
/// point behind the camera is projected through it; infinite for a point in the camera's plane.
#[must_use]
pub fn mspd(
    points: &[Point3<f64>],
    camera: &Camera,
    truth: &Isometry3<f64>,
    estimate: &Isometry3<f64>,
    symmetries: &[Isometry3<f64>],
) -> f64 {
    let k = Matrix3::from_row_slice(&camera.to_matrix()).cast::<f64>();
    let project = |pose: &Isometry3<f64>, point: &Point3<f64>| {
        let seen = k * (pose * point).coords;
        Point2::new(seen.x / seen.z, seen.y / seen.z)
    };
    let estimated: Vec<Point2<f64>> = points.iter().map(|p| project(estimate, p)).collect();
    let squared = least(symmetries, |symmetry, best| {
        let truth = truth * symmetry;
        largest(points.iter().zip(&estimated), best, |(point, estimated)| {
            let distance = (project(&truth, point) - estimated).norm_squared();
            if distance.is_nan() {
                f64::INFINITY
            } else {
                distance
            }
        })
    });
    squared.sqrt()
}

/// The least that `error` is of the identity and the symmetries; it is told the least so far.
fn least(symmetries: &[Isometry3<f64>], error: impl Fn(&Isometry3<f64>, f64) -> f64) -> f64 {
    let identity = Isometry3::identity();
    std::iter::once(&identity)
        .chain(symmetries)
        .fold(f64::INFINITY, |best, symmetry| {
            best.min(error(symmetry, best))
        })
}

/// The largest value, at least 0, or one that is not below `enough`: more does not matter then.
fn largest<T>(items: impl IntoIterator<Item = T>, enough: f64, value: impl Fn(T) -> f64) -> f64 {
    let mut most = 0.0_f64;
    for item in items {
        most = most.max(value(item));
        if most >= enough {
            break;
        }
    }
    most
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;
    use std::f64::consts::{FRAC_PI_2, PI};

    /// The corners of a square of side 2 at z = 0.
    fn square() -> Vec<Point3<f64>> {
        [[1., 1.], [1., -1.], [-1., -1.], [-1., 1.]]
            .map(|[x, y]| Point3::new(x, y, 0.0))
            .to_vec()
    }

    fn turn(angle: f64) -> Isometry3<f64> {
        Isometry3::rotation(Vector3::z() * angle)
    }

    fn in_front() -> Isometry3<f64> {
        Isometry3::translation(0.5, -0.25, 10.0)
    }

    #[test]
    fn a_shift_is_its_own_length() {
        let points = [Point3::new(1., 2., 3.), Point3::new(-4., 0., 9.)];
        let truth = Isometry3::rotation(Vector3::new(0.1, 0.2, 0.3));
        let shifted = Isometry3::translation(0., 3., 4.) * truth;
        assert!((add(&points, &truth, &shifted) - 5.0).abs() < 1e-12);
        assert!((mssd(&points, &truth, &shifted, &[]) - 5.0).abs() < 1e-12);
        assert_eq!(add(&points, &truth, &truth), 0.0);
        assert_eq!(add(&[], &truth, &shifted), 0.0);
        assert_eq!(mssd(&[], &truth, &shifted, &[]), 0.0);
    }

    #[test]
    fn add_s_asks_for_the_nearest_point_and_add_for_the_same() {
        let model = ModelPoints::new(square());
        let (truth, turned) = (in_front(), in_front() * turn(FRAC_PI_2));
        assert!((add(model.points(), &truth, &turned) - 2.0).abs() < 1e-12);
        assert!(add_s(&model, &truth, &turned) < 1e-12);
        // 0.5 to the side: the nearest corner is the same one.
        let shifted = in_front() * Isometry3::translation(0.5, 0., 0.);
        assert!((add_s(&model, &truth, &shifted) - 0.5).abs() < 1e-12);
        assert_eq!(add_s(&ModelPoints::new(Vec::new()), &truth, &turned), 0.0);
    }

    #[test]
    fn add_s_is_measured_from_the_points_in_the_true_pose() {
        // Of the points at x = 0, 1 and 10, moved by -10 in the estimate: from 0 to 0, from 1 to 0,
        // from 10 to 0; the other way round it would be from -10, from -9 and from 0.
        let line = [0.0, 1.0, 10.0].map(|x| Point3::new(x, 0., 0.)).to_vec();
        let model = ModelPoints::new(line);
        let moved = Isometry3::translation(-10.0, 0., 0.);
        let found = add_s(&model, &Isometry3::identity(), &moved);
        assert!((found - 11.0 / 3.0).abs() < 1e-12, "{found}");
    }

    #[test]
    fn a_symmetry_excuses_the_turn_that_it_names_and_no_other() {
        let camera = Camera::new(500.0, 400.0, 320.0, 240.0).unwrap();
        let (points, truth) = (square(), in_front());
        let half = [turn(PI)];
        let errors = |angle: f64, symmetries: &[Isometry3<f64>]| {
            let estimate = truth * turn(angle);
            [
                mssd(&points, &truth, &estimate, symmetries),
                mspd(&points, &camera, &truth, &estimate, symmetries),
            ]
        };
        for [without, with] in [errors(PI, &[]), errors(PI, &half)] {
            assert_eq!(without > 1.0, with > 100.0);
        }
        assert!(errors(PI, &half).iter().all(|error| *error < 1e-9));
        let quarter = errors(FRAC_PI_2, &half);
        assert!((quarter[0] - 2.0).abs() < 1e-12);
        // Neighbouring corners along x: 2 · 500 / 10 pixels; along y it would be 80.
        assert!((quarter[1] - 100.0).abs() < 1e-9);
        // Without the identity among them, symmetries never make an error larger.
        assert!(errors(0.0, &half).iter().all(|error| *error < 1e-9));
    }

    #[test]
    fn a_point_in_the_cameras_plane_is_infinitely_far() {
        let camera = Camera::new(500.0, 500.0, 320.0, 240.0).unwrap();
        let truth = in_front();
        let flat = Isometry3::identity();
        assert_eq!(mspd(&square(), &camera, &truth, &flat, &[]), f64::INFINITY);
        let origin = [Point3::origin()];
        assert_eq!(mspd(&origin, &camera, &truth, &flat, &[]), f64::INFINITY);
    }
}
