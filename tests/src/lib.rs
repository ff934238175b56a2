//! What the cross-crate tests share: the table of tolerances, and where the real data lies.

pub mod data;
pub mod tolerance;
