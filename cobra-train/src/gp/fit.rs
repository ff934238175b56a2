//! Fitting one component: from points around a reference point to directions and weights.

use super::cholesky::{Cholesky, NotPositiveDefinite};
use super::gram::{Coordinates, Hyperparameters, coordinates, covariances, gram};
use super::optimise::{Learned, NOISE_FLOOR, Optimiser, OptimiserError, learn, learn_from};
use cobra_infer::{Kernel, Model};
use nalgebra::{Point3, UnitVector3};
use rand::Rng;
use rand::seq::index;

/// The most points one Gaussian process is fitted to: its Gram matrix then takes 1.2 GB.
pub const LARGEST_GP: usize = 12_000;

/// The largest ratio of signal to noise of a process that is fitted from known hyperparameters: a flat
/// surface that is seen from the side is so smooth a function that its weights cancel, and `f32` sums
/// of them are wrong by many σ̂.
const LARGEST_RATIO: f64 = 1e5;

/// A point nearer to its reference point than this has no usable direction (unit sphere).
const SMALLEST_DISTANCE: f64 = 1e-4;

/// The prior mean m of the distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PriorMean {
    /// m = 0, as the paper (Eq. 3).
    Zero,
    /// m = the mean distance of the component's points.
    Average,
}

/// Which of a component's points hyperparameters are learned on; the weights are all points'.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subset {
    /// So many, drawn at random; all where there are fewer.
    Points(usize),
    /// All of them.
    All,
}

/// How a component is fitted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitOptions {
    /// Metric and covariance function.
    pub model: Model,
    /// The prior mean.
    pub prior_mean: PriorMean,
    /// The points that hyperparameters are learned on.
    pub subset: Subset,
    /// How they are learned.
    pub optimiser: Optimiser,
    /// The least noise variance η, greater than 0, in units of the unit sphere: [`NOISE_FLOOR`], or
    /// [`PAPER_NOISE_FLOOR`](super::PAPER_NOISE_FLOOR).
    pub noise_floor: f64,
}

impl FitOptions {
    /// This project's choices: chord distance, average prior mean, L-BFGS-B on 300 points.
    #[must_use]
    pub const fn new(kernel: Kernel) -> Self {
        Self {
            model: Model::chord(kernel),
            prior_mean: PriorMean::Average,
            subset: Subset::Points(300),
            optimiser: Optimiser::Lbfgs,
            noise_floor: NOISE_FLOOR,
        }
    }
}

/// A fitted component, in the units of the points that it was fitted to.
#[derive(Clone, Debug)]
pub struct FittedGp {
    /// Metric and covariance function.
    pub model: Model,
    /// The training directions.
    pub directions: Vec<UnitVector3<f64>>,
    /// d − m of each direction.
    pub targets: Vec<f64>,
    /// v·K⁻¹(d − m): multiplies the unit-variance kernel.
    pub weights: Vec<f64>,
    /// m.
    pub prior_mean: f64,
    /// The hyperparameters and how they were found.
    pub learned: Learned,
}

/// Why a component could not be fitted.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FitError {
    /// No point has a direction.
    #[error(
        "no training point lies away from the reference point: use fewer components or more points"
    )]
    NoPoints,
    /// The Gram matrix would not fit.
    #[error(
        "{found} training points in one component, at most {LARGEST_GP} fit: use more components \
         or fewer points"
    )]
    TooManyPoints {
        /// How many.
        found: usize,
    },
    /// The factorisation failed.
    #[error(transparent)]
    NotPositiveDefinite(#[from] NotPositiveDefinite),
    /// Learning failed.
    #[error(transparent)]
    Optimiser(#[from] OptimiserError),
}

/// Fits d ~ GP(m, v·k) + noise to the distances of `points` from `centre` (Eqs. 1 to 5).
///
/// Hyperparameters are learned on `options.subset`, the weights on all points.
///
/// # Errors
/// [`FitError`].
pub fn fit(
    centre: &Point3<f64>,
    points: &[Point3<f64>],
    options: &FitOptions,
    rng: &mut impl Rng,
) -> Result<FittedGp, FitError> {
    fit_from(centre, points, options, None, rng)
}

/// As [`fit`], from hyperparameters that are known to be good where there are any and
/// `options.optimiser` is L-BFGS-B ([`learn_from`]).
///
/// # Errors
/// [`FitError`].
pub fn fit_from(
    centre: &Point3<f64>,
    points: &[Point3<f64>],
    options: &FitOptions,
    known: Option<&Hyperparameters>,
    rng: &mut impl Rng,
) -> Result<FittedGp, FitError> {
    let data = TrainingData::new(centre, points, options.prior_mean)?;
    let found = data.targets.len();
    if found > LARGEST_GP {
        return Err(FitError::TooManyPoints { found });
    }
    let (_, mut learned) = data.learn(options, known, rng)?;
    let TrainingData {
        directions,
        targets,
        prior_mean,
    } = data;
    if known.is_some() {
        let h = &mut learned.hyperparameters;
        h.noise_variance = h.noise_variance.max(h.signal_variance / LARGEST_RATIO);
    }
    let h = &learned.hyperparameters;
    let points = Coordinates::new(options.model.metric, &directions);
    let factor = Cholesky::new(gram(options.model.kernel, h, &points))?;
    let weights = factor
        .solve(&targets)
        .into_iter()
        .map(|w| h.signal_variance * w)
        .collect();
    Ok(FittedGp {
        model: options.model,
        directions,
        targets,
        weights,
        prior_mean,
        learned,
    })
}

/// How many of the points a Gaussian process explains that was fitted to a few of them.
///
/// The process is fitted to `options.subset`; a point is explained when
/// the posterior mean in its direction lies within `tolerance` of its distance.
///
/// # Errors
/// [`FitError`].
pub fn explained(
    centre: &Point3<f64>,
    points: &[Point3<f64>],
    tolerance: f64,
    options: &FitOptions,
    rng: &mut impl Rng,
) -> Result<usize, FitError> {
    let data = TrainingData::new(centre, points, options.prior_mean)?;
    let (few, learned) = data.learn(options, None, rng)?;
    let h = &learned.hyperparameters;
    let Model { metric, kernel } = options.model;
    let points = Coordinates::new(metric, &few.directions);
    let weights = Cholesky::new(gram(kernel, h, &points))?.solve(&few.targets);
    Ok(data
        .directions
        .iter()
        .zip(&data.targets)
        .filter(|(direction, target)| {
            let row = covariances(kernel, h, &points, coordinates(metric, direction));
            let mean: f64 = row.iter().zip(&weights).map(|(k, weight)| weight * k).sum();
            (*target - mean).abs() <= tolerance
        })
        .count())
}

/// Points as the Gaussian process sees them.
struct TrainingData {
    directions: Vec<UnitVector3<f64>>,
    targets: Vec<f64>,
    prior_mean: f64,
}

impl TrainingData {
    fn new(
        centre: &Point3<f64>,
        points: &[Point3<f64>],
        prior_mean: PriorMean,
    ) -> Result<Self, FitError> {
        let (directions, distances): (Vec<_>, Vec<_>) = points
            .iter()
            .filter_map(|point| UnitVector3::try_new_and_get(point - centre, SMALLEST_DISTANCE))
            .unzip();
        if distances.is_empty() {
            return Err(FitError::NoPoints);
        }
        let prior_mean = match prior_mean {
            PriorMean::Zero => 0.0,
            PriorMean::Average => distances.iter().sum::<f64>() / distances.len() as f64,
        };
        Ok(Self {
            directions,
            targets: distances.iter().map(|d| d - prior_mean).collect(),
            prior_mean,
        })
    }

    /// The subset, and the hyperparameters that make it most probable.
    fn learn(
        &self,
        options: &FitOptions,
        known: Option<&Hyperparameters>,
        rng: &mut impl Rng,
    ) -> Result<(Self, Learned), FitError> {
        let found = self.targets.len();
        let subset = match options.subset {
            Subset::Points(count) => index::sample(rng, found, count.clamp(1, found)).into_vec(),
            Subset::All => (0..found).collect(),
        };
        let few = Self {
            directions: subset.iter().map(|&i| self.directions[i]).collect(),
            targets: subset.iter().map(|&i| self.targets[i]).collect(),
            prior_mean: self.prior_mean,
        };
        let points = Coordinates::new(options.model.metric, &few.directions);
        let (kernel, floor) = (options.model.kernel, options.noise_floor);
        let learned = match (known, options.optimiser) {
            (Some(known), Optimiser::Lbfgs) => {
                learn_from(kernel, &points, &few.targets, known, floor)?
            }
            _ => learn(kernel, &points, &few.targets, &options.optimiser, floor)?,
        };
        Ok((few, learned))
    }
}
