//! The demonstration: an object, simulated pose estimates of it, and a picture of what COBRA
//! decides about them.

mod axis;
mod camera;
pub(crate) mod canvas;
mod image;
mod outline;
mod panel;
mod part;
mod picture;
mod render;
mod scatter;
mod simulate;
mod solid;
pub(crate) mod style;

pub use camera::Camera;
pub use image::RgbImage;
pub use part::mechanical_part;
pub use picture::{PictureError, ScoredPose, Verdict, draw, encode_png};
pub use render::{Look, Renderer};
pub use simulate::{MEASUREMENT_NOISE, SimulatedEstimate, VIEW, scorer_camera, simulate};
