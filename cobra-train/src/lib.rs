//! Trains, evaluates and applies COBRA shape templates.

pub mod demo;
pub mod evaluate;
pub mod gp;
pub mod input;
pub mod output;
pub mod pose;
pub mod progress;
pub mod random;
pub mod reference;
pub mod surface;
pub mod train;
