//! What the colours and the patterns mean.

use super::colour::diverging;
use super::figures::length;
use super::layer::Patch;
use crate::demo::RgbImage;
use crate::demo::style::{Drawn, INK, Page, QUIET, px, text};
use cobra_infer::Unit;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

/// Height of the legend.
pub(super) const HEIGHT: i32 = px(76);

const BAR: (i32, i32) = (px(420), px(16));

const SWATCH: (u32, u32) = (px(28) as u32, px(20) as u32);

const PATTERNS: [(Patch, &str); 4] = [
    (Patch::Through, "seen through: over 3σ behind"),
    (Patch::Hidden, "hidden by something nearer"),
    (Patch::Unmeasured, "not measured"),
    (Patch::Silent, "observed, no surface near"),
];

/// Where the first swatch is, from the legend's left end, and how far the next is from there.
const FIRST: i32 = px(516);
const NEXT: (i32, i32) = (px(276), px(32));

/// The part that is painted: the bar and the swatches, on the page's image.
pub(super) fn paint(image: &mut RgbImage, (left, top): (i32, i32)) {
    let (width, height) = (BAR.0.cast_unsigned(), BAR.1.cast_unsigned());
    let mut bar = RgbImage::filled(width, height, [0; 3]);
    for (at, pixel) in (0_u32..).zip(bar.pixels.as_chunks_mut::<3>().0) {
        let share = 2.0 * ((at % width) as f32 + 0.5) / width as f32 - 1.0;
        *pixel = diverging(share);
    }
    image.paste(((left + px(16)).cast_unsigned(), top.cast_unsigned()), &bar);
    for (index, (patch, _)) in (0..).zip(PATTERNS) {
        let (x, y) = swatch((left, top), index);
        let swatch = patch.swatch(SWATCH.0, SWATCH.1);
        image.paste((x.cast_unsigned(), y.cast_unsigned()), &swatch);
    }
}

fn swatch((left, top): (i32, i32), index: i32) -> (i32, i32) {
    let (column, row) = (index % 2, index / 2);
    (left + FIRST + column * NEXT.0, top + row * NEXT.1)
}

/// Where colours are strongest.
#[derive(Clone, Copy)]
pub(super) enum Strongest {
    /// At a residual of this length.
    Length(f32, Unit),
    /// At so many σ_m, each estimate's own.
    Sigmas(f32),
}

impl Strongest {
    /// What a share of it, not negative, is.
    fn share(self, share: f32) -> String {
        match self {
            Self::Length(limit, unit) => length(share * limit, unit),
            Self::Sigmas(sigmas) if share * sigmas == 1.0 => "σ".to_owned(),
            Self::Sigmas(sigmas) => format!("{}σ", share * sigmas),
        }
    }
}

/// The words, once the page is painted.
pub(super) fn draw(page: &Page<'_>, (left, top): (i32, i32), strongest: Strongest) -> Drawn {
    let start = left + px(16);
    for share in [-1.0_f32, -0.5, 0.0, 0.5, 1.0] {
        let x = start + (0.5 * (share + 1.0) * BAR.0 as f32).round() as i32;
        let tick = [(x, top + BAR.1), (x, top + BAR.1 + px(4))];
        page.draw(&PathElement::new(
            tick.to_vec(),
            INK.stroke_width(px(1) as u32),
        ))?;
        let words = match share {
            0.0 => "0".to_owned(),
            share if share < 0.0 => format!("−{}", strongest.share(-share)),
            share => strongest.share(share),
        };
        page.draw(&Text::new(
            words,
            (x, top + BAR.1 + px(14)),
            text(14, INK, HPos::Center, VPos::Center),
        ))?;
    }
    for (words, x, across) in [
        ("seen in front of where the pose puts it", start, HPos::Left),
        ("seen behind it", start + BAR.0, HPos::Right),
    ] {
        let at = (x, top + BAR.1 + px(36));
        page.draw(&Text::new(words, at, text(14, QUIET, across, VPos::Center)))?;
    }
    for (index, (_, words)) in (0..).zip(PATTERNS) {
        let (x, y) = swatch((left, top), index);
        let at = (
            x + SWATCH.0.cast_signed() + px(10),
            y + SWATCH.1.cast_signed() / 2,
        );
        page.draw(&Text::new(
            words,
            at,
            text(14, INK, HPos::Left, VPos::Center),
        ))?;
    }
    Ok(())
}
