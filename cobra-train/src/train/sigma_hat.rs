//! σ̂ of each component, measured on the test points by the controller's own code.

use crate::evaluate::residuals;
use cobra_infer::{Assignment, ScoreError, Template};
use nalgebra::Point3;

/// The smallest σ̂, as a share of the bounding sphere's radius: a surface that a Gaussian process
/// fits perfectly, such as a sphere, would otherwise have none.
const SMALLEST: f64 = 1e-6;

/// σ̂_k² is the mean squared residual over the test points that component k speaks for (Eq. 9),
/// computed by the controller's own code.
pub(super) fn measure(
    template: &Template<'_>,
    test: &[Point3<f64>],
) -> Result<(Vec<f32>, Vec<usize>), ScoreError> {
    let count = template.component_count();
    let mut squares = vec![0.0_f64; count];
    let mut counts = vec![0_usize; count];
    let matches = residuals(template, Assignment::Nearest, test)?;
    for found in matches.iter().flatten() {
        squares[found.component] += f64::from(found.residual()).powi(2);
        counts[found.component] += 1;
    }
    let total: usize = counts.iter().sum();
    let pooled = squares.iter().sum::<f64>() / total.max(1) as f64;
    let least = SMALLEST * f64::from(template.radius());
    let sigma_hats = squares
        .iter()
        .zip(&counts)
        .map(|(square, count)| {
            // A component that no test point falls to has nothing but the whole's to go by.
            let variance = match count {
                0 => pooled,
                _ => square / *count as f64,
            };
            variance.sqrt().max(least) as f32
        })
        .collect();
    Ok((sigma_hats, counts))
}
