//! The surface against the image: was what must be visible seen?
//!
//! Owns the evidence of single points of the surface, and their mean.

use super::observed::{DepthImage, DepthPixel};
use super::residual::through;
use super::zbuffer::Visible;
use crate::math;

/// Nearer than this many σ in front of a point of the surface, something else hides it.
pub(super) const HIDDEN_SIGMAS: f32 = 3.0;

/// An offset is that of the whole surface where so much of what was measured lies within a diameter of it …
const COMMON_SHARE: f32 = 0.8;

/// … and where its standard deviation is no more than this share of it. Right shapes at a wrong distance come to
/// 0.1 to 0.5 on LineMOD-Occlusion, wrong shapes to more than 1.
const COMMON_SPREAD: f32 = 0.6;

/// What the image says of a point that must be visible.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Sight {
    /// Nothing was measured there, or it lies outside of the image.
    Unmeasured,
    /// Something nearer was, at this depth.
    Hidden(f32),
    /// This was, so far behind the point; negative in front of it.
    Measured(DepthPixel, f32),
}

/// Looks a visible point up in the image.
#[inline]
pub(super) fn look_up(image: &impl DepthImage, visible: &Visible, sigma: f32) -> Sight {
    let [x, y] = [visible.pixel.x + 0.5, visible.pixel.y + 0.5];
    if !(x >= 0.0 && y >= 0.0 && x < f32::from(image.width()) && y < f32::from(image.height())) {
        return Sight::Unmeasured;
    }
    // Rust's conversion rounds down: to the pixel whose centre is nearest.
    let (column, row) = (x as u16, y as u16);
    let Some(depth) = image.depth(column, row) else {
        return Sight::Unmeasured;
    };
    if depth.is_nan() || depth <= 0.0 {
        return Sight::Unmeasured;
    }
    let behind = depth - visible.depth;
    if behind < -(HIDDEN_SIGMAS * sigma) {
        return Sight::Hidden(depth);
    }
    Sight::Measured(DepthPixel { column, row, depth }, behind)
}

/// The evidence of all points that must be visible.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Evidence {
    pub(super) visible: u32,
    pub(super) judged: u32,
    pub(super) hidden: u32,
    pub(super) unmeasured: u32,
    /// Of the judged ones, those behind which more than [`HIDDEN_SIGMAS`] σ there is nothing.
    pub(super) seen_through: u32,
    sum: f32,
    measured_depths: f32,
    expected_depths: f32,
    near: u32,
    offsets: f32,
    offset_squares: f32,
}

impl Evidence {
    /// Takes a visible point in, and what was seen of it.
    pub(super) fn add(&mut self, visible: &Visible, sight: Sight, sigma: f32, diameter: f32) {
        self.visible = self.visible.saturating_add(1);
        match sight {
            Sight::Unmeasured => self.unmeasured = self.unmeasured.saturating_add(1),
            Sight::Hidden(depth) => {
                self.hidden = self.hidden.saturating_add(1);
                self.compare(depth, visible.depth);
                self.offset(depth - visible.depth, diameter);
            }
            Sight::Measured(pixel, behind) => {
                self.compare(pixel.depth, visible.depth);
                self.offset(behind, diameter);
                self.judged = self.judged.saturating_add(1);
                if through(behind, sigma) {
                    self.seen_through = self.seen_through.saturating_add(1);
                }
                let scaled = behind / sigma;
                self.sum += math::exp(-(0.5 * scaled * scaled));
            }
        }
    }

    /// Sums what lies within a diameter of where it must be.
    fn offset(&mut self, behind: f32, diameter: f32) {
        if math::abs(behind) < diameter {
            self.near = self.near.saturating_add(1);
            self.offsets += behind;
            self.offset_squares += behind * behind;
        }
    }

    /// How far behind the points something was measured on average, where that says it of all: where most lie
    /// within a diameter, and scatter little around the mean. 0 where it does not.
    pub(super) fn common_offset(&self) -> f32 {
        let measured = self.judged.saturating_add(self.hidden) as f32;
        let count = self.near as f32;
        if self.near == 0 || count < COMMON_SHARE * measured {
            return 0.0;
        }
        let mean = self.offsets / count;
        let variance = self.offset_squares / count - mean * mean;
        let most = COMMON_SPREAD * mean;
        if variance <= most * most { mean } else { 0.0 }
    }

    /// Sums both depths; what is infinitely far away has no ratio.
    pub(super) fn compare(&mut self, measured: f32, expected: f32) {
        if measured.is_finite() {
            self.measured_depths += measured;
            self.expected_depths += expected;
        }
    }

    /// The ratio of the sums; 0 where it is none.
    pub(super) fn depth_ratio(&self) -> f32 {
        let ratio = self.measured_depths / self.expected_depths;
        if ratio.is_finite() { ratio } else { 0.0 }
    }

    /// The mean likelihood of the points that are evidence; 0 without any.
    pub(super) fn likelihood(&self) -> f32 {
        match self.judged {
            0 => 0.0,
            judged => self.sum / judged as f32,
        }
    }
}
