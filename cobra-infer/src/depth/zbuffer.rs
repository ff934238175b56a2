//! Which of the surface's points a camera sees: a small depth buffer in the caller's memory.
//!
//! Owns the cells over the rectangle of the image that the object's bounding sphere projects into. Each
//! keeps the nearest of the points that fall into it, with its place inside the cell, so that the buffer is
//! also the list of visible points.

use super::pulse::Pulse;
use nalgebra::Point2;

/// A cell of the buffer: four bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cell {
    depth: u16,
    place: [u8; 2],
}

/// What is nearer than a neighbour by more than this share of the diameter may hide it.
const HIDING_SHARE: f32 = 0.05;

/// So many of the eight cells around one must be nearer to hide it.
const HIDING: u32 = 3;

/// The depth of a cell that holds nothing.
const EMPTY: u16 = u16::MAX;

impl Cell {
    /// Of nothing.
    pub const EMPTY: Self = Self {
        depth: EMPTY,
        place: [0; 2],
    };
}

impl Default for Cell {
    fn default() -> Self {
        Self::EMPTY
    }
}

/// A point of the surface that the camera sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Visible {
    pub(super) pixel: Point2<f32>,
    pub(super) depth: f32,
}

/// A square of the image, and the depths that are expected in it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Window {
    pub(super) middle: Point2<f32>,
    /// Half its side, in pixels.
    pub(super) half: f32,
    pub(super) near: f32,
    /// How far behind `near` the depths reach.
    pub(super) range: f32,
}

impl Window {
    /// How wide and high its cells are, in pixels: as small as it takes, but no smaller than a pixel, so
    /// that no pixel is evidence twice.
    pub(super) fn cell(&self, side: u16) -> f32 {
        let size = 2.0 * self.half / f32::from(side);
        if size > 1.0 { size } else { 1.0 }
    }
}

/// `side`² cells over a square of the image.
#[derive(Debug)]
pub(super) struct ZBuffer<'m> {
    cells: &'m mut [Cell],
    side: u16,
    corner: [f32; 2],
    size: f32,
    near: f32,
    step: f32,
    /// What is nearer than its neighbour by more than this hides it, in depth steps.
    margin: u16,
}

/// As far as an `i32` reaches.
fn nearest_integer(number: f32) -> f32 {
    let half = if number < 0.0 { -0.5 } else { 0.5 };
    (number + half) as i32 as f32
}

impl<'m> ZBuffer<'m> {
    /// Over a window, with `side`² cells.
    pub(super) fn new(cells: &'m mut [Cell], side: u16, window: Window, diameter: f32) -> Self {
        cells.fill(Cell::EMPTY);
        let step = window.range / f32::from(EMPTY - 1);
        let size = window.cell(side);
        let half = 0.5 * size * f32::from(side);
        let corner = [window.middle.x - half, window.middle.y - half];
        Self {
            cells,
            side,
            // Cells of a pixel are pixels, whose centres are at integers.
            corner: if size > 1.0 {
                corner
            } else {
                corner.map(|edge| nearest_integer(edge) - 0.5)
            },
            size,
            near: window.near,
            step,
            margin: (HIDING_SHARE * diameter / step) as u16,
        }
    }

    /// Takes a point in: the nearest in its cell stays, of equals the first.
    pub(super) fn insert(&mut self, pixel: Point2<f32>, depth: f32) {
        let [left, top] = self.corner;
        let x = (pixel.x - left) / self.size;
        let y = (pixel.y - top) / self.size;
        let side = f32::from(self.side);
        let inside = |t: f32| t >= 0.0 && t < side;
        if !(inside(x) && inside(y)) {
            return;
        }
        let (column, row) = (x as u16, y as u16);
        let depth = (((depth - self.near) / self.step) as u16).min(EMPTY - 1);
        let place = |t: f32, whole: u16| ((t - f32::from(whole)) * 256.0) as u8;
        let at = usize::from(row) * usize::from(self.side) + usize::from(column);
        if let Some(cell) = self.cells.get_mut(at)
            && depth < cell.depth
        {
            *cell = Cell {
                depth,
                place: [place(x, column), place(y, row)],
            };
        }
    }

    fn depth(&self, column: u16, row: u16) -> u16 {
        if column >= self.side || row >= self.side {
            return EMPTY;
        }
        let at = usize::from(row) * usize::from(self.side) + usize::from(column);
        self.cells.get(at).map_or(EMPTY, |cell| cell.depth)
    }

    /// Whether what lies around a cell hides what is in it: it was seen through a gap between points.
    fn is_hidden(&self, column: u16, row: u16, depth: u16) -> bool {
        let mut nearer = 0;
        for (dx, dy) in [
            (0, 0),
            (1, 0),
            (2, 0),
            (0, 1),
            (2, 1),
            (0, 2),
            (1, 2),
            (2, 2),
        ] {
            // One column and one row before: the outermost wrap to where nothing is.
            let (x, y) = (
                column.wrapping_add(dx).wrapping_sub(1),
                row.wrapping_add(dy).wrapping_sub(1),
            );
            if self.depth(x, y).saturating_add(self.margin) < depth {
                nearer += 1;
            }
        }
        nearer >= HIDING
    }

    /// Hands over the points that the camera sees, row by row.
    pub(super) fn visible(
        &self,
        pulse: &mut Pulse<'_, impl FnMut()>,
        take: &mut impl FnMut(&Visible),
    ) {
        let rows = self.cells.chunks_exact(usize::from(self.side.max(1)));
        for (row, cells) in (0_u16..).zip(rows) {
            for (column, cell) in (0_u16..).zip(cells) {
                pulse.beat();
                if cell.depth != EMPTY && !self.is_hidden(column, row, cell.depth) {
                    take(&self.point(column, row, cell));
                }
            }
        }
    }

    fn point(&self, column: u16, row: u16, cell: &Cell) -> Visible {
        let [left, top] = self.corner;
        let [x, y] = cell.place.map(|place| (f32::from(place) + 0.5) / 256.0);
        Visible {
            pixel: Point2::new(
                left + (f32::from(column) + x) * self.size,
                top + (f32::from(row) + y) * self.size,
            ),
            depth: self.near + (f32::from(cell.depth) + 0.5) * self.step,
        }
    }
}
