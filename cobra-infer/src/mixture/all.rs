//! The loop over components that leaves none out unasked: nearest and soft assignment, and the maximum
//! without validity.

use super::soft::Blend;
use super::{Assignment, Match, Mixture, Prediction};
use crate::math;

impl<const COMPONENTS: usize> Mixture<'_, COMPONENTS> {
    /// What [`Mixture::evaluate`] says.
    // One loop for these assignments: with one for each, none would contain the Gaussian process, and
    // the calls and what they return cost a controller a tenth of a point.
    pub(super) fn among_all(&self, at: [f32; 3]) -> Option<Match> {
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
}
