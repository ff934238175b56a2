//! Poses on the host: simulated errors, and how large an error is.
//!
//! Owns what needs the truth. What judges a pose without it is `cobra-infer`.

mod error;
mod simulate;

pub use error::add;
pub use simulate::{ObservationNoise, disturb, observe};
