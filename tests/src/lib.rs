//! What the cross-crate tests share: the table of tolerances, where the real data lies,
//! and files of points.

pub mod data;
pub mod points_file;
pub mod tolerance;
