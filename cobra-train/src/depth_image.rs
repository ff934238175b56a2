//! Depth images in memory.
//!
//! Owns what a pixel says. Reading them is `bop`'s business, scoring against them the scorer's.

use crate::depth::{observed, spread};
use crate::input::ImageSize;
use crate::pixel_mask::PixelMask;
use cobra_infer::depth::DepthPixel;

/// Depths along the camera's axis (z, not the distance from the camera's centre), in millimetres,
/// one a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthImage {
    size: ImageSize,
    millimetres: Vec<f32>,
}

impl DepthImage {
    /// From `width · height` depths in millimetres, row by row from the top left. Infinity is a
    /// measurement, of nothing within reach; 0, and whatever else is no number above 0, says that
    /// nothing was measured.
    ///
    /// # Panics
    /// If there are not as many depths as pixels.
    #[must_use]
    pub fn new(size: ImageSize, millimetres: Vec<f32>) -> Self {
        assert_eq!(
            millimetres.len(),
            size.width as usize * size.height as usize
        );
        Self { size, millimetres }
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> ImageSize {
        self.size
    }

    /// The depth measured at a pixel, in millimetres: infinite where all is far, `None` where
    /// nothing was measured and outside of the image.
    #[must_use]
    pub fn at(&self, column: u32, row: u32) -> Option<f32> {
        let depth = *self.millimetres.get(self.size.index(column, row)?)?;
        (depth > 0.0).then_some(depth)
    }

    /// At most `most` of a mask's pixels that have a depth, spread evenly, as the depth check takes them.
    #[must_use]
    pub fn pixels_in(&self, mask: &PixelMask, most: usize) -> Vec<DepthPixel> {
        spread(&observed(mask, self), most)
    }

    /// All depths in millimetres, row by row from the top left, as they were given.
    #[must_use]
    pub fn millimetres(&self) -> &[f32] {
        &self.millimetres
    }
}

impl cobra_infer::depth::DepthImage for DepthImage {
    fn width(&self) -> u16 {
        u16::try_from(self.size.width).unwrap_or(u16::MAX)
    }

    fn height(&self) -> u16 {
        u16::try_from(self.size.height).unwrap_or(u16::MAX)
    }

    fn depth(&self, column: u16, row: u16) -> Option<f32> {
        self.at(u32::from(column), u32::from(row))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn far_is_measured_and_zero_is_not() {
        let size = ImageSize {
            width: 3,
            height: 2,
        };
        let depths = vec![0.0, 700.5, f32::INFINITY, f32::NAN, -1.0, 3.0];
        let image = DepthImage::new(size, depths);
        assert_eq!(image.at(0, 0), None);
        assert_eq!(image.at(1, 0), Some(700.5));
        assert_eq!(image.at(2, 0), Some(f32::INFINITY));
        assert_eq!([image.at(0, 1), image.at(1, 1)], [None, None]);
        assert_eq!(image.at(2, 1), Some(3.0));
        let mask = PixelMask::new(size, vec![true, true, true, false, true, true]);
        let pixels = |most| -> Vec<(u16, u16)> {
            let taken = image.pixels_in(&mask, most);
            taken.iter().map(|p| (p.column, p.row)).collect()
        };
        assert_eq!(pixels(9), [(1, 0), (2, 0), (2, 1)]);
        assert_eq!(pixels(2), [(1, 0), (2, 0)]);
        // Beside the image, not the next row's pixel.
        assert_eq!([image.at(3, 0), image.at(0, 2)], [None, None]);
    }
}
