//! The pose of an object from points of it and where they are seen: the perspective-n-point problem.
//!
//! Owns the change between this crate's types and the solver's; the solver is `sqpnp_simple`'s.

use cobra_infer::{Camera, Correspondence};
use nalgebra::{Isometry3, Vector3};
use sqpnp_simple::sqpnp_solve;

/// The pose that puts the points of `correspondences` nearest to the rays of their pixels, by SQPnP; an
/// outlier pulls as much as any other. `None` of fewer than three correspondences, and where no pose is
/// found.
///
/// Reference: G. Terzakis and M. Lourakis, A Consistently Fast and Globally Optimal Solution to the
/// Perspective-n-Point Problem, ECCV 2020.
#[must_use]
pub fn solve_pnp(camera: &Camera, correspondences: &[Correspondence]) -> Option<Isometry3<f64>> {
    let (points, rays): (Vec<_>, Vec<_>) = correspondences
        .iter()
        .map(|seen| {
            let point = seen.point.cast::<f64>();
            let ray = camera.ray(&seen.pixel).cast::<f64>();
            ((point.x, point.y, point.z), (ray.x / ray.z, ray.y / ray.z))
        })
        .unzip();
    let (turn, shift) = sqpnp_solve(&points, &rays)?;
    let pose = Isometry3::new(
        Vector3::new(shift.0, shift.1, shift.2),
        Vector3::new(turn.0, turn.1, turn.2),
    );
    let finite = pose.to_homogeneous().iter().all(|entry| entry.is_finite());
    finite.then_some(pose)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose::add;
    use crate::random::{Purpose, normal, stream};
    use nalgebra::{Point2, Point3, Vector3};
    use rand::RngExt;

    /// Points of a unit cube and where they are seen, with `noise` pixels.
    fn seen(
        count: usize,
        noise: f64,
        seed: u64,
    ) -> (Isometry3<f64>, Vec<Point3<f64>>, Vec<Correspondence>) {
        let mut rng = stream(seed, Purpose::PoseErrors, 0);
        let axis = Vector3::from_fn(|_, _| normal(&mut rng));
        let truth = Isometry3::new(Vector3::new(0.2, -0.1, 4.0), axis);
        let points: Vec<Point3<f64>> = (0..count)
            .map(|_| Point3::from(Vector3::from_fn(|_, _| rng.random::<f64>() - 0.5)))
            .collect();
        let correspondences = points
            .iter()
            .map(|point| {
                let pixel = camera().project(&(truth * point).cast()).unwrap();
                let mut off = || (noise * normal(&mut rng)) as f32;
                Correspondence::new(
                    Point2::new(pixel.x + off(), pixel.y + off()),
                    point.cast::<f32>(),
                )
            })
            .collect();
        (truth, points, correspondences)
    }

    fn camera() -> Camera {
        Camera::new(600.0, 600.0, 320.0, 240.0).unwrap()
    }

    #[test]
    fn exact_correspondences_give_the_pose_back() {
        for seed in 0..50 {
            let (truth, points, correspondences) = seen(20, 0.0, seed);
            let found = solve_pnp(&camera(), &correspondences).unwrap();
            assert!(add(&points, &truth, &found) < 1e-4, "seed {seed}");
        }
    }

    #[test]
    fn a_pixel_of_noise_moves_five_hundred_points_little() {
        for seed in 0..50 {
            let (truth, points, correspondences) = seen(500, 1.0, seed);
            let found = solve_pnp(&camera(), &correspondences).unwrap();
            // A pixel is 0.007 there; the distance is the weakest: 0.003 is its standard deviation.
            assert!(add(&points, &truth, &found) < 0.012, "seed {seed}");
        }
    }

    #[test]
    fn too_few_points_have_no_pose_and_points_on_a_line_none_that_is_no_number() {
        let (_, _, correspondences) = seen(2, 0.0, 0);
        assert_eq!(solve_pnp(&camera(), &correspondences), None);
        let line: Vec<Correspondence> = (0..10)
            .map(|i| {
                Correspondence::new(
                    Point2::new(300.0 + i as f32, 240.0),
                    Point3::new(0.01 * i as f32, 0.0, 0.0),
                )
            })
            .collect();
        let found = solve_pnp(&camera(), &line);
        assert!(found.is_none_or(|pose| pose.translation.vector.iter().all(|t| t.is_finite())));
    }
}
