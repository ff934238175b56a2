//! The most probable of the components that may speak for a point: maximum assignment with validity.
//!
//! Owns the loop over the components that a point's window leaves, which is most of what a point costs
//! where components have maps. Which these are is [`super::reach`]'s.

use super::slabs::GROUP;
use super::{Mixture, Prediction};
use crate::template::Validities;

impl<const COMPONENTS: usize> Mixture<'_, COMPONENTS> {
    /// The component of the least cost, the first of equals, and what it says.
    // Out of line, a controller takes 40 instructions more for a point and 170 bytes of stack less.
    #[inline]
    pub(super) fn most_probable(
        &self,
        validities: &Validities<'_>,
        at: [f32; 3],
    ) -> Option<(usize, Prediction)> {
        let mut best = None;
        let mut least = f32::INFINITY;
        let mut asked = None;
        let mut look = self.reach.first;
        loop {
            let window = self.reach.window(at, look.reach);
            for group in 0..self.prepared.len().div_ceil(GROUP) {
                let mut left = self.reach.meeting(group, window, self.prepared.len());
                while left != 0 {
                    let index = group * GROUP + left.trailing_zeros() as usize;
                    left &= left - 1;
                    let validity = validities.get(index)?;
                    if !validity.meets(window) || asked.is_some_and(|asked| validity.meets(asked)) {
                        continue;
                    }
                    let component = self.template.stored_at(index)?;
                    let offset = component.offset(at);
                    let Some(square) = validity.locate(offset) else {
                        continue;
                    };
                    let prepared = self.prepared.get(index)?;
                    let asked = self.ask(component, prepared, offset, Some(square));
                    let Some((prediction, direction)) = asked else {
                        continue;
                    };
                    let cost = self.cost(prediction.half_square, prepared);
                    let first = best.as_ref().is_none_or(|(first, _)| index < *first);
                    if !(cost < least || (cost == least && first)) {
                        continue;
                    }
                    let place = self.place(component, &direction, prediction.predicted);
                    if validity.meets(place) {
                        least = cost;
                        best = Some((index, prediction));
                    }
                }
            }
            if least <= look.enough {
                break;
            }
            asked = Some(window);
            look = self.reach.after(look, least);
        }
        best
    }
}
