//! What users hand in to be scored: camera files, pose files, correspondences.
//!
//! Owns the file formats and their error messages. What the numbers mean belongs to
//! `cobra-infer`.

mod camera;
mod correspondences;
mod estimates;
mod image_id;
pub(crate) mod json;
mod scale;
mod text;

pub(crate) use camera::image_camera;
pub use camera::{CameraFile, ImageCamera, ImageSize, ReadCameraError, read_camera};
pub use correspondences::{
    CorrespondenceOptions, ReadCorrespondencesError, Weighting, read_correspondences,
};
pub use estimates::{Estimate, ReadEstimatesError, read_estimates};
pub use image_id::same_image;
pub use scale::{ScaleDoubt, doubt_point_scale, doubt_pose_scale};
pub(crate) use text::read_text;
