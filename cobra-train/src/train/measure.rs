//! What test points say of a template: σ̂, what it explains, what it leaves uncovered.
//!
//! Owns Eq. 9. Everything is computed by the controller's own code.

use super::TrainError;
use crate::evaluate::{TAU, residuals};
use cobra_infer::mixture::Match;
use cobra_infer::{Assignment, Template};
use nalgebra::Point3;

/// The smallest σ̂, as a share of the bounding sphere's radius: a surface that a Gaussian process
/// fits perfectly, such as a sphere, would otherwise have none.
const SMALLEST: f64 = 1e-6;

/// What was measured on the test points.
pub(super) struct Measured {
    pub(super) sigma_hats: Vec<f32>,
    /// Test points that each component speaks for.
    pub(super) test_points: Vec<usize>,
    /// Those of them that it does not explain.
    pub(super) unexplained: Vec<usize>,
    /// The share of the test points that some component explains.
    pub(super) covered: f64,
    /// Those that none does.
    pub(super) uncovered: Vec<Point3<f64>>,
    /// What was found of each.
    pub(super) matches: Vec<Option<Match>>,
}

/// σ̂_k² is the mean squared residual over the test points that component k speaks for and, in a
/// template with validity, explains: within τ of the unit sphere. Without validity points belong to
/// the nearest component and all count.
///
/// `template` must have the same σ̂ everywhere: of components that may speak, the one of the least
/// residual then speaks.
pub(super) fn measure(
    template: &Template<'_>,
    test: &[Point3<f64>],
) -> Result<Measured, TrainError> {
    let count = template.component_count();
    let (assignment, limit) = if template.has_validity() {
        (Assignment::Maximum, TAU * f64::from(template.radius()))
    } else {
        (Assignment::Nearest, f64::INFINITY)
    };
    let tau = TAU * f64::from(template.radius());
    let mut squares = vec![0.0_f64; count];
    let mut explained = vec![0_usize; count];
    let mut unexplained = vec![0_usize; count];
    let mut uncovered = Vec::new();
    let matches = residuals(template, assignment, test)?;
    for (found, point) in matches.iter().zip(test) {
        let residual = found.map(|found| f64::from(found.residual()));
        if !residual.is_some_and(|residual| residual.abs() <= tau) {
            uncovered.push(*point);
        }
        let (Some(found), Some(residual)) = (found, residual) else {
            continue;
        };
        if residual.abs() <= limit {
            squares[found.component] += residual.powi(2);
            explained[found.component] += 1;
        }
        if residual.abs() > tau {
            unexplained[found.component] += 1;
        }
    }
    let total: usize = explained.iter().sum();
    let pooled = squares.iter().sum::<f64>() / total.max(1) as f64;
    let least = SMALLEST * f64::from(template.radius());
    let sigma_hats = squares
        .iter()
        .zip(&explained)
        .map(|(square, count)| {
            // A component that no test point falls to has nothing but the whole's to go by.
            let variance = match count {
                0 => pooled,
                _ => square / *count as f64,
            };
            variance.sqrt().max(least) as f32
        })
        .collect();
    let mut test_points = vec![0; count];
    for found in matches.iter().flatten() {
        test_points[found.component] += 1;
    }
    Ok(Measured {
        sigma_hats,
        test_points,
        unexplained,
        covered: 1.0 - uncovered.len() as f64 / test.len().max(1) as f64,
        uncovered,
        matches,
    })
}
