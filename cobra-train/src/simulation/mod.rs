//! Labelled confidences without a data set: simulated pose errors of the object itself.
//!
//! Owns the scenes and the errors, and what they are drawn from; how a pose is scored is
//! [`cobra_infer::depth`]'s. What thresholds found here promise is as good as the simulation: its
//! occluders are walls, its background is a plane, and its noise knows no edges.
//!
//! A scene is the object in a random rotation, 4 to 10 diameters before a camera of 640 × 480 pixels and a
//! focal length of 570, in front of a plane; in half of the scenes a wall in front hides up to 70 % of the
//! square around the object. Each is used for five estimates, which differ from the truth
//! by a turn about the object's middle and a shift whose sizes are spread evenly over the logarithms from 1 %
//! to 100 % of the diameter: about 45 % of them are off by more than a tenth of it.

mod scene;

use crate::calibrate::Labelled;
use crate::depth::valid_pixels;
use crate::pose::{ModelPoints, RIGHT, add, add_s, disturb, single_pose};
use crate::random::{Purpose, stream};
use crate::surface::Mesh;
use cobra_infer::PoseError;
use cobra_infer::depth::{Cell, DepthCheck, DepthError, DepthSettings, Observed, Surface};
use nalgebra::{Isometry3, Point3};
use rand::RngExt;
use rayon::prelude::*;
use scene::Scene;

/// Estimates of one scene.
const ESTIMATES_PER_SCENE: usize = 5;

/// Sizes of errors, in diameters.
const SMALLEST_ERROR: f64 = 0.01;
const LARGEST_ERROR: f64 = 1.0;

/// Points that errors are measured on lie this share of the object's radius apart.
const POINT_SPACING: f32 = 0.1;

/// What is simulated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Simulation {
    /// How many estimates.
    pub estimates: usize,
    /// Standard deviation of the depth, in the surface's unit.
    pub noise: f64,
    /// Whether a mask says which pixels show the object; else the estimate's own silhouette does.
    pub masked: bool,
    /// Whether an estimate is judged by ADD-S rather than ADD: of objects that look the same from several
    /// sides, no score can tell these apart.
    pub symmetric: bool,
    /// Of all randomness.
    pub seed: u64,
}

/// An estimate that was simulated and scored.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SimulatedEstimate {
    /// Confidence, and whether it is right.
    pub labelled: Labelled,
    /// On how many pixels or points it rests.
    pub valid_pixels: u32,
    /// ADD or ADD-S, in the surface's unit.
    pub error: f64,
}

/// Why nothing could be simulated.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SimulationError {
    /// A setting is out of its range.
    #[error("{0}")]
    Check(DepthError),
    /// The object is so large that single precision does not hold its poses.
    #[error("a simulated pose of an object of diameter {diameter:e}: {source}")]
    Pose {
        /// The object's diameter.
        diameter: f32,
        /// What is wrong with the pose.
        source: PoseError,
    },
}

impl From<DepthError> for SimulationError {
    fn from(error: DepthError) -> Self {
        Self::Check(error)
    }
}

/// Simulates estimates of a surface; `mesh` is what the camera sees, in the same unit. Without one it is
/// the surface itself, which then has no error of its own.
///
/// The same numbers whatever the number of threads.
///
/// # Errors
/// [`SimulationError`]: a setting is out of its range, or the object too large for single precision.
pub fn simulate<S: Surface + Sync>(
    surface: &S,
    mesh: Option<&Mesh>,
    settings: &DepthSettings,
    simulation: &Simulation,
) -> Result<Vec<SimulatedEstimate>, SimulationError> {
    let mut points = Vec::new();
    surface.sample(POINT_SPACING * surface.radius(), &mut |point| {
        points.extend(point.map(|point| point.cast::<f64>()));
    });
    let points = ModelPoints::new(points);
    let no_pose = |source| SimulationError::Pose {
        diameter: surface.diameter(),
        source,
    };
    let model = mesh.map(crate::bop::render::RenderModel::new);
    let scenes = simulation.estimates.div_ceil(ESTIMATES_PER_SCENE);
    let scored: Result<Vec<Vec<SimulatedEstimate>>, SimulationError> = (0..scenes)
        .into_par_iter()
        .map(|index| {
            let mut rng = stream(simulation.seed, Purpose::SimulatedScenes, index as u64);
            let scene = Scene::draw(surface, model.as_ref(), simulation.noise, &mut rng)
                .map_err(no_pose)?;
            let check = DepthCheck::new(surface, scene.camera(), settings)?;
            let mask = simulation.masked.then(|| scene.mask());
            let observed = match &mask {
                Some(pixels) => Observed::Pixels(pixels),
                None => Observed::Silhouette,
            };
            let mut cells = vec![Cell::EMPTY; settings.cells()];
            let left = simulation.estimates - index * ESTIMATES_PER_SCENE;
            (0..left.min(ESTIMATES_PER_SCENE))
                .map(|_| {
                    let logarithm =
                        rng.random_range(0.0..1.0) * libm::log(LARGEST_ERROR / SMALLEST_ERROR);
                    let size =
                        SMALLEST_ERROR * libm::exp(logarithm) * f64::from(surface.diameter());
                    let centre = Point3::from(surface.centre()).cast::<f64>();
                    let radius = f64::from(surface.radius());
                    let estimate = disturb(scene.truth(), &centre, radius, size, &mut rng);
                    let pose = single_pose(&estimate).map_err(no_pose)?;
                    let report =
                        check.run(&pose, observed, scene.depth(), &mut cells, &mut || {})?;
                    let error = error(&points, scene.truth(), &estimate, simulation.symmetric);
                    Ok(SimulatedEstimate {
                        labelled: Labelled {
                            confidence: report.confidence,
                            right: error < RIGHT * f64::from(surface.diameter()),
                        },
                        valid_pixels: valid_pixels(&report),
                        error,
                    })
                })
                .collect()
        })
        .collect();
    Ok(scored?.into_iter().flatten().collect())
}

fn error(
    points: &ModelPoints,
    truth: &Isometry3<f64>,
    estimate: &Isometry3<f64>,
    symmetric: bool,
) -> f64 {
    if symmetric {
        add_s(points, truth, estimate)
    } else {
        add(points.points(), truth, estimate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::depth::MeshSurface;

    /// A bracket-like solid without a symmetry: two boxes.
    fn part() -> Mesh {
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        for [low, high] in [
            [[-40.0, -15.0, -10.0], [40.0, 15.0, 10.0]],
            [[10.0, -15.0, 10.0], [40.0, 5.0, 50.0]],
        ] {
            let base = vertices.len() as u32;
            for corner in 0..8 {
                let at = |axis: usize| if corner >> axis & 1 == 0 { low } else { high };
                vertices.push(Point3::new(at(0)[0], at(1)[1], at(2)[2]));
            }
            let sides = [
                [0, 1, 3, 2],
                [4, 5, 7, 6],
                [0, 1, 5, 4],
                [2, 3, 7, 6],
                [0, 2, 6, 4],
                [1, 3, 7, 5],
            ];
            for [a, b, c, d] in sides {
                triangles.push([base + a, base + b, base + c]);
                triangles.push([base + a, base + c, base + d]);
            }
        }
        Mesh::new(vertices, triangles).unwrap()
    }

    fn simulation(masked: bool) -> Simulation {
        Simulation {
            estimates: 203,
            noise: 1.5,
            masked,
            symmetric: false,
            seed: 3,
        }
    }

    #[test]
    fn simulated_errors_come_in_all_sizes_and_confidences_tell_them_apart() {
        let mesh = part();
        let noise = 0.08 * mesh.diameter() as f32;
        let surface = MeshSurface::new(&mesh, noise, 0);
        for masked in [true, false] {
            let found = simulate(
                &surface,
                Some(&mesh),
                &DepthSettings::DEFAULT,
                &simulation(masked),
            )
            .unwrap();
            assert_eq!(found.len(), 203);
            let labelled: Vec<Labelled> = found.iter().map(|one| one.labelled).collect();
            let right = labelled.iter().filter(|one| one.right).count();
            assert!((50..120).contains(&right), "{right}");
            let area = crate::calibrate::Roc::new(&labelled).unwrap().area;
            assert!(area > 0.93, "masked {masked}: {area}");
        }
    }

    #[test]
    fn an_object_too_large_for_single_precision_is_an_error() {
        let part = part();
        let huge = 1e38 / part.diameter();
        let vertices = part.vertices().iter().map(|vertex| vertex * huge);
        let mesh = Mesh::new(vertices.collect(), part.triangles().to_vec()).unwrap();
        let surface = MeshSurface::new(&mesh, 1e36, 0);
        for seen in [None, Some(&mesh)] {
            for masked in [true, false] {
                let settings = DepthSettings::DEFAULT;
                let found = simulate(&surface, seen, &settings, &simulation(masked));
                let error = found.unwrap_err().to_string();
                assert!(
                    error.starts_with("a simulated pose of an object of diameter 1"),
                    "{error}"
                );
            }
        }
    }

    #[test]
    fn one_thread_and_several_simulate_the_same() {
        let mesh = part();
        let surface = MeshSurface::new(&mesh, 8.0, 0);
        let run = || {
            let settings = DepthSettings::DEFAULT;
            simulate(&surface, None, &settings, &simulation(false)).unwrap()
        };
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).build();
        assert_eq!(one.unwrap().install(run), run());
    }
}
