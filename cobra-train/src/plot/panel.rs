//! One plot of a page.

use super::{Area, Axis, Drawn, Look, style};
use crate::demo::style::{HAIRLINE, INK, QUIET};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

/// What stands in a panel, in the axes' numbers.
pub(crate) enum Item {
    /// Values of one kind, in the order in which a line joins them; what is no number is left out.
    Series(Look, Vec<(f64, f64)>),
    /// A line across at a height, with what it says at its right end.
    Rule(Look, f64, String),
    /// A rectangle between two corners, of a share from 0 (paper) to 1 (full colour), with what it says.
    Cell([(f64, f64); 2], f64, String),
    /// Words to the right of a place.
    Words((f64, f64), String),
}

/// One plot of a page.
pub(crate) struct Panel<'a> {
    pub(crate) heading: String,
    pub(crate) across: Axis<'a>,
    pub(crate) up: Axis<'a>,
    /// Room for the texts of the ticks of `up`, in pixels.
    pub(crate) room: u32,
    pub(crate) items: Vec<Item>,
}

/// Room for the ticks' texts and what the axis is called.
const ROOM_BELOW: u32 = 52;

/// Room between the values and the edge of a panel, in pixels.
const ROOM_RIGHT: i32 = 16;

impl Panel<'_> {
    pub(super) fn draw(&self, page: &Area<'_>, area: &Area<'_>) -> Drawn {
        let heading = style(16, INK, HPos::Left, VPos::Center);
        area.draw(&Text::new(self.heading.clone(), (8, 14), heading))?;
        let below = area.margin(28, 6, 0, ROOM_RIGHT);
        let range = |axis: &Axis<'_>| axis.range.0..axis.range.1;
        let chart = ChartBuilder::on(&below)
            .x_label_area_size(ROOM_BELOW)
            .y_label_area_size(self.room)
            .build_cartesian_2d(range(&self.across), range(&self.up))?;
        self.frame(page, &|x, y| chart.backend_coord(&(x, y)))?;
        let at = |(x, y): (f64, f64)| chart.backend_coord(&(self.across.at(x), self.up.at(y)));
        for item in &self.items {
            match item {
                Item::Series(look, values) => {
                    let finite = values
                        .iter()
                        .filter(|(x, y)| x.is_finite() && y.is_finite());
                    let places: Vec<(i32, i32)> = finite.map(|value| at(*value)).collect();
                    look.join(page, &places)?;
                    for place in places {
                        look.mark(page, place)?;
                    }
                }
                Item::Rule(look, height, words) => {
                    let ends = [self.across.range.0, self.across.range.1]
                        .map(|x| chart.backend_coord(&(x, self.up.at(*height))));
                    look.join(page, &ends)?;
                    let [_, (right, y)] = ends;
                    let words_style = style(13, look.colour.rgb(), HPos::Right, VPos::Bottom);
                    page.draw(&Text::new(words.clone(), (right - 4, y - 2), words_style))?;
                }
                Item::Cell(corners, share, words) => {
                    let corners = corners.map(at);
                    let colour = cell_colour(*share);
                    page.draw(&Rectangle::new(corners, colour.filled()))?;
                    let middle = (
                        i32::midpoint(corners[0].0, corners[1].0),
                        i32::midpoint(corners[0].1, corners[1].1),
                    );
                    let ink = if *share > 0.55 { WHITE } else { INK };
                    let words_style = style(14, ink, HPos::Center, VPos::Center);
                    page.draw(&Text::new(words.clone(), middle, words_style))?;
                }
                Item::Words(place, words) => {
                    let (x, y) = at(*place);
                    let words_style = style(13, QUIET, HPos::Left, VPos::Center);
                    page.draw(&Text::new(words.clone(), (x + 10, y), words_style))?;
                }
            }
        }
        Ok(())
    }
}

impl Panel<'_> {
    /// Ticks, the lines from them, and what the axes are called. Plotters' own are where it likes.
    fn frame(&self, page: &Area<'_>, place: &dyn Fn(f64, f64) -> (i32, i32)) -> Drawn {
        let (left, bottom) = place(self.across.range.0, self.up.range.0);
        let (right, top) = place(self.across.range.1, self.up.range.1);
        let line =
            |from, to, colour: RGBColor| PathElement::new([from, to], colour.stroke_width(1));
        for (value, text) in &self.across.ticks {
            let x = place(*value, self.up.range.0).0;
            page.draw(&line((x, top), (x, bottom), HAIRLINE))?;
            page.draw(&line((x, bottom), (x, bottom + 4), QUIET))?;
            let words = style(14, INK, HPos::Center, VPos::Top);
            page.draw(&Text::new(text.clone(), (x, bottom + 7), words))?;
        }
        for (value, text) in &self.up.ticks {
            let y = place(self.across.range.0, *value).1;
            page.draw(&line((left, y), (right, y), HAIRLINE))?;
            page.draw(&line((left - 4, y), (left, y), QUIET))?;
            let words = style(14, INK, HPos::Right, VPos::Center);
            page.draw(&Text::new(text.clone(), (left - 8, y), words))?;
        }
        page.draw(&line((left, top), (left, bottom), QUIET))?;
        page.draw(&line((left, bottom), (right, bottom), QUIET))?;
        let words = style(15, INK, HPos::Center, VPos::Bottom);
        let below = (i32::midpoint(left, right), bottom + ROOM_BELOW as i32 - 4);
        page.draw(&Text::new(
            self.across.label.to_owned(),
            below,
            words.clone(),
        ))?;
        let words = style(15, INK, HPos::Center, VPos::Top).transform(FontTransform::Rotate270);
        let beside = (left - self.room as i32, i32::midpoint(top, bottom));
        page.draw(&Text::new(self.up.label.to_owned(), beside, words))?;
        Ok(())
    }
}

/// From paper to the demonstration's teal, darker beyond it.
fn cell_colour(share: f64) -> RGBColor {
    let (from, to) = ([246.0, 249.0, 249.0], [0.0, 92.0, 88.0]);
    let share = share.clamp(0.0, 1.0);
    let [red, green, blue] =
        std::array::from_fn(|i| (from[i] + share * (to[i] - from[i])).round() as u8);
    RGBColor(red, green, blue)
}
