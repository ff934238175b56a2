//! What a depth camera saw: single pixels, and the image to look others up in.
//!
//! Owns the interface to the caller's memory. Nothing is copied: pixels come as a slice, the image through
//! a trait, so that it may lie in any layout, be a window of a larger one, or still be in a DMA buffer.

use nalgebra::Point2;

/// A pixel that shows the object, as a mask says, and the depth measured there: eight bytes, its fields in
/// this order.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct DepthPixel {
    /// Column, from 0; pixel centres are at integers.
    pub column: u16,
    /// Row, from 0.
    pub row: u16,
    /// λ, the z-depth along the camera's axis, in the template's unit; 0, or what is no number, where
    /// nothing was measured. Infinite where it is known that nothing is as near as the object: that counts
    /// against the pose.
    pub depth: f32,
}

impl DepthPixel {
    /// The pixel as a point of the image.
    #[must_use]
    #[inline]
    pub fn pixel(&self) -> Point2<f32> {
        Point2::new(f32::from(self.column), f32::from(self.row))
    }

    #[inline]
    pub(super) fn is_measured(&self) -> bool {
        // Nor is what is no number.
        self.depth > 0.0
    }
}

/// A depth image that is looked up pixel by pixel.
pub trait DepthImage {
    /// Columns.
    fn width(&self) -> u16;

    /// Rows.
    fn height(&self) -> u16;

    /// The z-depth at a pixel inside the image, in the template's unit. `None` where nothing was measured,
    /// which is no evidence; infinite where it is known that nothing is as near as the object, which is.
    fn depth(&self, column: u16, row: u16) -> Option<f32>;
}

/// A depth image as sensors give it: row by row, `u16`, 0 where nothing was measured.
#[derive(Clone, Copy, Debug)]
pub struct DepthWords<'a> {
    words: &'a [u16],
    width: u16,
    scale: f32,
}

impl<'a> DepthWords<'a> {
    /// `width` columns; `scale` turns a word into the template's unit (BOP's `depth_scale`, of a template
    /// in millimetres). `None` where the words are no whole number of rows, of no more than 65,535, or the
    /// scale is not positive and finite.
    #[must_use]
    pub fn new(words: &'a [u16], width: u16, scale: f32) -> Option<Self> {
        let rows = words.len().checked_div(usize::from(width))?;
        let whole = rows.checked_mul(usize::from(width)) == Some(words.len());
        let fits = u16::try_from(rows).is_ok() && scale.is_finite() && scale > 0.0;
        (whole && fits).then_some(Self {
            words,
            width,
            scale,
        })
    }
}

impl DepthImage for DepthWords<'_> {
    fn width(&self) -> u16 {
        self.width
    }

    fn height(&self) -> u16 {
        let rows = self.words.len().checked_div(usize::from(self.width));
        rows.and_then(|rows| u16::try_from(rows).ok()).unwrap_or(0)
    }

    fn depth(&self, column: u16, row: u16) -> Option<f32> {
        if column >= self.width {
            return None;
        }
        let at = usize::from(row) * usize::from(self.width) + usize::from(column);
        let word = *self.words.get(at)?;
        (word != 0).then(|| f32::from(word) * self.scale)
    }
}
