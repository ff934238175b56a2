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

/// The index of the nearest reference point for each point; the first of equals, and 0 where there
/// is no reference point.
#[must_use]
pub fn assign_nearest(points: &[Point3<f64>], centres: &[Point3<f64>]) -> Vec<usize> {
    points
        .par_iter()
        .map(|point| nearest(point, centres).0)
        .collect()
}

/// For each point the index of the nearest centre and the squared distance to it; the first of
/// equals.
///
/// Points go through in groups, for each of which the compiler makes vectors; k-means does little
/// else than this.
fn nearest_to_each(points: &[Point3<f64>], centres: &[Point3<f64>]) -> Vec<(usize, f64)> {
    const GROUP: usize = 4;
    let (groups, rest) = points.as_chunks::<GROUP>();
    let mut found = Vec::with_capacity(points.len());
    for group in groups {
        let mut indices = [0; GROUP];
        let mut least = [f64::INFINITY; GROUP];
        for (index, centre) in centres.iter().enumerate() {
            let squared = group.map(|point| (point - centre).norm_squared());
            for ((best, least), squared) in indices.iter_mut().zip(&mut least).zip(squared) {
                // Both are written every time: a branch could not be foretold.
                let nearer = squared < *least;
                *best = if nearer { index } else { *best };
                *least = if nearer { squared } else { *least };
            }
        }
        found.extend(indices.into_iter().zip(least));
    }
    found.extend(rest.iter().map(|point| nearest(point, centres)));
    found
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
