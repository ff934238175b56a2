//! What the cross-crate tests share: the table of tolerances, where the real data lies, which
//! directions a component knows, and files of points.

pub mod data;
pub mod directions;
pub mod points_file;
pub mod tolerance;
