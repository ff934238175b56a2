//! How a series looks.

use super::{Area, Drawn};
use crate::demo::Verdict;
use crate::demo::style::{INK, PAPER};
use plotters::element::DashedPathElement;
use plotters::prelude::*;

/// Colours that stay apart for every common kind of colour blindness.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Colour {
    /// What this project does.
    Teal,
    /// What the paper prints or does.
    Vermilion,
    Blue,
    Ochre,
    Violet,
    Ink,
}

impl Colour {
    pub(super) fn rgb(self) -> RGBColor {
        match self {
            Self::Teal => Verdict::Accept.colour(),
            Self::Vermilion => Verdict::Reject.colour(),
            Self::Blue => RGBColor(38, 96, 190),
            Self::Ochre => RGBColor(184, 134, 11),
            Self::Violet => RGBColor(134, 72, 150),
            Self::Ink => INK,
        }
    }
}

/// What stands where a value is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mark {
    None,
    Dot,
    Disc,
    Ring,
    Square,
    Triangle,
    Cross,
    Plus,
    /// A short upright stroke, for what was printed.
    Stroke,
}

/// How a series looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Look {
    pub(crate) colour: Colour,
    pub(crate) mark: Mark,
    /// Whether a line joins the values, and whether it is broken.
    pub(crate) line: Option<Dash>,
}

/// How a line runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Dash {
    Solid,
    Broken,
}

impl Look {
    pub(crate) const fn marks(colour: Colour, mark: Mark) -> Self {
        Self {
            colour,
            mark,
            line: None,
        }
    }

    pub(crate) const fn joined(colour: Colour, mark: Mark) -> Self {
        Self {
            colour,
            mark,
            line: Some(Dash::Solid),
        }
    }

    pub(crate) const fn broken(colour: Colour, mark: Mark) -> Self {
        Self {
            colour,
            mark,
            line: Some(Dash::Broken),
        }
    }

    /// The mark at a place of the page.
    pub(super) fn mark(self, page: &Area<'_>, (x, y): (i32, i32)) -> Drawn {
        let colour = self.colour.rgb();
        let stroke = colour.stroke_width(2);
        let square = |half: i32| [(x - half, y - half), (x + half, y + half)];
        let line = |ends: [(i32, i32); 2], style: ShapeStyle| {
            PathElement::new(ends.map(|(across, down)| (x + across, y + down)), style)
        };
        match self.mark {
            Mark::None => {}
            Mark::Dot => page.draw(&Circle::new((x, y), 2, colour.mix(0.45).filled()))?,
            Mark::Disc => {
                page.draw(&Circle::new((x, y), 6, PAPER.filled()))?;
                page.draw(&Circle::new((x, y), 5, colour.filled()))?;
            }
            Mark::Ring => {
                page.draw(&Circle::new((x, y), 5, PAPER.filled()))?;
                page.draw(&Circle::new((x, y), 5, stroke))?;
            }
            Mark::Square => {
                page.draw(&Rectangle::new(square(6), PAPER.filled()))?;
                page.draw(&Rectangle::new(square(5), colour.filled()))?;
            }
            Mark::Triangle => {
                let corners =
                    [(-6, 5), (6, 5), (0, -7)].map(|(across, down)| (x + across, y + down));
                page.draw(&Polygon::new(corners, colour.filled()))?;
            }
            Mark::Cross => {
                page.draw(&line([(-5, -5), (5, 5)], stroke))?;
                page.draw(&line([(-5, 5), (5, -5)], stroke))?;
            }
            Mark::Plus => {
                page.draw(&line([(-6, 0), (6, 0)], stroke))?;
                page.draw(&line([(0, -6), (0, 6)], stroke))?;
            }
            Mark::Stroke => page.draw(&line([(0, -9), (0, 9)], colour.stroke_width(4)))?,
        }
        Ok(())
    }

    /// Joins places of the page.
    pub(super) fn join(self, page: &Area<'_>, places: &[(i32, i32)]) -> Drawn {
        let style = self.colour.rgb().stroke_width(2);
        match self.line {
            Some(Dash::Solid) => page.draw(&PathElement::new(places.to_vec(), style))?,
            Some(Dash::Broken) => {
                let places = places.iter().copied();
                page.draw(&DashedPathElement::new(places, 6, 5, style))?;
            }
            None => {}
        }
        Ok(())
    }

    /// The look in a legend, on the 24 pixels from a place.
    pub(super) fn sample(self, page: &Area<'_>, (x, y): (i32, i32)) -> Drawn {
        self.join(page, &[(x, y), (x + 24, y)])?;
        let look = match self.mark {
            // Too small to be known by.
            Mark::Dot => Self::marks(self.colour, Mark::Disc),
            _ => self,
        };
        look.mark(page, (x + 12, y))
    }
}
