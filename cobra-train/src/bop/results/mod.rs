//! BOP's results files: estimates of poses, one a row, as estimators write them and `bop_toolkit`
//! reads them.
//!
//! Owns the rows: what stands in them, what of it is an estimate, and the same file with other
//! scores. What an estimate is worth is not known here.

mod error;
mod parse;
mod rescore;

pub use error::{ReadResultsError, RowError};

use crate::pose::nearest_pose;
use cobra_infer::{Pose, PoseError};
use nalgebra::Isometry3;
use std::path::Path;

/// The columns, in the only order in which `bop_toolkit` reads them.
pub const COLUMNS: [&str; 7] = ["scene_id", "im_id", "obj_id", "score", "R", "t", "time"];

/// A results file: all its rows, in its order.
#[derive(Clone, Debug, PartialEq)]
pub struct Results {
    /// The rows, without the header and without empty lines.
    pub rows: Vec<Row>,
}

/// A row, whether or not it is an estimate.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The line of the file on which it begins, from 1, the header's line being 1.
    pub line: u64,
    /// The fields as they stand in the file, without the quotes of CSV.
    pub fields: Vec<String>,
    /// What they say.
    pub estimate: Result<PoseEstimate, RowError>,
}

/// One estimate of one object's pose in one image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseEstimate {
    /// The scene, `000002` being 2.
    pub scene_id: u32,
    /// The image in it.
    pub im_id: u32,
    /// The object.
    pub obj_id: u32,
    /// The estimator's own score, whatever it means.
    pub score: f64,
    /// R, row-major, object to camera, as it stands in the file.
    pub r: [f64; 9],
    /// t, in millimetres.
    pub t: [f64; 3],
    /// Seconds that the image took; −1 if unknown.
    pub time: f64,
}

impl PoseEstimate {
    /// The pose as the scorer takes it, R replaced by the nearest rotation.
    ///
    /// # Errors
    /// As [`Pose::from_row_major_orthonormalised`]: R is no rotation, or a number overflows `f32`.
    pub fn pose(&self) -> Result<Pose, PoseError> {
        Pose::from_row_major_orthonormalised(self.r.map(|x| x as f32), self.t.map(|x| x as f32))
    }

    /// The pose for errors against the truth, R replaced by the nearest rotation, in `f64`.
    ///
    /// # Errors
    /// As [`nearest_pose`].
    pub fn isometry(&self) -> Result<Isometry3<f64>, PoseError> {
        nearest_pose(self.r, self.t)
    }
}

/// Reads `scene_id,im_id,obj_id,score,R,t,time`: ids are whole numbers, R nine and t three numbers
/// separated by blanks. Line ends of Windows, a byte order mark, quotes and blanks around fields do
/// not matter; empty lines are no rows.
///
/// A row that is no estimate is kept with the reason, so that the others can be scored.
///
/// # Errors
/// [`ReadResultsError`] names the file: it cannot be read, or its header is another one.
pub fn read_results(path: &Path) -> Result<Results, ReadResultsError> {
    let bytes = std::fs::read(path).map_err(|source| ReadResultsError::Io {
        path: path.to_owned(),
        source,
    })?;
    parse::parse(&bytes, path)
}
