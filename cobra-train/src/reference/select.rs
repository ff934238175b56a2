//! Choosing among several placements of reference points by what they explain.
//!
//! k-means knows nothing of directions: its results on one object differ by several points of
//! F-score, because some fold the surface over in the directions from a centre and others do not.
//! Fitting each component to a few of its points and counting which of the others lie within the
//! paper's τ of the prediction sees exactly that.

use super::{Cluster, members};
use crate::evaluate::TAU;
use crate::gp::{self, FitError, FitOptions, Subset};
use crate::random::{Purpose, stream};
use cobra_infer::{Exponent, Kernel};
use nalgebra::Point3;
use rayon::prelude::*;

/// Points a component is judged by.
const SUBSET: usize = 100;

/// The placement under which most points are explained, the first of equals.
///
/// Points are explained by the rational quadratic with α = 1 on the chord, whatever kernel, metric
/// and optimiser the template will have: which of them is best shall be compared on the same
/// reference points, and hundreds of fits with a costly kernel take minutes.
///
/// Each point belongs to one cluster ([`members`]). `None` when there is no placement; a placement
/// that leaves a cluster without points is the last choice.
#[must_use]
pub fn most_explanatory(
    points: &[Point3<f64>],
    placements: Vec<Vec<Cluster>>,
    seed: u64,
) -> Option<Vec<Cluster>> {
    if placements.len() < 2 {
        return placements.into_iter().next();
    }
    let options = FitOptions {
        subset: Subset::Points(SUBSET),
        ..FitOptions::new(Kernel::RationalQuadratic(Exponent::One))
    };
    let counts: Vec<usize> = placements
        .par_iter()
        .map(|clusters| count(points, clusters, &options, seed).unwrap_or(0))
        .collect();
    placements
        .into_iter()
        .zip(counts)
        .reduce(|best, next| if next.1 > best.1 { next } else { best })
        .map(|(clusters, _)| clusters)
}

/// How many of the points are explained, over all components.
fn count(
    points: &[Point3<f64>],
    clusters: &[Cluster],
    options: &FitOptions,
    seed: u64,
) -> Result<usize, FitError> {
    let mut total = 0;
    for (index, (cluster, own)) in clusters.iter().zip(members(points, clusters)).enumerate() {
        let mut rng = stream(seed, Purpose::Selection, index as u64);
        total += gp::explained(&cluster.centre(), &own, TAU, options, &mut rng)?;
    }
    Ok(total)
}
