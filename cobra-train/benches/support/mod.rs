//! What both benchmarks need: objects, sizes, and a table of medians and their ratios.

mod object;
mod size;
mod table;

pub(crate) use object::{Object, objects};
pub(crate) use size::Size;
pub(crate) use table::Table;
