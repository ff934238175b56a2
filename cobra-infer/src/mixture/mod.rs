//! The likelihood of one object-frame point under a template (Eqs. 6 to 9).
//!
//! Owns which component speaks for a point, or how much each has to say, and how probable they find
//! it. Averaging over points is the scorer's ([`mod@crate::score`]).
//!
//! A component of a template with validity speaks for a point P only if the cell of P − C_k is valid and
//! the point it predicts, C_k + μ·u, lies in its box; what speaks for no point is as if it were not
//! there. Without validity every component speaks that has a direction and a finite mean.
//!
//! Components are near or far by (P − C_k)ᵀQ_k(P − C_k), the exponent of Eq. 8: with the precisions
//! Q_k that expectation maximisation learned, or with the identity in the object's unit sphere,
//! as the paper has it for k-means, which makes it the Euclidean distance.

#[cfg(test)]
mod pruning;
mod reach;
mod search;
mod slabs;
mod soft;

use crate::bound::{self, Threshold};
use crate::error::ScoreError;
use crate::gp::{self, UnitDirection};
use crate::math::{self, Real, SQRT_TWO_PI};
use crate::template::{Stored, Template, Validity, Window};
use crate::tolerance;
use crate::validity::Square;
use heapless::Vec;
use nalgebra::Point3;
use reach::Reach;
use soft::Blend;

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

    fn check(&self) -> Result<(), ScoreError> {
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

/// What scoring keeps per component; everything else stays in the template.
#[derive(Clone, Copy, Debug)]
struct Prepared {
    inverse_sigma: f32,
    log_sigma: f32,
    threshold: f32,
}

/// What a template says of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Match {
    /// Which component speaks for it; of a soft assignment, the one with the largest share
    /// π_k q̂_k of the likelihood.
    pub component: usize,
    /// Distance of the point from the reference point.
    pub distance: f32,
    /// The posterior mean in the point's direction.
    pub predicted: f32,
    /// The point's likelihood.
    pub likelihood: f32,
    /// What the point contributes to the threshold; of a soft assignment, the components'
    /// contributions mixed as their likelihoods are.
    pub threshold: f32,
}

impl Match {
    /// e = distance − posterior mean, in the template's unit; positive outside the surface as seen
    /// from the reference point.
    #[must_use]
    pub fn residual(&self) -> f32 {
        self.distance - self.predicted
    }
}

/// One component's answer before it is turned into a likelihood.
#[derive(Clone, Copy)]
struct Prediction {
    distance: f32,
    predicted: f32,
    half_square: f32,
}

/// A template with the settings it is used with, for at most `COMPONENTS` components.
#[derive(Clone, Debug)]
pub struct Mixture<'t, const COMPONENTS: usize> {
    template: &'t Template<'t>,
    likelihood: Likelihood,
    assignment: Assignment,
    smallest_distance: f32,
    largest_threshold: f32,
    reach: Reach,
    prepared: Vec<Prepared, COMPONENTS>,
}

impl<'t, const COMPONENTS: usize> Mixture<'t, COMPONENTS> {
    /// Prepares σ, its inverse and its threshold for each component.
    ///
    /// # Errors
    /// [`ScoreError::TooManyComponents`], or a setting out of its range.
    pub fn new(template: &'t Template<'t>, settings: &Settings) -> Result<Self, ScoreError> {
        Self::check(template, settings)?;
        let mut mixture = Self::unprepared(template, settings);
        mixture.prepare(settings);
        Ok(mixture)
    }

    /// Whether [`Mixture::new`] would have an error.
    pub(crate) fn check(template: &Template<'_>, settings: &Settings) -> Result<(), ScoreError> {
        settings.check()?;
        let found = template.component_count();
        if found > COMPONENTS {
            return Err(ScoreError::TooManyComponents {
                capacity: COMPONENTS,
                found,
            });
        }
        Ok(())
    }

    /// Of what [`Mixture::check`] has passed, and to be filled by [`Mixture::prepare`]: in two steps,
    /// so that it is built where it is to lie and nothing large is moved.
    #[inline]
    pub(crate) fn unprepared(template: &'t Template<'t>, settings: &Settings) -> Self {
        Self {
            template,
            likelihood: settings.likelihood,
            assignment: settings.assignment,
            smallest_distance: tolerance::NO_DIRECTION * template.radius(),
            largest_threshold: 0.0,
            reach: Reach::new(template),
            prepared: Vec::new(),
        }
    }

    /// σ, its inverse and its threshold for each component.
    pub(crate) fn prepare(&mut self, settings: &Settings) {
        for component in self.template.stored() {
            let sigma = match settings.sigma {
                Sigma::Fixed(sigma) => sigma,
                Sigma::Template { noise } => combined(component.sigma_hat(), noise),
            };
            let threshold = bound::contribution(
                settings.likelihood,
                settings.threshold,
                sigma,
                settings.delta,
            );
            if threshold > self.largest_threshold {
                self.largest_threshold = threshold;
            }
            let prepared = Prepared {
                inverse_sigma: 1.0 / sigma,
                log_sigma: math::ln(sigma),
                threshold,
            };
            let least_cost = self.cost(0.0, &prepared);
            self.reach.take(component.centre(), sigma, least_cost);
            // There is room for all of them.
            let _ = self.prepared.push(prepared);
        }
        if let Some(validities) = self.template.validities()
            && self.assignment == Assignment::Maximum
        {
            self.reach.prune(validities);
        }
    }

    /// The component that speaks for `point`, and what it says; `None` when none does: the point
    /// lies on its reference point or infinitely far away, or where no component is valid.
    ///
    /// The most probable component has the smallest e²/2σ², plus ln σ for the density, so that one
    /// exponential a point is enough unless all are mixed. Which components are passed over, and in
    /// which order the others are asked, does not show in the answer.
    // One loop for all assignments: with one for each, none would contain the Gaussian process, and
    // the calls and what they return cost a controller a tenth of a point.
    #[must_use]
    pub fn evaluate(&self, point: &Point3<f32>) -> Option<Match> {
        let at = [point.x, point.y, point.z];
        if let Some(validities) = self.template.validities()
            && self.assignment == Assignment::Maximum
        {
            let (component, prediction) = self.most_probable(validities, at)?;
            return self.finish(component, prediction, None);
        }
        let mut blend = None;
        let candidates = match self.assignment {
            Assignment::Nearest => {
                let index = self.template.nearest(at)?;
                index..index.saturating_add(1)
            }
            Assignment::Maximum => 0..self.prepared.len(),
            Assignment::Soft => {
                blend = Some(Blend::over(self.template, at)?);
                0..self.prepared.len()
            }
        };
        let validities = self.template.validities();
        let mut best: Option<(f32, usize, Prediction)> = None;
        for index in candidates {
            let component = self.template.stored_at(index)?;
            let offset = component.offset(at);
            let validity = validities.and_then(|all| all.get(index));
            let mut square = None;
            if let Some(validity) = &validity {
                square = validity.square(offset);
                if square.is_none() {
                    continue;
                }
            }
            let prepared = self.prepared.get(index)?;
            let (mut excess, mut weight) = (0.0, 0.0);
            if let Some(blend) = &blend {
                excess = blend.excess(self.template.exponent(index, at));
                weight = math::exp(-excess);
                let heard = weight > 0.0;
                if !heard {
                    continue;
                }
            }
            let prediction = self.predict(component, prepared, offset, square, validity);
            if let Some(blend) = &mut blend
                && (prediction.is_some() || validity.is_none())
            {
                blend.weigh(weight, prepared);
            }
            let Some(prediction) = prediction else {
                continue;
            };
            if let Some(blend) = &mut blend {
                blend.add(self.likelihood, excess, &prediction, prepared);
            }
            let cost = excess + self.cost(prediction.half_square, prepared);
            if best.as_ref().is_none_or(|(least, ..)| cost < *least) {
                best = Some((cost, index, prediction));
            }
        }
        let (_, component, prediction) = best?;
        self.finish(component, prediction, blend.as_ref())
    }

    /// Turns the answer of the component that speaks into a likelihood.
    #[inline(always)]
    fn finish(
        &self,
        component: usize,
        prediction: Prediction,
        blend: Option<&Blend>,
    ) -> Option<Match> {
        let prepared = self.prepared.get(component)?;
        let (likelihood, threshold) = match blend {
            Some(blend) => blend.finish(self.likelihood),
            None => {
                let peak = math::exp(-prediction.half_square);
                let likelihood = self.likelihood.of_peak(peak, prepared.inverse_sigma);
                (likelihood, prepared.threshold)
            }
        };
        Some(Match {
            component,
            distance: prediction.distance,
            predicted: prediction.predicted,
            likelihood,
            threshold,
        })
    }

    /// What a match contributes to the threshold; without a match, the largest of all components,
    /// so that points that nothing explains never make a pose easier to accept.
    #[must_use]
    pub fn threshold(&self, found: Option<&Match>) -> f32 {
        found.map_or(self.largest_threshold, |found| found.threshold)
    }

    /// e²/2σ², plus ln σ for the density: the less, the more probable.
    fn cost(&self, half_square: f32, prepared: &Prepared) -> f32 {
        match self.likelihood {
            Likelihood::Peak => half_square,
            Likelihood::Density => half_square + prepared.log_sigma,
        }
    }

    /// What a component says of the point at this offset from its reference point, which lies at `square`
    /// on its map of directions; `None` where that is nothing.
    #[inline(never)]
    fn predict(
        &self,
        component: Stored<'t>,
        prepared: &Prepared,
        offset: [f32; 3],
        square: Option<Square>,
        validity: Option<Validity<'t>>,
    ) -> Option<Prediction> {
        let (prediction, direction) = self.ask(component, prepared, offset, square)?;
        let speaks = validity.is_none_or(|validity| {
            let window = self.place(component, &direction, prediction.predicted);
            validity.meets(window)
        });
        speaks.then_some(prediction)
    }

    /// What a component would say if it may, and the direction that it was asked in.
    #[inline(always)]
    fn ask(
        &self,
        component: Stored<'t>,
        prepared: &Prepared,
        offset: [f32; 3],
        square: Option<Square>,
    ) -> Option<(Prediction, UnitDirection)> {
        let (direction, distance) = gp::direction_and_length(offset, self.smallest_distance)?;
        let predicted = component.posterior_mean(self.template.model(), &direction, square);
        if !predicted.is_finite() {
            return None;
        }
        let scaled = (distance - predicted) * prepared.inverse_sigma;
        let prediction = Prediction {
            distance,
            predicted,
            half_square: 0.5 * scaled * scaled,
        };
        Some((prediction, direction))
    }

    /// Where the point lies that a component predicts.
    #[inline(always)]
    fn place(&self, component: Stored<'t>, u: &UnitDirection, predicted: f32) -> Window {
        let [x, y, z] = component.centre();
        let point = [
            x + predicted * u.x,
            y + predicted * u.y,
            z + predicted * u.z,
        ];
        self.reach.position(point)
    }
}

/// √(σ̂² + σ_m²) for σ̂ > 0 and σ_m ≥ 0: never below either, never infinite.
fn combined(sigma_hat: f32, noise: f32) -> f32 {
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
