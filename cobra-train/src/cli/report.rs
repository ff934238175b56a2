//! Tables for people and JSON for programs.

use super::failure::Failure;
use super::terminal::{Terminal, one_line};
use cobra_train::output::write_whole;
use comfy_table::{CellAlignment, Table, presets};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Where JSON goes: to a file, or with `-` to standard output in place of the table.
pub(crate) struct JsonTarget<'a>(pub(crate) Option<&'a PathBuf>);

impl JsonTarget<'_> {
    pub(crate) fn replaces_the_table(&self) -> bool {
        self.0.is_some_and(|path| path == Path::new("-"))
    }

    pub(crate) fn write(
        &self,
        document: &impl Serialize,
        terminal: &Terminal,
    ) -> Result<(), Failure> {
        let Some(path) = self.0 else { return Ok(()) };
        let text = serde_json::to_string_pretty(document)
            .map_err(|error| Failure::Io(format!("cannot write JSON: {error}")))?;
        if self.replaces_the_table() {
            terminal.print(&text)
        } else {
            Ok(write_whole(path, format!("{text}\n").as_bytes())?)
        }
    }
}

/// A plain table: columns named in `left` are text, the others are numbers and stand right.
pub(crate) fn table(header: &[&str], left: &[&str], rows: &[Vec<String>]) -> String {
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    table.set_header(header);
    for row in rows {
        table.add_row(row.iter().map(|cell| one_line(cell)));
    }
    for (column, name) in table.column_iter_mut().zip(header) {
        column.set_padding((0, 2));
        if !left.contains(name) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table
        .to_string()
        .lines()
        .map(str::trim_end)
        .collect::<Vec<_>>()
        .join("\n")
}

/// `text` unless the number says otherwise: `1 point`, `2 points`.
pub(crate) fn plural(count: usize, noun: &str) -> String {
    if count == 1 {
        format!("1 {noun}")
    } else {
        format!("{count} {noun}s")
    }
}
