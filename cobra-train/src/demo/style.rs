//! The picture's visual vocabulary: colours, type sizes, and one mark for each decision.
//!
//! Teal and vermilion stay apart for every common kind of colour blindness, and no meaning rests on
//! colour alone: each decision also has a shape and a word.

use std::convert::Infallible;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::FontStyle;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::canvas::Canvas;
use super::picture::Verdict;

/// The page is drawn this many times larger, and then reduced.
pub(crate) const SUPERSAMPLING: i32 = 2;

/// A length of the finished picture, in pixels of the page.
pub(crate) const fn px(length: i32) -> i32 {
    length * SUPERSAMPLING
}

pub(crate) const PAPER: RGBColor = RGBColor(255, 255, 255);
pub(crate) const INK: RGBColor = RGBColor(28, 32, 40);
pub(crate) const QUIET: RGBColor = RGBColor(92, 98, 110);
pub(crate) const HAIRLINE: RGBColor = RGBColor(226, 229, 234);

pub(crate) type Page<'a> = DrawingArea<Canvas<'a>, Shift>;
pub(crate) type Drawn = Result<(), DrawingAreaErrorKind<Infallible>>;

impl Verdict {
    pub(super) const ALL: [Self; 3] = [Self::Accept, Self::Undecided, Self::Reject];

    pub(crate) fn colour(self) -> RGBColor {
        match self {
            Self::Accept => RGBColor(0, 124, 118),
            Self::Undecided => RGBColor(104, 110, 124),
            Self::Reject => RGBColor(208, 66, 10),
        }
    }

    /// What lies behind a panel: a breath of the decision's colour.
    pub(crate) fn background(self) -> [u8; 3] {
        match self {
            Self::Accept => [238, 248, 247],
            Self::Undecided => [243, 244, 246],
            Self::Reject => [254, 243, 237],
        }
    }

    pub(crate) fn verdict(self) -> &'static str {
        match self {
            Self::Accept => "ACCEPT",
            Self::Undecided => "UNDECIDED",
            Self::Reject => "REJECT",
        }
    }

    pub(super) fn participle(self) -> &'static str {
        match self {
            Self::Accept => "accepted",
            Self::Undecided => "undecided",
            Self::Reject => "rejected",
        }
    }
}

/// Type of `size` pixels of the finished picture.
pub(crate) fn text(size: i32, colour: RGBColor, across: HPos, up: VPos) -> TextStyle<'static> {
    TextStyle {
        font: ("sans-serif", px(size)).into_font(),
        color: colour.to_backend_color(),
        pos: Pos::new(across, up),
    }
}

/// As [`text`], in bold.
pub(crate) fn bold(size: i32, colour: RGBColor, across: HPos, up: VPos) -> TextStyle<'static> {
    let style = text(size, colour, across, up);
    TextStyle {
        font: style.font.style(FontStyle::Bold),
        ..style
    }
}

/// The mark of a decision in a plot: a disc, a cross or a square.
pub(super) fn mark(page: &Page, decision: Verdict, (x, y): (i32, i32)) -> Drawn {
    let colour = decision.colour();
    match decision {
        Verdict::Accept => {
            page.draw(&Circle::new((x, y), px(6), PAPER.filled()))?;
            page.draw(&Circle::new((x, y), px(5), colour.mix(0.85).filled()))
        }
        Verdict::Undecided => {
            let square = |half: i32| [(x - half, y - half), (x + half, y + half)];
            page.draw(&Rectangle::new(square(px(5)), PAPER.filled()))?;
            page.draw(&Rectangle::new(square(px(4)), colour.mix(0.85).filled()))
        }
        Verdict::Reject => {
            cross(page, (x, y), px(5), PAPER.stroke_width(px(4) as u32))?;
            cross(
                page,
                (x, y),
                px(5),
                colour.mix(0.9).stroke_width(px(2) as u32 + 1),
            )
        }
    }
}

/// A seal: the decision's sign in white on a disc of its colour.
pub(crate) fn seal(page: &Page, decision: Verdict, (x, y): (i32, i32)) -> Drawn {
    let white = PAPER.stroke_width(px(3) as u32);
    page.draw(&Circle::new((x, y), px(15), PAPER.filled()))?;
    page.draw(&Circle::new((x, y), px(13), decision.colour().filled()))?;
    match decision {
        Verdict::Accept => page.draw(&PathElement::new(
            vec![
                (x - px(6), y),
                (x - px(2), y + px(5)),
                (x + px(6), y - px(5)),
            ],
            white,
        )),
        Verdict::Undecided => page.draw(&PathElement::new(
            vec![(x - px(6), y), (x + px(6), y)],
            white,
        )),
        Verdict::Reject => cross(page, (x, y), px(5), white),
    }
}

/// A panel's letter in white on a disc of its decision's colour.
pub(super) fn letter(page: &Page, decision: Verdict, index: usize, at: (i32, i32)) -> Drawn {
    page.draw(&Circle::new(at, px(14), PAPER.filled()))?;
    page.draw(&Circle::new(at, px(12), decision.colour().filled()))?;
    let name = char::from(b'A' + index as u8).to_string();
    let style = bold(15, PAPER, HPos::Center, VPos::Center);
    page.draw(&Text::new(name, at, style))
}

fn cross(page: &Page, (x, y): (i32, i32), arm: i32, style: ShapeStyle) -> Drawn {
    for rise in [-arm, arm] {
        let ends = vec![(x - arm, y - rise), (x + arm, y + rise)];
        page.draw(&PathElement::new(ends, style))?;
    }
    Ok(())
}
