//! Points that are seen from the reference points: rays from each, the first hit kept.
//!
//! Owns the directions, how many rays are cast and which hits count; where reference points lie is
//! `reference`'s work. The same surface, points, count and seed give the same hits, bit for bit, on
//! any number of threads.

use libm::{cos, sin};
use nalgebra::{Point3, Quaternion, UnitQuaternion};
use rand::seq::SliceRandom;
use rand::{Rng, RngExt};
use rayon::prelude::*;
use std::f64::consts::TAU;

use super::camera::fibonacci_sphere;
use super::raycast::RayCaster;
use super::sample::SampleError;
use crate::random::{Purpose, stream};

/// A hit nearer to the reference point than this lies on it and gives no direction (unit sphere):
/// rays start that far out.
const SMALLEST_DISTANCE: f64 = 1e-4;

/// A reference point from which fewer rays than this share hit is given up.
const LOWEST_HIT_RATE: f64 = 0.01;

/// A further round casts at least this many rays.
const FEWEST_RAYS: usize = 100;

/// Draws `count` points: an equal share of first hits of rays from each of `origins`, to within one
/// point, in the order of the origins.
///
/// The rays of a round leave in the directions of a Fibonacci sphere, turned at random; where rays
/// miss, further rounds follow, and of too many hits a random choice is kept. All is in the unit
/// sphere.
///
/// # Errors
/// [`SampleError::HiddenSurface`]: hardly any ray from one of the origins hits.
pub fn sample_from_within(
    caster: &RayCaster,
    origins: &[Point3<f64>],
    count: usize,
    seed: u64,
) -> Result<Vec<Point3<f64>>, SampleError> {
    let share = count / origins.len().max(1);
    let rest = count - share * origins.len();
    let hits = origins
        .par_iter()
        .enumerate()
        .map(|(index, origin)| {
            let wanted = share + usize::from(index < rest);
            let mut rng = stream(seed, Purpose::RaysFromWithin, index as u64);
            hits_from(caster, origin, wanted, &mut rng).map_err(|(hits, rays)| {
                SampleError::HiddenSurface {
                    index,
                    wanted,
                    hits,
                    rays,
                }
            })
        })
        .collect::<Result<Vec<_>, _>>()?;
    Ok(hits.concat())
}

/// Exactly `wanted` hits, or how many there were of how many rays.
fn hits_from(
    caster: &RayCaster,
    origin: &Point3<f64>,
    wanted: usize,
    rng: &mut impl Rng,
) -> Result<Vec<Point3<f64>>, (usize, usize)> {
    let mut hits = Vec::new();
    let mut rays = 0;
    let mut cast = wanted;
    while hits.len() < wanted {
        let turn = random_rotation(rng);
        let directions = fibonacci_sphere(cast);
        rays += directions.len();
        hits.extend(directions.iter().filter_map(|direction| {
            let direction = turn * direction.into_inner();
            let start = origin + direction * SMALLEST_DISTANCE;
            Some(caster.cast(&start, &direction)?.point)
        }));
        let rate = hits.len() as f64 / rays as f64;
        if rate < LOWEST_HIT_RATE {
            return Err((hits.len(), rays));
        }
        let missing = wanted.saturating_sub(hits.len()) as f64;
        cast = ((1.05 * missing / rate) as usize).max(FEWEST_RAYS);
    }
    hits.shuffle(rng);
    hits.truncate(wanted);
    Ok(hits)
}

/// A rotation drawn uniformly from all (K. Shoemake, Uniform random rotations, 1992).
fn random_rotation(rng: &mut impl Rng) -> UnitQuaternion<f64> {
    let [share, first, second]: [f64; 3] = rng.random();
    let (a, b) = ((1.0 - share).sqrt(), share.sqrt());
    let (first, second) = (TAU * first, TAU * second);
    UnitQuaternion::new_normalize(Quaternion::new(
        a * sin(first),
        a * cos(first),
        b * sin(second),
        b * cos(second),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::Mesh;

    /// A cube with half-width 0.5, without its lid when `open`.
    fn cube(open: bool) -> RayCaster {
        let vertices = (0..8)
            .map(|corner| [0, 1, 2].map(|axis| f64::from(corner >> axis & 1) - 0.5))
            .map(Point3::from)
            .collect();
        let quads = [
            [0, 1, 3, 2],
            [0, 1, 5, 4],
            [2, 3, 7, 6],
            [0, 2, 6, 4],
            [1, 3, 7, 5],
            [4, 5, 7, 6],
        ];
        let triangles = quads
            .iter()
            .take(if open { 5 } else { 6 })
            .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
            .collect();
        RayCaster::new(&Mesh::new(vertices, triangles).unwrap())
    }

    #[test]
    fn each_origin_gives_its_share_and_all_points_lie_on_the_surface() {
        let origins = [
            Point3::origin(),
            Point3::new(0.2, 0.1, 0.3),
            Point3::new(-0.4, 0.0, 0.0),
        ];
        for open in [false, true] {
            let caster = cube(open);
            let points = sample_from_within(&caster, &origins, 1000, 1).unwrap();
            assert_eq!(points.len(), 1000);
            for (index, share) in [(0, 0..334), (1, 334..667), (2, 667..1000)] {
                for point in &points[share] {
                    assert!(caster.distance(point) < 1e-12);
                    let ray = point - origins[index];
                    let first = caster.cast(&origins[index], &ray).unwrap();
                    assert!((first.distance - ray.norm()).abs() < 1e-9);
                }
            }
        }
    }

    #[test]
    fn hits_are_spread_evenly_over_the_directions() {
        let points = sample_from_within(&cube(false), &[Point3::origin()], 6000, 2).unwrap();
        for axis in 0..3 {
            for side in [-1.0, 1.0] {
                let on = points
                    .iter()
                    .filter(|p| (p[axis] - side * 0.5).abs() < 1e-9);
                let share = on.count() as f64 / 6000.0;
                assert!((share - 1.0 / 6.0).abs() < 0.005, "{share}");
            }
        }
    }

    #[test]
    fn rays_pass_through_surface_that_the_reference_point_lies_on() {
        let on_a_face = Point3::new(0.5, 0.1, 0.0);
        let points = sample_from_within(&cube(false), &[on_a_face], 500, 3).unwrap();
        assert_eq!(points.len(), 500);
        assert!(points.iter().all(|point| (point - on_a_face).norm() > 1e-4));
    }

    #[test]
    fn a_reference_point_that_sees_hardly_anything_is_named() {
        let origins = [Point3::origin(), Point3::new(0.0, 0.0, 40.0)];
        let refused = sample_from_within(&cube(false), &origins, 1000, 4).unwrap_err();
        assert!(
            matches!(
                refused,
                SampleError::HiddenSurface {
                    index: 1,
                    wanted: 500,
                    rays: 500,
                    ..
                }
            ),
            "{refused}"
        );
    }

    #[test]
    fn seeds_draw_different_points_and_the_number_of_threads_does_not() {
        let caster = cube(true);
        let origins = [Point3::origin(), Point3::new(0.2, 0.1, 0.3)];
        let draw = |seed| sample_from_within(&caster, &origins, 301, seed).unwrap();
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            pool.build().unwrap().install(|| draw(5))
        };
        assert_eq!(with(1), with(3));
        assert_ne!(with(1), draw(6));
    }
}
