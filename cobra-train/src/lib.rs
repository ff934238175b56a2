//! Trains, evaluates and applies COBRA shape templates: the host's side of `cobra-infer`.
//!
//! From a mesh to a template: [`surface`] reads it and draws points on it, [`mod@reference`] places
//! reference points, [`gp`] fits a Gaussian process around each, [`mod@train`] puts them together and
//! hands them to `cobra-infer`'s encoder. [`mod@evaluate`] measures the result with the scorer's own
//! [`pose`] simulates them, [`bop`] reads data sets and results of the BOP benchmark, [`demo`] shows
//! [`pose`] simulates them, [`demo`] shows the whole. The command `cobra` is a thin layer over this
//! code, [`calibrate`] finds the thresholds for a false-accept rate, [`export`] makes source text of it. [`input`] reads cameras, poses and correspondences,
//! code, [`export`] makes source text of it. [`input`] reads cameras, poses and correspondences,
//! the whole. The command `cobra` is a thin layer over this
//! library. [`overlay`] draws estimates over the image that they are of.
//!
//! # Example
//! ```no_run
//! use cobra_train::progress::Silent;
//! use cobra_train::surface::read_geometry;
//! use cobra_train::train::{TrainOptions, train};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let object = read_geometry("screwdriver.ply".as_ref())?.geometry;
//! let trained = train(&object, &TrainOptions::new("screwdriver"), &Silent)?;
//! cobra_train::output::write_whole("screwdriver.cobra".as_ref(), &trained.bytes)?;
//! let template = cobra_infer::Template::from_bytes(&trained.bytes)?;
//! println!("{} components", template.component_count());
//! # Ok(()) }
//! ```
#![forbid(unsafe_code)]

pub mod bop;
pub mod calibrate;
pub mod coverage;
pub mod demo;
pub mod depth;
pub mod depth_image;
pub mod evaluate;
pub mod export;
pub mod gp;
pub mod input;
pub mod output;
pub mod overlay;
pub mod pixel_mask;
pub mod pose;
pub mod progress;
pub mod random;
pub mod reference;
pub mod surface;
pub mod train;
pub mod validity;
