//! What a panel shows of one estimate: which pixel of the page shows what, and how that is painted.
//!
//! Owns that a reader who sees no colours can tell apart what is hidden, what the camera sees through and what
//! was not measured: each has a pattern of its own.

use super::colour::{blend, diverging};
use super::view::View;
use crate::demo::RgbImage;
use crate::demo::style::px;
use crate::depth::ResidualMap;
use cobra_infer::depth::Seen;
use nalgebra::Point2;

/// What a pixel of the page shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Patch {
    /// A residual.
    Residual(f32),
    /// A residual so far behind that the camera sees through.
    Through,
    /// Something else in front.
    Hidden,
    /// Nothing measured.
    Unmeasured,
    /// A pixel that nothing of the surface speaks for.
    Silent,
}

const HATCH: [u8; 3] = [28, 32, 40];
const PALE: [u8; 3] = [255, 255, 255];

impl Patch {
    /// The colour and opacity at a pixel of the page; residuals are strongest at `limit`.
    fn paint(self, (column, row): (u32, u32), limit: f32) -> ([u8; 3], f32) {
        let [x, y] = [column, row].map(|at| at.cast_signed());
        let (period, width) = (px(7), px(2));
        let along = (x + y).rem_euclid(period) < width;
        let across = (x - y).rem_euclid(period) < width;
        let dot = x.rem_euclid(px(5)) < px(2) && y.rem_euclid(px(5)) < px(2);
        match self {
            Self::Residual(residual) => (diverging(residual / limit), 0.92),
            Self::Through if along || across => (PALE, 0.9),
            Self::Through => (diverging(1.0), 0.85),
            Self::Hidden if along => (HATCH, 0.85),
            Self::Hidden => (PALE, 0.35),
            Self::Unmeasured if dot => (HATCH, 0.8),
            Self::Unmeasured => (PALE, 0.25),
            Self::Silent if across => (PALE, 0.9),
            Self::Silent => (HATCH, 0.85),
        }
    }

    /// A swatch for the legend.
    pub(super) fn swatch(self, width: u32, height: u32) -> RgbImage {
        let mut image = RgbImage::filled(width, height, [190, 194, 200]);
        for row in 0..height {
            for column in 0..width {
                let (colour, opacity) = self.paint((column, row), 1.0);
                mix(&mut image, column, row, colour, opacity);
            }
        }
        image
    }
}

/// Which pixels of a view show what.
pub(super) struct Layer {
    view: View,
    patches: Vec<Option<(f32, Patch)>>,
}

/// Half the diagonal of a cell and a little more, so that no gap stays between neighbours.
fn radius(view: View, residuals: &ResidualMap) -> f32 {
    (0.85 * residuals.spacing * view.zoom()).max(1.5)
}

impl Layer {
    fn empty(view: View) -> Self {
        let (width, height) = view.size();
        Self {
            view,
            patches: vec![None; width as usize * height as usize],
        }
    }

    /// The surface that the pose says is visible, and what was seen of it.
    pub(super) fn of_surface(view: View, residuals: &ResidualMap) -> Self {
        let mut layer = Self::empty(view);
        let radius = radius(view, residuals);
        for point in &residuals.surface {
            let patch = match point.seen {
                Seen::Surface { behind } => Patch::Residual(behind),
                Seen::Through { .. } => Patch::Through,
                Seen::Hidden { .. } => Patch::Hidden,
                Seen::Unmeasured => Patch::Unmeasured,
            };
            layer.disc(view.place(point.pixel), radius, point.depth, patch);
        }
        layer.close(4.0 * radius);
        layer
    }

    /// Fills holes of no more than `side`² pixels with what lies to the left of them: cells that no point of the
    /// surface fell into, rather than holes of the object.
    fn close(&mut self, side: f32) {
        let (width, _) = self.view.size();
        let most = (side * side) as usize;
        let mut seen = vec![false; self.patches.len()];
        for start in 0..self.patches.len() {
            if seen[start] || self.patches[start].is_some() {
                continue;
            }
            let mut hole = vec![start];
            seen[start] = true;
            let (mut next, mut open) = (0, false);
            while let Some(&at) = hole.get(next) {
                next += 1;
                let (column, row) = (at % width as usize, at / width as usize);
                let [x, y] = [column, row].map(|t| i32::try_from(t).unwrap_or(i32::MAX));
                for (dx, dy) in [(-1, 0), (1, 0), (0, -1), (0, 1)] {
                    match self.index(x + dx, y + dy) {
                        Some(beside) if self.patches[beside].is_none() => {
                            if !seen[beside] {
                                seen[beside] = true;
                                hole.push(beside);
                            }
                        }
                        Some(_) => {}
                        None => open = true,
                    }
                }
            }
            if open || hole.len() > most {
                continue;
            }
            hole.sort_unstable();
            for at in hole {
                // A hole does not reach the rim: something lies to the left.
                self.patches[at] = self.patches[at.saturating_sub(1)];
            }
        }
    }

    /// The observed pixels: those of a mask as the squares that they are, those of a silhouette as large as the
    /// cells of the surface that they were looked up for.
    pub(super) fn of_pixels(view: View, residuals: &ResidualMap, masked: bool) -> Self {
        let mut layer = Self::empty(view);
        let radius = radius(view, residuals);
        for (pixel, residual) in &residuals.pixels {
            let patch = residual.map_or(Patch::Silent, |found| Patch::Residual(found.distance));
            if !masked {
                layer.disc(view.place(pixel.pixel()), radius, pixel.depth, patch);
                continue;
            }
            let [low, high] = [-0.5, 0.5].map(|half| {
                let corner = pixel.pixel() + nalgebra::Vector2::repeat(half);
                view.place(corner).map(|t| t.round())
            });
            for row in low.y as i32..high.y as i32 {
                for column in low.x as i32..high.x as i32 {
                    layer.set(column, row, pixel.depth, patch);
                }
            }
        }
        if !masked {
            layer.close(2.0 * radius);
        }
        layer
    }

    fn disc(&mut self, middle: Point2<f32>, radius: f32, depth: f32, patch: Patch) {
        let range = |t: f32| ((t - radius).floor() as i32, (t + radius).ceil() as i32);
        let ((left, right), (top, bottom)) = (range(middle.x), range(middle.y));
        for row in top..=bottom {
            for column in left..=right {
                let offset = Point2::new(column as f32 + 0.5, row as f32 + 0.5) - middle;
                if offset.norm_squared() <= radius * radius {
                    self.set(column, row, depth, patch);
                }
            }
        }
    }

    /// The nearest stays.
    fn set(&mut self, column: i32, row: i32, depth: f32, patch: Patch) {
        let Some(at) = self.index(column, row) else {
            return;
        };
        let here = &mut self.patches[at];
        if here.is_none_or(|(nearest, _)| depth < nearest) {
            *here = Some((depth, patch));
        }
    }

    fn index(&self, column: i32, row: i32) -> Option<usize> {
        let (width, height) = self.view.size();
        let (column, row) = (u32::try_from(column).ok()?, u32::try_from(row).ok()?);
        (column < width && row < height).then_some(row as usize * width as usize + column as usize)
    }

    fn is_empty(&self, column: i32, row: i32) -> bool {
        self.index(column, row)
            .is_none_or(|at| self.patches[at].is_none())
    }

    /// Paints on the image of the view; `strength` weakens all opacities.
    pub(super) fn paint(&self, image: &mut RgbImage, limit: f32, strength: f32) {
        let (width, _) = self.view.size();
        for (at, patch) in (0_u32..).zip(&self.patches) {
            if let Some((_, patch)) = patch {
                let (column, row) = (at % width, at / width);
                let (colour, opacity) = patch.paint((column, row), limit);
                mix(image, column, row, colour, strength * opacity);
            }
        }
    }

    /// Draws the rim of what is shown, `pen` pixels of the page wide.
    pub(super) fn outline(&self, image: &mut RgbImage, colour: [u8; 3], pen: i32) {
        let (width, _) = self.view.size();
        for (at, patch) in (0_u32..).zip(&self.patches) {
            if patch.is_none() {
                continue;
            }
            let (column, row) = (at % width, at / width);
            let [x, y] = [column, row].map(|at| at.cast_signed());
            let beside = [(-pen, 0), (pen, 0), (0, -pen), (0, pen)];
            let diagonal = (0.7 * pen as f32).round() as i32;
            let corners = [-diagonal, diagonal].map(|dx| [(dx, -diagonal), (dx, diagonal)]);
            let mut around = beside.iter().chain(corners.iter().flatten());
            if around.any(|(dx, dy)| self.is_empty(x + dx, y + dy)) {
                mix(image, column, row, colour, 1.0);
            }
        }
    }
}

fn mix(image: &mut RgbImage, column: u32, row: u32, colour: [u8; 3], opacity: f32) {
    let at = (row as usize * image.width as usize + column as usize) * 3;
    if let Some(under) = image.pixels.get_mut(at..at + 3) {
        let mixed = blend([under[0], under[1], under[2]], colour, opacity);
        under.copy_from_slice(&mixed);
    }
}
