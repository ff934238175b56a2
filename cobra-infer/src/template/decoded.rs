//! Compact terms as `f32` in memory of the caller's: where there is enough of it, scoring is faster.
//!
//! Owns that the bits of every score stay the same. Conversion is exact, and the sum over decoded terms
//! is that over compact ones.

use super::wire::{TermValues, decoded_at};
use super::{Stored, Template};

/// Room for one decoded term, as bytes of four `f32`.
pub type DecodedTerm = [[u8; 4]; 4];

impl<'a> Template<'a> {
    /// How many elements of room [`Template::decoded`] takes; 0 for a template without compact terms.
    #[must_use]
    pub fn decoded_len(&self) -> usize {
        match self.values {
            TermValues::Compact(bytes) => decoded_at(bytes.len()),
            TermValues::Exact(_) | TermValues::Decoded(..) | TermValues::Map(_) => 0,
        }
    }

    /// The same template, with compact terms decoded into `room`; any other is returned as it is. The
    /// same bits, in less time on a host, for 16 bytes a term.
    ///
    /// `None` where `room` is shorter than [`Template::decoded_len`].
    #[must_use]
    pub fn decoded<'b>(&self, room: &'b mut [DecodedTerm]) -> Option<Template<'b>>
    where
        'a: 'b,
    {
        let mut template: Template<'b> = self.clone();
        let TermValues::Compact(bytes) = self.values else {
            return Some(template);
        };
        let room = room.get_mut(..self.decoded_len())?;
        for stored in self.stored() {
            decode(stored, room)?;
        }
        template.values = TermValues::Decoded(bytes, room);
        Some(template)
    }
}

/// Decodes a component's terms to their place: all x, all y, all z, all weights.
fn decode(stored: Stored<'_>, room: &mut [DecodedTerm]) -> Option<()> {
    let (first, count) = stored.term_range()?;
    let words = room.get_mut(decoded_at(first)..)?.get_mut(..count)?;
    let (x, rest) = words.as_flattened_mut().split_at_mut_checked(count)?;
    let (y, rest) = rest.split_at_mut_checked(count)?;
    let (z, weights) = rest.split_at_mut_checked(count)?;
    let places = x.iter_mut().zip(y).zip(z).zip(weights);
    for ((((x, y), z), weight), (direction, steps)) in places.zip(stored.terms().steps()) {
        let [a, b, c] = direction.map(f32::to_le_bytes);
        (*x, *y, *z, *weight) = (a, b, c, steps.to_le_bytes());
    }
    Some(())
}
