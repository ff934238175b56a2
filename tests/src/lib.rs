//! What the cross-crate tests share: the table of tolerances, where the real data lies, and the
//! replay of recorded scores.

pub mod data;
pub mod golden;
pub mod tolerance;
