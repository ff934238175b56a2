//! An RGB image in memory, and its encoding as PNG.
//!
//! Owns the pixels; what they show is `render`'s and `picture`'s business.

use std::io;

/// An image of 8-bit sRGB pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RgbImage {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green and blue of each pixel, row by row from the top left.
    pub pixels: Vec<u8>,
}

impl RgbImage {
    /// An image of one colour.
    #[must_use]
    pub fn filled(width: u32, height: u32, colour: [u8; 3]) -> Self {
        Self {
            width,
            height,
            pixels: colour.repeat(width as usize * height as usize),
        }
    }

    /// Copies another image onto this one, its upper left pixel onto `column` and `row`.
    ///
    /// # Panics
    /// If it does not fit.
    pub fn paste(&mut self, (column, row): (u32, u32), other: &Self) {
        let stride = self.width as usize * 3;
        let length = other.width as usize * 3;
        assert!(column + other.width <= self.width && row + other.height <= self.height);
        let start = row as usize * stride + column as usize * 3;
        for (i, line) in other.pixels.chunks_exact(length).enumerate() {
            self.pixels[start + i * stride..][..length].copy_from_slice(line);
        }
    }

    /// The image at `1 / factor` of the size, each pixel the mean of the square that it replaces.
    /// Columns and rows that do not fill a square are left out.
    ///
    /// # Panics
    /// If `factor` is 0.
    #[must_use]
    pub fn reduced(&self, factor: u32) -> Self {
        let (width, height) = (self.width / factor, self.height / factor);
        let count = factor * factor;
        let mut pixels = Vec::with_capacity(width as usize * height as usize * 3);
        for row in 0..height {
            for column in 0..width {
                let mut sums = [count / 2; 3];
                for y in row * factor..(row + 1) * factor {
                    let start = (y * self.width + column * factor) as usize * 3;
                    for pixel in self.pixels[start..][..factor as usize * 3]
                        .as_chunks::<3>()
                        .0
                    {
                        for (sum, &value) in sums.iter_mut().zip(pixel) {
                            *sum += u32::from(value);
                        }
                    }
                }
                pixels.extend(sums.map(|sum| (sum / count) as u8));
            }
        }
        Self {
            width,
            height,
            pixels,
        }
    }

    /// The image as a PNG file. The same image gives the same bytes.
    ///
    /// # Errors
    /// [`io::Error`] if the image has no pixels, or `pixels` does not hold three bytes for each.
    pub fn encode_png(&self) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width, self.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.pixels)?;
        writer.finish()?;
        Ok(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_png_decodes_to_the_drawn_pixels() {
        let mut image = RgbImage::filled(5, 3, [250, 128, 7]);
        image.pixels[4 * 3] = 1;
        let bytes = image.encode_png().unwrap();
        let mut reader = png::Decoder::new(io::Cursor::new(bytes))
            .read_info()
            .unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let frame = reader.next_frame(&mut pixels).unwrap();
        assert_eq!((frame.width, frame.height), (5, 3));
        assert_eq!(frame.color_type, png::ColorType::Rgb);
        assert_eq!(pixels, image.pixels);
    }

    #[test]
    fn an_image_without_its_pixels_is_refused() {
        let mut image = RgbImage::filled(5, 3, [0; 3]);
        image.pixels.pop();
        assert!(image.encode_png().is_err());
        assert!(RgbImage::filled(0, 0, [0; 3]).encode_png().is_err());
    }

    #[test]
    fn a_pasted_image_stands_where_it_was_put() {
        let mut image = RgbImage::filled(3, 2, [0; 3]);
        image.paste((1, 1), &RgbImage::filled(2, 1, [7; 3]));
        let expected = [[[0; 3]; 4].concat(), [[7; 3]; 2].concat()].concat();
        assert_eq!(image.pixels, expected);
    }

    #[test]
    fn a_reduced_pixel_is_the_mean_of_its_square() {
        let image = RgbImage {
            width: 3,
            height: 2,
            pixels: [
                [0, 10, 255],
                [2, 20, 255],
                [9; 3],
                [4, 30, 255],
                [6, 40, 255],
                [9; 3],
            ]
            .concat(),
        };
        let expected = RgbImage::filled(1, 1, [3, 25, 255]);
        assert_eq!(image.reduced(2), expected);
    }
}
