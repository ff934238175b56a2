//! What users hand in to be scored: camera files, pose files, correspondences; and the reports of what was
//! scored, to be calibrated on.
//!
//! Owns the file formats and their error messages. What the numbers mean belongs to
//! `cobra-infer`.

mod camera;
mod correspondences;
mod estimates;
mod image_id;
pub(crate) mod json;
mod scale;
mod score_report;
mod text;

pub(crate) use camera::image_camera;
pub use camera::{CameraFile, ImageCamera, ImageSize, ReadCameraError, read_camera};
pub use correspondences::{
    CorrespondenceOptions, ReadCorrespondencesError, Weighting, read_correspondences,
};
pub use estimates::{Estimate, ReadEstimatesError, read_estimates};
pub use image_id::same_image;
pub use scale::{ScaleDoubt, doubt_point_scale, doubt_pose_scale};
pub use score_report::{
    ReadReportError, ReportedEstimate, ScoreReport, ScoredEstimate, read_score_report,
};
pub(crate) use text::read_text;
