//! Every tolerance that a cross-crate test asserts, in one table; `docs/TOLERANCES.md` quotes it.

/// Posterior mean of the trained process against an independent dense solve in `f64`, as a share of
/// the bounding sphere's radius: the Gram matrices' condition, at most 10⁶, times `f64`'s rounding.
pub const DENSE_MEAN: f64 = 1e-8;

/// Negative log marginal likelihood against the same, relative.
pub const DENSE_LIKELIHOOD: f64 = 1e-9;

/// Predictive variance against the same, as a share of the prior variance: as the mean.
pub const DENSE_VARIANCE: f64 = 1e-8;

/// Gradient of the likelihood against central differences of step 10⁻⁵, relative to the largest
/// entry: their own truncation and rounding.
pub const FINITE_DIFFERENCE: f64 = 1e-6;

/// The template's `f32` posterior mean against the trained process in `f64`, in units of σ̂.
pub const SINGLE_PRECISION_MEAN: f64 = 0.01;

/// How far the negative log likelihood per point may fall at a step of 5 % from the learned
/// hyperparameters: where one of them hardly matters, rounding decides.
pub const LEARNED: f64 = 1e-9;

/// Negative log likelihood per point that Adam reaches against L-BFGS-B's, on the same points from the
/// same start, outside of the cases that the test names: where a free exponent hardly matters, 250 iterations leave 6·10⁻⁴.
pub const OPTIMISERS_AGREE: f64 = 1e-3;

/// How far Adam ends above L-BFGS-B in the cases that the test names, against the measured gap,
/// relative: its two digits, and what another machine's rounding makes of 250 iterations.
pub const OPTIMISERS_APART: f64 = 0.1;

/// Distance of a sampled point from the mesh, in the unit sphere: a ray's length times rounding.
pub const ON_SURFACE: f64 = 1e-9;

/// Confidence of a real pose against the one that exact distances to the mesh give: what 10 k-means
/// components lose where the surface folds over in their directions.
pub const REAL_CONFIDENCE: f64 = 0.12;

/// The exact confidence as computed here against the published one: its three printed digits.
pub const EXACT_CONFIDENCE: f64 = 0.002;

/// A simulated average against the threshold that stands for it, in standard errors: one in two
/// million samples lies farther off.
pub const MONTE_CARLO: f64 = 5.0;

/// The rms residual of fresh points against the pooled σ̂, relative: a few points on folded surface
/// make up most of either.
pub const HELD_OUT: f64 = 0.15;

/// F-score of an object before and after it is moved, in percentage points: other camera rays,
/// other points, other k-means clusters.
pub const SAME_SHAPE: f64 = 3.0;

/// Errors of real estimates against the published ones, relative: these are of the estimates' matrices
/// as single precision leaves them, the test's of the nearest rotations.
pub const PUBLISHED_ERROR: f64 = 2e-6;

/// A number of an experiment on the real data against the committed one, relative where it is above 1: what
/// another processor's vector units make of training and of poses.
pub const SAME_EXPERIMENT: f64 = 0.02;
