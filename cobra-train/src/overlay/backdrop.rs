//! What lies under the residuals: the photograph, or the depth image in grey.

use super::view::View;
use crate::demo::RgbImage;
use crate::depth_image::DepthImage;
use nalgebra::Point2;

/// What is seen beside the image.
const BESIDE: [f32; 3] = [236.0, 238.0, 241.0];

/// Where nothing was measured.
const UNMEASURED: [u8; 3] = [34, 36, 40];

/// Shares of the measured depths that are brightest and darkest: a single far pixel leaves the others their
/// contrast.
const ENDS: (f64, f64) = (0.01, 0.99);

/// The depth image in grey, near is bright; where nothing was measured it is nearly black, and where all is far
/// dark.
#[must_use]
pub fn grey_depth(depth: &DepthImage) -> RgbImage {
    let measured = |z: &f32| *z > 0.0 && z.is_finite();
    let all = depth.millimetres();
    let mut sorted: Vec<f32> = all.iter().copied().filter(measured).collect();
    sorted.sort_unstable_by(f32::total_cmp);
    let at = |share: f64| {
        let index = share * sorted.len().saturating_sub(1) as f64;
        sorted.get(index.round() as usize).copied().unwrap_or(0.0)
    };
    let (near, far) = (at(ENDS.0), at(ENDS.1));
    let range = (far - near).max(f32::MIN_POSITIVE);
    let size = depth.size();
    let pixels = all.iter().flat_map(|z| {
        if *z > 0.0 {
            let share = ((z - near) / range).clamp(0.0, 1.0);
            [(226.0 - 160.0 * share).round() as u8; 3]
        } else {
            UNMEASURED
        }
    });
    RgbImage {
        width: size.width,
        height: size.height,
        pixels: pixels.collect(),
    }
}

/// The photograph as a view shows it, with this share of its colour, mixed with white by `pale`.
pub(super) fn shown(photo: &RgbImage, view: &View, saturation: f32, pale: f32) -> RgbImage {
    let (width, height) = view.size();
    let mut pixels = Vec::with_capacity(width as usize * height as usize * 3);
    for row in 0..height {
        for column in 0..width {
            let colour = sampled(photo, view.pixel(column, row));
            let [red, green, blue] = colour;
            let grey = 0.2126 * red + 0.7152 * green + 0.0722 * blue;
            pixels.extend(colour.map(|value| {
                let value = grey + (value - grey) * saturation;
                (value + (255.0 - value) * pale).round() as u8
            }));
        }
    }
    RgbImage {
        width,
        height,
        pixels,
    }
}

/// The photograph between four pixels.
fn sampled(photo: &RgbImage, at: Point2<f32>) -> [f32; 3] {
    let inside = |t: f32, end: u32| t >= -0.5 && t < end as f32 - 0.5;
    if !(inside(at.x, photo.width) && inside(at.y, photo.height)) {
        return BESIDE;
    }
    let split = |t: f32, end: u32| {
        let t = t.clamp(0.0, end as f32 - 1.0);
        let low = t.floor();
        (
            low as usize,
            (low as usize + 1).min(end as usize - 1),
            t - low,
        )
    };
    let (left, right, x) = split(at.x, photo.width);
    let (top, bottom, y) = split(at.y, photo.height);
    let value = |column: usize, row: usize, channel: usize| {
        f32::from(photo.pixels[(row * photo.width as usize + column) * 3 + channel])
    };
    std::array::from_fn(|channel| {
        let line = |row| {
            let (a, b) = (value(left, row, channel), value(right, row, channel));
            a + (b - a) * x
        };
        let (a, b) = (line(top), line(bottom));
        a + (b - a) * y
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::ImageSize;

    #[test]
    fn near_is_brighter_than_far_and_nothing_is_darkest() {
        let size = ImageSize {
            width: 4,
            height: 1,
        };
        let depth = DepthImage::new(size, vec![500.0, 900.0, f32::INFINITY, 0.0]);
        let image = grey_depth(&depth);
        let grey: Vec<u8> = image.pixels.iter().step_by(3).copied().collect();
        assert!(
            grey[0] > grey[1] && grey[1] >= grey[2] && grey[2] > grey[3],
            "{grey:?}"
        );
        let blind = grey_depth(&DepthImage::new(size, vec![0.0; 4]));
        assert!(blind.pixels.chunks(3).all(|pixel| pixel == UNMEASURED));
    }
}
