//! The page of several estimates: the whole image with all of them, and a list beside it.

use super::backdrop::shown;
use super::estimate::OverlayEstimate;
use super::figures::{gauge, wrapped};
use super::layer::Layer;
use super::legend::Strongest;
use super::view::View;
use super::{MARGIN, Overlay, SIGMAS, WIDTH, legend, on};
use crate::demo::RgbImage;
use crate::demo::style::{Drawn, INK, PAPER, Page, QUIET, bold, px, seal, text};
use nalgebra::Point2;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

const WHOLE: i32 = px(1104);
const TOP: i32 = px(96);
/// The list's left end.
const LIST: i32 = MARGIN + WHOLE + px(32);
/// From one entry of the list to the next, at most.
const ENTRY: i32 = px(98);

/// The height of the page for an image.
pub(super) fn height(photo: &RgbImage) -> i32 {
    let view = View::whole((photo.width, photo.height), WHOLE as u32);
    TOP + view.size().1.cast_signed() + px(28) + legend::HEIGHT + px(16)
}

pub(super) fn draw(
    image: &mut RgbImage,
    overlay: &Overlay<'_>,
    estimates: &[OverlayEstimate],
) -> Drawn {
    let photo = overlay.photo;
    let view = View::whole((photo.width, photo.height), WHOLE as u32);
    let mut picture = shown(photo, &view, 0.35, 0.2);
    for estimate in estimates {
        let layer = Layer::of_surface(view, &estimate.residuals);
        let (red, green, blue) = estimate.verdict().colour().rgb();
        layer.paint(&mut picture, overlay.limit(estimate), 0.9);
        layer.outline(&mut picture, [red, green, blue], px(2));
    }
    on(&mut picture, |page| labels(page, &view, estimates))?;
    image.paste((MARGIN.cast_unsigned(), TOP.cast_unsigned()), &picture);
    let floor = TOP + view.size().1.cast_signed();
    let key = (MARGIN, floor + px(28));
    legend::paint(image, key);
    on(image, |page| {
        page.draw(&Text::new(
            format!("{} estimates: where each puts its object", estimates.len()),
            (MARGIN, px(32)),
            bold(25, INK, HPos::Left, VPos::Center),
        ))?;
        page.draw(&Text::new(
            overlay.subtitle.to_owned(),
            (MARGIN, px(66)),
            text(16, QUIET, HPos::Left, VPos::Center),
        ))?;
        let strongest = match overlay.limit {
            Some(limit) => Strongest::Length(limit, estimates[0].unit),
            None => Strongest::Sigmas(SIGMAS),
        };
        legend::draw(page, key, strongest)?;
        list(page, floor - TOP, estimates)
    })
}

/// The box of each estimate in the image, in the colour of its decision, with its number.
fn labels(page: &Page<'_>, view: &View, estimates: &[OverlayEstimate]) -> Drawn {
    let (width, height) = view.size();
    let mut plates: Vec<[(i32, i32); 2]> = Vec::new();
    let mut labels = Vec::new();
    let rim = Point2::new(width as f32 - 2.0, height as f32 - 2.0);
    for (index, estimate) in estimates.iter().enumerate() {
        let points = estimate.residuals.surface.iter();
        let mut points = points.map(|point| view.place(point.pixel));
        let Some(first) = points.next() else {
            continue;
        };
        let (low, high) = points.fold((first, first), |(low, high), p| (low.inf(&p), high.sup(&p)));
        if low.x > rim.x || low.y > rim.y || high.x < 0.0 || high.y < 0.0 {
            continue;
        }
        let (low, high) = (low.sup(&Point2::new(1.0, 1.0)), high.inf(&rim));
        let [low, high] = [low, high].map(|p| (p.x as i32, p.y as i32));
        let colour = estimate.verdict().colour();
        page.draw(&Rectangle::new(
            [low, high],
            colour.stroke_width(px(2) as u32),
        ))?;
        let label = format!("{}  {:.2}", index + 1, estimate.report.confidence);
        let style = bold(15, PAPER, HPos::Left, VPos::Center);
        let (wide, _) = page.estimate_text_size(&label, &style)?;
        // Above the box, or within it at the image's upper rim.
        let top = if low.1 >= px(22) {
            low.1 - px(22)
        } else {
            low.1
        };
        let left = low.0.min(width.cast_signed() - wide.cast_signed() - px(14));
        let mut plate = [
            (left - px(1), top),
            (left + wide.cast_signed() + px(12), top + px(22)),
        ];
        // Below those that are there already.
        while let Some(other) = plates.iter().find(|other| overlap(other, &plate)) {
            let down = other[1].1 + px(1) - plate[0].1;
            plate = plate.map(|(x, y)| (x, y + down));
        }
        plates.push(plate);
        labels.push((label, colour, style));
    }
    // Last, so that no other estimate's box goes through a label.
    for (plate, (label, colour, style)) in plates.into_iter().zip(labels) {
        let (left, top) = plate[0];
        page.draw(&Rectangle::new(plate, colour.filled()))?;
        page.draw(&Text::new(label, (left + px(7), top + px(11)), style))?;
    }
    Ok(())
}

/// Whether two rectangles share a pixel.
fn overlap([a, b]: &[(i32, i32); 2], [c, d]: &[(i32, i32); 2]) -> bool {
    a.0 <= d.0 && c.0 <= b.0 && a.1 <= d.1 && c.1 <= b.1
}

/// An entry for each estimate, as many as there is room for.
fn list(page: &Page<'_>, height: i32, estimates: &[OverlayEstimate]) -> Drawn {
    let count = i32::try_from(estimates.len()).unwrap_or(i32::MAX).max(1);
    let step = (height / count).clamp(px(76), ENTRY);
    let room = usize::try_from(height / step).unwrap_or(1);
    for (index, estimate) in estimates.iter().take(room).enumerate() {
        let top = TOP + index as i32 * step;
        entry(page, top, index, estimate)?;
    }
    if estimates.len() > room {
        let more = format!("and {} more", estimates.len() - room);
        let at = (LIST, TOP + height + px(20));
        page.draw(&Text::new(
            more,
            at,
            text(15, QUIET, HPos::Left, VPos::Center),
        ))?;
    }
    Ok(())
}

fn entry(page: &Page<'_>, top: i32, index: usize, estimate: &OverlayEstimate) -> Drawn {
    let verdict = estimate.verdict();
    let right = WIDTH - MARGIN;
    seal(page, verdict, (LIST + px(15), top + px(17)))?;
    let left = LIST + px(40);
    page.draw(&Text::new(
        format!("{}  {}", index + 1, estimate.name),
        (left, top + px(10)),
        bold(16, INK, HPos::Left, VPos::Center),
    ))?;
    page.draw(&Text::new(
        verdict.verdict(),
        (right, top + px(10)),
        bold(14, verdict.colour(), HPos::Right, VPos::Center),
    ))?;
    let middle = top + px(31);
    page.draw(&Text::new(
        format!(
            "{:.2}   error {}",
            estimate.report.confidence,
            estimate.error()
        ),
        (left, middle),
        text(14, INK, HPos::Left, VPos::Center),
    ))?;
    gauge(page, (right - px(150), middle), px(150), estimate)?;
    let style = text(13, QUIET, HPos::Left, VPos::Center);
    let lines = wrapped(page, &estimate.reason(), &style, right - left, 2);
    for (row, words) in lines.into_iter().enumerate() {
        let at = (left, top + px(50) + row as i32 * px(17));
        page.draw(&Text::new(words, at, style.clone()))?;
    }
    Ok(())
}
