//! How well a template reproduces a surface: Chamfer distance, precision, recall, F-score; and how well
//! the order of one list of numbers follows another's.
//!
//! Owns the paper's definitions (its supplement, Metrics). Predictions come from the scorer's own
//! mixture, so that what is measured is what will run.

mod rank;
mod strict;

pub use rank::rank_correlation;
pub(crate) use strict::own_points;
pub use strict::{OwnCloud, TrueSurface, WronglyAccepted, own_cloud, wrongly_accepted};

use crate::output::{WriteError, write_whole};
use crate::random::Purpose;
use crate::surface::{Geometry, RayCaster, SampleError, sample_visible};
use crate::train::LARGEST_TEMPLATE;
use cobra_infer::mixture::Match;
use cobra_infer::{Assignment, Mixture, ScoreError, Settings, Template};
use kiddo::{ImmutableKdTree, SquaredEuclidean};
use nalgebra::{Point3, Vector3};
use rayon::prelude::*;
use serde::Serialize;
use std::path::Path;

/// τ: a point is reproduced when the other set has a point nearer than this (unit sphere).
pub const TAU: f64 = 0.01;

/// How well a template reproduces a surface, in the unit sphere.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ShapeMetrics {
    /// d_C × 10³: the mean squared distances from each set to the other, added.
    pub chamfer: f64,
    /// Percent of the predicted points within τ of the surface points.
    pub precision: f64,
    /// Percent of the surface points within τ of the predicted points.
    pub recall: f64,
    /// 2PR/(P + R).
    pub f_score: f64,
}

/// The magnitude of the residuals d − μ(u).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ResidualSummary {
    /// Root mean square.
    pub rms: f64,
    /// Median.
    pub median: f64,
    /// 95th percentile.
    pub p95: f64,
}

impl ResidualSummary {
    /// The same in another unit.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self {
            rms: factor * self.rms,
            median: factor * self.median,
            p95: factor * self.p95,
        }
    }
}

/// A surface point and what the template predicts in its direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PredictedPoint {
    /// C_k + μ_k(u)·u, in the object's frame and the template's unit.
    pub position: Point3<f64>,
    /// e = d − μ_k(u), in the template's unit.
    pub residual: f64,
    /// k.
    pub component: usize,
}

/// A template measured on surface points under one rule of assignment.
#[derive(Clone, Debug)]
pub struct Evaluation {
    /// The paper's metrics.
    pub shape: ShapeMetrics,
    /// Residuals, in the template's unit.
    pub residual: ResidualSummary,
    /// Surface points that no component could say anything about.
    pub unmatched: usize,
    /// Percent of the surface points with a residual of at most τ.
    pub covered: f64,
    /// The predictions, in the order of the points; those without a match left out.
    pub predicted: Vec<PredictedPoint>,
}

/// At most `count` points to measure a template on, in the object's frame and unit: of a mesh,
/// visible surface points drawn independently of the training's; of a cloud, which has no others,
/// points that no training with the same seed uses.
///
/// # Errors
/// [`SampleError`], of a mesh.
pub fn evaluation_points(
    object: &Geometry,
    count: usize,
    seed: u64,
) -> Result<Vec<Point3<f64>>, SampleError> {
    let mesh = match object {
        Geometry::Mesh(mesh) => mesh,
        Geometry::Cloud(cloud) => return Ok(cloud.test_points(count, seed)),
    };
    let sphere = mesh.bounding_sphere();
    let unit = mesh.normalised(&sphere);
    let caster = RayCaster::new(&unit);
    let sampled = sample_visible(&unit, &caster, count, seed, Purpose::Evaluation)?;
    Ok(sampled
        .iter()
        .map(|point| sphere.denormalise(&point.position))
        .collect())
}

/// What the template says of each point, in the object's frame and the template's unit.
///
/// # Errors
/// [`ScoreError::TooManyComponents`] beyond [`LARGEST_TEMPLATE`].
pub fn residuals(
    template: &Template<'_>,
    assignment: Assignment,
    points: &[Point3<f64>],
) -> Result<Vec<Option<Match>>, ScoreError> {
    let settings = Settings {
        assignment,
        ..Settings::with_delta(template.radius())
    };
    let mixture = Mixture::<LARGEST_TEMPLATE>::new(template, &settings)?;
    Ok(points
        .par_iter()
        .map(|point| mixture.evaluate(&point.cast::<f32>()))
        .collect())
}

/// Measures a template on surface points (object frame, template's unit), at least one.
///
/// # Errors
/// [`ScoreError::TooManyComponents`] beyond [`LARGEST_TEMPLATE`].
pub fn evaluate(
    template: &Template<'_>,
    assignment: Assignment,
    points: &[Point3<f64>],
) -> Result<Evaluation, ScoreError> {
    let matches = residuals(template, assignment, points)?;
    let centres: Vec<Point3<f64>> = template
        .components()
        .map(|component| Point3::from(component.centre).cast())
        .collect();
    let predicted: Vec<PredictedPoint> = points
        .iter()
        .zip(&matches)
        .filter_map(|(point, found)| {
            let found = found.as_ref()?;
            let centre = centres[found.component];
            let direction: Vector3<f64> = (point - centre).normalize();
            Some(PredictedPoint {
                position: centre + direction * f64::from(found.predicted),
                residual: f64::from(found.residual()),
                component: found.component,
            })
        })
        .collect();
    let centre: Point3<f64> = Point3::from(template.centre()).cast();
    let radius = f64::from(template.radius());
    let unit = |point: &Point3<f64>| -> [f64; 3] { ((point - centre) / radius).into() };
    let surface: Vec<[f64; 3]> = points.iter().map(unit).collect();
    let estimate: Vec<[f64; 3]> = predicted.iter().map(|p| unit(&p.position)).collect();
    let tau = TAU * f64::from(template.radius());
    let covered = predicted.iter().filter(|p| p.residual.abs() <= tau).count();
    Ok(Evaluation {
        covered: 100.0 * covered as f64 / points.len().max(1) as f64,
        shape: shape_metrics(&surface, &estimate),
        residual: summarise(predicted.iter().map(|p| p.residual.abs()).collect()),
        unmatched: points.len() - predicted.len(),
        predicted,
    })
}

/// The paper's metrics between two point sets in the unit sphere; the worst values where one is
/// empty.
#[must_use]
pub fn shape_metrics(surface: &[[f64; 3]], estimate: &[[f64; 3]]) -> ShapeMetrics {
    let to_surface = squared_distances(estimate, surface);
    let to_estimate = squared_distances(surface, estimate);
    let mean = |squared: &[f64]| squared.iter().sum::<f64>() / squared.len() as f64;
    let share = |squared: &[f64]| {
        let near = squared.iter().filter(|s| **s < TAU * TAU).count();
        100.0 * near as f64 / squared.len().max(1) as f64
    };
    let (precision, recall) = (share(&to_surface), share(&to_estimate));
    ShapeMetrics {
        chamfer: if estimate.is_empty() || surface.is_empty() {
            f64::INFINITY
        } else {
            1e3 * (mean(&to_surface) + mean(&to_estimate))
        },
        precision,
        recall,
        f_score: if precision + recall > 0.0 {
            2.0 * precision * recall / (precision + recall)
        } else {
            0.0
        },
    }
}

/// The squared distance from each point of `from` to the nearest of `to`.
fn squared_distances(from: &[[f64; 3]], to: &[[f64; 3]]) -> Vec<f64> {
    let Ok(tree) = ImmutableKdTree::<f64, 3>::new_from_slice(to) else {
        return vec![f64::INFINITY; from.len()];
    };
    if to.is_empty() {
        return vec![f64::INFINITY; from.len()];
    }
    from.par_iter()
        .map(|point| {
            tree.query(point)
                .nearest_one::<SquaredEuclidean<f64>>()
                .execute()
                .distance
        })
        .collect()
}

/// Writes predicted points as a PLY cloud: `x y z`, `residual` (signed, template's unit) and
/// `component`.
///
/// # Errors
/// [`WriteError`].
pub fn write_points(path: &Path, points: &[PredictedPoint]) -> Result<(), WriteError> {
    let mut text = String::from("ply\nformat ascii 1.0\n");
    text += &format!("element vertex {}\n", points.len());
    for property in [
        "float x",
        "float y",
        "float z",
        "float residual",
        "int component",
    ] {
        text += &format!("property {property}\n");
    }
    text += "end_header\n";
    for point in points {
        let [x, y, z] = [point.position.x, point.position.y, point.position.z];
        text += &format!(
            "{} {} {} {} {}\n",
            x as f32, y as f32, z as f32, point.residual as f32, point.component
        );
    }
    write_whole(path, text.as_bytes())
}

fn summarise(mut magnitudes: Vec<f64>) -> ResidualSummary {
    magnitudes.sort_by(f64::total_cmp);
    let squares: f64 = magnitudes.iter().map(|m| m * m).sum();
    let quantile = |share: f64| {
        let index = (share * magnitudes.len() as f64) as usize;
        magnitudes
            .get(index.min(magnitudes.len().saturating_sub(1)))
            .copied()
            .unwrap_or(0.0)
    };
    ResidualSummary {
        rms: (squares / magnitudes.len().max(1) as f64).sqrt(),
        median: quantile(0.5),
        p95: quantile(0.95),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(z: f64) -> Vec<[f64; 3]> {
        (0..10_000)
            .map(|i| [f64::from(i % 100) * 0.1, f64::from(i / 100) * 0.1, z])
            .collect()
    }

    #[test]
    fn a_set_reproduces_itself() {
        // Every coordinate occurs a hundred times and one is constant: k-d trees dislike that.
        let metrics = shape_metrics(&plane(0.0), &plane(0.0));
        assert_eq!(metrics.chamfer, 0.0);
        assert_eq!((metrics.precision, metrics.recall), (100.0, 100.0));
        assert_eq!(metrics.f_score, 100.0);
    }

    #[test]
    fn a_shift_beyond_tau_reproduces_nothing_and_adds_both_squares() {
        let metrics = shape_metrics(&plane(0.0), &plane(0.02));
        assert!((metrics.chamfer - 1e3 * 2.0 * 4e-4).abs() < 1e-12);
        assert_eq!(metrics.f_score, 0.0);
    }

    #[test]
    fn half_a_surface_is_precise_and_recalls_half() {
        let metrics = shape_metrics(&plane(0.0), &plane(0.0)[..5000]);
        assert_eq!((metrics.precision, metrics.recall), (100.0, 50.0));
        assert!((metrics.f_score - 200.0 / 3.0).abs() < 1e-12);
    }

    #[test]
    fn an_empty_set_has_the_worst_figures() {
        let metrics = shape_metrics(&plane(0.0), &[]);
        assert!(metrics.chamfer.is_infinite());
        assert_eq!((metrics.recall, metrics.f_score), (0.0, 0.0));
    }

    #[test]
    fn the_summary_is_of_magnitudes() {
        let summary = summarise((1..=100).rev().map(f64::from).collect());
        assert_eq!((summary.median, summary.p95), (51.0, 96.0));
        assert!((summary.rms - (338_350.0_f64 / 100.0).sqrt()).abs() < 1e-9);
    }
}
