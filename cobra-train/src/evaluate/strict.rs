//! What the choice of the component hides: it is made by the point's own distance, so that a template
//! that says much in every direction looks better than it is.
//!
//! Owns two measures that see through it: how many points off the surface are accepted, and how well
//! the template's own points, of which no test point knows, lie on the surface and cover it.

use super::{TAU, residuals, squared_distances};
use crate::random::{Purpose, stream};
use crate::surface::{Geometry, NearestPoints, RayCaster};
use crate::train::LARGEST_TEMPLATE;
use cobra_infer::gp::UnitDirection;
use cobra_infer::validity::{BoxGrid, direction};
use cobra_infer::{Assignment, ScoreError, Template};
use nalgebra::{Point3, UnitVector3, Vector3};
use rand::Rng;
use rand::RngExt;
use rayon::prelude::*;
use serde::Serialize;

/// Points that are moved off the surface.
const MOVED: usize = 10_000;

/// How far they are moved, and how far off the surface they must then be, in the unit sphere.
const MOVE: std::ops::Range<f64> = 0.02..0.06;
const OFF: std::ops::RangeInclusive<f64> = 0.02..=0.05;

/// Predictions along each side of a valid cell: a cell is about 2τ wide.
const PER_SIDE: u8 = 6;

/// The surface that a template is measured against, in the object's frame.
pub struct TrueSurface {
    kind: Kind,
}

enum Kind {
    Faces(Box<RayCaster>),
    Points(NearestPoints),
}

impl TrueSurface {
    /// Of a mesh, its faces; of a cloud, all its points.
    #[must_use]
    pub fn new(object: &Geometry) -> Self {
        let kind = match object {
            Geometry::Mesh(mesh) => Kind::Faces(Box::new(RayCaster::new(mesh))),
            Geometry::Cloud(cloud) => {
                let points: Vec<[f64; 3]> = cloud.points().iter().map(|p| (*p).into()).collect();
                Kind::Points(NearestPoints::new(&points))
            }
        };
        Self { kind }
    }

    fn distance(&self, point: &Point3<f64>) -> f64 {
        match &self.kind {
            Kind::Faces(caster) => caster.distance(point),
            Kind::Points(tree) => tree.distance(&(*point).into()),
        }
    }
}

/// How many points off the surface the template takes for points on it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct WronglyAccepted {
    /// Points truly 0.02 to 0.05 off the surface (unit sphere).
    pub points: usize,
    /// Percent of them with a residual below τ.
    pub percent: f64,
}

/// Moves up to 10,000 of `points` 0.02 to 0.06 in random directions, keeps those that are then 0.02
/// to 0.05 off the surface, and asks the template about them, all in the unit sphere. The same
/// arguments give the same numbers.
///
/// # Errors
/// [`ScoreError::TooManyComponents`] beyond [`LARGEST_TEMPLATE`].
pub fn wrongly_accepted(
    template: &Template<'_>,
    assignment: Assignment,
    surface: &TrueSurface,
    points: &[Point3<f64>],
    seed: u64,
) -> Result<WronglyAccepted, ScoreError> {
    let radius = f64::from(template.radius());
    let mut rng = stream(seed, Purpose::OffSurface, 0);
    let moved: Vec<Point3<f64>> = points
        .iter()
        .take(MOVED)
        .map(|point| point + any_direction(&mut rng).scale(radius * rng.random_range(MOVE)))
        .collect();
    let off: Vec<Point3<f64>> = moved
        .into_par_iter()
        .filter(|point| OFF.contains(&(surface.distance(point) / radius)))
        .collect();
    let accepted = residuals(template, assignment, &off)?
        .iter()
        .flatten()
        .filter(|found| f64::from(found.residual()).abs() < TAU * radius)
        .count();
    Ok(WronglyAccepted {
        points: off.len(),
        percent: 100.0 * accepted as f64 / off.len().max(1) as f64,
    })
}

/// Uniform on the sphere: uniform in the ball, scaled.
fn any_direction(rng: &mut impl Rng) -> UnitVector3<f64> {
    loop {
        let [x, y, z]: [f64; 3] = rng.random();
        let v = Vector3::new(2.0 * x - 1.0, 2.0 * y - 1.0, 2.0 * z - 1.0);
        if v.norm_squared() <= 1.0
            && let Some(direction) = UnitVector3::try_new(v, 1e-3)
        {
            return direction;
        }
    }
}

/// The template's own points against the surface.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OwnCloud {
    /// How many points the template was asked for.
    pub points: usize,
    /// Percent of them within τ of the surface.
    pub self_precision: f64,
    /// Percent of the test points within τ of one of them.
    pub self_recall: f64,
    /// 2PR/(P + R).
    pub self_f_score: f64,
}

/// The points that all components predict on a grid of 6 × 6 directions in each valid cell, where they
/// lie in the component's box, against the surface and against test `points` (object frame, template's
/// unit). `None` for a template without validity.
#[must_use]
pub fn own_cloud(
    template: &Template<'_>,
    surface: &TrueSurface,
    points: &[Point3<f64>],
) -> Option<OwnCloud> {
    if !template.has_validity() {
        return None;
    }
    let cloud: Vec<_> = own_points(template)
        .into_iter()
        .map(|(_, point)| point)
        .collect();
    let radius = f64::from(template.radius());
    let on_surface = cloud
        .par_iter()
        .filter(|point| surface.distance(point) < TAU * radius)
        .count();
    let arrays = |points: &[Point3<f64>]| -> Vec<[f64; 3]> {
        points.iter().map(|point| (point / radius).into()).collect()
    };
    let recalled = squared_distances(&arrays(points), &arrays(&cloud))
        .into_iter()
        .filter(|squared| *squared < TAU * TAU)
        .count();
    let percent = |some: usize, all: usize| 100.0 * some as f64 / all.max(1) as f64;
    let (precision, recall) = (
        percent(on_surface, cloud.len()),
        percent(recalled, points.len()),
    );
    Some(OwnCloud {
        points: cloud.len(),
        self_precision: precision,
        self_recall: recall,
        self_f_score: if precision + recall > 0.0 {
            2.0 * precision * recall / (precision + recall)
        } else {
            0.0
        },
    })
}

/// The points that all components predict on a grid of 6 × 6 directions in each valid cell, where they lie in
/// the component's box, each with its component (object frame, template's unit). None of a template without
/// validity.
pub(crate) fn own_points(template: &Template<'_>) -> Vec<(usize, Point3<f64>)> {
    let grid = BoxGrid::new(template.centre(), template.radius());
    let components: Vec<_> = template.components().take(LARGEST_TEMPLATE).collect();
    components
        .par_iter()
        .enumerate()
        .flat_map_iter(|(index, component)| {
            let centre = Point3::from(component.centre);
            let validity = component.validity.into_iter();
            let cells = validity.flat_map(|validity| {
                let places = (0..PER_SIDE).flat_map(|row| (0..PER_SIDE).map(move |c| [c, row]));
                let places: Vec<[f32; 2]> = places.map(|at| at.map(inside)).collect();
                validity.cells().flat_map(move |cell| {
                    let (pole, side) = (validity.pole(), validity.side());
                    places
                        .clone()
                        .into_iter()
                        .map(move |at| (validity, direction(pole, side, cell, at)))
                })
            });
            cells
                .filter_map(|(validity, direction)| {
                    let u = UnitDirection::new_unchecked(direction.into());
                    let mean = component.posterior_mean(template.model(), &u);
                    let point = centre + u.into_inner() * mean;
                    let position = grid.position(point.coords.into());
                    let in_box = (0..3)
                        .all(|i| (validity.low()[i]..=validity.high()[i]).contains(&position[i]));
                    in_box.then(|| (index, point.cast()))
                })
                .collect::<Vec<(usize, Point3<f64>)>>()
        })
        .collect()
}

/// The middle of one of six parts.
fn inside(part: u8) -> f32 {
    (f32::from(part) + 0.5) / f32::from(PER_SIDE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::{Mesh, PointCloud, fibonacci_sphere};
    use cobra_infer::gp::Hyperparameters;
    use cobra_infer::template::{
        ComponentSource, TemplateSource, TermsSource, ValiditySource, encode, encoded_len,
    };
    use cobra_infer::validity::{BOX_STEPS, Pole};
    use cobra_infer::{Exponent, Kernel, Model, Unit};

    const RADIUS: f64 = 50.0;
    const SIDE: u8 = 64;

    /// A template of a sphere around the origin: components of these distances there, which may speak
    /// where `valid` says, or, of `None`, everywhere.
    fn template(distances: &[f64], valid: Option<&[bool]>) -> Vec<u8> {
        let directions = [UnitDirection::new_unchecked([0.0, 0.0, 1.0].into())];
        let components: Vec<_> = distances
            .iter()
            .map(|distance| ComponentSource {
                centre: [0.0; 3],
                sigma_hat: 0.1,
                precision: None,
                hyperparameters: Hyperparameters {
                    length_scale: 1.0,
                    parameter: 1.0,
                    prior_mean: *distance as f32,
                },
                terms: TermsSource::Exact {
                    directions: &directions,
                    weights: &[0.0],
                },
                validity: valid.map(|cells| ValiditySource {
                    pole: Pole::PlusZ,
                    side: SIDE,
                    cells,
                    low: [0; 3],
                    high: [BOX_STEPS - 1; 3],
                }),
            })
            .collect();
        let source = TemplateSource {
            name: "sphere",
            unit: Unit::Millimetre,
            centre: [0.0; 3],
            radius: RADIUS as f32,
            diameter: 2.0 * RADIUS as f32,
            model: Model::chord(Kernel::RationalQuadratic(Exponent::One)),
            components: &components,
            quality: None,
            depth: None,
        };
        let mut bytes = vec![0; encoded_len(&source)];
        let length = encode(&source, &mut bytes).unwrap();
        bytes.truncate(length);
        bytes
    }

    fn everywhere() -> Vec<bool> {
        vec![true; usize::from(SIDE).pow(2)]
    }

    fn points(count: usize) -> Vec<Point3<f64>> {
        let directions = fibonacci_sphere(count).into_iter();
        directions.map(|u| Point3::from(u.scale(RADIUS))).collect()
    }

    /// The sphere by triangles that leave it by no more than 10⁻³ of its radius.
    fn faces() -> Geometry {
        const ROWS: u32 = 60;
        let vertices = (0..=ROWS)
            .flat_map(|row| (0..2 * ROWS).map(move |column| (row, column)))
            .map(|(row, column)| {
                let [down, turn] =
                    [row, column].map(|i| std::f64::consts::PI * f64::from(i) / f64::from(ROWS));
                let [x, y] = [turn.cos(), turn.sin()].map(|t| t * down.sin());
                Point3::from(Vector3::new(x, y, down.cos()) * RADIUS)
            })
            .collect();
        let corner = |row: u32, column: u32| row * 2 * ROWS + column % (2 * ROWS);
        let triangles = (0..ROWS)
            .flat_map(|row| (0..2 * ROWS).map(move |column| (row, column)))
            .flat_map(|(row, column)| {
                let [a, b] = [corner(row, column), corner(row, column + 1)];
                let [c, d] = [corner(row + 1, column), corner(row + 1, column + 1)];
                [[a, c, b], [b, c, d]]
            })
            .collect();
        Mesh::new(vertices, triangles).unwrap().into()
    }

    fn percent(bytes: &[u8], surface: &TrueSurface) -> WronglyAccepted {
        let template = Template::from_bytes(bytes).unwrap();
        wrongly_accepted(&template, Assignment::Maximum, surface, &points(4000), 0).unwrap()
    }

    #[test]
    fn an_exact_template_accepts_nothing_off_the_surface() {
        let surface = TrueSurface::new(&faces());
        for valid in [None, Some(&everywhere()[..])] {
            let found = percent(&template(&[RADIUS], valid), &surface);
            // Not all that are moved leave the surface by 0.02.
            assert!((1000..4000).contains(&found.points), "{found:?}");
            assert_eq!(found.percent, 0.0);
        }
    }

    #[test]
    fn a_template_that_says_more_than_there_is_accepts_what_is_not_there() {
        let surface = TrueSurface::new(&faces());
        let distances = [RADIUS, 1.035 * RADIUS];
        let found = percent(&template(&distances, Some(&everywhere())), &surface);
        assert!((20.0..70.0).contains(&found.percent), "{found:?}");
    }

    #[test]
    fn the_same_seed_moves_points_alike() {
        let surface = TrueSurface::new(&faces());
        let bytes = template(&[RADIUS], None);
        let template = Template::from_bytes(&bytes).unwrap();
        let with = |seed| {
            let points = points(1000);
            wrongly_accepted(&template, Assignment::Nearest, &surface, &points, seed).unwrap()
        };
        assert_eq!(with(3), with(3));
        assert_ne!(with(3).points, with(4).points);
    }

    #[test]
    fn the_own_cloud_of_a_sphere_is_the_sphere() {
        let cloud = PointCloud::new(points(100_000)).unwrap();
        for object in [faces(), Geometry::from(cloud)] {
            let bytes = template(&[RADIUS], Some(&everywhere()));
            let template = Template::from_bytes(&bytes).unwrap();
            let own = own_cloud(&template, &TrueSurface::new(&object), &points(3000)).unwrap();
            let cells = usize::from(SIDE).pow(2);
            assert_eq!(own.points, usize::from(PER_SIDE).pow(2) * cells);
            assert!(own.self_precision > 99.0, "{own:?}");
            assert!(own.self_recall > 99.0, "{own:?}");
            assert!(own.self_f_score > 99.0, "{own:?}");
        }
    }

    #[test]
    fn what_is_not_said_is_not_recalled_and_what_is_wrong_is_not_precise() {
        let surface = TrueSurface::new(&faces());
        let own = |distances: &[f64], valid: &[bool]| {
            let bytes = template(distances, Some(valid));
            own_cloud(
                &Template::from_bytes(&bytes).unwrap(),
                &surface,
                &points(3000),
            )
            .unwrap()
        };
        // The middle of the map is the half above: half of the square.
        let half = i32::from(SIDE) / 2;
        let upper: Vec<bool> = (0..i32::from(SIDE).pow(2))
            .map(|place| {
                let [row, column] = [place / (2 * half), place % (2 * half)];
                let away = |index: i32| (2 * index + 1 - 2 * half).abs();
                away(row) + away(column) <= 2 * half
            })
            .collect();
        let above = own(&[RADIUS], &upper);
        assert!(above.self_precision > 99.0, "{above:?}");
        assert!((above.self_recall - 50.0).abs() < 4.0, "{above:?}");
        let double = own(&[RADIUS, 0.9 * RADIUS], &everywhere());
        assert!((double.self_precision - 50.0).abs() < 1.0, "{double:?}");
        assert!(double.self_recall > 99.0, "{double:?}");
        let wrong = own(&[0.9 * RADIUS], &everywhere());
        assert_eq!((wrong.self_recall, wrong.self_f_score), (0.0, 0.0));
    }

    #[test]
    fn a_template_that_speaks_everywhere_has_no_own_cloud() {
        let bytes = template(&[RADIUS], None);
        let template = Template::from_bytes(&bytes).unwrap();
        let surface = TrueSurface::new(&faces());
        assert_eq!(own_cloud(&template, &surface, &points(10)), None);
    }
}
