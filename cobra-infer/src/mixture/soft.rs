//! The mixture of Eqs. 6 to 8: p(P) = Σ_k π_k q̂_k, π_k ∝ exp(−a_k), a_k = (P − C_k)ᵀQ_k(P − C_k).
//!
//! Owns the order in which it is added, which is part of the template format. The least exponent is
//! taken from all of them, which cancels in the quotient and keeps it from being 0/0: with
//! xₖ = a_k − min a, the likelihood is (Σ exp(−(xₖ + e²/2σ²))·scale) / Σ exp(−xₖ), both sums from +0
//! by rising k over the components whose exp(−xₖ) is not 0, the others not being asked. With validity
//! the least exponent is that of the components which are valid in the point's direction, and both sums
//! go over those that speak for the point. Far from the
//! object, where exponents exceed some 10⁶, `f32` rounds their differences and with them the weights.

use super::{Likelihood, Prediction, Prepared};
use crate::math;
use crate::template::Template;

/// The sums over the components, and the least exponent.
#[derive(Clone, Copy)]
pub(super) struct Blend {
    least: f32,
    weights: f32,
    likelihoods: f32,
    thresholds: f32,
}

impl Blend {
    /// Of the components around a point, those that are valid in its direction; `None` where none is
    /// finitely near.
    pub(super) fn over(template: &Template<'_>, at: [f32; 3]) -> Option<Self> {
        let mut least = f32::INFINITY;
        for index in 0..template.component_count() {
            let exponent = template.exponent(index, at);
            if exponent < least && template.is_valid_towards(index, at) {
                least = exponent;
            }
        }
        least.is_finite().then_some(Self {
            least,
            weights: 0.0,
            likelihoods: 0.0,
            thresholds: 0.0,
        })
    }

    /// xₖ = a_k − min a.
    pub(super) fn excess(&self, exponent: f32) -> f32 {
        exponent - self.least
    }

    /// Takes exp(−xₖ) into the sums.
    pub(super) fn weigh(&mut self, weight: f32, prepared: &Prepared) {
        self.weights += weight;
        self.thresholds += weight * prepared.threshold;
    }

    /// Takes the component's answer into the sum.
    pub(super) fn add(
        &mut self,
        likelihood: Likelihood,
        excess: f32,
        prediction: &Prediction,
        prepared: &Prepared,
    ) {
        let peak = math::exp(-(excess + prediction.half_square));
        self.likelihoods += likelihood.of_peak(peak, prepared.inverse_sigma);
    }

    /// The likelihood and the contribution to the threshold.
    pub(super) fn finish(&self, likelihood: Likelihood) -> (f32, f32) {
        let mixed = self.likelihoods / self.weights;
        let mixed = match likelihood {
            // Two rounded sums may differ by an ulp where every likelihood is 1.
            Likelihood::Peak if mixed > 1.0 => 1.0,
            _ => mixed,
        };
        (mixed, self.thresholds / self.weights)
    }
}
