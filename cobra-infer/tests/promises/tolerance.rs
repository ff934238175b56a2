//! Every tolerance that these tests assert, in one table. Where nothing stands here, bits are
//! compared.

/// The unit roundoff of `f32`, 2⁻²⁴: the scale of what follows.
pub(crate) const ROUNDOFF: f64 = 1.0 / 16_777_216.0;

/// Posterior mean against a sum in `f64`, relative to |m| + Σ|wᵢ|kᵢ: up to 7 additions in a lane and
/// 4 behind it, and a kernel whose 6 roundings an exponent of at most 4 multiplies; doubled.
pub(crate) const POSTERIOR_MEAN: f64 = 80.0 * ROUNDOFF;

/// Confidence or threshold (at most 1) after a permutation or another constant weight: two
/// compensated sums of 2 roundings each, a product and a quotient, on both sides; doubled.
pub(crate) const CONFIDENCE: f64 = 24.0 * ROUNDOFF;

/// How far, relatively, the maximum's likelihood may lie below the nearest's: components are compared
/// by e²/2σ² + ln σ, whose rounding at 104, where the exponential vanishes, is 2⁻¹⁸, on both sides.
pub(crate) const MAXIMUM_LIKELIHOOD: f64 = 128.0 * ROUNDOFF;

/// Density against Peak/(√(2π)σ), relative: a reciprocal, a product, a quotient and √(2π) itself.
pub(crate) const DENSITY: f64 = 4.0 * ROUNDOFF;

/// Likelihoods against those computed by hand, relative: a residual of 1 carries the rounding of
/// coordinates near 500, some 10⁻⁴.
pub(crate) const BY_HAND: f64 = 2e-4;

/// σ from σ̂ and noise against `f64`, relative: a quotient, a product, a sum, a root, a product.
pub(crate) const QUADRATURE: f64 = 4.0 * ROUNDOFF;

/// Entries of RᵀR − I after orthonormalising: three products and sums of entries at most 1.
pub(crate) const ORTHONORMAL: f64 = 16.0 * ROUNDOFF;

/// A projected point against its back-projection, relative to its distance from the camera: the
/// twenty-odd roundings of projecting, of the ray, and of two changes of frame.
pub(crate) const BACK_PROJECTION: f64 = 64.0 * ROUNDOFF;

/// The nearest reference point's distance against every other's, relative: both are rounded.
pub(crate) const DISTANCE: f64 = 1e-6;

/// The threshold under noise whose square would underflow, against that of the noise alone.
pub(crate) const TINY_NOISE: f64 = 1e-5;

/// A mixed likelihood against the formula in `f64`, absolute; the posterior mean's rounding, over σ.
pub(crate) const SOFT: f64 = 1e-4;

/// A confidence before and after the object's frame is moved: the directions' rounding times a
/// steep kernel's slope, over σ.
pub(crate) const MOVED: f64 = 2e-3;

/// A confidence before and after points or components are reordered, where two components equally
/// near or likely may swap.
pub(crate) const REORDERED: f64 = 1e-5;
