//! Scores recorded vectors and compares every bit: on the host, under emulators, on bare metal.
//!
//! Owns what a target must reproduce: the [`vectors`] that every board scores, the [`depth`] images that it
//! checks poses against, and with the feature `golden` the replay of the [`golden`] templates of every kernel;
//! the [`report`] is what boards, other
//! processors and WebAssembly print of them. Needs `core`, `cobra-infer` and `libm` alone and stores
//! nothing.
#![no_std]

pub mod depth;
pub mod golden;
pub mod object;
pub mod report;
pub mod square_root;
pub mod vectors;

pub use vectors::{Outcome, SETS, Set};
