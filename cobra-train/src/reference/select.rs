//! Choosing among several placements of reference points by what they explain.
//!
//! k-means knows nothing of directions: its results on one object differ by several points of
//! F-score, because some fold the surface over in the directions from a centre and others do not.
//! Fitting each component to a few of its points and counting which of the others lie within the
//! paper's τ of the prediction sees exactly that.

use super::assign_nearest;
use crate::evaluate::TAU;
use crate::gp::{self, FitError, FitOptions, NOISE_FLOOR, Optimiser, Subset};
use crate::random::{Purpose, stream};
use nalgebra::Point3;
use rayon::prelude::*;

/// Points a component is judged by.
const SUBSET: usize = 100;

/// The placement under which most points are explained, the first of equals.
///
/// Each point belongs to its nearest reference point. `None` when there is no placement; a
/// placement that leaves a reference point without points is the last choice.
#[must_use]
pub fn most_explanatory(
    points: &[Point3<f64>],
    placements: Vec<Vec<Point3<f64>>>,
    options: &FitOptions,
    seed: u64,
) -> Option<Vec<Point3<f64>>> {
    if placements.len() < 2 {
        return placements.into_iter().next();
    }
    let options = FitOptions {
        subset: Subset::Points(SUBSET),
        // Hundreds of fits are compared, and the placement shall not depend on how the one that is
        // chosen learns.
        optimiser: Optimiser::Lbfgs,
        noise_floor: NOISE_FLOOR,
        ..*options
    };
    let counts: Vec<usize> = placements
        .par_iter()
        .map(|centres| count(points, centres, &options, seed).unwrap_or(0))
        .collect();
    placements
        .into_iter()
        .zip(counts)
        .reduce(|best, next| if next.1 > best.1 { next } else { best })
        .map(|(centres, _)| centres)
}

/// How many of the points are explained, over all components.
fn count(
    points: &[Point3<f64>],
    centres: &[Point3<f64>],
    options: &FitOptions,
    seed: u64,
) -> Result<usize, FitError> {
    let mut members = vec![Vec::new(); centres.len()];
    for (point, label) in points.iter().zip(assign_nearest(points, centres)) {
        members[label].push(*point);
    }
    let mut total = 0;
    for (index, (centre, members)) in centres.iter().zip(&members).enumerate() {
        let mut rng = stream(seed, Purpose::Selection, index as u64);
        total += gp::explained(centre, members, TAU, options, &mut rng)?;
    }
    Ok(total)
}
