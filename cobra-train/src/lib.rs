//! Trains, evaluates and applies COBRA shape templates.
