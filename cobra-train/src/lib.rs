//! Trains, evaluates and applies COBRA shape templates.

pub mod surface;
