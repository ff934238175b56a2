//! Sets of pixels of an image.
//!
//! Owns which pixels are in. Whose they are, the reader of a mask or the renderer says.

use crate::input::ImageSize;

/// A set of pixels: those that show an object, for instance.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PixelMask {
    size: ImageSize,
    inside: Vec<bool>,
}

impl PixelMask {
    /// From `width · height` answers, row by row from the top left.
    ///
    /// # Panics
    /// If there are not as many answers as pixels.
    #[must_use]
    pub fn new(size: ImageSize, inside: Vec<bool>) -> Self {
        assert_eq!(inside.len(), size.width as usize * size.height as usize);
        Self { size, inside }
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> ImageSize {
        self.size
    }

    /// Whether a pixel is in the set; no pixel outside of the image is.
    #[must_use]
    pub fn contains(&self, column: u32, row: u32) -> bool {
        let inside = self
            .size
            .index(column, row)
            .and_then(|i| self.inside.get(i));
        inside.copied().unwrap_or(false)
    }

    /// How many pixels are in the set.
    #[must_use]
    pub fn count(&self) -> usize {
        self.inside.iter().filter(|inside| **inside).count()
    }

    /// The pixels in the set as (column, row), row by row from the top left.
    pub fn pixels(&self) -> impl Iterator<Item = (u32, u32)> + '_ {
        let width = self.size.width;
        let inside = self.inside.iter().zip(0_u32..);
        inside.filter_map(move |(inside, i)| inside.then_some((i % width, i / width)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_come_row_by_row_and_end_with_the_image() {
        let size = ImageSize {
            width: 3,
            height: 2,
        };
        let mask = PixelMask::new(size, vec![false, true, true, true, false, false]);
        assert_eq!(mask.pixels().collect::<Vec<_>>(), [(1, 0), (2, 0), (0, 1)]);
        assert_eq!(mask.count(), 3);
        assert!(mask.contains(0, 1) && !mask.contains(3, 0) && !mask.contains(0, 2));
    }
}
