//! Simulated pose estimates of the demonstration's part, of growing error.
//!
//! Owns the numbers of the simulation: where the camera stands, what its estimator's
//! correspondences are worth, how far the poses are off.

use super::camera::Camera;
use crate::pose::{ObservationNoise, add, disturb, observe};
use crate::random::{Purpose, stream};
use crate::surface::{Mesh, RayCaster, SampleError, sample_visible};
use cobra_infer::Correspondence;
use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use rand::{Rng, RngExt};
use rayon::prelude::*;

/// The camera of the demonstration: 1280 × 960 pixels, 71° across.
pub const VIEW: Camera = Camera {
    fx: 900.0,
    fy: 900.0,
    cx: 639.5,
    cy: 479.5,
    width: 1280,
    height: 960,
};

/// Correspondences a pose.
const CORRESPONDENCES: usize = 500;

/// The standard deviation of the points that the simulated estimator finds, in millimetres: what the
/// scorer is told as σ_m.
pub const MEASUREMENT_NOISE: f64 = 1.0;

/// Pixels as a good estimator finds them, every twentieth wrong.
const NOISE: ObservationNoise = ObservationNoise {
    pixel: 0.7,
    point: MEASUREMENT_NOISE,
    outliers: 0.05,
    outlier_pixel: 20.0,
};

/// The smallest and largest pose error, about, in millimetres.
const ERRORS: (f64, f64) = (0.2, 60.0);

/// Surface points that the observed ones are drawn from, and that ADD is taken over.
const SURFACE_POINTS: usize = 4000;

/// A pose that an estimator might have given, and what it saw.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulatedEstimate {
    /// The true pose, in millimetres.
    pub truth: Isometry3<f64>,
    /// The estimated pose.
    pub pose: Isometry3<f64>,
    /// ADD over points of the surface, in millimetres.
    pub error: f64,
    /// What the estimator handed out with the pose.
    pub correspondences: Vec<Correspondence>,
}

/// [`VIEW`] as the scorer has it.
#[must_use]
pub fn scorer_camera() -> cobra_infer::Camera {
    let [fx, fy, cx, cy] = [VIEW.fx, VIEW.fy, VIEW.cx, VIEW.cy].map(|number| number as f32);
    cobra_infer::Camera::new(fx, fy, cx, cy).expect("the demonstration's camera is a pinhole")
}

/// `count` estimates, sorted by error.
///
/// # Errors
/// [`SampleError`] when the mesh cannot be sampled.
pub fn simulate(
    mesh: &Mesh,
    count: usize,
    seed: u64,
) -> Result<Vec<SimulatedEstimate>, SampleError> {
    let sphere = mesh.bounding_sphere();
    let unit = mesh.normalised(&sphere);
    let surface: Vec<Point3<f64>> = sample_visible(
        &unit,
        &RayCaster::new(&unit),
        SURFACE_POINTS,
        seed,
        Purpose::Demonstration,
    )?
    .iter()
    .map(|point| sphere.denormalise(&point.position))
    .collect();
    let caster = RayCaster::new(mesh);
    let camera = scorer_camera();
    let last = count.saturating_sub(1).max(1) as f64;
    let mut estimates: Vec<SimulatedEstimate> = (0..count)
        .into_par_iter()
        .map(|index| {
            let mut rng = stream(seed, Purpose::PoseErrors, index as u64);
            let truth = view(&mut rng);
            let size = ERRORS.0 * (ERRORS.1 / ERRORS.0).powf(index as f64 / last);
            let pose = disturb(&truth, &sphere.centre, sphere.radius, size, &mut rng);
            // Another start for each pose, so that not all see the same points.
            let start = rng.random_range(0..surface.len());
            let (head, tail) = surface.split_at(start);
            let order = [tail, head].concat();
            SimulatedEstimate {
                truth,
                pose,
                error: add(&surface, &truth, &pose),
                correspondences: observe(
                    &caster,
                    &order,
                    &camera,
                    &truth,
                    &NOISE,
                    CORRESPONDENCES,
                    &mut rng,
                ),
            }
        })
        .collect();
    estimates.sort_by(|a, b| a.error.total_cmp(&b.error));
    Ok(estimates)
}

/// A true pose: the part on a table, seen from its front and above.
fn view(rng: &mut impl Rng) -> Isometry3<f64> {
    let upside_down = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
    let tilt = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), -rng.random_range(0.5..1.0));
    let yaw = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), rng.random_range(-0.75..0.75));
    let place = Translation3::new(
        rng.random_range(-40.0..40.0),
        rng.random_range(-30.0..30.0),
        rng.random_range(520.0..640.0),
    );
    Isometry3::from_parts(place, upside_down * tilt * yaw)
}
