//! The posterior mean as a map over directions: sixteen nodes a point, however many points it was
//! fitted to.
//!
//! Owns what the numbers of a map mean and the order in which they are added, which is part of the
//! template format. The square that the map lies on is that of [`crate::validity`], so that scoring
//! projects a direction once for both; where a map may be asked is validity's to say.
//!
//! The nodes are the coefficients of a uniform cubic B-spline and not values of the mean: what they
//! stand for is fitted where the component is valid, so that neither the folds of the octahedral map
//! nor what the process extrapolates beside its own surface costs more than the rows it lies in. A byte
//! a node: twice as many nodes reproduce the mean better than twice the precision.
//!
//! # Order of operations
//! x = p·s + x₀ and y = q·s + y₀. The column c is ⌊x⌋, at least 0 and at most columns − 4, and 0 of what
//! is no number; t = x − c, r = 1 − t, and the weights along a row are w₀ = (r·r)·r,
//! w₁ = ((3·t − 6)·(t·t)) + 4, w₂ = ((3·r − 6)·(r·r)) + 4, w₃ = (t·t)·t. The row and the weights along a
//! column follow from y the same way. Of each of four rows the sum is
//! (w₀n₀ + w₁n₁) + (w₂n₂ + w₃n₃) of its four nodes from column c on, and S is the same of the four sums
//! with the weights along the column. The mean is m + scale·S. Weights add up to 6 each way, and the
//! scale makes up for it.

use super::Word;
use crate::validity::{Pole, Square};

/// Bytes before the nodes: scale, s, x₀, y₀ (`f32`), columns, rows, the pole's number, 0.
pub(crate) const HEADER_LENGTH: usize = HEADER_WORDS * size_of::<Word>();

const HEADER_WORDS: usize = 5;

/// Nodes along each side that one point reads.
const SUPPORT: u8 = 4;

/// Nodes that one point reads.
pub const READS: usize = SUPPORT as usize * SUPPORT as usize;

/// What lies before the nodes.
pub(crate) type Header = [Word; HEADER_WORDS];

/// The map of one component, where it lies in the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Map<'a> {
    header: &'a Header,
    nodes: &'a [u8],
}

impl<'a> Map<'a> {
    #[inline]
    pub(crate) const fn new(header: &'a Header, nodes: &'a [u8]) -> Self {
        Self { header, nodes }
    }

    /// What the sum over the nodes is multiplied by.
    #[must_use]
    #[inline(always)]
    pub fn scale(&self) -> f32 {
        let [scale, ..] = *self.header;
        f32::from_le_bytes(scale)
    }

    /// s: nodes in a unit of the square, of which a side is 2.
    #[must_use]
    #[inline(always)]
    pub fn spacing(&self) -> f32 {
        let [_, spacing, ..] = *self.header;
        f32::from_le_bytes(spacing)
    }

    /// (x₀, y₀): the place of the middle of the square, in nodes.
    #[must_use]
    #[inline(always)]
    pub fn origin(&self) -> [f32; 2] {
        let [_, _, x, y, _] = *self.header;
        [f32::from_le_bytes(x), f32::from_le_bytes(y)]
    }

    /// Nodes in a row.
    #[must_use]
    #[inline(always)]
    pub fn columns(&self) -> u8 {
        let [.., [columns, ..]] = *self.header;
        columns
    }

    /// Rows of nodes.
    #[must_use]
    #[inline(always)]
    pub fn rows(&self) -> u8 {
        let [.., [_, rows, ..]] = *self.header;
        rows
    }

    /// Which half axis points at the middle of the square.
    #[must_use]
    pub fn pole(&self) -> Pole {
        // Loading has refused any other number.
        Pole::from_number(self.pole_number()).unwrap_or(Pole::PlusZ)
    }

    pub(crate) fn pole_number(&self) -> u8 {
        let [.., [_, _, pole, _]] = *self.header;
        pole
    }

    /// Whether there are as many nodes as columns and rows say, at least four of each, and nothing
    /// where nothing belongs.
    pub(crate) fn is_whole(&self) -> bool {
        let [.., [columns, rows, _, reserved]] = *self.header;
        let nodes = u16::from(columns) * u16::from(rows);
        columns >= SUPPORT
            && rows >= SUPPORT
            && usize::from(nodes) == self.nodes.len()
            && reserved == 0
    }

    /// How many nodes there are.
    pub(super) const fn len(&self) -> usize {
        self.nodes.len()
    }

    /// The nodes, row by row.
    pub fn nodes(&self) -> impl ExactSizeIterator<Item = i8> + use<'a> {
        self.nodes.iter().map(|node| *node as i8)
    }

    /// scale·S of the module's documentation; NaN where there is no such node, which loading has
    /// refused.
    #[inline]
    pub(crate) fn above_prior(&self, [p, q]: Square) -> f32 {
        let (spacing, [x, y]) = (self.spacing(), self.origin());
        let (column, across) = place(p * spacing + x, self.columns());
        let (row, along) = place(q * spacing + y, self.rows());
        let columns = usize::from(self.columns());
        let first = usize::from(row) * columns + usize::from(column);
        #[cfg(test)]
        super::evaluations::add(READS);
        let sums = || {
            let (one, rest) = four(self.nodes.get(first..)?, columns, across)?;
            let (two, rest) = four(rest, columns, across)?;
            let (three, rest) = four(rest, columns, across)?;
            // The last row may end with its fourth node.
            let (last, _) = four(rest, 0, across)?;
            Some([one, two, three, last])
        };
        sums().map_or(f32::NAN, |sums| self.scale() * dot(along, sums))
    }

    /// The derivative of [`Map::above_prior`] along p and along q: (scale·s)·S, with the weights' derivatives
    /// in their place along the one side and the weights along the other.
    pub(crate) fn gradient(&self, [p, q]: Square) -> Square {
        let (spacing, [x, y]) = (self.spacing(), self.origin());
        let (x, y) = (p * spacing + x, q * spacing + y);
        let (column, across) = place(x, self.columns());
        let (row, along) = place(y, self.rows());
        let columns = usize::from(self.columns());
        let first = usize::from(row) * columns + usize::from(column);
        let sums = |weights: [f32; 4]| {
            let (one, rest) = four(self.nodes.get(first..)?, columns, weights)?;
            let (two, rest) = four(rest, columns, weights)?;
            let (three, rest) = four(rest, columns, weights)?;
            let (last, _) = four(rest, 0, weights)?;
            Some([one, two, three, last])
        };
        let factor = self.scale() * spacing;
        let slope = |weights, sums: Option<[f32; 4]>| {
            sums.map_or(f32::NAN, |sums| factor * dot(weights, sums))
        };
        [
            slope(along, sums(slopes(x - f32::from(column)))),
            slope(slopes(y - f32::from(row)), sums(across)),
        ]
    }
}

/// The derivatives of the four weights: −3r², 9t² − 12t, 12r − 9r², 3t².
#[inline]
fn slopes(t: f32) -> [f32; 4] {
    let r = 1.0 - t;
    let inner = |t: f32| (9.0 * t - 12.0) * t;
    [-3.0 * (r * r), inner(t), -inner(r), 3.0 * (t * t)]
}

/// The first of the four nodes along a side that `at` lies among, and their weights.
#[inline]
fn place(at: f32, nodes: u8) -> (u8, [f32; 4]) {
    // Rust's conversion rounds down what is not negative, and takes NaN for 0.
    let most = u32::from(nodes.saturating_sub(SUPPORT));
    let first = (at as u32).min(most) as u8;
    let t = at - f32::from(first);
    let r = 1.0 - t;
    let (tt, rr) = (t * t, r * r);
    let inner = |t: f32, tt: f32| (3.0 * t - 6.0) * tt + 4.0;
    (first, [rr * r, inner(t, tt), inner(r, rr), tt * t])
}

/// The weighted sum of the first four nodes, and what follows a row later.
#[inline]
fn four(nodes: &[u8], columns: usize, weights: [f32; 4]) -> Option<(f32, &[u8])> {
    let [a, b, c, d] = *nodes.first_chunk()?;
    let value = |node: u8| f32::from(node as i8);
    let sum = dot(weights, [value(a), value(b), value(c), value(d)]);
    Some((sum, nodes.get(columns..)?))
}

#[inline]
fn dot([w0, w1, w2, w3]: [f32; 4], [n0, n1, n2, n3]: [f32; 4]) -> f32 {
    (w0 * n0 + w1 * n1) + (w2 * n2 + w3 * n3)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec::Vec;

    fn header(numbers: [f32; 4], columns: u8, rows: u8) -> Header {
        let [scale, spacing, x, y] = numbers.map(f32::to_le_bytes);
        [scale, spacing, x, y, [columns, rows, 0, 0]]
    }

    /// The module's documentation, word by word.
    fn documented(map: &Map<'_>, [p, q]: [f32; 2]) -> f32 {
        let nodes: Vec<f32> = map.nodes().map(f32::from).collect();
        let along = |at: f32, count: u8| {
            let most = count - 4;
            let first = if at.is_nan() || at < 0.0 {
                0
            } else if at >= f32::from(most) {
                most
            } else {
                at as u8
            };
            let t = at - f32::from(first);
            let r = 1.0 - t;
            let w0 = (r * r) * r;
            let w1 = ((3.0 * t - 6.0) * (t * t)) + 4.0;
            let w2 = ((3.0 * r - 6.0) * (r * r)) + 4.0;
            let w3 = (t * t) * t;
            (usize::from(first), [w0, w1, w2, w3])
        };
        let [x0, y0] = map.origin();
        let (column, w) = along(p * map.spacing() + x0, map.columns());
        let (row, v) = along(q * map.spacing() + y0, map.rows());
        let mut sums = [0.0; 4];
        for (j, sum) in sums.iter_mut().enumerate() {
            let n = |i: usize| nodes[(row + j) * usize::from(map.columns()) + column + i];
            *sum = (w[0] * n(0) + w[1] * n(1)) + (w[2] * n(2) + w[3] * n(3));
        }
        let s = (v[0] * sums[0] + v[1] * sums[1]) + (v[2] * sums[2] + v[3] * sums[3]);
        map.scale() * s
    }

    #[test]
    fn the_mean_of_a_map_is_the_documented_one_bit_by_bit() {
        let mut state = 7_u32;
        let mut number = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / (1 << 23) as f32 - 1.0
        };
        for (columns, rows) in [(4, 4), (5, 4), (9, 13), (255, 4), (64, 64)] {
            let count = usize::from(columns) * usize::from(rows);
            let nodes: Vec<u8> = (0..count).map(|_| (number() * 128.0) as i8 as u8).collect();
            let spacing = f32::from(columns) * 0.4;
            let header = header([0.01, spacing, 3.7, 2.1 * number()], columns, rows);
            let map = Map::new(&header, &nodes);
            assert!(map.is_whole());
            let odd = [f32::NAN, f32::INFINITY, -f32::INFINITY, f32::MAX, -0.0, 1.0];
            let near = core::iter::repeat_with(|| [number(), number()]).take(500);
            let squares: Vec<_> = near.chain(odd.map(|p| [p, 0.3])).collect();
            for square in squares.into_iter().chain(odd.map(|q| [-0.2, q])) {
                let (found, expected) = (map.above_prior(square), documented(&map, square));
                let same = found.to_bits() == expected.to_bits();
                assert!(same || (found.is_nan() && expected.is_nan()), "{square:?}");
            }
        }
    }

    #[test]
    fn equal_nodes_are_a_constant_and_rising_ones_a_slope() {
        let nodes: Vec<u8> = (0..64_u8).map(|i| i % 8 * 10).collect();
        let header = header([0.1 / 36.0, 4.0, 2.5, 2.5], 8, 8);
        let map = Map::new(&header, &nodes);
        for step in 0..=16_u8 {
            let p = f32::from(step) / 8.0 - 1.0;
            // Node i of a cubic B-spline is centred on the place i, which is one beyond its own cell.
            let expected = p * 4.0 + 2.5 + 1.0;
            let [a, b] = [-0.3, 0.9].map(|q| map.above_prior([p * 0.6, q * 0.6]));
            let expected = expected * 0.6 + 3.5 * 0.4;
            assert!((a - expected).abs() < 1e-5, "{a} {expected}");
            assert!((a - b).abs() < 1e-5);
        }
    }

    #[test]
    fn nodes_that_are_missing_are_noticed() {
        let header = header([1.0, 4.0, 0.0, 0.0], 4, 4);
        assert!(!Map::new(&header, &[0; 15]).is_whole());
        assert!(Map::new(&header, &[0; 15]).above_prior([0.0; 2]).is_nan());
        let narrow = self::header([1.0, 4.0, 0.0, 0.0], 3, 4);
        assert!(!Map::new(&narrow, &[0; 12]).is_whole());
    }
}
