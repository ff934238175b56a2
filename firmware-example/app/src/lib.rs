//! What every board runs: no start-up code, no device.
//!
//! | module | owns |
//! |---|---|
//! | [`score`] | the example: a template in flash, a stream of correspondences, a watchdog, a report |
//! | [`footprint`] | the least that a controller links: load and score, nothing printed |
//! | [`footprint_depth`] | the same of a check against depth |
//! | [`agreement`] | the recorded vectors, scored here and compared bit by bit |
//! | [`budget`] | stack and instructions of load and score |
//! | [`encodings`] | bytes and instructions of a term by how it is written |
//! | `object` | a template of one's own: instructions a point, and the host's bits; with `semihosting` |
//! | `object_depth` | the same of checks against a depth image |
//! | [`stack`] | how deep a call reaches into the stack |
//! | `console` | standard output through a debugger, with the feature `semihosting` |
#![no_std]

pub mod agreement;
pub mod budget;
#[cfg(feature = "semihosting")]
pub mod console;
pub mod encodings;
pub mod footprint;
pub mod footprint_depth;
#[cfg(feature = "semihosting")]
pub mod object;
#[cfg(feature = "semihosting")]
pub mod object_depth;
pub mod score;
pub mod stack;

/// What the application needs of a board.
pub trait Board {
    /// Its name, as QEMU has it.
    fn name(&self) -> &'static str;
    /// Tells the watchdog that the program is alive.
    fn feed_watchdog(&mut self);
    /// Instructions that the emulator has executed, from any start, wrapping around: only
    /// differences mean something.
    fn instructions(&mut self) -> u64;
}

/// Something did not come out as it should, and was told, or could not be told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Failed;

impl From<core::fmt::Error> for Failed {
    fn from(_: core::fmt::Error) -> Self {
        Self
    }
}
