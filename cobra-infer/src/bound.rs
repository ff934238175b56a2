//! The threshold, which relates a tolerance δ to a confidence: Eq. 11 and what stands beside it.
//!
//! Owns one point's contribution; the weighted sum over points is the scorer's.
//!
//! With x = δ²/(2σ²), a point whose component has standard deviation σ contributes under the peak
//! likelihood
//!
//! | [`Threshold`] | contribution | what it is |
//! |---|---|---|
//! | `Paper` | (1 − e^−x)/(2x) | Eq. 11, a lower bound of `Mean`; never above ½ |
//! | `Mean` | (√π/2)·erf(√x)/√x | the average likelihood over residuals spread evenly in ±δ |
//! | `Worst` | e^−x | the likelihood of a residual of exactly δ |
//!
//! and each of these divided by √(2π)σ under the density, which for `Paper` is Eq. 11 as printed.
//!
//! All this is of residuals of the one component that speaks for a point, the nearest or the
//! likeliest; a mixture lies below its best component, and of it nothing is promised.
//!
//! Only `Worst` is a promise about one pose: if every residual is within δ, the confidence reaches
//! it. `Mean` and `Paper` speak of the average over many poses whose residuals spread evenly in ±δ.
//! `Paper` lies below `Worst`, and so accepts every pose within δ, only up to δ = 1.585 σ (where
//! eˣ = 1 + 2x, x = 1.2564); beyond, it rejects poses whose residuals all lie within δ but mostly
//! near it. `Mean` rejects such poses for every δ.

use crate::math::{self, Real, SQRT_TWO_PI};
use crate::mixture::Likelihood;

/// What the threshold promises of a pose within the tolerance δ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Threshold {
    /// Eq. 11: a lower bound of the average confidence of poses whose residuals spread evenly in
    /// ±δ.
    #[default]
    Paper,
    /// That average itself.
    Mean,
    /// The least confidence of a pose all of whose residuals are within δ.
    Worst,
}

/// √π/2.
const HALF_SQRT_PI: f32 = 0.886_226_95;

/// One point's contribution to the threshold: `sigma > 0` and `delta > 0` in the same unit.
///
/// Never NaN; between 0 and 1 for [`Likelihood::Peak`] (½ for [`Threshold::Paper`]), in 1/length
/// for [`Likelihood::Density`].
#[must_use]
pub fn contribution(likelihood: Likelihood, threshold: Threshold, sigma: f32, delta: f32) -> f32 {
    let half_square = |ratio: f32| 0.5 * ratio * ratio;
    // As the scorer computes a residual of δ, so that rounding never puts that below its threshold.
    let inverse_sigma = 1.0 / sigma;
    let as_scored = half_square(delta * inverse_sigma);
    match threshold {
        Threshold::Paper => {
            let peak = paper(half_square(delta / sigma));
            match likelihood {
                Likelihood::Peak => peak,
                Likelihood::Density => peak / (SQRT_TWO_PI * sigma),
            }
        }
        Threshold::Mean => likelihood.of_peak(mean(as_scored), inverse_sigma),
        Threshold::Worst => likelihood.of_peak(math::exp(-as_scored), inverse_sigma),
    }
}

/// (1 − e^−x)/(2x) for x ≥ 0 or infinite.
fn paper(x: f32) -> f32 {
    if x < f32::MIN_POSITIVE {
        0.5
    } else if x.is_finite() {
        -math::exp_minus_one(-x) / (2.0 * x)
    } else {
        0.0
    }
}

/// (√π/2)·erf(√x)/√x for x ≥ 0 or infinite; rounding may lift it above its limit of 1.
fn mean(x: f32) -> f32 {
    if x < f32::MIN_POSITIVE {
        return 1.0;
    }
    if !x.is_finite() {
        return 0.0;
    }
    let root = x.square_root();
    let mean = HALF_SQRT_PI * math::error_function(root) / root;
    if mean > 1.0 { 1.0 } else { mean }
}

#[cfg(test)]
mod tests {
    use super::*;

    const THRESHOLDS: [Threshold; 3] = [Threshold::Paper, Threshold::Mean, Threshold::Worst];

    fn peak(threshold: Threshold, sigma: f32, delta: f32) -> f32 {
        contribution(Likelihood::Peak, threshold, sigma, delta)
    }

    #[test]
    fn equation_11_gives_0_387_for_a_sigma_of_1_93_and_a_tolerance_of_2() {
        for (threshold, expected) in [(Threshold::Paper, 0.387), (Threshold::Worst, 0.585)] {
            let found = peak(threshold, 1.93, 2.0);
            assert!((found - expected).abs() < 5e-4, "{threshold:?}: {found}");
        }
    }

    #[test]
    #[expect(
        clippy::disallowed_methods,
        reason = "the reference value is computed independently of the crate's own functions"
    )]
    fn the_density_form_is_equation_11_as_printed() {
        let (sigma, delta) = (0.7_f64, 1.3_f64);
        let printed = sigma * (1.0 - (-delta * delta / (2.0 * sigma * sigma)).exp())
            / ((2.0 * core::f64::consts::PI).sqrt() * delta * delta);
        let ours = contribution(
            Likelihood::Density,
            Threshold::Paper,
            sigma as f32,
            delta as f32,
        );
        assert!((f64::from(ours) - printed).abs() < 1e-6 * printed);
    }

    #[test]
    fn equation_11_never_exceeds_the_average_and_the_average_lies_above_the_worst_case() {
        for step in 1..400 {
            let delta = 0.02 * step as f32;
            let [paper, mean, worst] = THRESHOLDS.map(|threshold| peak(threshold, 1.0, delta));
            assert!(paper <= mean && worst <= mean, "{delta}");
        }
    }

    #[test]
    fn equation_11_rejects_poses_within_delta_from_1_585_sigma_on() {
        for (delta, rejects) in [(0.1, false), (1.584, false), (1.587, true), (6.0, true)] {
            let (paper, worst) = (
                peak(Threshold::Paper, 1.0, delta),
                peak(Threshold::Worst, 1.0, delta),
            );
            assert_eq!(paper > worst, rejects, "{delta}: {paper} {worst}");
        }
    }

    #[test]
    fn no_sigma_and_delta_give_nan_or_leave_the_range() {
        let sizes = [
            f32::MIN_POSITIVE,
            1e-30,
            1e-10,
            1e-3,
            1.0,
            1e5,
            1e30,
            f32::MAX,
        ];
        for sigma in sizes {
            for delta in sizes {
                for (threshold, most) in THRESHOLDS.into_iter().zip([0.5, 1.0, 1.0]) {
                    let c = peak(threshold, sigma, delta);
                    assert!(
                        (0.0..=most).contains(&c),
                        "{threshold:?}, sigma {sigma}, delta {delta}: {c}"
                    );
                    let density = contribution(Likelihood::Density, threshold, sigma, delta);
                    assert!(!density.is_nan());
                }
            }
        }
    }
}
