//! The page's colours that mean something: residuals, components, what is covered.
//!
//! Owns the ramp and the hues; teal and vermilion are the demonstration's, which stay apart for every common
//! kind of colour blindness. The ramp falls in lightness all the way, so that it reads without its hue too.

use crate::demo::Verdict;
use plotters::style::RGBColor;

type Rgb = [u8; 3];

/// What is not covered.
pub(super) fn uncovered() -> Rgb {
    bytes(Verdict::Reject.colour())
}

/// What is covered, where nothing more is told.
pub(super) const COVERED: Rgb = [190, 196, 203];

/// What no component speaks for, where colours are those of components.
pub(super) const SILENT: Rgb = [84, 88, 96];

/// Residuals from 0 to τ.
pub(super) fn ramp() -> Vec<Rgb> {
    let stops = [
        [226, 235, 230],
        [150, 206, 197],
        bytes(Verdict::Accept.colour()),
        [16, 74, 104],
        [34, 28, 74],
    ];
    const STEPS: usize = 8;
    let mut ramp: Vec<Rgb> = stops
        .windows(2)
        .flat_map(|pair| {
            (0..STEPS).map(|step| {
                std::array::from_fn(|c| {
                    let [from, to] = [pair[0][c], pair[1][c]].map(f64::from);
                    (from + (to - from) * step as f64 / STEPS as f64).round() as u8
                })
            })
        })
        .collect();
    ramp.extend(stops.last());
    ramp
}

/// Component `index`'s hue: neighbours in number are far apart on the circle, and differ in lightness too.
pub(super) fn component(index: usize) -> Rgb {
    /// The golden angle, in turns: no number of hues divides the circle badly.
    const TURN: f64 = 0.381_966_011_250_105;
    // Four, because hues that are 21 apart are neighbours.
    const LIGHTNESS: [f64; 4] = [0.66, 0.8, 0.54, 0.73];
    let hue = 2.0 * std::f64::consts::PI * (0.53 + TURN * index as f64).fract();
    oklch(LIGHTNESS[index % LIGHTNESS.len()], 0.125, hue)
}

/// Lightness, chroma and hue to sRGB, cut to what it can show (B. Ottosson, A perceptual color space for
/// image processing, 2020); by `libm`, so that a page has the same bytes everywhere.
fn oklch(lightness: f64, chroma: f64, hue: f64) -> Rgb {
    let (a, b) = (chroma * libm::cos(hue), chroma * libm::sin(hue));
    let l = (lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b).powi(3);
    let m = (lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b).powi(3);
    let s = (lightness - 0.089_484_177_5 * a - 1.291_485_548_0 * b).powi(3);
    let linear = [
        4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
        -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
        -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s,
    ];
    linear.map(|value| {
        let value = value.clamp(0.0, 1.0);
        let encoded = if value <= 0.003_130_8 {
            12.92 * value
        } else {
            1.055 * libm::pow(value, 1.0 / 2.4) - 0.055
        };
        (255.0 * encoded).round() as u8
    })
}

fn bytes(RGBColor(r, g, b): RGBColor) -> Rgb {
    [r, g, b]
}

/// As a style sheet writes it.
pub(super) fn hex([r, g, b]: Rgb) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance as of WCAG 2.
    fn luminance(colour: Rgb) -> f64 {
        let [r, g, b] = colour.map(|byte| {
            let value = f64::from(byte) / 255.0;
            if value <= 0.040_45 {
                value / 12.92
            } else {
                ((value + 0.055) / 1.055).powf(2.4)
            }
        });
        0.2126 * r + 0.7152 * g + 0.0722 * b
    }

    #[test]
    fn the_ramp_darkens_all_the_way_and_ends_apart_from_what_is_not_covered() {
        let ramp: Vec<f64> = ramp().into_iter().map(luminance).collect();
        assert!(ramp.windows(2).all(|pair| pair[0] > pair[1]), "{ramp:?}");
        let contrast = (luminance(uncovered()) + 0.05) / (ramp[ramp.len() - 1] + 0.05);
        assert!(contrast > 2.5, "{contrast}");
    }

    #[test]
    fn no_two_of_64_components_have_the_same_colour() {
        let mut colours: Vec<Rgb> = (0..64).map(component).collect();
        colours.sort_unstable();
        colours.dedup();
        assert_eq!(colours.len(), 64);
    }
}
