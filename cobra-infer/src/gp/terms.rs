//! A component's directions and weights where they lie.
//!
//! Owns their encodings, and that all arrays of a component are of one length without a check
//! for each; the sum over them is [`super::sum`]'s, a map in their place [`super::map`]'s.

use super::Word;
use super::compact::{GRID, TERM_LENGTH};
use super::map::Map;

/// The directions and weights of one component: four borrowed arrays of the same length behind each
/// other, at any alignment; each a run of little-endian `f32`, or compact ([`super::compact`]). Or the
/// nodes of a map in their place ([`super::map`]).
///
/// A direction lies in the coordinates of the template's metric: a unit vector, or (φ, θ, 0).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Terms<'a>(pub(super) Encoded<'a>);

/// As many elements as there are terms. What lies in one are not a term's numbers: it is as many bytes
/// as a term has, only so that their number needs no check.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Encoded<'a> {
    /// With the scale of compact terms, in grid steps, where they were decoded.
    Exact {
        quads: &'a [[Word; 4]],
        scale: Option<f32>,
    },
    Compact {
        scale: f32,
        bytes: &'a [[u8; TERM_LENGTH]],
    },
    Map(Map<'a>),
}

/// A number as it lies in a template.
pub(super) trait Number: Copy {
    /// As an `f32`, exactly.
    fn read(self) -> f32;
}

impl Number for Word {
    #[inline(always)]
    fn read(self) -> f32 {
        f32::from_le_bytes(self)
    }
}

/// A number that was converted.
impl Number for f32 {
    #[inline(always)]
    fn read(self) -> f32 {
        self
    }
}

/// A coordinate in grid steps.
impl Number for u8 {
    #[inline(always)]
    fn read(self) -> f32 {
        f32::from(self as i8)
    }
}

/// A weight in units of its component's scale.
impl Number for [u8; 2] {
    #[inline(always)]
    fn read(self) -> f32 {
        f32::from(i16::from_le_bytes(self))
    }
}

/// All x, all y, all z, all weights.
#[derive(Clone, Copy)]
pub(super) struct Arrays<'a, C, W> {
    pub(super) coordinates: [&'a [C]; 3],
    pub(super) weights: &'a [W],
}

/// Always some, but for the compiler, which then sees that the four are of one length.
#[inline]
pub(super) fn exact(quads: &[[Word; 4]]) -> Option<Arrays<'_, Word, Word>> {
    let count = quads.len();
    let (x, rest) = quads.as_flattened().split_at_checked(count)?;
    let (y, rest) = rest.split_at_checked(count)?;
    let (z, rest) = rest.split_at_checked(count)?;
    let (weights, _) = rest.split_at_checked(count)?;
    Some(Arrays {
        coordinates: [x, y, z],
        weights,
    })
}

/// As [`exact`].
#[inline]
pub(super) fn compact(bytes: &[[u8; TERM_LENGTH]]) -> Option<Arrays<'_, u8, [u8; 2]>> {
    let count = bytes.len();
    let (x, rest) = bytes.as_flattened().split_at_checked(count)?;
    let (y, rest) = rest.split_at_checked(count)?;
    let (z, rest) = rest.split_at_checked(count)?;
    let (weights, _) = rest.as_chunks().0.split_at_checked(count)?;
    Some(Arrays {
        coordinates: [x, y, z],
        weights,
    })
}

impl<'a> Terms<'a> {
    #[inline]
    pub(crate) const fn from_quads(quads: &'a [[Word; 4]]) -> Self {
        Self(Encoded::Exact { quads, scale: None })
    }

    /// Of compact terms, decoded: grid steps and weights as `f32`.
    #[inline]
    pub(crate) const fn from_decoded(scale: f32, quads: &'a [[Word; 4]]) -> Self {
        let scale = Some(scale);
        Self(Encoded::Exact { quads, scale })
    }

    /// Of all x, all y, all z (one byte each), all weights (two).
    #[inline]
    pub(crate) const fn from_compact(scale: f32, bytes: &'a [[u8; TERM_LENGTH]]) -> Self {
        Self(Encoded::Compact { scale, bytes })
    }

    #[inline]
    pub(crate) const fn from_map(map: Map<'a>) -> Self {
        Self(Encoded::Map(map))
    }

    /// The map; `None` where there are terms.
    #[must_use]
    pub const fn map(&self) -> Option<Map<'a>> {
        match self.0 {
            Encoded::Map(map) => Some(map),
            Encoded::Exact { .. } | Encoded::Compact { .. } => None,
        }
    }

    /// Of all x, all y, all z, all weights. `None` when the length is not a multiple of four.
    #[must_use]
    pub fn from_words(words: &'a [Word]) -> Option<Self> {
        let (quads, rest) = words.as_chunks();
        rest.is_empty().then_some(Self::from_quads(quads))
    }

    /// How many terms there are; of a map, nodes.
    #[must_use]
    pub fn len(&self) -> usize {
        match self.0 {
            Encoded::Exact { quads, .. } => quads.len(),
            Encoded::Compact { bytes, .. } => bytes.len(),
            Encoded::Map(map) => map.len(),
        }
    }

    /// Whether there is no term.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// What the weights of compact terms are multiplied by; `None` where terms are exact.
    #[must_use]
    pub fn compact_scale(&self) -> Option<f32> {
        match self.0 {
            Encoded::Map(_) => None,
            Encoded::Exact { scale, .. } => scale,
            Encoded::Compact { scale, .. } => Some(scale),
        }
    }

    /// The terms one by one: direction, in the metric's coordinates, and weight. Of compact terms,
    /// the grid's coordinates divided by [`GRID`], and the weight times its scale. Of a map, none.
    pub fn iter(&self) -> impl Iterator<Item = ([f32; 3], f32)> + use<'a> {
        let (decoded, scale) = match self.0 {
            Encoded::Exact { scale: None, .. } | Encoded::Map(_) => (&[][..], 1.0),
            Encoded::Exact {
                quads,
                scale: Some(scale),
            } => (quads, scale),
            Encoded::Compact { scale, .. } => (&[][..], scale),
        };
        let decoded = exact(decoded).into_iter().flat_map(Arrays::iter);
        self.exact().chain(
            self.steps().chain(decoded).map(move |(direction, weight)| {
                (direction.map(|steps| steps / GRID), weight * scale)
            }),
        )
    }

    /// Compact terms as they lie in the file: direction in grid steps, and weight in units of the scale.
    pub(crate) fn steps(&self) -> impl Iterator<Item = ([f32; 3], f32)> + use<'a> {
        let bytes = match self.0 {
            Encoded::Exact { .. } | Encoded::Map(_) => &[][..],
            Encoded::Compact { bytes, .. } => bytes,
        };
        compact(bytes).into_iter().flat_map(Arrays::iter)
    }

    /// The exact terms: of compact ones and of a map, none. Loading looks at these and at the directions of the
    /// others, so that a controller links no loop over both.
    pub(crate) fn exact(&self) -> impl Iterator<Item = ([f32; 3], f32)> + use<'a> {
        let quads = match self.0 {
            Encoded::Exact { quads, scale: None } => quads,
            Encoded::Exact { .. } | Encoded::Compact { .. } | Encoded::Map(_) => &[],
        };
        exact(quads).into_iter().flat_map(Arrays::iter)
    }

    /// The directions of compact terms, in grid steps.
    pub(crate) fn grid_directions(&self) -> impl Iterator<Item = [i8; 3]> + use<'a> {
        let bytes = match self.0 {
            Encoded::Exact { .. } | Encoded::Map(_) => &[][..],
            Encoded::Compact { bytes, .. } => bytes,
        };
        compact(bytes).into_iter().flat_map(|arrays| {
            let [x, y, z] = arrays.coordinates;
            let directions = x.iter().zip(y).zip(z);
            directions.map(|((x, y), z)| [*x as i8, *y as i8, *z as i8])
        })
    }
}

impl<'a, C: Number, W: Number> Arrays<'a, C, W> {
    /// The numbers of the terms, one by one.
    pub(super) fn iter(self) -> impl Iterator<Item = ([f32; 3], f32)> + use<'a, C, W> {
        let [x, y, z] = self.coordinates;
        x.iter()
            .zip(y)
            .zip(z)
            .zip(self.weights)
            .map(|(((x, y), z), w)| ([x.read(), y.read(), z.read()], w.read()))
    }
}
