//! From the pixels of a mask to those that a pose is checked with, and that say something of it.

use crate::depth_image::DepthImage;
use crate::pixel_mask::PixelMask;
use cobra_infer::depth::{DepthPixel, DepthReport};

/// The pixels of a mask that have a depth, row by row.
#[must_use]
pub fn observed(mask: &PixelMask, depth: &DepthImage) -> Vec<DepthPixel> {
    let pixels = mask.pixels().filter_map(|(column, row)| {
        Some(DepthPixel {
            column: u16::try_from(column).ok()?,
            row: u16::try_from(row).ok()?,
            depth: depth.at(column, row)?,
        })
    });
    pixels.collect()
}

/// At most `most` of the pixels, spread evenly.
#[must_use]
pub fn spread(pixels: &[DepthPixel], most: usize) -> Vec<DepthPixel> {
    let count = pixels.len().min(most);
    (0..count)
        .map(|i| pixels[i * pixels.len() / count])
        .collect()
}

/// On how many pixels or points of the surface a report rests, whichever are fewer: what
/// [`cobra_infer::depth::DepthSettings::minimum_points`] is compared with.
#[must_use]
pub fn valid_pixels(report: &DepthReport) -> u32 {
    report.pixels.min(report.judged)
}
