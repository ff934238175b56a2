//! Points drawn on the visible surface, as the paper's data preparation draws them.
//!
//! Owns how many rays are cast, their random streams, and the order of the points. The same mesh,
//! count, seed and purpose give the same points, bit for bit, on any number of threads.

use std::collections::HashSet;

use nalgebra::{Point3, UnitVector3};
use rand::RngExt;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use super::camera::{CAMERAS, Camera, fibonacci_sphere};
use super::mesh::Mesh;
use super::raycast::RayCaster;
use crate::random::{Purpose, stream};

/// How far outside of the unit sphere rounding may put a vertex.
const ROUNDING: f64 = 1e-9;

/// A round casts at least this many rays, so that each camera's share is many rays.
const FEWEST_RAYS: f64 = 20_000.0;

/// The share of rays that is expected to hit before the first round has told.
const FIRST_HIT_RATE: f64 = 0.3;

/// Fewer hits than this share of the rays, inside windows cropped to the mesh, is given up.
const LOWEST_HIT_RATE: f64 = 0.002;

/// A point on the surface, in the frame in which the object's bounding sphere is the unit sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The point.
    pub position: Point3<f64>,
    /// The surface's normal there, on the side from which the point was seen.
    pub normal: UnitVector3<f64>,
}

/// Why a mesh cannot be sampled.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SampleError {
    /// The mesh is not normalised.
    #[error(
        "the mesh reaches {radius} from the origin: sampling expects it normalised to the unit \
         sphere"
    )]
    NotNormalised {
        /// The largest distance of a vertex from the origin.
        radius: f64,
    },
    /// Hardly any ray hits.
    #[error(
        "only {hits} of {rays} rays at the mesh hit it, where {wanted} points are wanted: it shows \
         too little surface, or a stray face makes it too large"
    )]
    TooFewHits {
        /// How many points are wanted.
        wanted: usize,
        /// How many different points were hit.
        hits: usize,
        /// How many rays were cast.
        rays: usize,
    },
    /// Hardly any ray from a reference point hits.
    #[error(
        "only {hits} of {rays} rays from reference point {index} hit the surface, where {wanted} \
         points are wanted from there: it lies outside of the object or on a flat part of it"
    )]
    HiddenSurface {
        /// Which reference point, from 0.
        index: usize,
        /// How many points are wanted from it.
        wanted: usize,
        /// How many rays hit.
        hits: usize,
        /// How many rays were cast.
        rays: usize,
    },
}

/// Draws `count` different points, in random order, on the surface as it is visible from outside.
///
/// [`CAMERAS`] cameras stand on a Fibonacci sphere of radius 2.5 around the mesh, which is
/// normalised to the unit sphere, and look at the origin; rays fall evenly on all of their windows,
/// and the first hit of each ray is a point. Since the order is random, the first n points are
/// themselves such a sample. `caster` is built from the same mesh.
///
/// # Errors
/// [`SampleError`]: a vertex lies outside of the unit sphere, or hardly any ray hits.
pub fn sample_visible(
    mesh_unit: &Mesh,
    caster: &RayCaster,
    count: usize,
    seed: u64,
    purpose: Purpose,
) -> Result<Vec<SurfacePoint>, SampleError> {
    let radius = mesh_unit
        .used_vertices()
        .map(|v| v.coords.norm())
        .fold(0.0, f64::max);
    if radius > 1.0 + ROUNDING {
        return Err(SampleError::NotNormalised { radius });
    }
    let cameras: Vec<Camera> = fibonacci_sphere(CAMERAS)
        .par_iter()
        .map(|from| Camera::new(from, mesh_unit))
        .collect();
    let area: f64 = cameras.iter().map(Camera::area).sum();

    let mut points = Vec::new();
    let mut seen = HashSet::new();
    let mut rays = 0;
    let mut rate = FIRST_HIT_RATE;
    let mut round = 0;
    while points.len() < count {
        let missing = (count - points.len()) as f64;
        let density = (1.05 * missing / rate).max(FEWEST_RAYS) / area;
        let round_hits: Vec<(usize, Vec<SurfacePoint>)> = cameras
            .par_iter()
            .enumerate()
            .map(|(index, camera)| {
                let cast = (density * camera.area()).round() as usize;
                let mut rng = ray_stream(seed, purpose, round, index as u32);
                (cast, hits_of(camera, caster, cast, &mut rng))
            })
            .collect();
        for (cast, camera_hits) in round_hits {
            rays += cast;
            let bits = |p: &SurfacePoint| <[f64; 3]>::from(p.position).map(f64::to_bits);
            points.extend(camera_hits.into_iter().filter(|p| seen.insert(bits(p))));
        }
        rate = points.len() as f64 / rays.max(1) as f64;
        if rate < LOWEST_HIT_RATE {
            return Err(SampleError::TooFewHits {
                wanted: count,
                hits: points.len(),
                rays,
            });
        }
        round += 1;
    }
    points.shuffle(&mut stream(seed, purpose, u64::MAX));
    points.truncate(count);
    Ok(points)
}

fn hits_of(
    camera: &Camera,
    caster: &RayCaster,
    rays: usize,
    rng: &mut ChaCha8Rng,
) -> Vec<SurfacePoint> {
    (0..rays)
        .filter_map(|_| {
            let hit = caster.cast(&camera.origin, &camera.ray(rng.random()))?;
            Some(SurfacePoint {
                position: hit.point,
                normal: hit.normal,
            })
        })
        .collect()
}

/// The random numbers of one camera in one round.
fn ray_stream(seed: u64, purpose: Purpose, round: u32, camera: u32) -> ChaCha8Rng {
    stream(seed, purpose, u64::from(round) << 32 | u64::from(camera))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::camera::CAMERA_DISTANCE;
    use rand::SeedableRng;

    /// A box of these half-widths, closed, scaled into the unit sphere.
    fn cuboid(half: [f64; 3]) -> Mesh {
        let vertices = (0..8)
            .map(|corner| {
                let side = |axis: usize| {
                    if corner >> axis & 1 == 1 {
                        half[axis]
                    } else {
                        -half[axis]
                    }
                };
                Point3::new(side(0), side(1), side(2))
            })
            .collect();
        let quads = [
            [0, 1, 3, 2],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 3, 7, 6],
            [0, 2, 6, 4],
            [1, 3, 7, 5],
        ];
        let triangles = quads
            .iter()
            .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
            .collect();
        let mesh = Mesh::new(vertices, triangles).unwrap();
        mesh.normalised(&mesh.bounding_sphere())
    }

    fn draw(mesh: &Mesh, count: usize, seed: u64, purpose: Purpose) -> Vec<SurfacePoint> {
        sample_visible(mesh, &RayCaster::new(mesh), count, seed, purpose).unwrap()
    }

    #[test]
    fn exactly_the_wanted_number_of_different_points_is_drawn() {
        let mesh = cuboid([1.0, 0.5, 0.1]);
        for count in [0, 1, 999, 30_000] {
            let points = draw(&mesh, count, 1, Purpose::Training);
            assert_eq!(points.len(), count);
            let different: HashSet<_> = points
                .iter()
                .map(|p| <[f64; 3]>::from(p.position).map(f64::to_bits))
                .collect();
            assert_eq!(different.len(), count);
        }
    }

    #[test]
    fn points_lie_on_the_mesh_with_normals_towards_the_outside() {
        let mesh = cuboid([1.0, 0.5, 0.1]);
        let caster = RayCaster::new(&mesh);
        for point in draw(&mesh, 5000, 2, Purpose::Training) {
            assert!(caster.distance(&point.position) < 1e-12);
            assert!(point.normal.dot(&point.position.coords) > 0.0);
        }
    }

    #[test]
    fn the_number_of_threads_does_not_change_the_points() {
        let mesh = cuboid([1.0, 0.5, 0.1]);
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            let pool = pool.build().unwrap();
            pool.install(|| draw(&mesh, 5000, 3, Purpose::Training))
        };
        assert_eq!(with(1), with(3));
    }

    #[test]
    fn seeds_and_purposes_draw_different_points() {
        let mesh = cuboid([1.0, 0.5, 0.1]);
        let first = draw(&mesh, 100, 4, Purpose::Training);
        assert_ne!(first, draw(&mesh, 100, 5, Purpose::Training));
        assert_ne!(first, draw(&mesh, 100, 4, Purpose::Evaluation));
        assert_ne!(first, draw(&mesh, 100, 4, Purpose::Demonstration));
    }

    /// The share of the points on the box's faces across each axis.
    fn shares(points: &[SurfacePoint]) -> [f64; 3] {
        [0, 1, 2].map(|axis| {
            let across = points.iter().filter(|p| p.normal[axis].abs() > 0.5);
            across.count() as f64 / points.len() as f64
        })
    }

    #[test]
    fn cropped_windows_draw_from_the_distribution_of_whole_windows() {
        let mesh = cuboid([1.0, 0.4, 0.05]);
        let caster = RayCaster::new(&mesh);
        let half_width = 1.0 / (CAMERA_DISTANCE * CAMERA_DISTANCE - 1.0).sqrt();
        let mut rng = ChaCha8Rng::seed_from_u64(6);
        let mut whole = Vec::new();
        for from in fibonacci_sphere(CAMERAS) {
            let origin = Point3::from(from.into_inner() * CAMERA_DISTANCE);
            let rotation =
                nalgebra::Rotation3::face_towards(&-from.into_inner(), &nalgebra::Vector3::y());
            for _ in 0..6000 {
                let [u, v]: [f64; 2] = rng.random();
                let window = [u, v].map(|share| (2.0 * share - 1.0) * half_width);
                let direction = rotation * nalgebra::Vector3::new(window[0], window[1], 1.0);
                whole.extend(caster.cast(&origin, &direction).map(|hit| SurfacePoint {
                    position: hit.point,
                    normal: hit.normal,
                }));
            }
        }
        let cropped = draw(&mesh, 100_000, 7, Purpose::Training);
        for (a, b) in shares(&whole).into_iter().zip(shares(&cropped)) {
            assert!((a - b).abs() < 0.006, "{a} {b}");
        }
    }

    #[test]
    fn the_first_points_are_a_sample_of_the_whole_surface() {
        let points = draw(&cuboid([1.0, 0.4, 0.05]), 50_000, 8, Purpose::Training);
        let (first, rest) = points.split_at(10_000);
        for (a, b) in shares(first).into_iter().zip(shares(rest)) {
            assert!((a - b).abs() < 0.02, "{a} {b}");
        }
    }

    #[test]
    fn a_mesh_outside_of_the_unit_sphere_is_refused() {
        let mesh = Mesh::new(
            vec![
                Point3::origin(),
                Point3::new(30.0, 0.0, 0.0),
                Point3::new(0.0, 40.0, 0.0),
            ],
            vec![[0, 1, 2]],
        )
        .unwrap();
        let refused = sample_visible(&mesh, &RayCaster::new(&mesh), 10, 0, Purpose::Training);
        assert_eq!(refused, Err(SampleError::NotNormalised { radius: 40.0 }));
    }

    #[test]
    fn a_mesh_that_rays_hardly_hit_is_an_error_and_no_endless_search() {
        let far = 1.0 / 3.0_f64.sqrt();
        let thin = 1e-6;
        let mesh = Mesh::new(
            vec![
                Point3::new(far, far, far),
                Point3::new(-far, -far, -far),
                Point3::new(thin, 0.0, 0.0),
            ],
            vec![[0, 1, 2]],
        )
        .unwrap();
        let refused = sample_visible(&mesh, &RayCaster::new(&mesh), 10, 0, Purpose::Training);
        assert!(
            matches!(refused, Err(SampleError::TooFewHits { wanted: 10, .. })),
            "{refused:?}"
        );
    }
}
