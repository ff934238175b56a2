//! Simulated estimates, as the paper's supplement describes them.
//!
//! Owns the grid of poses and of noise, which the supplement asks for and does not print. The solver is
//! `pose`'s.

use crate::pose::{add, solve_pnp, solve_pnp_in_space};
use crate::random::{Purpose, normal, stream};
use cobra_infer::{Camera, Correspondence};
use nalgebra::{Isometry3, Point2, Point3, UnitQuaternion, Vector3};
use rand::RngExt;
use rayon::prelude::*;

/// What is simulated, lengths in radii of the object's bounding sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Protocol {
    /// Points of the surface, the same for all estimates of an object.
    pub points: usize,
    /// The turns about the object's axis z, φ, in degrees.
    pub turns: &'static [f64],
    /// The tilts about the camera's axis x that follow, θ, in degrees.
    pub tilts: &'static [f64],
    /// How far the object's centre is from the camera, along its axis.
    pub distances: &'static [f64],
    /// The standard deviation of an inlier's pixel coordinates.
    pub inlier_noise: f64,
    /// The probability of a point being an outlier, and the standard deviation of an outlier's pixel
    /// coordinates.
    pub noise: &'static [(f64, f64)],
    /// Estimates for each of these poses and each of these noises.
    pub repetitions: usize,
    /// How poses are found.
    pub solver: PnpSolver,
}

/// How poses are found from correspondences.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PnpSolver {
    /// By the least reprojection error ([`solve_pnp`]).
    Reprojection,
    /// By the least distances in space ([`solve_pnp_in_space`]).
    Space,
}

/// The grid of noise: five outlier shares times five standard deviations, and no outliers.
const NOISE: [(f64, f64); 26] = {
    let mut noise = [(0.0, 0.0); 26];
    let mut index = 1;
    while index < 26 {
        let (share, size) = ((index - 1) / 5 + 1, (index - 1) % 5 + 1);
        noise[index] = (0.1 * share as f64, 12.0 * size as f64);
        index += 1;
    }
    noise
};

impl Protocol {
    /// That of Table 2: 936 estimates an object.
    pub const CORRELATION: Self = Self {
        points: 500,
        turns: &[0.0, 60.0, 120.0, 180.0, 240.0, 300.0],
        tilts: &[30.0, 90.0, 150.0],
        distances: &[3.5, 5.5],
        inlier_noise: 1.0,
        noise: &NOISE,
        repetitions: 1,
        solver: PnpSolver::Reprojection,
    };
}

/// The camera: 640 × 480 pixels, 56° across.
///
/// # Panics
/// Never: its numbers are a camera's.
#[must_use]
pub(super) fn camera() -> Camera {
    Camera::new(600.0, 600.0, 320.0, 240.0).expect("a camera")
}

/// An estimate, and what is known of it.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// The probability of a point being an outlier.
    pub outliers: f64,
    /// The standard deviation of an outlier's pixel coordinates.
    pub outlier_noise: f64,
    /// The pose that PnP found.
    pub pose: Isometry3<f64>,
    /// What it was found from: noisy pixels and the points that belong to them.
    pub correspondences: Vec<Correspondence>,
    /// ADD, in radii of the object's bounding sphere.
    pub add: f64,
}

/// The estimates of a protocol on the first points of `surface`, a random sample of the object's surface in
/// the unit sphere, over all of which ADD is taken. Points that the object itself hides are projected like
/// all others, as in the supplement. Estimates for which PnP finds no pose are left out.
///
/// The same arguments give the same estimates, whatever the number of threads.
#[must_use]
pub fn simulate_estimates(
    surface: &[Point3<f64>],
    protocol: &Protocol,
    seed: u64,
) -> Vec<Estimate> {
    let points = &surface[..protocol.points.min(surface.len())];
    let mut jobs = Vec::new();
    for repetition in 0..protocol.repetitions {
        for (&turn, &tilt) in pairs(protocol.turns, protocol.tilts) {
            for (&distance, &noise) in pairs(protocol.distances, protocol.noise) {
                jobs.push((repetition, turn, tilt, distance, noise));
            }
        }
    }
    jobs.par_iter()
        .enumerate()
        .filter_map(
            |(index, &(_, turn, tilt, distance, (outliers, outlier_noise)))| {
                let truth = view(turn, tilt, distance);
                let mut rng = stream(seed, Purpose::SimulatedEstimates, index as u64);
                let correspondences: Vec<Correspondence> = points
                    .iter()
                    .filter_map(|point| {
                        let pixel = camera().project(&(truth * point).cast::<f32>())?;
                        let outlier = rng.random::<f64>() < outliers;
                        let spread = if outlier {
                            outlier_noise
                        } else {
                            protocol.inlier_noise
                        };
                        let mut off = || (spread * normal(&mut rng)) as f32;
                        let pixel = Point2::new(pixel.x + off(), pixel.y + off());
                        Some(Correspondence::new(pixel, point.cast::<f32>()))
                    })
                    .collect();
                let solve = match protocol.solver {
                    PnpSolver::Reprojection => solve_pnp,
                    PnpSolver::Space => solve_pnp_in_space,
                };
                let pose = solve(&camera(), &correspondences)?;
                Some(Estimate {
                    outliers,
                    outlier_noise,
                    add: add(surface, &truth, &pose),
                    pose,
                    correspondences,
                })
            },
        )
        .collect()
}

/// The object turned about its z by φ, tilted about the camera's x by θ, and moved away from the camera.
fn view(turn: f64, tilt: f64, distance: f64) -> Isometry3<f64> {
    let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turn.to_radians());
    let tilt = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), tilt.to_radians());
    Isometry3::from_parts(Vector3::new(0.0, 0.0, distance).into(), tilt * turn)
}

fn pairs<'a, A, B>(a: &'a [A], b: &'a [B]) -> impl Iterator<Item = (&'a A, &'a B)> {
    a.iter().flat_map(move |a| b.iter().map(move |b| (a, b)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::fibonacci_sphere;

    /// Points of an ellipsoid, which no turn maps onto itself but half ones.
    fn surface() -> Vec<Point3<f64>> {
        let sphere = fibonacci_sphere(600);
        let squeezed = sphere
            .iter()
            .map(|u| Point3::new(u.x, 0.7 * u.y, 0.4 * u.z));
        squeezed.collect()
    }

    #[test]
    fn the_noise_is_a_grid_and_once_none() {
        assert_eq!(NOISE[0], (0.0, 0.0));
        assert_eq!((NOISE[1], NOISE[25]), ((0.1, 12.0), (0.5, 60.0)));
        let shares: std::collections::BTreeSet<u64> = NOISE
            .iter()
            .map(|noise| (10.0 * noise.0).round() as u64)
            .collect();
        assert_eq!(shares.len(), 6);
    }

    #[test]
    fn more_outliers_of_more_noise_give_worse_poses() {
        let estimates = simulate_estimates(&surface(), &Protocol::CORRELATION, 0);
        assert_eq!(estimates.len(), 936);
        let mean = |outliers: f64, noise: f64| {
            let of = estimates.iter().filter(|e| {
                (e.outliers - outliers).abs() < 1e-9 && (e.outlier_noise - noise).abs() < 1e-9
            });
            let errors: Vec<f64> = of.map(|e| e.add).collect();
            errors.iter().sum::<f64>() / errors.len() as f64
        };
        let (none, few, many) = (mean(0.0, 0.0), mean(0.1, 12.0), mean(0.5, 60.0));
        assert!(none < few && few < many, "{none} {few} {many}");
        assert!(none < 0.01, "{none}");
    }

    #[test]
    fn the_seed_says_the_estimates() {
        let poses = |seed| -> Vec<Isometry3<f64>> {
            let estimates = simulate_estimates(&surface(), &Protocol::CORRELATION, seed);
            estimates
                .into_iter()
                .map(|estimate| estimate.pose)
                .collect()
        };
        assert_eq!(poses(1), poses(1));
        assert_ne!(poses(1), poses(2));
    }
}
