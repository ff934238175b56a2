//! The page of one estimate: the whole image with the object's box, the surface that the pose says is visible
//! with what was seen of it, and the observed pixels with how far they lie from the surface.

use super::backdrop::shown;
use super::estimate::OverlayEstimate;
use super::layer::Layer;
use super::legend::Strongest;
use super::lines::line;
use super::view::View;
use super::{MARGIN, Overlay, WIDTH, figures, legend, on};
use crate::demo::RgbImage;
use crate::demo::style::{Drawn, INK, PAPER, Page, QUIET, bold, px, seal, text};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

/// Height of the page, before it is reduced.
pub(super) const HEIGHT: i32 = px(784);

/// Width of the whole image, and the side of the close-ups.
const WHOLE: i32 = px(464);
const CLOSE: i32 = px(512);
const GAP: i32 = px(24);
/// Top of the panels, below their captions.
const TOP: i32 = px(152);

pub(super) fn draw(
    image: &mut RgbImage,
    overlay: &Overlay<'_>,
    estimate: &OverlayEstimate,
) -> Drawn {
    let photo = overlay.photo;
    let size = (photo.width, photo.height);
    let whole = View::whole(size, WHOLE as u32);
    let outline = estimate.outline();
    let close = View::around(outline.into_iter(), size, CLOSE as u32)
        .unwrap_or_else(|| View::all(size, CLOSE as u32));
    let limit = overlay.limit(estimate);
    let (red, green, blue) = estimate.verdict().colour().rgb();
    let colour = [red, green, blue];

    let mut context = shown(photo, &whole, 1.0, 0.0);
    let layer = Layer::of_surface(whole, &estimate.residuals);
    layer.outline(&mut context, colour, px(2));
    on(&mut context, |page| edges(page, &whole, estimate, px(2)))?;

    let mut surface = shown(photo, &close, 0.15, 0.25);
    let layer = Layer::of_surface(close, &estimate.residuals);
    layer.paint(&mut surface, limit, 1.0);
    layer.outline(&mut surface, colour, px(3));
    on(&mut surface, |page| edges(page, &close, estimate, px(1)))?;

    let mut pixels = shown(photo, &close, 0.15, 0.25);
    let observed = Layer::of_pixels(close, &estimate.residuals, estimate.masked);
    observed.paint(&mut pixels, limit, 1.0);
    layer.outline(&mut pixels, colour, px(3));

    let columns = [MARGIN, MARGIN + WHOLE + GAP, WIDTH - MARGIN - CLOSE];
    for (left, panel) in columns.iter().zip([&context, &surface, &pixels]) {
        image.paste((left.cast_unsigned(), TOP.cast_unsigned()), panel);
    }
    let key = (columns[1], TOP + CLOSE + px(28));
    legend::paint(image, key);
    let below = TOP + whole.size().1.cast_signed() + px(18);
    on(image, |page| {
        heading(page, overlay, estimate)?;
        let pixels = if estimate.masked {
            "the pixels of the mask"
        } else {
            "the pixels of its silhouette"
        };
        for (left, words) in columns.into_iter().zip([
            "The image, the pose's outline and box".to_owned(),
            "Surface that must be visible: what was seen there".to_owned(),
            format!("Observed, {pixels}: distance from the surface"),
        ]) {
            let at = (left, TOP - px(16));
            page.draw(&Text::new(
                words,
                at,
                text(15, QUIET, HPos::Left, VPos::Center),
            ))?;
        }
        if estimate.residuals.surface.is_empty() {
            nothing(page, columns[1])?;
        }
        figures::draw(page, (MARGIN, below), WHOLE, estimate)?;
        legend::draw(page, key, Strongest::Length(limit, estimate.unit))
    })
}

/// Decision, name, reason, and what the image is.
fn heading(page: &Page<'_>, overlay: &Overlay<'_>, estimate: &OverlayEstimate) -> Drawn {
    let verdict = estimate.verdict();
    seal(page, verdict, (MARGIN + px(16), px(44)))?;
    let left = MARGIN + px(44);
    let style = bold(25, verdict.colour(), HPos::Left, VPos::Center);
    let (width, _) = page.estimate_text_size(verdict.verdict(), &style)?;
    page.draw(&Text::new(verdict.verdict(), (left, px(34)), style))?;
    page.draw(&Text::new(
        format!(
            "{}   confidence {:.2}   estimated error {}",
            estimate.name,
            estimate.report.confidence,
            estimate.error()
        ),
        (left + width.cast_signed() + px(20), px(34)),
        bold(25, INK, HPos::Left, VPos::Center),
    ))?;
    page.draw(&Text::new(
        format!(
            "Why: {}.  Decision: {}.",
            estimate.reason(),
            estimate.report.decision.reason()
        ),
        (left, px(68)),
        text(19, INK, HPos::Left, VPos::Center),
    ))?;
    page.draw(&Text::new(
        overlay.subtitle.to_owned(),
        (left, px(98)),
        text(16, QUIET, HPos::Left, VPos::Center),
    ))
}

/// The box's edges, dark on light so that they are seen on any image.
pub(super) fn edges(page: &Page<'_>, view: &View, estimate: &OverlayEstimate, pen: i32) -> Drawn {
    for (colour, width) in [(INK, pen + px(1)), (PAPER, pen)] {
        for ends in &estimate.edges {
            line(
                page,
                view,
                *ends,
                colour.mix(0.75).stroke_width(width.cast_unsigned()),
            )?;
        }
    }
    Ok(())
}

fn nothing(page: &Page<'_>, left: i32) -> Drawn {
    let at = (left + CLOSE / 2, TOP + CLOSE / 2);
    let style = bold(18, INK, HPos::Center, VPos::Center);
    page.draw(&Text::new(
        "nothing of the object lies in front of the camera",
        at,
        style,
    ))
}
