//! The directions in which a component may speak, and where in space what it says must lie.
//!
//! Owns the two grids that validity is written on: an octahedral one over the directions from a
//! reference point, and a cubic one over the object's bounding sphere, in which boxes are given.
//! How both lie in a file is [`crate::template`]'s; which component is asked is [`crate::mixture`]'s.
//!
//! The octahedral map (Cigolle et al., A Survey of Efficient Representations for Independent Unit
//! Vectors, JCGT 2014) projects a direction onto the octahedron |a| + |b| + |c| = 1 and folds the
//! half with c < 0 outward, which fills a square. The axis that is c is chosen for each component,
//! so that the directions it knows lie around the middle of the square rather than across its fold.

use crate::math::{self, Real};
use serde::{Deserialize, Serialize};

/// Most cells along a side of the grid of directions.
pub const LARGEST_SIDE: u8 = 64;

/// Steps of the grid of boxes along each axis; a position is a whole number from 0 to this less one.
pub const BOX_STEPS: u8 = 128;

/// Which half axis points at the middle of the octahedral map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Pole {
    /// +z: (a, b, c) = (x, y, z).
    PlusZ,
    /// +x: (y, z, x).
    PlusX,
    /// +y: (z, x, y).
    PlusY,
    /// −z: (x, y, −z).
    MinusZ,
    /// −x: (y, z, −x).
    MinusX,
    /// −y: (z, x, −y).
    MinusY,
}

impl Pole {
    /// All of them, by their numbers in a file.
    pub const ALL: [Self; 6] = [
        Self::PlusZ,
        Self::PlusX,
        Self::PlusY,
        Self::MinusZ,
        Self::MinusX,
        Self::MinusY,
    ];

    /// The one with this number in a file.
    #[must_use]
    pub const fn from_number(number: u8) -> Option<Self> {
        match number {
            0 => Some(Self::PlusZ),
            1 => Some(Self::PlusX),
            2 => Some(Self::PlusY),
            3 => Some(Self::MinusZ),
            4 => Some(Self::MinusX),
            5 => Some(Self::MinusY),
            _ => None,
        }
    }

    /// x, y, z as a, b, c.
    #[inline]
    const fn turn(self, [x, y, z]: [f32; 3]) -> [f32; 3] {
        match self {
            Self::PlusZ => [x, y, z],
            Self::PlusX => [y, z, x],
            Self::PlusY => [z, x, y],
            Self::MinusZ => [x, y, -z],
            Self::MinusX => [y, z, -x],
            Self::MinusY => [z, x, -y],
        }
    }

    /// a, b, c as x, y, z.
    #[inline]
    const fn turn_back(self, [a, b, c]: [f32; 3]) -> [f32; 3] {
        match self {
            Self::PlusZ => [a, b, c],
            Self::PlusX => [c, a, b],
            Self::PlusY => [b, c, a],
            Self::MinusZ => [a, b, -c],
            Self::MinusX => [-c, a, b],
            Self::MinusY => [b, -c, a],
        }
    }
}

/// A cell of the grid of directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cell {
    /// From 0, along a.
    pub column: u8,
    /// From 0, along b.
    pub row: u8,
}

/// (p, q): where a direction lies on the octahedral map, from −1 to 1.
pub type Square = [f32; 2];

/// Where the direction of `offset` lies: with s = (|a| + |b|) + |c|, p = a·(1/s), q = b·(1/s), and for
/// c < 0 the folded (1 − |q|)·sign p, (1 − |p|)·sign q in their place (of 0 the sign is +).
///
/// The offset need not be of any length. One that is 0 or not finite lies nowhere.
#[must_use]
#[inline(never)]
pub fn square(pole: Pole, offset: [f32; 3]) -> Square {
    project(pole, offset)
}

/// [`square`], for where it is most of what is done.
#[inline(always)]
pub(crate) fn project(pole: Pole, offset: [f32; 3]) -> Square {
    let [a, b, c] = pole.turn(offset);
    let inverse = 1.0 / ((math::abs(a) + math::abs(b)) + math::abs(c));
    let (mut p, mut q) = (a * inverse, b * inverse);
    if c < 0.0 {
        (p, q) = (folded(p, q), folded(q, p));
    }
    [p, q]
}

/// The gradient over the direction `u` of what has the gradient `over` on the octahedral map, as a vector
/// of the frame that `u` is in; along the folds that of one side.
#[must_use]
pub(crate) fn pull_back(pole: Pole, u: [f32; 3], [over_p, over_q]: Square) -> [f32; 3] {
    let sign = |t: f32| if t < 0.0 { -1.0 } else { 1.0 };
    let [a, b, c] = pole.turn(u);
    let inverse = 1.0 / ((math::abs(a) + math::abs(b)) + math::abs(c));
    let (mut p, mut q) = (over_p, over_q);
    if c < 0.0 {
        let both = -(sign(a) * sign(b));
        (p, q) = (both * over_q, both * over_p);
    }
    // The sum of magnitudes, which a and b are divided by, grows with each of them.
    let shared = (p * a + q * b) * (inverse * inverse);
    pole.turn_back([
        p * inverse - sign(a) * shared,
        q * inverse - sign(b) * shared,
        -(sign(c) * shared),
    ])
}

/// The cell of a grid of `side`² cells that holds a place: column and row are ⌊(p + 1)·(side/2)⌋ and
/// ⌊(q + 1)·(side/2)⌋, at most side − 1. What lies nowhere falls into some cell.
#[must_use]
#[inline]
pub fn cell_at(side: u8, [p, q]: Square) -> Cell {
    let half = 0.5 * f32::from(side);
    // Rust's conversion rounds down what is not negative, and takes NaN for 0. To a whole word it is
    // one instruction where there is a floating-point unit, to a byte it is seven.
    let last = u32::from(side.saturating_sub(1));
    let index = |t: f32| (((t + 1.0) * half) as u32).min(last) as u8;
    Cell {
        column: index(p),
        row: index(q),
    }
}

/// The cell that the direction of `offset` falls into, of a grid of `side`² cells.
#[must_use]
#[inline]
pub fn cell(pole: Pole, side: u8, offset: [f32; 3]) -> Cell {
    cell_at(side, square(pole, offset))
}

/// (1 − |other|)·sign t.
#[inline]
fn folded(t: f32, other: f32) -> f32 {
    let rest = 1.0 - math::abs(other);
    if t < 0.0 { -rest } else { rest }
}

/// The directions of a cell: what is `at` 0 to 1 along its column and its row, as a unit vector.
#[must_use]
pub fn direction(pole: Pole, side: u8, cell: Cell, [column, row]: [f32; 2]) -> [f32; 3] {
    let map = |index: u8, at: f32| 2.0 * (f32::from(index) + at) / f32::from(side) - 1.0;
    let (mut p, mut q) = (map(cell.column, column), map(cell.row, row));
    let c = (1.0 - math::abs(p)) - math::abs(q);
    if c < 0.0 {
        (p, q) = (folded(p, q), folded(q, p));
    }
    let length = math::dot([p, q, c], [p, q, c]).square_root();
    pole.turn_back([p / length, q / length, c / length])
}

/// The grid that boxes are given in: [`BOX_STEPS`] steps along each edge of the cube around the
/// object's bounding sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoxGrid {
    origin: [f32; 3],
    inverse_step: f32,
}

impl BoxGrid {
    /// Of a bounding sphere: its cube's corner is `centre` − `radius`, a step is 2·radius/128.
    #[must_use]
    pub fn new([x, y, z]: [f32; 3], radius: f32) -> Self {
        Self {
            origin: [x - radius, y - radius, z - radius],
            inverse_step: f32::from(BOX_STEPS) * 0.5 / radius,
        }
    }

    /// ⌊(point − corner)·(1/step)⌋ of each coordinate, at least 0 and at most 127.
    #[must_use]
    #[inline]
    pub fn position(&self, [x, y, z]: [f32; 3]) -> [u8; 3] {
        let [ox, oy, oz] = self.origin;
        let index = |t: f32| ((t * self.inverse_step) as u32).min(u32::from(BOX_STEPS) - 1) as u8;
        [index(x - ox), index(y - oy), index(z - oz)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIDES: [u8; 3] = [8, 12, 64];

    #[test]
    fn the_middle_of_every_cell_falls_into_it_for_every_pole() {
        for pole in Pole::ALL {
            for side in SIDES {
                for row in 0..side {
                    for column in 0..side {
                        let expected = Cell { column, row };
                        let middle = direction(pole, side, expected, [0.5, 0.5]);
                        assert_eq!(cell(pole, side, middle), expected, "{pole:?} {side}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_length_of_an_offset_does_not_matter_and_nothing_leaves_the_grid() {
        for pole in Pole::ALL {
            for offset in [[1.0, 2.0, -3.0], [0.0, 0.0, -1.0], [-1.0, -1.0, -1e-6]] {
                let scaled = offset.map(|x: f32| x * 64.0);
                assert_eq!(cell(pole, 64, offset), cell(pole, 64, scaled));
            }
            for strange in [0.0, f32::NAN, f32::INFINITY, f32::MAX, -f32::MAX] {
                let found = cell(pole, 64, [strange, strange, -strange]);
                assert!(found.column < 64 && found.row < 64);
            }
        }
    }

    #[test]
    fn the_pole_points_at_the_middle_of_the_map() {
        let axes = [
            [0.0, 0.0, 1.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, -1.0],
            [-1.0, 0.0, 0.0],
            [0.0, -1.0, 0.0],
        ];
        for (number, (pole, axis)) in (0_u8..).zip(Pole::ALL.into_iter().zip(axes)) {
            let middle = Cell { column: 4, row: 4 };
            assert_eq!(cell(pole, 8, axis), middle, "{pole:?}");
            assert_eq!(Pole::from_number(number), Some(pole));
            assert_eq!(pole as u8, number);
        }
        assert_eq!(Pole::from_number(6), None);
    }

    #[test]
    fn positions_in_the_grid_of_boxes_are_clamped_to_it() {
        let grid = BoxGrid::new([10.0, 0.0, -10.0], 64.0);
        assert_eq!(grid.position([10.0, 0.0, -10.0]), [64, 64, 64]);
        assert_eq!(grid.position([10.5, -0.5, 1e9]), [64, 63, 127]);
        assert_eq!(grid.position([f32::NAN, -1e9, f32::INFINITY]), [0, 0, 127]);
    }
}
