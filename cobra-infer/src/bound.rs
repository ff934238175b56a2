//! The threshold of Eq. 11, which relates a tolerance δ to a confidence.
//!
//! Owns one point's contribution; the weighted sum over points is the scorer's.
//!
//! With x = δ²/(2σ²), a point whose component has standard deviation σ contributes
//! (1 − e^−x)/(2x) under the peak likelihood (never above ½), and that divided by √(2π)σ under the
//! density, which is Eq. 11 as printed. Eq. 11 bounds the *average* confidence over residuals
//! spread evenly in ±δ; it does not promise that every pose with all residuals within δ passes.

use crate::math::{self, SQRT_TWO_PI};
use crate::mixture::Likelihood;

/// One point's contribution to the threshold: `sigma > 0` and `delta > 0` in the same unit.
///
/// Never NaN; between 0 and ½ for [`Likelihood::Peak`], in 1/length for [`Likelihood::Density`].
#[must_use]
pub fn contribution(likelihood: Likelihood, sigma: f32, delta: f32) -> f32 {
    let ratio = delta / sigma;
    let x = 0.5 * ratio * ratio;
    let peak = if x < f32::MIN_POSITIVE {
        // The limit of (1 − e^−x)/(2x) for x → 0.
        0.5
    } else if x.is_finite() {
        -math::exp_minus_one(-x) / (2.0 * x)
    } else {
        0.0
    };
    match likelihood {
        Likelihood::Peak => peak,
        Likelihood::Density => peak / (SQRT_TWO_PI * sigma),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equation_11_gives_0_387_for_a_sigma_of_1_93_and_a_tolerance_of_2() {
        let threshold = contribution(Likelihood::Peak, 1.93, 2.0);
        assert!((threshold - 0.387).abs() < 5e-4, "{threshold}");
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
        let ours = contribution(Likelihood::Density, sigma as f32, delta as f32);
        assert!((f64::from(ours) - printed).abs() < 1e-6 * printed);
    }

    #[test]
    fn no_sigma_and_delta_give_nan_or_more_than_a_half() {
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
                let c = contribution(Likelihood::Peak, sigma, delta);
                assert!(
                    (0.0..=0.5).contains(&c),
                    "sigma {sigma}, delta {delta}: {c}"
                );
                assert!(!contribution(Likelihood::Density, sigma, delta).is_nan());
            }
        }
    }
}
