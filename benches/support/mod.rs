//! What the benchmarks of scoring and of training both need: objects, sizes, the peers that fit
//! Gaussian processes and what they are fitted to, a table of medians and their ratios.

mod component;
mod object;
mod peer;
mod size;
mod table;

pub(crate) use component::{Component, components, training_points};
pub(crate) use object::{Object, objects};
pub(crate) use peer::PEERS;
pub(crate) use size::Size;
pub(crate) use table::Table;
