//! Whether a standard deviation is what it says: how many residuals lie within multiples of it.
//!
//! Owns the comparison of the Gaussian process's own variance (Eq. 5) with the σ̂ that replaces it
//! (Eq. 9). Residuals and the component that speaks for a point are the scorer's own. Does not own
//! where the points come from: they should be neither those that the template was fitted to nor those
//! that σ̂ was measured on, which a point cloud has no others than.

use crate::evaluate::residuals;
use crate::gp::{NotPositiveDefinite, Posterior};
use crate::train::Trained;
use cobra_infer::{ScoreError, Settings, Template, TemplateError};
use nalgebra::{Point3, UnitVector3};
use rayon::prelude::*;
use serde::Serialize;

/// The shares, in percent, that are asked for.
pub const NOMINAL: [f64; 5] = [50.0, 68.27, 90.0, 95.0, 99.0];

/// How well three standard deviations describe the residuals of one set of points.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Coverage {
    /// Points that a component speaks for.
    pub points: usize,
    /// Points that none speaks for.
    pub unmatched: usize,
    /// Root mean square of the residuals, in the template's unit.
    pub rms_residual: f64,
    /// The shares that a Gaussian promises, in percent.
    pub nominal: Vec<f64>,
    /// The process's own, of the surface's distance (Eq. 5).
    pub latent: Calibration,
    /// The process's own with its noise η.
    pub observed: Calibration,
    /// σ̂ of the component (Eq. 9).
    pub sigma_hat: Calibration,
}

/// How well one standard deviation describes the residuals.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Calibration {
    /// Its mean over the points, in the template's unit.
    pub mean_sigma: f64,
    /// That over the residuals' root mean square: below 1, it is too small.
    pub sigma_over_residual: f64,
    /// The share of residuals within z(nominal)·σ, in percent, one a nominal share.
    pub within: Vec<f64>,
}

/// Why nothing was measured.
#[derive(Debug, thiserror::Error)]
pub enum CoverageError {
    /// The template cannot be used.
    #[error(transparent)]
    Template(#[from] TemplateError),
    /// The points could not be scored.
    #[error(transparent)]
    Score(#[from] ScoreError),
    /// A component's Gram matrix could not be factorised.
    #[error(transparent)]
    NotPositiveDefinite(#[from] NotPositiveDefinite),
}

/// z such that a standard Gaussian lies within ±z with probability `share`, 0 < `share` < 1.
///
/// The root of erf(z/√2) = `share` by bisection, to the rounding of `libm`'s erf, whose slope
/// magnifies it: 1e-12 for shares up to 0.99.
#[must_use]
pub fn half_width(share: f64) -> f64 {
    // Beyond 10, erf is 1 in f64.
    let (mut low, mut high) = (0.0, 10.0);
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        if libm::erf(middle * std::f64::consts::FRAC_1_SQRT_2) < share {
            low = middle;
        } else {
            high = middle;
        }
    }
}

/// Measures coverage on surface points (object frame, template's unit), each spoken for by the
/// component that scoring chooses ([`Settings::for_template`]); points that none may speak of are
/// counted as unmatched.
///
/// # Errors
/// [`CoverageError`].
pub fn coverage(trained: &Trained, points: &[Point3<f64>]) -> Result<Coverage, CoverageError> {
    let template = Template::from_bytes(&trained.bytes)?;
    let chosen = Settings::for_template(&template, 1.0).assignment;
    let matches = residuals(&template, chosen, points)?;
    let radius = f64::from(template.radius());
    let speakers = template
        .components()
        .zip(&trained.components)
        .map(|(component, trained)| {
            Ok(Speaker {
                centre: Point3::from(component.centre).cast(),
                posterior: Posterior::of(&trained.fitted)?,
                sigma_hat: f64::from(component.sigma_hat),
            })
        })
        .collect::<Result<Vec<_>, NotPositiveDefinite>>()?;
    let samples: Vec<Sample> = points
        .par_iter()
        .zip(&matches)
        .filter_map(|(point, found)| {
            let found = found.as_ref()?;
            Some(Sample {
                residual: f64::from(found.residual()),
                sigmas: speakers[found.component].sigmas(point, radius),
            })
        })
        .collect();
    Ok(Coverage::of(&samples, points.len()))
}

/// What is asked about the points of one component.
struct Speaker {
    centre: Point3<f64>,
    posterior: Posterior,
    sigma_hat: f64,
}

impl Speaker {
    /// The three standard deviations at a point, in the template's unit.
    fn sigmas(&self, point: &Point3<f64>, radius: f64) -> [f64; 3] {
        let direction = UnitVector3::new_normalize(point - self.centre);
        let prediction = self.posterior.predict(&direction);
        let observed = self.posterior.observation_variance(&prediction);
        [
            radius * prediction.variance.sqrt(),
            radius * observed.sqrt(),
            self.sigma_hat,
        ]
    }
}

struct Sample {
    residual: f64,
    sigmas: [f64; 3],
}

impl Coverage {
    fn of(samples: &[Sample], points: usize) -> Self {
        let count = samples.len().max(1) as f64;
        let squares: f64 = samples.iter().map(|s| s.residual * s.residual).sum();
        let rms_residual = (squares / count).sqrt();
        let calibration = |which: usize| {
            let sum: f64 = samples.iter().map(|s| s.sigmas[which]).sum();
            let within = |nominal: f64| {
                let z = half_width(nominal / 100.0);
                let inside = |s: &&Sample| s.residual.abs() <= z * s.sigmas[which];
                100.0 * samples.iter().filter(inside).count() as f64 / count
            };
            Calibration {
                mean_sigma: sum / count,
                sigma_over_residual: sum / count / rms_residual.max(f64::MIN_POSITIVE),
                within: NOMINAL.map(within).to_vec(),
            }
        };
        Self {
            points: samples.len(),
            unmatched: points - samples.len(),
            rms_residual,
            nominal: NOMINAL.to_vec(),
            latent: calibration(0),
            observed: calibration(1),
            sigma_hat: calibration(2),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_widths_are_the_gaussians() {
        // Abramowitz and Stegun, Handbook of Mathematical Functions, table 26.5 and its reading
        // for one standard deviation.
        for (share, expected) in [
            (0.5, 0.674_489_750_2),
            (0.682_689_492_137, 1.0),
            (0.9, 1.644_853_627_0),
            (0.95, 1.959_963_984_5),
            (0.99, 2.575_829_303_5),
        ] {
            let found = half_width(share);
            assert!((found - expected).abs() < 1e-10, "{share}: {found}");
        }
    }

    /// Residuals at the quantiles of a Gaussian of deviation 2, and σ of half, right and twice that.
    fn gaussian() -> Vec<Sample> {
        (0..10_000)
            .map(|i| Sample {
                residual: 2.0 * half_width((f64::from(i) + 0.5) / 10_000.0),
                sigmas: [1.0, 2.0, 4.0],
            })
            .collect()
    }

    #[test]
    fn the_right_deviation_covers_what_it_promises() {
        let found = Coverage::of(&gaussian(), 10_000);
        for (within, nominal) in found.observed.within.iter().zip(NOMINAL) {
            assert!((within - nominal).abs() < 0.02, "{within} of {nominal}");
        }
        assert!((found.observed.sigma_over_residual - 1.0).abs() < 1e-3);
    }

    #[test]
    fn a_deviation_too_small_covers_less_and_one_too_large_more() {
        let found = Coverage::of(&gaussian(), 10_001);
        for (index, nominal) in NOMINAL.into_iter().enumerate() {
            assert!(found.latent.within[index] < nominal);
            assert!(found.sigma_hat.within[index] > nominal);
        }
        assert!((found.latent.sigma_over_residual - 0.5).abs() < 1e-3);
        assert!((found.sigma_hat.sigma_over_residual - 2.0).abs() < 2e-3);
        assert_eq!((found.points, found.unmatched), (10_000, 1));
    }
}
