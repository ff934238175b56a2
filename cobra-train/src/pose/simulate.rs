//! Simulated observations and simulated pose errors.

use crate::random::normal;
use crate::surface::RayCaster;
use cobra_infer::{Camera, Correspondence};
use nalgebra::{Isometry3, Point2, Point3, Translation3, UnitQuaternion, UnitVector3, Vector3};
use rand::{Rng, RngExt};

/// How an estimator's correspondences differ from the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObservationNoise {
    /// Standard deviation of a pixel coordinate, in pixels.
    pub pixel: f64,
    /// Standard deviation of an object coordinate, in the mesh's unit.
    pub point: f64,
    /// Share of pixels that do not belong to the object point that is claimed for them.
    pub outliers: f64,
    /// Standard deviation of such a pixel's displacement, in pixels.
    pub outlier_pixel: f64,
}

/// Correspondences of about `count` of the `surface` points that are visible in `truth`.
///
/// Points are taken in their order. A point is visible when the ray from the camera to it meets the
/// surface there first; `caster` and `surface` share the object's frame.
#[must_use]
pub fn observe(
    caster: &RayCaster,
    surface: &[Point3<f64>],
    camera: &Camera,
    truth: &Isometry3<f64>,
    noise: &ObservationNoise,
    count: usize,
    rng: &mut impl Rng,
) -> Vec<Correspondence> {
    let eye = truth.inverse() * Point3::origin();
    let tolerance = 1e-6 * surface.iter().map(|p| p.coords.norm()).fold(0.0, f64::max);
    let mut correspondences = Vec::with_capacity(count);
    for point in surface {
        if correspondences.len() == count {
            break;
        }
        let sight = point - eye;
        let hidden = caster
            .cast(&eye, &sight)
            .is_none_or(|hit| hit.distance < sight.norm() - tolerance);
        let Some(pixel) = camera.project(&(truth * point).cast::<f32>()) else {
            continue;
        };
        if hidden {
            continue;
        }
        let spread = if rng.random::<f64>() < noise.outliers {
            noise.outlier_pixel
        } else {
            noise.pixel
        };
        let claimed = point + noise.point * Vector3::from_fn(|_, _| normal(rng));
        correspondences.push(Correspondence::new(
            Point2::new(
                pixel.x + (spread * normal(rng)) as f32,
                pixel.y + (spread * normal(rng)) as f32,
            ),
            claimed.cast::<f32>(),
        ));
    }
    correspondences
}

/// A pose that differs from `truth` by a turn about a random axis through `centre` that moves a
/// point at `radius` by about `size`, and by a shift of about `size` in a random direction.
#[must_use]
pub fn disturb(
    truth: &Isometry3<f64>,
    centre: &Point3<f64>,
    radius: f64,
    size: f64,
    rng: &mut impl Rng,
) -> Isometry3<f64> {
    let angle = (size / radius * rng.random_range(0.5..1.5)).min(std::f64::consts::PI);
    let turn = UnitQuaternion::from_axis_angle(&direction(rng), angle);
    let shift = direction(rng).into_inner() * size * rng.random_range(0.3..1.0);
    let to_centre = Translation3::from(centre.coords);
    Translation3::from(shift) * truth * to_centre * turn * to_centre.inverse()
}

fn direction(rng: &mut impl Rng) -> UnitVector3<f64> {
    loop {
        let vector = Vector3::from_fn(|_, _| normal(rng));
        if let Some(direction) = UnitVector3::try_new(vector, 1e-9) {
            return direction;
        }
    }
}
