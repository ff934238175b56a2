//! What the cross-crate tests share: the table of tolerances, where the real data lies, which
//! directions a component knows, files of points, scenes to check poses against, and the experiments'
//! committed numbers.

pub mod csv;
pub mod data;
pub mod directions;
pub mod points_file;
pub mod scene_file;
pub mod tolerance;
