//! Where the reference points lie: by charts, by clustering, or as they are given.
//!
//! Owns how many results of clustering are compared and by what; charts and clustering are
//! `reference`'s work.

use super::membership::{Patch, patches};
use super::squeeze::most_charts;
use super::{LARGEST_TEMPLATE, MeanForm, SurfaceSampling, TrainError, TrainOptions};
use crate::reference::{self, Aim, Cluster, ClusterError};
use crate::surface::{BoundingSphere, SurfacePoint};
use nalgebra::Point3;

/// How many results of clustering are compared.
///
/// EM's are compared by what they explain as well: with 16 components, those of the best likelihood
/// give F 0.9 lower on the screwdriver and on the bunny.
pub const PLACEMENTS: usize = 32;

/// Charts are not split into more than so many. Of the screwdriver in 14,336 bytes a point takes 10,985
/// instructions on an M4F with the 17 charts that it needs, 6,787 with 24 and 6,051 with 28, for 0.08 of F.
const ENOUGH: usize = 28;

/// Nor into more than leave each so many bytes: what does not fit is left out, and has to be whole.
const PIECE: usize = 510;

/// Where the reference points come from.
#[derive(Clone, Debug, PartialEq)]
pub enum ReferencePoints {
    /// Charts, as many as the surface asks for ([`reference::charts`]).
    Auto {
        /// The most.
        most: usize,
    },
    /// k-means on the training points.
    KMeans {
        /// How many.
        components: usize,
    },
    /// Expectation maximisation on the training points.
    Em {
        /// How many.
        components: usize,
    },
    /// These, in the mesh's frame and unit.
    Given(Vec<Point3<f64>>),
}

/// Components and which of the training points are whose.
pub(super) fn place(
    training: &[SurfacePoint],
    others: &[SurfacePoint],
    sphere: &BoundingSphere,
    options: &TrainOptions,
) -> Result<Vec<Patch>, TrainError> {
    if let ReferencePoints::Auto { most } = options.reference_points {
        check_count(most)?;
        if options.sampling == SurfaceSampling::ReferencePoints {
            return Err(TrainError::NeedsReferencePoints);
        }
        let (most, aim) = match (options.mean, options.budget) {
            (MeanForm::Process, Some(budget)) => (most.min(most_charts(budget)), Aim::Bytes),
            (MeanForm::Process, None) => (most, Aim::Coverage),
            (MeanForm::Map, _) => (most, Aim::Time),
        };
        let charts = reference::charts(training, others, most, aim, options.seed)
            .map_err(|source| TrainError::Charts { source })?;
        if charts.is_empty() {
            return Err(TrainError::NoCharts);
        }
        let charts = match (aim, options.budget) {
            (Aim::Bytes, Some(budget)) => {
                let enough = ENOUGH.min(budget / PIECE);
                reference::split(charts, training, most.min(enough))
            }
            // A map costs the same whatever its size, and the exact process is there to compare with.
            _ => charts,
        };
        return Ok(charts
            .into_iter()
            .map(|chart| Patch {
                cluster: Cluster::round(chart.centre),
                own: chart.own,
                training: chart.training,
                known: Some(chart.hyperparameters),
            })
            .collect());
    }
    let points: Vec<Point3<f64>> = training.iter().map(|p| p.position).collect();
    let clusters = clusters(&points, sphere, options)?;
    Ok(patches(&points, &clusters, options.overlap))
}

/// Clusters of points, or around given ones.
fn clusters(
    points: &[Point3<f64>],
    sphere: &BoundingSphere,
    options: &TrainOptions,
) -> Result<Vec<Cluster>, TrainError> {
    match &options.reference_points {
        // Charts are no clusters.
        ReferencePoints::Auto { .. } => Ok(Vec::new()),
        ReferencePoints::KMeans { components } => {
            check_count(*components)?;
            let placements = reference::kmeans(points, *components, PLACEMENTS, options.seed)?
                .into_iter()
                .map(|centres| centres.into_iter().map(Cluster::round).collect())
                .collect();
            Ok(most_explanatory(points, placements, options))
        }
        ReferencePoints::Em { components } => {
            check_count(*components)?;
            let mixtures = reference::em(points, *components, PLACEMENTS, options.seed)?;
            let placements = mixtures
                .into_iter()
                .map(|mixture| mixture.clusters)
                .collect();
            Ok(most_explanatory(points, placements, options))
        }
        ReferencePoints::Given(given) => {
            check_count(given.len())?;
            Ok(given
                .iter()
                .map(|point| Cluster::round(sphere.normalise(point)))
                .collect())
        }
    }
}

fn most_explanatory(
    points: &[Point3<f64>],
    placements: Vec<Vec<Cluster>>,
    options: &TrainOptions,
) -> Vec<Cluster> {
    reference::most_explanatory(points, placements, options.seed).unwrap_or_default()
}

fn check_count(found: usize) -> Result<(), TrainError> {
    if found == 0 {
        return Err(ClusterError::NoComponents.into());
    }
    if found > LARGEST_TEMPLATE {
        return Err(TrainError::TooManyComponents { found });
    }
    Ok(())
}
