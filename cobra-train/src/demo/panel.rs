//! One panel of the picture: an estimate over the observed object, framed and captioned in its
//! decision's colour.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use super::picture::ScoredPose;
use super::style::{Drawn, HAIRLINE, INK, PAPER, Page, QUIET, bold, letter, px, seal, text};

/// Width of a panel, frame included.
pub(super) const WIDTH: i32 = px(296);
/// Height of a panel, frame and caption included.
pub(super) const HEIGHT: i32 = px(288);

const FRAME: i32 = px(4);
const IMAGE_HEIGHT: i32 = px(228);

/// Columns and rows of the rendering inside the frame.
pub(super) const RENDERING: (u32, u32) = (
    (WIDTH - 2 * FRAME) as u32,
    (IMAGE_HEIGHT - 2 * FRAME) as u32,
);

/// Where the rendering belongs in a panel with this upper left corner.
pub(super) fn rendering_corner((left, top): (i32, i32)) -> (u32, u32) {
    ((left + FRAME) as u32, (top + FRAME) as u32)
}

/// Draws everything but the rendering of the panel with this upper left corner.
pub(super) fn draw(page: &Page, (left, top): (i32, i32), index: usize, pose: &ScoredPose) -> Drawn {
    let colour = pose.verdict.colour();
    let right = left + WIDTH;
    let floor = top + IMAGE_HEIGHT;
    for (from, to) in [
        ((left, top), (right, top + FRAME)),
        ((left, floor - FRAME), (right, floor)),
        ((left, top), (left + FRAME, floor)),
        ((right - FRAME, top), (right, floor)),
    ] {
        let side = [from, (to.0 - 1, to.1 - 1)];
        page.draw(&Rectangle::new(side, colour.filled()))?;
    }
    letter(page, pose.verdict, index, (left + px(24), top + px(24)))?;
    seal(page, pose.verdict, (right - px(25), top + px(25)))?;

    let verdict = floor + px(19);
    page.draw(&Text::new(
        pose.verdict.verdict(),
        (left, verdict),
        bold(17, colour, HPos::Left, VPos::Center),
    ))?;
    page.draw(&Text::new(
        format!("ADD {}", millimetres(pose.error_mm)),
        (right, verdict),
        text(17, INK, HPos::Right, VPos::Center),
    ))?;

    let line = floor + px(45);
    page.draw(&Text::new(
        format!("confidence {:.2}", pose.confidence),
        (left, line),
        text(16, QUIET, HPos::Left, VPos::Center),
    ))?;
    gauge(page, (left + px(150), line), right - left - px(150), pose)
}

/// A bar as long as the confidence, with a tick at the threshold.
fn gauge(page: &Page, (left, middle): (i32, i32), width: i32, pose: &ScoredPose) -> Drawn {
    let at = |share: f64| left + (share.clamp(0.0, 1.0) * f64::from(width)).round() as i32;
    let bar = |from: i32, to: i32, half: i32, colour: RGBColor| {
        let corners = [(from, middle - half), (to - 1, middle + half - 1)];
        page.draw(&Rectangle::new(corners, colour.filled()))
    };
    bar(left, left + width, px(5), HAIRLINE)?;
    bar(left, at(pose.confidence), px(5), pose.verdict.colour())?;
    let threshold = at(pose.threshold);
    bar(threshold - px(2), threshold + px(2), px(9), PAPER)?;
    bar(threshold - px(1), threshold + px(1), px(9), INK)
}

/// A length with two significant digits at least.
fn millimetres(length: f64) -> String {
    if length < 1.0 {
        format!("{length:.2} mm")
    } else {
        format!("{length:.1} mm")
    }
}
