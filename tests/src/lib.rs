//! What the cross-crate tests share: the table of tolerances, where the real data lies, which
//! directions a component knows, files of points, and scenes to check poses against.

pub mod data;
pub mod directions;
pub mod points_file;
pub mod scene_file;
pub mod tolerance;
