//! What the crate promises, tested from outside: templates that are refused or loaded whole, sums
//! in the documented order, scores that are never NaN, and decisions with their reasons.
//!
//! One binary, so that its helpers are compiled once. `tolerance` is the one table of what is
//! allowed to differ.

mod charts;
mod content;
mod decisions;
mod depth;
mod depth_input;
mod depth_reasons;
mod depth_scene;
mod depth_section;
mod geometry;
mod hostile_input;
mod invariance;
mod map;
mod mixture;
mod posterior_mean;
mod precisions;
mod scene;
mod sections;
mod seed;
mod soft;
mod sphere;
mod template_mutations;
mod template_numbers;
mod template_round_trip;
mod template_sections;
mod tolerance;
mod tracking;
mod uncovered;
mod validity;
