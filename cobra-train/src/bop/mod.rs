//! The BOP benchmark's files (T. Hodaň et al., BOP: Benchmark for 6D Object Pose Estimation, ECCV
//! 2018): data sets, results, and what follows from them before anything is scored.
//!
//! Owns names, units and keys of these files, the symmetries that `models_info.json` states, and depth
//! rendered from true poses where a data set has none, and which of all that belongs to an estimate when
//! it is scored. Lengths are millimetres throughout. Does not own errors of poses ([`crate::pose`]) nor
//! the check against depth ([`cobra_infer::depth`]).

pub mod dataset;
mod objects;
pub mod render;
pub mod results;
pub mod score;
pub mod symmetry;
pub mod templates;
