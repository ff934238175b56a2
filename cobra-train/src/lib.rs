//! Trains, evaluates and applies COBRA shape templates.

pub mod demo;
pub mod surface;
