//! The command `cobra`, run as its users run it.

mod ambiguity;
mod auto;
mod bop;
mod calibrate;
mod calibrate_simulated;
mod camera_input;
mod demo;
mod eval;
mod export;
mod export_input;
mod geometry_input;
mod help;
mod inspect;
mod learning;
mod map;
mod output;
mod overlay;
mod placement;
mod run;
mod scene;
mod score;
mod score_input;
mod score_warnings;
mod template_input;
mod train;
mod train_input;
