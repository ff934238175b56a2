//! From a mesh to a template: sampling, reference points, one Gaussian process each, σ̂, bytes.
//!
//! Owns the order of the steps and the change of scale. Everything is learned in the unit sphere,
//! as the paper does, and written in the mesh's unit, so that the controller never scales anything.

mod assemble;
mod sigma_hat;

use crate::gp::{self, FitError, FitOptions, FittedGp};
use crate::progress::Progress;
use crate::random::{Purpose, stream};
use crate::reference::{self, ClusterError};
use crate::surface::{BoundingSphere, Mesh, RayCaster, SampleError, sample_visible};
use assemble::{Frame, ScaledComponent};
use cobra_infer::{EncodeError, Exponent, Kernel, ScoreError, Template, TemplateError, Unit};
use nalgebra::Point3;
use rayon::prelude::*;

/// The most components the host scores with.
pub const LARGEST_TEMPLATE: usize = 1024;

/// How many k-means results are compared.
pub const PLACEMENTS: usize = 32;

/// Where the reference points come from.
#[derive(Clone, Debug, PartialEq)]
pub enum ReferencePoints {
    /// k-means on the training points.
    KMeans {
        /// How many.
        components: usize,
    },
    /// These, in the mesh's frame and unit.
    Given(Vec<Point3<f64>>),
}

/// What to train.
#[derive(Clone, Debug, PartialEq)]
pub struct TrainOptions {
    /// The object's name, as it is written into the template.
    pub name: String,
    /// The unit that the mesh's numbers are in.
    pub unit: Unit,
    /// Training points.
    pub points: usize,
    /// Test points, for σ̂.
    pub test_points: usize,
    /// Where the reference points come from.
    pub reference_points: ReferencePoints,
    /// The covariance function and how it is fitted.
    pub fit: FitOptions,
    /// The seed of all randomness.
    pub seed: u64,
}

impl TrainOptions {
    /// The paper's numbers with this project's decisions: 10,000 and 30,000 points, 16 k-means
    /// components, the rational quadratic with α = 1, hyperparameters learned on 300 points.
    #[must_use]
    pub fn new(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            unit: Unit::Millimetre,
            points: 10_000,
            test_points: 30_000,
            reference_points: ReferencePoints::KMeans { components: 16 },
            fit: FitOptions::new(Kernel::RationalQuadratic(Exponent::One)),
            seed: 0,
        }
    }
}

/// A trained template.
#[derive(Clone, Debug)]
pub struct Trained {
    /// The template file.
    pub bytes: Vec<u8>,
    /// What training found, one entry a component.
    pub components: Vec<TrainedComponent>,
}

/// What training found for a component.
#[derive(Clone, Debug)]
pub struct TrainedComponent {
    /// The fit, in the unit sphere.
    pub fitted: FittedGp,
    /// Test points that it speaks for.
    pub test_points: usize,
}

/// Why there is no template.
#[derive(Debug, thiserror::Error)]
pub enum TrainError {
    /// No training or no test point was asked for.
    #[error("at least one training point and one test point are needed")]
    NoPoints,
    /// More components than the host scores with.
    #[error("{found} components, at most {LARGEST_TEMPLATE} are supported")]
    TooManyComponents {
        /// How many were asked for.
        found: usize,
    },
    /// The surface could not be sampled.
    #[error(transparent)]
    Sample(#[from] SampleError),
    /// The points could not be clustered.
    #[error(transparent)]
    Cluster(#[from] ClusterError),
    /// A given reference point is of no use.
    #[error(
        "reference point {index} at ({}, {}, {}) is the nearest of none of the {points} training \
         points; are the reference points in the mesh's unit and frame?",
        centre.x, centre.y, centre.z
    )]
    UnusedReferencePoint {
        /// Which one, from 0.
        index: usize,
        /// Where it lies.
        centre: Point3<f64>,
        /// How many training points there are.
        points: usize,
    },
    /// A component could not be fitted.
    #[error("component {component}: {source}")]
    Fit {
        /// Which one.
        component: usize,
        /// Why.
        source: FitError,
    },
    /// The template could not be written.
    #[error(transparent)]
    Encode(#[from] EncodeError),
    /// The template that was written cannot be used.
    #[error(transparent)]
    Template(#[from] TemplateError),
    /// The template could not be measured.
    #[error(transparent)]
    Score(#[from] ScoreError),
}

/// Trains a template of `mesh`.
///
/// The same mesh, options and build give the same bytes, whatever the number of threads.
///
/// # Errors
/// [`TrainError`].
pub fn train(
    mesh: &Mesh,
    options: &TrainOptions,
    progress: &dyn Progress,
) -> Result<Trained, TrainError> {
    if options.points == 0 || options.test_points == 0 {
        return Err(TrainError::NoPoints);
    }
    let sphere = mesh.bounding_sphere();
    let (training, test) = sample(mesh, &sphere, options, progress)?;
    let centres = place(&training, &sphere, options, progress)?;
    let fitted = fit_all(&training, &centres, options, progress)?;

    progress.start("measuring sigma-hat", 1);
    let scaled: Vec<ScaledComponent> = centres
        .iter()
        .zip(&fitted)
        .map(|(centre, fitted)| ScaledComponent::new(centre, fitted, &sphere))
        .collect();
    let frame = Frame {
        options,
        sphere: &sphere,
        diameter: mesh.diameter(),
    };
    let provisional = frame.encode(&scaled, &vec![sphere.radius as f32; scaled.len()])?;
    let (sigma_hats, test_counts) = sigma_hat::measure(
        &Template::from_bytes(&provisional)?,
        &test
            .iter()
            .map(|point| sphere.denormalise(point))
            .collect::<Vec<_>>(),
    )?;
    let bytes = frame.encode(&scaled, &sigma_hats)?;
    progress.step();
    progress.finish();
    Ok(Trained {
        bytes,
        components: fitted
            .into_iter()
            .zip(test_counts)
            .map(|(fitted, test_points)| TrainedComponent {
                fitted,
                test_points,
            })
            .collect(),
    })
}

type Points = Vec<Point3<f64>>;

fn sample(
    mesh: &Mesh,
    sphere: &BoundingSphere,
    options: &TrainOptions,
    progress: &dyn Progress,
) -> Result<(Points, Points), TrainError> {
    progress.start("sampling the surface", 1);
    let unit = mesh.normalised(sphere);
    let caster = RayCaster::new(&unit);
    let mut training: Points = sample_visible(
        &unit,
        &caster,
        options.points + options.test_points,
        options.seed,
        Purpose::Training,
    )?
    .into_iter()
    .map(|point| point.position)
    .collect();
    let test = training.split_off(options.points);
    progress.step();
    progress.finish();
    Ok((training, test))
}

fn place(
    training: &[Point3<f64>],
    sphere: &BoundingSphere,
    options: &TrainOptions,
    progress: &dyn Progress,
) -> Result<Points, TrainError> {
    progress.start("placing reference points", 1);
    let centres = match &options.reference_points {
        ReferencePoints::KMeans { components } => {
            check_count(*components)?;
            let placements = reference::kmeans(training, *components, PLACEMENTS, options.seed)?;
            reference::most_explanatory(training, placements, &options.fit, options.seed)
                .unwrap_or_default()
        }
        ReferencePoints::Given(given) => {
            check_count(given.len())?;
            given.iter().map(|point| sphere.normalise(point)).collect()
        }
    };
    progress.step();
    progress.finish();
    Ok(centres)
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

fn fit_all(
    training: &[Point3<f64>],
    centres: &[Point3<f64>],
    options: &TrainOptions,
    progress: &dyn Progress,
) -> Result<Vec<FittedGp>, TrainError> {
    let labels = reference::assign_nearest(training, centres);
    let mut members = vec![Vec::new(); centres.len()];
    for (point, label) in training.iter().zip(&labels) {
        members[*label].push(*point);
    }
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
    progress.start("fitting components", centres.len() as u64);
    let fitted = members
        .par_iter()
        .zip(centres)
        .enumerate()
        .map(|(component, (members, centre))| {
            let mut rng = stream(
                options.seed,
                Purpose::HyperparameterSubset,
                component as u64,
            );
            let fitted = gp::fit(centre, members, &options.fit, &mut rng);
            progress.step();
            fitted.map_err(|source| TrainError::Fit { component, source })
        })
        .collect::<Result<Vec<_>, _>>();
    progress.finish();
    fitted
}
