//! Trains, evaluates and applies COBRA shape templates.

pub mod gp;
pub mod random;
pub mod reference;
pub mod surface;
