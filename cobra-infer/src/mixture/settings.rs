//! How points are scored.
//!
//! Owns the choices that a caller has, their defaults, and the ranges of their numbers.

use crate::bound::Threshold;
use crate::error::ScoreError;
use crate::math::{Real, SQRT_TWO_PI};
use crate::template::Template;

/// Which likelihood a residual e under standard deviation σ has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Likelihood {
    /// exp(−e²/2σ²), between 0 and 1: what decisions use by default.
    Peak,
    /// The Gaussian density exp(−e²/2σ²)/(√(2π)σ) of Eq. 9, in 1/length.
    Density,
}

impl Likelihood {
    /// The likelihood whose peak form is `peak`. The threshold goes through it as well, so that
    /// equal residuals are equal after rounding.
    pub(crate) fn of_peak(self, peak: f32, inverse_sigma: f32) -> f32 {
        match self {
            Likelihood::Peak => peak,
            Likelihood::Density => peak * inverse_sigma / SQRT_TWO_PI,
        }
    }
}

/// Which component speaks for a point.
///
/// Without validity nearest is the safer choice: a component that is asked outside its own patch
/// extrapolates, so the maximum over all of them finds an excuse for more wrong points. With validity
/// none is asked there, and the maximum is the better one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Assignment {
    /// The one whose reference point is nearest: that of the largest weight in Eq. 8; the first of
    /// equals. With validity, of those that are valid in the point's direction; if what it predicts
    /// leaves its box, none.
    Nearest,
    /// The one that finds the point most probable (Eq. 10), of those that speak for it; the first of
    /// equals.
    Maximum,
    /// All of them, mixed with the weights of Eq. 8: p(P) = Σ_k π_k q̂_k (Eq. 6). With the identity
    /// for Q_k the weights hardly differ over an object, so that components which extrapolate
    /// dilute the one that knows. With validity, of those that speak for the point.
    Soft,
}

/// The standard deviation σ of a component's residual.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Sigma {
    /// σ² = σ̂_k² + σ_m², with σ_m ≥ 0 the measurement's own standard deviation, in the template's
    /// unit.
    Template {
        /// σ_m.
        noise: f32,
    },
    /// This σ > 0 for every component, in the template's unit.
    Fixed(f32),
}

/// How points are scored.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Settings {
    /// Which likelihood.
    pub likelihood: Likelihood,
    /// Which component speaks for a point.
    pub assignment: Assignment,
    /// Which σ.
    pub sigma: Sigma,
    /// What the threshold promises of a pose within δ.
    pub threshold: Threshold,
    /// The tolerance δ > 0, in the template's unit.
    pub delta: f32,
    /// With fewer points of positive weight than this the decision is undecided.
    pub minimum_points: u32,
}

impl Settings {
    /// The fewest points that a decision is made on unless the caller says otherwise: the mean of
    /// ten peak likelihoods has a standard error of about 0.1.
    pub const MINIMUM_POINTS: u32 = 10;

    /// Peak likelihood, nearest component, the template's σ without measurement noise, Eq. 11, and
    /// the tolerance `delta` in the template's unit.
    #[must_use]
    pub const fn with_delta(delta: f32) -> Self {
        Self {
            likelihood: Likelihood::Peak,
            assignment: Assignment::Nearest,
            sigma: Sigma::Template { noise: 0.0 },
            threshold: Threshold::Paper,
            delta,
            minimum_points: Self::MINIMUM_POINTS,
        }
    }

    /// [`Settings::with_delta`] with the tolerance in millimetres, whatever the template's unit, and
    /// the maximum where the template has validity.
    #[must_use]
    pub fn for_template(template: &Template<'_>, delta_millimetres: f32) -> Self {
        let mut settings = Self::with_delta(delta_millimetres / template.unit().millimetres());
        if template.has_validity() {
            settings.assignment = Assignment::Maximum;
        }
        settings
    }

    pub(super) fn check(&self) -> Result<(), ScoreError> {
        // The inverse of a smaller σ would not be finite.
        let positive = |value: f32| value.is_finite() && value >= f32::MIN_POSITIVE;
        if !positive(self.delta) {
            return Err(ScoreError::Delta { found: self.delta });
        }
        match self.sigma {
            Sigma::Fixed(sigma) if !positive(sigma) => Err(ScoreError::Sigma { found: sigma }),
            Sigma::Template { noise } if !(noise.is_finite() && noise >= 0.0) => {
                Err(ScoreError::Noise { found: noise })
            }
            _ => Ok(()),
        }
    }
}

/// √(σ̂² + σ_m²) for σ̂ > 0 and σ_m ≥ 0: never below either, never infinite.
pub(super) fn combined(sigma_hat: f32, noise: f32) -> f32 {
    let (smaller, larger) = if sigma_hat < noise {
        (sigma_hat, noise)
    } else {
        (noise, sigma_hat)
    };
    // As a ratio, so that no square underflows and the smaller one is never lost to it.
    let ratio = smaller / larger;
    let both = larger * (1.0 + ratio * ratio).square_root();
    if both.is_finite() { both } else { f32::MAX }
}
