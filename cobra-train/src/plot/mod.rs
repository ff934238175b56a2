//! Plots as SVG: a page with a heading, a legend and panels.
//!
//! Owns how pages look: colours, type sizes, ticks, marks. What is plotted is the business of whoever
//! asks. Text is the viewer's sans-serif, of which no width is known here: everything is anchored so that
//! none is needed. No meaning rests on colour alone: each look has a mark or a dash of its own.

mod axis;
mod look;
mod panel;

pub(crate) use axis::Axis;
pub(crate) use look::{Colour, Look, Mark};
pub(crate) use panel::{Item, Panel};

use crate::demo::style::{INK, PAPER, QUIET};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Why a plot could not be drawn.
#[derive(Debug, thiserror::Error)]
#[error("cannot draw: {0}")]
pub struct PlotError(pub(crate) String);

pub(crate) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub(crate) type Drawn = Result<(), Box<dyn std::error::Error>>;

/// From the page's left edge to its text.
const MARGIN: i32 = 28;

/// What the heading takes of a page's height, and a row of the legend.
const HEADING: i32 = 76;
const LEGEND_ROW: i32 = 26;

/// Type of `size` pixels.
pub(crate) fn style(size: i32, colour: RGBColor, across: HPos, up: VPos) -> TextStyle<'static> {
    let font = ("sans-serif", size).into_font();
    font.color(&colour).pos(Pos::new(across, up))
}

/// An empty page with its heading, and what is left of it.
pub(crate) fn headed<'a>(
    text: &'a mut String,
    size: (u32, u32),
    title: &str,
    subtitle: &str,
) -> Result<(Area<'a>, Area<'a>), Box<dyn std::error::Error>> {
    let page: Area<'_> = SVGBackend::with_string(text, size).into_drawing_area();
    page.fill(&PAPER)?;
    let left = |text: &str, y, size, colour| {
        let style = style(size, colour, HPos::Left, VPos::Center);
        Text::new(text.to_owned(), (MARGIN, y), style)
    };
    page.draw(&left(title, 30, 22, INK))?;
    page.draw(&left(subtitle, 58, 16, QUIET))?;
    let below = page.margin(HEADING, 14, 14, MARGIN);
    Ok((page, below))
}

/// A page of panels.
pub(crate) struct Page<'a> {
    pub(crate) title: &'a str,
    /// What was measured, below the title.
    pub(crate) subtitle: &'a str,
    /// What the looks stand for.
    pub(crate) legend: &'a [(Look, String)],
    /// Panels beside each other.
    pub(crate) columns: usize,
    /// A panel's width and height, in pixels.
    pub(crate) panel: (u32, u32),
}

/// Room for a title.
const LEAST_WIDTH: u32 = 760;

/// An entry of the legend is so wide.
const ENTRY: i32 = 270;

impl Page<'_> {
    /// The page as text.
    ///
    /// # Errors
    /// [`PlotError`].
    pub(crate) fn svg(&self, panels: &[Panel<'_>]) -> Result<String, PlotError> {
        let mut text = String::new();
        self.onto(&mut text, panels)
            .map_err(|error| PlotError(error.to_string()))?;
        Ok(text)
    }

    fn onto(&self, text: &mut String, panels: &[Panel<'_>]) -> Drawn {
        let columns = self.columns.clamp(1, panels.len().max(1));
        let rows = panels.len().div_ceil(columns).max(1);
        let width = (columns as u32 * self.panel.0 + MARGIN as u32 + 14).max(LEAST_WIDTH);
        let beside = (((width as i32 - MARGIN) / ENTRY).max(1) as usize).min(self.legend.len());
        let legend = LEGEND_ROW * self.legend.len().div_ceil(beside.max(1)) as i32;
        let height = rows as u32 * self.panel.1 + (HEADING + legend + 20) as u32;
        let (page, below) = headed(text, (width, height), self.title, self.subtitle)?;
        for (index, (look, name)) in self.legend.iter().enumerate() {
            let (row, column) = (index / beside, index % beside);
            let x = MARGIN + ENTRY * column as i32;
            let y = HEADING + LEGEND_ROW * row as i32 + 8;
            look.sample(&page, (x, y))?;
            let style = style(15, INK, HPos::Left, VPos::Center);
            page.draw(&Text::new(name.clone(), (x + 34, y), style))?;
        }
        let plots = below.margin(legend, 0, 0, 0);
        for (panel, area) in panels.iter().zip(plots.split_evenly((rows, columns))) {
            panel.draw(&page, &area)?;
        }
        page.present()?;
        Ok(())
    }
}
