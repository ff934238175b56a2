//! Where components may speak, as it lies in the file.
//!
//! Owns the two-level grid of directions and the boxes; the grids themselves are
//! [`crate::validity`]'s. Scoring asks the cell of a direction in three steps: the row of blocks, the
//! block's two bits, and of a block that is valid in part its cells.

use super::wire::{BLOCK_SIDE, LEAF_LENGTH, ROW_LENGTH, ValidityRecord};
use crate::validity::{BOX_STEPS, Cell, Pole, Square, cell_at, project};

/// The validities of all components.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Validities<'a> {
    pub(super) records: &'a [ValidityRecord],
    pub(super) cells: &'a [u8],
}

impl<'a> Validities<'a> {
    /// Component `index`'s.
    #[inline]
    pub(crate) fn get(&self, index: usize) -> Option<Validity<'a>> {
        Some(Validity {
            record: self.records.get(index)?,
            cells: self.cells,
        })
    }
}

/// Where one component may speak: the directions from its reference point, and the box in
/// [`crate::validity::BoxGrid`] that the point it predicts must lie in.
#[derive(Clone, Copy, Debug)]
pub struct Validity<'a> {
    record: &'a ValidityRecord,
    cells: &'a [u8],
}

/// Equal where the same directions and the same box are, wherever the bytes lie.
impl PartialEq for Validity<'_> {
    fn eq(&self, other: &Self) -> bool {
        let box_and_grid = |validity: &Self| {
            let [lows, highs, ..] = *validity.record;
            (lows, highs)
        };
        let [.., rows, _] = *self.record;
        let [.., other_rows, _] = *other.record;
        box_and_grid(self) == box_and_grid(other) && rows == other_rows && self.run() == other.run()
    }
}

/// The rows of a component's blocks, and the cells of those that are mixed.
type Run<'a> = (&'a [[u8; ROW_LENGTH]], &'a [[u8; LEAF_LENGTH]]);

/// What a row of blocks says.
#[derive(Clone, Copy)]
pub(super) struct Row {
    /// Bit c: all cells of block c are valid.
    pub(super) full: u16,
    /// Bit c: some are.
    pub(super) mixed: u16,
    /// How many mixed blocks the rows before it have.
    pub(super) rank: u8,
}

impl Row {
    #[inline(always)]
    pub(super) fn from_bytes([f0, f1, m0, m1, rank]: [u8; ROW_LENGTH]) -> Self {
        Self {
            full: u16::from_le_bytes([f0, f1]),
            mixed: u16::from_le_bytes([m0, m1]),
            rank,
        }
    }
}

impl<'a> Validity<'a> {
    /// Which half axis points at the middle of the map of directions.
    #[must_use]
    #[inline(always)]
    pub fn pole(&self) -> Pole {
        // Loading has refused any other number.
        Pole::from_number(self.pole_number()).unwrap_or(Pole::PlusZ)
    }

    #[inline(always)]
    pub(super) fn pole_number(&self) -> u8 {
        let [[_, _, _, pole], ..] = *self.record;
        pole
    }

    /// Blocks along a side.
    #[inline(always)]
    pub(super) fn blocks(&self) -> u8 {
        let [_, [_, _, _, blocks], ..] = *self.record;
        blocks
    }

    /// Cells along a side of the map.
    #[must_use]
    #[inline(always)]
    pub fn side(&self) -> u8 {
        // Loading has refused more than 16.
        self.blocks().wrapping_mul(BLOCK_SIDE)
    }

    /// The least position of the box along each axis.
    #[must_use]
    pub fn low(&self) -> [u8; 3] {
        let [[x, y, z, _], ..] = *self.record;
        [x, y, z]
    }

    /// The largest.
    #[must_use]
    pub fn high(&self) -> [u8; 3] {
        let [_, [x, y, z, _], ..] = *self.record;
        [x, y, z]
    }

    /// The first row of blocks, and how many there are.
    #[inline(always)]
    pub(super) fn rows(&self) -> (u8, u8) {
        let [_, _, [first, rows, ..], _] = *self.record;
        (first, rows)
    }

    /// How many mixed blocks there are.
    pub(super) fn mixed(&self) -> u16 {
        let [_, _, [_, _, m0, m1], _] = *self.record;
        u16::from_le_bytes([m0, m1])
    }

    /// Where its cells start.
    #[inline(always)]
    pub(super) fn first(&self) -> u32 {
        let [.., first] = *self.record;
        u32::from_le_bytes(first)
    }

    /// Its rows and the cells of its mixed blocks, where they lie inside the section.
    pub(super) fn run(&self) -> Option<Run<'a>> {
        let (_, rows) = self.rows();
        let behind = self.cells.get(usize::try_from(self.first()).ok()?..)?;
        let (rows, leaves) = behind.split_at_checked(usize::from(rows) * ROW_LENGTH)?;
        let leaves = leaves.as_chunks().0.get(..usize::from(self.mixed()))?;
        Some((rows.as_chunks().0, leaves))
    }

    /// Whether the component may speak in the direction of this offset from its reference point,
    /// which need not be of any length.
    #[must_use]
    pub fn contains_direction(&self, offset: [f32; 3]) -> bool {
        self.square(offset).is_some()
    }

    /// Where the direction of this offset from the reference point lies on the map of directions, if
    /// the component may speak in it.
    #[inline(never)]
    pub(crate) fn square(&self, offset: [f32; 3]) -> Option<Square> {
        self.locate(offset)
    }

    /// [`Validity::square`], for where it is most of what is done.
    #[inline(always)]
    pub(crate) fn locate(&self, offset: [f32; 3]) -> Option<Square> {
        let square = project(self.pole(), offset);
        self.contains(cell_at(self.side(), square))
            .then_some(square)
    }

    /// Whether a cell is valid.
    #[must_use]
    #[inline(always)]
    pub fn contains(&self, cell: Cell) -> bool {
        self.find(cell).unwrap_or(false)
    }

    /// `None` for a row that has no valid cell.
    #[inline(always)]
    fn find(&self, cell: Cell) -> Option<bool> {
        let (first, rows) = self.rows();
        let row = (cell.row / BLOCK_SIDE).checked_sub(first)?;
        if row >= rows {
            return None;
        }
        // Loading has refused a component whose rows and cells do not lie inside the section.
        let run = self.cells.get(usize::try_from(self.first()).ok()?..)?;
        let at = |row: u8| usize::from(row) * ROW_LENGTH;
        let row = Row::from_bytes(*run.get(at(row)..)?.first_chunk()?);
        let block = 1_u16.wrapping_shl(u32::from(cell.column / BLOCK_SIDE));
        if row.full & block != 0 {
            return Some(true);
        }
        if row.mixed & block == 0 {
            return Some(false);
        }
        let before = (row.mixed & block.wrapping_sub(1)).count_ones();
        let leaf = usize::from(row.rank).saturating_add(before as usize) * LEAF_LENGTH;
        let leaf = run.get(at(rows).saturating_add(leaf)..)?.first_chunk()?;
        let bit = (cell.row % BLOCK_SIDE) * BLOCK_SIDE + cell.column % BLOCK_SIDE;
        Some((u16::from_le_bytes(*leaf) >> bit) & 1 != 0)
    }

    /// The valid cells, row by row.
    pub fn cells(self) -> impl Iterator<Item = Cell> + use<'a> {
        let side = self.side();
        (0..side)
            .flat_map(move |row| (0..side).map(move |column| Cell { column, row }))
            .filter(move |cell| self.contains(*cell))
    }

    /// Whether the box and the window have a position in common.
    #[must_use]
    #[inline]
    pub(crate) fn meets(&self, window: Window) -> bool {
        let [lows, highs, ..] = *self.record;
        // No lane borrows from the next: the bit that is set above a position covers any other, and
        // what lies in the fourth borrows from none.
        let reaches = (u32::from_le_bytes(highs) | LANES).wrapping_sub(window.low);
        let starts = (window.high | LANES).wrapping_sub(u32::from_le_bytes(lows));
        reaches & starts & LANES == LANES
    }
}

/// The bit above each of three positions in a word.
const LANES: u32 = u32::from_le_bytes([BOX_STEPS, BOX_STEPS, BOX_STEPS, 0]);

/// A box of positions, those of an axis in a byte.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Window {
    low: u32,
    high: u32,
}

impl Window {
    /// Its ends along each axis.
    #[inline]
    pub(crate) const fn axes(self) -> [(u8, u8); 3] {
        let [x, y, z, _] = self.low.to_le_bytes();
        let [u, v, w, _] = self.high.to_le_bytes();
        [(x, u), (y, v), (z, w)]
    }

    /// From one position to another.
    #[inline]
    pub(crate) const fn between([x, y, z]: [u8; 3], [u, v, w]: [u8; 3]) -> Self {
        Self {
            low: u32::from_le_bytes([x, y, z, 0]),
            high: u32::from_le_bytes([u, v, w, 0]),
        }
    }
}
