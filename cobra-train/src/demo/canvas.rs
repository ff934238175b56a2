//! Where `plotters` draws: an [`RgbImage`], with text set in an embedded font.
//!
//! Owns blending and the setting of text. Glyphs stand where the font's metrics put them, to the
//! fraction of a pixel, and no font of the system is asked for. Lengths are pixels of the image.

use std::convert::Infallible;

use ab_glyph::{Font, FontRef, PxScale, ScaleFont, point};
use plotters_backend::text_anchor::{HPos, VPos};
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind,
    FontStyle,
};

use super::RgbImage;

/// Height of DejaVu Sans's capitals, in ems.
const CAPITALS: f64 = 0.729;

type Outcome = Result<(), DrawingErrorKind<Infallible>>;

/// A drawing backend that paints on an image. What falls outside the image is left out.
///
/// A text's box reaches from its baseline to the height of its capitals: anchored in the middle,
/// text looks centred, and descenders hang below the box.
pub(crate) struct Canvas<'a> {
    image: &'a mut RgbImage,
    regular: FontRef<'static>,
    bold: FontRef<'static>,
}

impl<'a> Canvas<'a> {
    pub(crate) fn new(image: &'a mut RgbImage) -> Self {
        let font = |bytes| FontRef::try_from_slice(bytes).expect("the embedded font is a font");
        Self {
            image,
            regular: font(dejavu::sans::regular()),
            bold: font(dejavu::sans::bold()),
        }
    }

    fn font(&self, style: &FontStyle) -> &FontRef<'static> {
        match style {
            FontStyle::Bold => &self.bold,
            FontStyle::Normal | FontStyle::Oblique | FontStyle::Italic => &self.regular,
        }
    }
}

/// The scale at which an em of the font is `size` pixels.
fn em(font: &FontRef<'static>, size: f64) -> PxScale {
    let per_em = f64::from(font.units_per_em().unwrap_or(1000.0));
    PxScale::from((size * f64::from(font.height_unscaled()) / per_em) as f32)
}

/// Calls `place` with each glyph's character and its left end on the baseline; returns the width.
fn set(
    font: &FontRef<'static>,
    scale: PxScale,
    text: &str,
    mut place: impl FnMut(char, f32),
) -> f32 {
    let scaled = font.as_scaled(scale);
    let mut x = 0.0;
    let mut previous = None;
    for c in text.chars() {
        let glyph = scaled.glyph_id(c);
        if let Some(previous) = previous {
            x += scaled.kern(previous, glyph);
        }
        place(c, x);
        x += scaled.h_advance(glyph);
        previous = Some(glyph);
    }
    x
}

impl DrawingBackend for Canvas<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        (self.image.width, self.image.height)
    }

    fn ensure_prepared(&mut self) -> Outcome {
        Ok(())
    }

    fn present(&mut self) -> Outcome {
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, colour: BackendColor) -> Outcome {
        let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) else {
            return Ok(());
        };
        if x >= self.image.width || y >= self.image.height {
            return Ok(());
        }
        let start = (y as usize * self.image.width as usize + x as usize) * 3;
        let (red, green, blue) = colour.rgb;
        for (under, over) in self.image.pixels[start..][..3]
            .iter_mut()
            .zip([red, green, blue])
        {
            let (below, above) = (f64::from(*under), f64::from(over));
            *under = (below + (above - below) * colour.alpha).round() as u8;
        }
        Ok(())
    }

    fn draw_text<S: BackendTextStyle>(
        &mut self,
        text: &str,
        style: &S,
        pos: BackendCoord,
    ) -> Outcome {
        let font = self.font(&style.style()).clone();
        let scale = em(&font, style.size());
        let width = set(&font, scale, text, |_, _| {});
        let left = match style.anchor().h_pos {
            HPos::Left => 0.0,
            HPos::Center => -width / 2.0,
            HPos::Right => -width,
        };
        let capitals = (CAPITALS * style.size()) as f32;
        let baseline = match style.anchor().v_pos {
            VPos::Top => capitals,
            VPos::Center => (capitals / 2.0).round(),
            VPos::Bottom => 0.0,
        };
        let mut covered = Vec::new();
        set(&font, scale, text, |c, x| {
            let glyph = font
                .glyph_id(c)
                .with_scale_and_position(scale, point(left + x, baseline));
            if let Some(outline) = font.outline_glyph(glyph) {
                let corner = outline.px_bounds().min;
                outline.draw(|x, y, share| {
                    covered.push((
                        x as i32 + corner.x as i32,
                        y as i32 + corner.y as i32,
                        share,
                    ));
                });
            }
        });
        let colour = style.color();
        for (x, y, share) in covered {
            let (x, y) = style.transform().transform(x, y);
            let colour = BackendColor {
                alpha: colour.alpha * f64::from(share.clamp(0.0, 1.0)),
                rgb: colour.rgb,
            };
            self.draw_pixel((pos.0 + x, pos.1 + y), colour)?;
        }
        Ok(())
    }

    fn estimate_text_size<S: BackendTextStyle>(
        &self,
        text: &str,
        style: &S,
    ) -> Result<(u32, u32), DrawingErrorKind<Infallible>> {
        let font = self.font(&style.style());
        let width = set(font, em(font, style.size()), text, |_, _| {});
        Ok((width.ceil() as u32, (CAPITALS * style.size()).ceil() as u32))
    }

    /// `plotters` draws the rims of circles with an uneven width; a ring of exact distances is
    /// round.
    fn draw_circle<S: BackendStyle>(
        &mut self,
        centre: BackendCoord,
        radius: u32,
        style: &S,
        fill: bool,
    ) -> Outcome {
        let half = f64::from(style.stroke_width()) / 2.0;
        let radius = f64::from(radius);
        let reach = (radius + half).ceil() as i32 + 1;
        for y in -reach..=reach {
            for x in -reach..=reach {
                let distance = f64::from(x * x + y * y).sqrt();
                let outside = if fill {
                    distance - radius
                } else {
                    (distance - radius).abs() - half
                };
                let share = (0.5 - outside).clamp(0.0, 1.0);
                if share > 0.0 {
                    let colour = BackendColor {
                        alpha: style.color().alpha * share,
                        rgb: style.color().rgb,
                    };
                    self.draw_pixel((centre.0 + x, centre.1 + y), colour)?;
                }
            }
        }
        Ok(())
    }
}
