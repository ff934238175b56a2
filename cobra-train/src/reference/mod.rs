//! Where the reference points lie.
//!
//! Owns their placement and the assignment of points to them; fitting is `gp`'s work.

mod given;
mod kmeans;
mod select;

pub use given::{ReadReferencePointsError, read_reference_points};
pub use kmeans::{ClusterError, kmeans};
pub use select::most_explanatory;

use nalgebra::Point3;
use rayon::prelude::*;

/// The index of the nearest reference point for each point; the first of equals.
#[must_use]
pub fn assign_nearest(points: &[Point3<f64>], centres: &[Point3<f64>]) -> Vec<usize> {
    points
        .par_iter()
        .map(|point| nearest(point, centres).0)
        .collect()
}

/// The index of the nearest centre and the squared distance to it.
fn nearest(point: &Point3<f64>, centres: &[Point3<f64>]) -> (usize, f64) {
    let mut best = (0, f64::INFINITY);
    for (index, centre) in centres.iter().enumerate() {
        let squared = (point - centre).norm_squared();
        if squared < best.1 {
            best = (index, squared);
        }
    }
    best
}
