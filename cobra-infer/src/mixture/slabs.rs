//! Which boxes lie in which slab of the object, so that a point need not look at all of them.
//!
//! Owns nothing that shows in an answer: a component that is left out here has a box that does not meet
//! the window. Along each axis the positions are cut into slabs; a window meets at most those components
//! that have a bit in one of its slabs along every axis.

use crate::template::{Validities, Window};
use crate::validity::BOX_STEPS;

/// Components in a group, which are told apart by the bits of a word.
pub(super) const GROUP: usize = 32;

/// Groups whose boxes are sorted into slabs; components beyond them are looked at one by one. A group
/// takes 192 bytes of RAM.
const GROUPS: usize = 1;

/// Slabs along an axis.
const SLABS: usize = 16;

/// Positions in a slab.
const WIDTH: u8 = BOX_STEPS / SLABS as u8;

/// For each group, axis and slab, a bit for each component whose box reaches into it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slabs([[[u32; SLABS]; 3]; GROUPS]);

impl Slabs {
    /// Of no box.
    pub(super) const NONE: Self = Self([[[0; SLABS]; 3]; GROUPS]);

    /// Sorts the boxes in.
    pub(super) fn take(&mut self, validities: &Validities<'_>) {
        for (group, axes) in self.0.iter_mut().enumerate() {
            for bit in 0..GROUP {
                let Some(validity) = validities.get(group * GROUP + bit) else {
                    return;
                };
                let ends = validity.low().into_iter().zip(validity.high());
                for (slabs, (low, high)) in axes.iter_mut().zip(ends) {
                    let (first, last) = (low / WIDTH, high / WIDTH);
                    for (slab, bits) in (0..).zip(slabs) {
                        if (first..=last).contains(&slab) {
                            *bits |= 1 << bit;
                        }
                    }
                }
            }
        }
    }

    /// The components of a group whose boxes may meet the window, and perhaps others; `None` for a group
    /// whose boxes are not sorted.
    #[inline]
    pub(super) fn meeting(&self, group: usize, window: Window) -> Option<u32> {
        let axes = self.0.get(group)?;
        let along = |slabs: &[u32; SLABS], (low, high): (u8, u8)| {
            let (first, last) = (usize::from(low / WIDTH), usize::from(high / WIDTH));
            // The remainder is the compiler's: it then sees that there is such a slab.
            let of = |slab: usize| slabs.get(slab % SLABS).copied().unwrap_or(0);
            let mut some = of(first) | of(last);
            // Rare: most windows are narrower than a slab.
            for slab in first.saturating_add(1)..last {
                some |= of(slab);
            }
            some
        };
        // One by one: a loop is not unrolled at `opt-level = "s"`.
        let [x, y, z] = axes;
        let [in_x, in_y, in_z] = window.axes();
        Some(along(x, in_x) & along(y, in_y) & along(z, in_z))
    }
}
