//! Trains, evaluates and applies COBRA shape templates: the host's side of `cobra-infer`.
//!
//! From a mesh to a template: [`surface`] reads it and draws points on it, [`mod@reference`] places
//! reference points, [`gp`] fits a Gaussian process around each, [`mod@train`] puts them together and
//! hands them to `cobra-infer`'s encoder. [`mod@evaluate`] measures the result with the scorer's own
//! code, [`calibrate`] finds the thresholds for a false-accept rate, on labelled estimates or on those of
//! [`simulation`], and [`ambiguity`] the poses that no threshold tells apart. [`export`] makes source text
//! of a template. [`input`] reads cameras, poses and correspondences, [`pose`] simulates them, [`bop`] reads
//! data sets and results of the BOP benchmark and scores them against depth, [`overlay`] draws estimates
//! over the image that they are of, [`mod@report`] makes a page that says whether a template can be trusted,
//! [`demo`] shows the whole. The command `cobra` is a thin layer over this
//! library.
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

pub mod ambiguity;
pub mod bop;
pub mod calibrate;
pub mod coverage;
pub mod demo;
pub mod depth;
pub mod depth_image;
pub mod digits;
pub mod evaluate;
pub mod experiment;
pub mod export;
pub mod gp;
pub mod input;
pub mod output;
pub mod overlay;
pub mod pixel_mask;
pub(crate) mod plot;
pub mod pose;
pub mod progress;
pub mod random;
pub mod reference;
pub mod report;
pub mod simulation;
pub mod surface;
pub mod train;
pub mod validity;
