//! Writes where components may speak: the two levels of a grid of directions.
//!
//! Most blocks of 4 × 4 cells are wholly valid or wholly not, and take two bits; the others are
//! spelled out. Rows of blocks without a valid cell before the first and behind the last are left out.

use super::encode::byte_array;
use super::source::{ComponentSource, ValiditySource};
use super::wire::{BLOCK_SIDE, LEAF_LENGTH, MOST_BLOCKS, ROW_LENGTH, VALIDITY_LENGTH};
use core::ops::Range;
use serde::{Serialize, Serializer};

/// A grid of directions in blocks.
#[derive(Clone, Copy)]
struct Blocks<'a>(ValiditySource<'a>);

impl Blocks<'_> {
    fn along(self) -> u8 {
        // The length is asked for before the side is refused.
        (self.0.side / BLOCK_SIDE).min(MOST_BLOCKS)
    }

    /// The block's cells, one bit each.
    fn leaf(self, row: u8, column: u8) -> u16 {
        let side = usize::from(self.0.side);
        let (row, column) = (
            usize::from(row * BLOCK_SIDE),
            usize::from(column * BLOCK_SIDE),
        );
        let mut leaf = 0;
        for bit in 0..16 {
            let place = (row + bit / 4) * side + column + bit % 4;
            if self.0.cells.get(place) == Some(&true) {
                leaf |= 1 << bit;
            }
        }
        leaf
    }

    /// Which blocks of a row are wholly valid, and which in part.
    fn row(self, row: u8) -> (u16, u16) {
        let (mut full, mut mixed) = (0, 0);
        for column in 0..self.along() {
            match self.leaf(row, column) {
                0 => {}
                u16::MAX => full |= 1 << column,
                _ => mixed |= 1 << column,
            }
        }
        (full, mixed)
    }

    /// The rows that are written; none where no cell is valid.
    fn rows(self) -> Range<u8> {
        let holds = |row: &u8| self.row(*row) != (0, 0);
        let first = (0..self.along()).find(holds);
        let last = (0..self.along()).rfind(holds);
        first.unwrap_or(0)..last.map_or(0, |last| last + 1)
    }

    fn mixed(self) -> u16 {
        let blocks = self.rows().map(|row| self.row(row).1.count_ones());
        blocks.sum::<u32>() as u16
    }

    fn length(self) -> usize {
        self.rows().len() * ROW_LENGTH + usize::from(self.mixed()) * LEAF_LENGTH
    }

    /// The leaves of a row's mixed blocks.
    fn leaves(self, row: u8) -> impl Iterator<Item = u16> {
        let leaves = (0..self.along()).map(move |column| self.leaf(row, column));
        leaves.filter(|leaf| !matches!(*leaf, 0 | u16::MAX))
    }

    fn bytes(self) -> impl Iterator<Item = u8> {
        let mut rank = 0_u8;
        let rows = self.rows().flat_map(move |row| {
            let (full, mixed) = self.row(row);
            let [f0, f1] = full.to_le_bytes();
            let [m0, m1] = mixed.to_le_bytes();
            let before = rank;
            // A row has at most 16 of them, and only the last row's sum can exceed a byte.
            rank = rank.wrapping_add(mixed.count_ones() as u8);
            [f0, f1, m0, m1, before]
        });
        let leaves = self.rows().flat_map(move |row| self.leaves(row));
        rows.chain(leaves.flat_map(u16::to_le_bytes))
    }
}

/// The bytes of a component's cells.
pub(super) fn run_length(source: ValiditySource<'_>) -> usize {
    Blocks(source).length()
}

fn blocks<'a>(components: &'a [ComponentSource<'a>]) -> impl Iterator<Item = Blocks<'a>> {
    components.iter().filter_map(|c| c.validity).map(Blocks)
}

/// One record a component.
pub(super) struct Records<'a>(pub(super) &'a [ComponentSource<'a>]);

impl Serialize for Records<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut next = 0_u32;
        let records = blocks(self.0).flat_map(|blocks| {
            let Blocks(source) = blocks;
            let [lx, ly, lz] = source.low;
            let [hx, hy, hz] = source.high;
            let rows = blocks.rows();
            let [m0, m1] = blocks.mixed().to_le_bytes();
            let offset = next;
            next = next.saturating_add(u32::try_from(blocks.length()).unwrap_or(u32::MAX));
            [
                [lx, ly, lz, source.pole as u8],
                [hx, hy, hz, blocks.along()],
                [rows.start, rows.len() as u8, m0, m1],
                offset.to_le_bytes(),
            ]
            .into_iter()
            .flatten()
        });
        let length = self.0.len().saturating_mul(VALIDITY_LENGTH);
        byte_array(serializer, length, records)
    }
}

/// The components' cells.
pub(super) struct Cells<'a>(pub(super) &'a [ComponentSource<'a>]);

impl Serialize for Cells<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let lengths = blocks(self.0).map(Blocks::length);
        let length = lengths.fold(0, usize::saturating_add);
        byte_array(serializer, length, blocks(self.0).flat_map(Blocks::bytes))
    }
}
