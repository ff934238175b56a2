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

mod all;
#[cfg(test)]
mod pruning;
mod reach;
mod search;
mod settings;
mod slabs;
mod slope;
mod soft;

use crate::bound;
use crate::error::ScoreError;
use crate::gp::{self, UnitDirection};
use crate::math;
use crate::template::{Stored, Template, Validity, Window};
use crate::tolerance;
use crate::validity::Square;
use heapless::Vec;
use nalgebra::Point3;
use reach::Reach;
use settings::combined;
pub use settings::{Assignment, Likelihood, Settings, Sigma};
use soft::Blend;

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
            self.reach.prune(validities, self.likelihood);
        }
    }

    /// The component that speaks for `point`, and what it says; `None` when none does: the point
    /// lies on its reference point or infinitely far away, or where no component is valid.
    ///
    /// The most probable component has the smallest e²/2σ², plus ln σ for the density, so that one
    /// exponential a point is enough unless all are mixed. Which components are passed over, and in
    /// which order the others are asked, does not show in the answer.
    #[must_use]
    pub fn evaluate(&self, point: &Point3<f32>) -> Option<Match> {
        let at = [point.x, point.y, point.z];
        if let Some(validities) = self.template.validities()
            && self.assignment == Assignment::Maximum
        {
            let (component, prediction) = self.most_probable(validities, at)?;
            return self.finish(component, prediction, None);
        }
        self.among_all(at)
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
