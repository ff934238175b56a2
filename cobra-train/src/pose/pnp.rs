//! The pose of an object from points of it and where they are seen: the perspective-n-point problem.
//!
//! Owns the change between this crate's types and the solvers', and the reprojection error; the solvers are
//! `sqpnp_simple`'s and `basin`'s.

use basin::{Executor, FiniteDiff, LevenbergMarquardt, PointState, Residual};
use cobra_infer::{Camera, Correspondence};
use nalgebra::{
    Isometry3, Matrix2x3, Matrix3, Point2, Point3, Translation3, UnitQuaternion, Vector2, Vector3,
};
use sqpnp_simple::sqpnp_solve;
use std::convert::Infallible;

/// The refinement ends when a step promises to lessen the squared error by less than this share.
const TOLERANCE: f64 = 1e-8;

/// Steps of the refinement, a limit that few come near.
const ITERATIONS: u64 = 100;

/// A point nearer to the camera's plane than this is projected as if it were there.
const NEAREST: f64 = 1e-6;

/// The pose of the least squared reprojection error of `correspondences`: SQPnP, refined by
/// Levenberg and Marquardt's method, from there and from where it would be seen from afar. An outlier pulls as
/// much as its distance in the image. `None` of fewer than three correspondences, and where no pose is found.
///
/// Reference: J. Moré, The Levenberg-Marquardt algorithm: implementation and theory, 1978; the other is
/// [`solve_pnp_in_space`]'s.
#[must_use]
pub fn solve_pnp(camera: &Camera, correspondences: &[Correspondence]) -> Option<Isometry3<f64>> {
    if correspondences.len() < 3 {
        return None;
    }
    let seen = rays(camera, correspondences);
    let starts = [sqpnp(&seen), from_afar(&seen)];
    let camera = camera.to_matrix().map(f64::from);
    let refined = starts.map(|start| refine(start?, &seen, camera));
    let found = refined
        .into_iter()
        .flatten()
        .filter(|(_, pose)| finite(pose));
    found
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, pose)| pose)
}

/// The pose of the least squared distances of points from the rays of their pixels, by SQPnP. These
/// shrink as the object comes nearer to the camera: with many pixels of noise it is found far too near. `None` of
/// fewer than three correspondences, and where no pose is found.
///
/// Reference: G. Terzakis and M. Lourakis, A Consistently Fast and Globally Optimal Solution to the
/// Perspective-n-Point Problem, ECCV 2020.
#[must_use]
pub fn solve_pnp_in_space(
    camera: &Camera,
    correspondences: &[Correspondence],
) -> Option<Isometry3<f64>> {
    sqpnp(&rays(camera, correspondences))
}

fn sqpnp(seen: &[Seen]) -> Option<Isometry3<f64>> {
    let (points, rays): (Vec<_>, Vec<_>) = seen
        .iter()
        .map(|Seen { point, ray }| ((point.x, point.y, point.z), (ray.x, ray.y)))
        .unzip();
    let (turn, shift) = sqpnp_solve(&points, &rays)?;
    let pose = Isometry3::new(
        Vector3::new(shift.0, shift.1, shift.2),
        Vector3::new(turn.0, turn.1, turn.2),
    );
    finite(&pose).then_some(pose)
}

fn finite(pose: &Isometry3<f64>) -> bool {
    pose.to_homogeneous().iter().all(|entry| entry.is_finite())
}

fn rays(camera: &Camera, correspondences: &[Correspondence]) -> Vec<Seen> {
    let seen = correspondences.iter().map(|seen| {
        let ray = camera.ray(&seen.pixel).cast::<f64>();
        Seen {
            point: seen.point.cast(),
            ray: Point2::new(ray.x / ray.z, ray.y / ray.z),
        }
    });
    seen.collect()
}

/// The pose of the least squared reprojection error near `first`, with half of that error.
fn refine(first: Isometry3<f64>, seen: &[Seen], camera: [f64; 9]) -> Option<(f64, Isometry3<f64>)> {
    let problem = Reprojection {
        first,
        seen,
        camera,
    };
    let solver = LevenbergMarquardt::new().with_relative_model_reduction_tolerance(TOLERANCE);
    let start = PointState::new(vec![0.0; 6]);
    let result = Executor::new(FiniteDiff::new(problem), solver, start)
        .max_iter(ITERATIONS)
        .run()
        .ok()?;
    Some((result.best_cost(), moved(&first, result.best_param())))
}

/// The pose as if the camera were far away: rays are then a turned, scaled and shifted shadow of the points.
/// The rotation is that of the orthogonal Procrustes problem, the scale the least squares one, which noise on
/// rays leaves unbiased. SQPnP's own pose may be so near to the camera that nothing leads away from there.
/// `None` where no scale above 0 fits.
fn from_afar(seen: &[Seen]) -> Option<Isometry3<f64>> {
    let count = seen.len() as f64;
    let middle = seen
        .iter()
        .map(|seen| seen.point.coords)
        .sum::<Vector3<f64>>()
        / count;
    let ray = seen
        .iter()
        .map(|seen| seen.ray.coords)
        .sum::<Vector2<f64>>()
        / count;
    let together: Matrix2x3<f64> = seen
        .iter()
        .map(|seen| (seen.ray.coords - ray) * (seen.point.coords - middle).transpose())
        .sum();
    let svd = together.svd(true, true);
    let shadow = svd.u? * svd.v_t?;
    let (across, down) = (shadow.row(0).transpose(), shadow.row(1).transpose());
    let rotation = Matrix3::from_rows(&[
        across.transpose(),
        down.transpose(),
        across.cross(&down).transpose(),
    ]);
    let rotation = UnitQuaternion::from_matrix(&rotation);
    let turned = rotation * middle;
    let (mut product, mut square) = (0.0, 0.0);
    for one in seen {
        let point = (rotation * one.point.coords - turned).xy();
        product += point.dot(&(one.ray.coords - ray));
        square += point.norm_squared();
    }
    let depth = square / product;
    let place = Vector3::new(depth * ray.x, depth * ray.y, depth) - turned;
    (depth > 0.0).then(|| Isometry3::from_parts(Translation3::from(place), rotation))
}

/// A point of the object, and the ray that it is seen on, at z = 1.
struct Seen {
    point: Point3<f64>,
    ray: Point2<f64>,
}

/// The reprojection error in pixels over a turn and a shift of a first pose.
struct Reprojection<'s> {
    first: Isometry3<f64>,
    seen: &'s [Seen],
    /// K, row-major.
    camera: [f64; 9],
}

impl Residual for Reprojection<'_> {
    type Param = Vec<f64>;
    type Output = Vec<f64>;
    type Error = Infallible;

    fn residual(&self, by: &Vec<f64>) -> Result<Vec<f64>, Infallible> {
        let pose = moved(&self.first, by);
        Ok(self
            .seen
            .iter()
            .flat_map(|Seen { point, ray }| {
                let at = pose * point;
                let depth = at.z.max(NEAREST);
                let (x, y) = (at.x / depth - ray.x, at.y / depth - ray.y);
                let [fx, skew, _, _, fy, ..] = self.camera;
                [fx * x + skew * y, fy * y]
            })
            .collect())
    }
}

/// The pose turned about the object's own origin and shifted: a rotation vector and a translation.
fn moved(pose: &Isometry3<f64>, by: &[f64]) -> Isometry3<f64> {
    let &[a, b, c, x, y, z] = by else {
        return *pose;
    };
    let turn = UnitQuaternion::from_scaled_axis(Vector3::new(a, b, c));
    let shift = pose.translation.vector + Vector3::new(x, y, z);
    Isometry3::from_parts(Translation3::from(shift), turn * pose.rotation)
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
    fn pixels_of_noise_do_not_draw_the_object_to_the_camera() {
        let errors = (0..50).map(|seed| {
            let (truth, _, correspondences) = seen(500, 20.0, seed);
            let found = solve_pnp(&camera(), &correspondences).unwrap();
            found.translation.z - truth.translation.z
        });
        let mean = errors.sum::<f64>() / 50.0;
        // One estimate's standard deviation is 0.06.
        assert!(mean.abs() < 0.03, "{mean}");
    }

    #[test]
    fn no_pose_near_the_truth_has_a_smaller_error_than_the_one_that_is_found() {
        let thin = |point: &Point3<f64>| Point3::new(point.x, 0.3 * point.y, 0.2 * point.z);
        for seed in 0..50 {
            let mut rng = stream(seed, Purpose::PoseErrors, 1);
            let (truth, points, _) = seen(500, 0.0, seed);
            let correspondences: Vec<Correspondence> = points
                .iter()
                .map(|point| {
                    let point = thin(point);
                    let pixel = camera().project(&(truth * point).cast()).unwrap();
                    let mut off = || (25.0 * normal(&mut rng)) as f32;
                    Correspondence::new(
                        Point2::new(pixel.x + off(), pixel.y + off()),
                        point.cast::<f32>(),
                    )
                })
                .collect();
            let found = solve_pnp(&camera(), &correspondences).unwrap();
            let k = camera().to_matrix().map(f64::from);
            let all = rays(&camera(), &correspondences);
            let [(near, _), (error, _)] =
                [truth, found].map(|start| refine(start, &all, k).unwrap());
            assert!(error < near * (1.0 + 1e-6), "seed {seed}: {error} {near}");
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
