//! One Gaussian process a component, in parallel.
//!
//! Owns the random stream of each fit and the check that each component has points; the fit itself
//! is `gp`'s work.

use super::membership::Patch;
use super::{ReferencePoints, TrainError, TrainOptions};
use crate::gp::{self, FittedGp};
use crate::progress::Progress;
use crate::random::{Purpose, stream};
use cobra_infer::{Exponent, Kernel, Metric, Model};
use nalgebra::Point3;
use rayon::prelude::*;

/// The most points that the process of a chart is fitted to. One chart may have a third of all points,
/// and the exact process is, but for `budget: None`, what the compressed one is compared with.
const LARGEST_CHART: usize = 1500;

/// What the step is called, to whoever follows progress.
pub const FITTING: &str = "fitting components";

pub(super) fn fit_all(
    points: &[Point3<f64>],
    patches: &[Patch],
    options: &TrainOptions,
    progress: &dyn Progress,
) -> Result<Vec<FittedGp>, TrainError> {
    if let (Some(index), ReferencePoints::Given(given)) = (
        patches.iter().position(|patch| patch.training.is_empty()),
        &options.reference_points,
    ) {
        return Err(TrainError::UnusedReferencePoint {
            index,
            centre: given[index],
            points: points.len(),
        });
    }
    let most = match options.reference_points {
        ReferencePoints::Auto { .. } => LARGEST_CHART,
        _ => usize::MAX,
    };
    let kin = matches!(
        options.fit.model,
        Model {
            metric: Metric::Chord,
            kernel: Kernel::RationalQuadratic(Exponent::One | Exponent::Half),
        }
    );
    progress.start(FITTING, patches.len() as u64);
    let fitted = patches
        .par_iter()
        .enumerate()
        .map(|(component, patch)| {
            let mut rng = stream(
                options.seed,
                Purpose::HyperparameterSubset,
                component as u64,
            );
            let training: Vec<Point3<f64>> = patch
                .training
                .iter()
                .take(most)
                .map(|&index| points[index])
                .collect();
            // Of other kernels the same numbers mean something else.
            let known = patch.known.as_ref().filter(|_| kin);
            let centre = patch.cluster.centre();
            let fitted = gp::fit_from(&centre, &training, &options.fit, known, &mut rng);
            progress.step();
            fitted.map_err(|source| TrainError::Fit { component, source })
        })
        .collect::<Result<Vec<_>, _>>();
    progress.finish();
    fitted
}
