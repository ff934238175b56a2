//! The mixture of Eqs. 6 to 8: p(P) = Σ_k π_k q̂_k, π_k ∝ exp(−a_k), a_k = (P − C_k)ᵀQ_k(P − C_k).
//!
//! Owns the order in which it is added, which is part of the template format. The least exponent is
//! taken from all of them, which cancels in the quotient and keeps it from being 0/0: with
//! xₖ = a_k − min a, the likelihood is (Σ exp(−(xₖ + e²/2σ²))·scale) / Σ exp(−xₖ), both sums from +0
//! by rising k over the components whose exp(−xₖ) is not 0, the others not being asked. Far from the
//! object, where exponents exceed some 10⁶, `f32` rounds their differences and with them the weights.

use super::{Likelihood, Match, Mixture, Prediction};
use crate::math;
use nalgebra::Point3;

impl<const COMPONENTS: usize> Mixture<'_, COMPONENTS> {
    /// The mixture; `None` where no component is finitely near or none of those with a weight has
    /// an answer.
    pub(super) fn evaluate_soft(&self, point: &Point3<f32>) -> Option<Match> {
        let at = [point.x, point.y, point.z];
        let least = self
            .template
            .exponents(at)
            .fold(
                f32::INFINITY,
                |least, next| if next < least { next } else { least },
            );
        if !least.is_finite() {
            return None;
        }
        let (mut weights, mut likelihoods, mut thresholds) = (0.0, 0.0, 0.0);
        let mut best: Option<(f32, usize, Prediction)> = None;
        let components = self.template.stored().zip(&self.prepared);
        for (index, ((component, prepared), exponent)) in
            components.zip(self.template.exponents(at)).enumerate()
        {
            let excess = exponent - least;
            let weight = math::exp(-excess);
            if weight.is_nan() || weight <= 0.0 {
                continue;
            }
            weights += weight;
            thresholds += weight * prepared.threshold;
            let Some(prediction) = self.predict(component, prepared, point) else {
                continue;
            };
            let peak = math::exp(-(excess + prediction.half_square));
            likelihoods += self.likelihood.of_peak(peak, prepared.inverse_sigma);
            let cost = excess + self.cost(&prediction, prepared);
            if best.as_ref().is_none_or(|(least, ..)| cost < *least) {
                best = Some((cost, index, prediction));
            }
        }
        let (_, component, prediction) = best?;
        let likelihood = likelihoods / weights;
        Some(Match {
            component,
            distance: prediction.distance,
            predicted: prediction.predicted,
            likelihood: match self.likelihood {
                // Two rounded sums may differ by an ulp where every likelihood is 1.
                Likelihood::Peak if likelihood > 1.0 => 1.0,
                _ => likelihood,
            },
            threshold: thresholds / weights,
        })
    }
}
