//! Scores 6D object poses against a Gaussian-process shape template.
//!
//! A pose estimator says "the object is at pose T". This crate asks whether what the camera saw,
//! put back into the object's frame through T, lies on the object's surface, and answers with a
//! confidence, a threshold and a decision. It is everything that runs on the robot and nothing
//! else: no standard library, no allocator, no `unsafe`, no operating system.
//!
//! The method is that of "COBRA - COnfidence score Based on shape Regression Analysis for quality
//! assessment of object pose estimation". Equations are numbered as they follow each other in its
//! text, the kernel's own formula left out: 1 and 2 direction and distance, 3 prior, 4 and 5
//! posterior, 6 to 8 mixture, 9 likelihood with σ̂, 10 confidence, 11 threshold.
//!
//! | module | owns |
//! |---|---|
//! | [`template`] | the wire format: validation, the zero-copy view, the encoder |
//! | [`kernel`] | covariance functions, and which of them a build contains |
//! | [`gp`] | the posterior mean over borrowed arrays, and its order of summation |
//! | [`camera`] | pinhole intrinsics and back-projection |
//! | [`pose`] | rotation and translation, checked |
//! | [`validity`] | the directions and the boxes in which a component may speak |
//! | [`mixture`] | the likelihood of one object-frame point under a template |
//! | [`mod@score`] | the streaming scorer, the confidence of Eq. 10, the decision |
//! | [`bound`] | the threshold: Eq. 11, the exact average, the worst case |
//! | [`tracking`] | whether an object is still tracked, from the confidences of its frames |
//! | [`tolerance`] | every tolerance this crate applies, in one table |
//! | [`math`] | the only place that knows `libm` |
//!
//! The features `log` and `defmt`, off by default, tell a logger of templates loaded and refused
//! and of each pose's report; with `defmt`, errors, reports and settings are `defmt::Format` too.
//! With `wide-vectors`, off by default and for hosts alone, the sum over terms uses vectors as wide as
//! the processor has; the bits stay the same.
//!
//! # Example
//! ```
//! use cobra_infer::{Camera, Correspondence, Decision, Pose, Scorer, Settings, Template};
//! # fn run(flash: &[u8], stream: &[Correspondence]) -> Result<(), Box<dyn core::error::Error>> {
//! let template = Template::from_bytes(flash)?;
//! let camera = Camera::new(423.9, 423.1, 318.7, 243.0)?;
//! let pose = Pose::from_row_major([1., 0., 0., 0., 1., 0., 0., 0., 1.], [0., 0., 500.])?;
//! let settings = Settings::for_template(&template, 2.0); // 2 mm
//! // 16: the most components that this controller makes room for.
//! let mut scorer = Scorer::<16>::new(&template, &camera, &pose, &settings)?;
//! for correspondence in stream {
//!     scorer.push(correspondence);
//! }
//! let report = scorer.finish();
//! if report.decision == Decision::Accept {
//!     // grasp
//! }
//! # Ok(()) }
//! ```
#![no_std]
#![forbid(unsafe_code)]
#![cfg_attr(
    not(test),
    deny(
        clippy::indexing_slicing,
        clippy::unwrap_used,
        clippy::expect_used,
        clippy::panic,
        clippy::unreachable
    )
)]

#[cfg(test)]
extern crate std;

#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;

/// The crate of the points, vectors and rotations in this crate's interface.
pub use nalgebra;

pub mod bound;
pub mod camera;
pub mod depth;
mod error;
pub mod gp;
pub mod kernel;
pub mod math;
pub mod mixture;
pub mod pose;
pub mod score;
pub mod template;
pub mod tolerance;
mod trace;
pub mod tracking;
mod unit;
pub mod validity;
mod widest;

pub use bound::Threshold;
pub use camera::{Camera, Correspondence};
pub use error::{CameraError, PoseError, ScoreError};
pub use gp::UnitDirection;
pub use kernel::{Exponent, Kernel, Metric, Model, Smoothness};
pub use mixture::{Assignment, Likelihood, Mixture, Settings, Sigma};
pub use pose::Pose;
pub use score::{Decision, Doubt, Rejection, Report, Scorer, score};
pub use template::{EncodeError, Section, Template, TemplateError};
pub use unit::Unit;
