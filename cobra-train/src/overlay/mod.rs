//! Pictures of estimated poses over the image that they are of: where the pose puts the object, what was seen
//! there, and what was decided.
//!
//! Owns what is drawn and where. The residuals are [`crate::depth::ResidualMap`]'s, confidences and reasons the
//! scorer's; type, page and the colours of decisions are those of the demonstration's picture. The model is
//! drawn from the surface's own points, so that a template suffices and no mesh is asked for.

mod backdrop;
mod colour;
mod estimate;
mod figures;
mod layer;
mod legend;
mod lines;
mod several;
mod single;
mod view;

pub use backdrop::grey_depth;
pub use estimate::{Evidence, OverlayEstimate};

use crate::demo::canvas::Canvas;
use crate::demo::style::{PAPER, SUPERSAMPLING};
use crate::demo::{PictureError, RgbImage};
use plotters::prelude::*;

/// What a picture shows.
#[derive(Clone, Copy, Debug)]
pub struct Overlay<'a> {
    /// The image that the camera took, or its depth in grey ([`grey_depth`]).
    pub photo: &'a RgbImage,
    /// The estimates: one is shown closely, several in one image.
    pub estimates: &'a [OverlayEstimate],
    /// What the image is, in a line.
    pub subtitle: &'a str,
    /// The residual at which colours are strongest; by default 2σ_m of each estimate.
    pub limit: Option<f32>,
}

impl Overlay<'_> {
    fn limit(&self, estimate: &OverlayEstimate) -> f32 {
        self.limit.unwrap_or(SIGMAS * estimate.residuals.noise)
    }
}

/// Draws the picture, 1600 pixels wide. The same arguments draw the same bytes.
///
/// # Errors
/// [`PictureError`]: there is no estimate, or the drawing library gives up.
pub fn draw(overlay: &Overlay<'_>) -> Result<RgbImage, PictureError> {
    let drawn = |image: &mut RgbImage| match overlay.estimates {
        [] => unreachable!("asked before"),
        [one] => single::draw(image, overlay, one),
        several => several::draw(image, overlay, several),
    };
    let height = match overlay.estimates {
        [] => return Err(PictureError::NoPoses),
        [_] => single::HEIGHT,
        _ => several::height(overlay.photo),
    };
    let (red, green, blue) = PAPER.rgb();
    let mut image = RgbImage::filled(WIDTH as u32, height as u32, [red, green, blue]);
    drawn(&mut image).map_err(|cause| PictureError::Drawing(Box::new(cause)))?;
    Ok(image.reduced(SUPERSAMPLING as u32))
}

/// Residuals of so many σ_m have the strongest colours.
const SIGMAS: f32 = 2.0;

/// Width of the page, before it is reduced.
const WIDTH: i32 = crate::demo::style::px(1600);

const MARGIN: i32 = crate::demo::style::px(32);

/// Draws on an image.
fn on(
    image: &mut RgbImage,
    draw: impl FnOnce(&crate::demo::style::Page<'_>) -> crate::demo::style::Drawn,
) -> crate::demo::style::Drawn {
    draw(&Canvas::new(image).into_drawing_area())
}

#[cfg(test)]
mod tests;
