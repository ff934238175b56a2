//! One Gaussian process a component, in parallel.
//!
//! Owns the random stream of each fit and the check that each component has points; the fit itself
//! is `gp`'s work.

use super::membership::training_points;
use super::{ReferencePoints, TrainError, TrainOptions};
use crate::gp::{self, FittedGp};
use crate::progress::Progress;
use crate::random::{Purpose, stream};
use crate::reference::Cluster;
use nalgebra::Point3;
use rayon::prelude::*;

pub(super) fn fit_all(
    training: &[Point3<f64>],
    clusters: &[Cluster],
    options: &TrainOptions,
    progress: &dyn Progress,
) -> Result<Vec<FittedGp>, TrainError> {
    let members = training_points(training, clusters, options.overlap);
    if let (Some(index), ReferencePoints::Given(given)) = (
        members.iter().position(Vec::is_empty),
        &options.reference_points,
    ) {
        return Err(TrainError::UnusedReferencePoint {
            index,
            centre: given[index],
            points: training.len(),
        });
    }
    progress.start("fitting components", clusters.len() as u64);
    let fitted = members
        .par_iter()
        .zip(clusters)
        .enumerate()
        .map(|(component, (members, cluster))| {
            let mut rng = stream(
                options.seed,
                Purpose::HyperparameterSubset,
                component as u64,
            );
            let fitted = gp::fit(&cluster.centre(), members, &options.fit, &mut rng);
            progress.step();
            fitted.map_err(|source| TrainError::Fit { component, source })
        })
        .collect::<Result<Vec<_>, _>>();
    progress.finish();
    fitted
}
