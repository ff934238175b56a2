//! The posterior mean of a Gaussian process over borrowed arrays.
//!
//! Owns the sum μ(u) = m + Σᵢ wᵢ k(u, uᵢ) (Eq. 5 with w = K⁻¹(d − m) precomputed) and the order in
//! which it is added, which is part of the template format. Does not own where the arrays lie
//! ([`crate::template`]) or the kernels ([`crate::kernel`]).
//!
//! # Order of summation
//! Term i goes to accumulator i mod 8. Within an accumulator terms are added by rising i, starting
//! from +0. The mean is m + (((a₀+a₁)+(a₂+a₃)) + ((a₄+a₅)+(a₆+a₇))). A term is wᵢ·k. Of compact terms the sum
//! is multiplied by the scale before m is added. This is what vector code on the host and scalar code
//! on a controller both compute.

use crate::kernel::{Covariance, Model, Visitor};
use crate::math::{self, Real};
use crate::validity::{self, Square};
use nalgebra::{Unit, Vector3};
use terms::Encoded;

pub mod compact;
#[cfg(test)]
pub(crate) mod evaluations;
mod gradient;
pub mod map;
mod sum;
mod terms;

pub use gradient::posterior_gradient;
pub use terms::Terms;

/// How many accumulators the sum is interleaved over.
pub const LANES: usize = 8;

/// A direction: a unit vector.
pub type UnitDirection = Unit<Vector3<f32>>;

/// A little-endian `f32` as it lies in a template.
pub type Word = [u8; 4];

/// The hyperparameters of one component.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Hyperparameters {
    /// l > 0, in units of the metric's coordinates; 1 where the kernel has none.
    pub length_scale: f32,
    /// The kernel's parameter besides: the exponent α of the rational quadratic (what the kernel
    /// fixes, where it fixes one), the polynomial's offset, the period; 1 where it has none.
    pub parameter: f32,
    /// The prior mean m, in the template's unit.
    pub prior_mean: f32,
}

/// The posterior mean in direction `u`, in the template's unit.
///
/// The order of summation is the module's, of a map [`map`]'s; a map does not ask for the model. NaN
/// where this build does not contain the model's kernel or metric, which
/// [`crate::Template::from_bytes`] refuses.
#[must_use]
pub fn posterior_mean(
    model: Model,
    hyperparameters: &Hyperparameters,
    terms: &Terms<'_>,
    u: &UnitDirection,
) -> f32 {
    let square = terms
        .map()
        .map(|map| validity::square(map.pole(), [u.x, u.y, u.z]));
    posterior_mean_at(model, hyperparameters, terms, u, square)
}

/// [`posterior_mean`], where a map need not project the direction once more: `square` is where it lies
/// on the map of the component's directions, which a map cannot do without.
#[inline(never)]
pub(crate) fn posterior_mean_at(
    model: Model,
    hyperparameters: &Hyperparameters,
    terms: &Terms<'_>,
    u: &UnitDirection,
    square: Option<Square>,
) -> f32 {
    if let Some(map) = terms.map() {
        let above = square.map_or(f32::NAN, |square| map.above_prior(square));
        return hyperparameters.prior_mean + above;
    }
    let Some(mut query) = model.metric.coordinates([u.x, u.y, u.z]) else {
        return f32::NAN;
    };
    if terms.compact_scale().is_some() {
        query = query.map(|coordinate| coordinate * compact::GRID);
    }
    let sum = model.kernel.visit(
        hyperparameters.length_scale,
        hyperparameters.parameter,
        WeightedSum { terms, query },
    );
    sum.map_or(f32::NAN, |sum| hyperparameters.prior_mean + sum)
}

/// Σᵢ wᵢ k(query, uᵢ), of compact terms times their scale.
struct WeightedSum<'a> {
    terms: &'a Terms<'a>,
    query: [f32; 3],
}

impl Visitor<f32> for WeightedSum<'_> {
    type Output = f32;

    fn visit(self, kernel: impl Covariance<f32>) -> f32 {
        let Self { terms, query } = self;
        #[cfg(test)]
        let kernel = evaluations::Counted(kernel);
        match terms.0 {
            // What is no compact term has no scale, and a product with 1 has the bits of the other factor.
            Encoded::Exact { quads, scale } => {
                scale.unwrap_or(1.0) * sum::weighted_sum(&kernel, terms::exact(quads), query)
            }
            // It was asked before.
            Encoded::Map(_) => f32::NAN,
            Encoded::Compact { scale, bytes } => {
                scale * sum::weighted_sum(&kernel, terms::compact(bytes), query)
            }
        }
    }
}

/// The direction from `origin` to `point` and the distance between them.
///
/// `None` when the distance is not a finite number above `smallest`: such a point has no direction.
#[must_use]
pub fn direction_and_distance(
    point: [f32; 3],
    origin: [f32; 3],
    smallest: f32,
) -> Option<(UnitDirection, f32)> {
    let [px, py, pz] = point;
    let [ox, oy, oz] = origin;
    direction_and_length([px - ox, py - oy, pz - oz], smallest)
}

/// The direction and the length of a vector, on the terms of [`direction_and_distance`].
#[inline]
pub(crate) fn direction_and_length(
    [x, y, z]: [f32; 3],
    smallest: f32,
) -> Option<(UnitDirection, f32)> {
    let distance = math::dot([x, y, z], [x, y, z]).square_root();
    if !(distance > smallest && distance.is_finite()) {
        return None;
    }
    let u = Vector3::new(x / distance, y / distance, z / distance);
    Some((Unit::new_unchecked(u), distance))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::{Exponent, Kernel, Metric, Smoothness};
    use crate::math::Real;
    use core::f32::consts::PI;
    use std::vec::Vec;

    /// The module's documentation and the format's, word by word, one term at a time.
    fn documented_mean(
        kernel: Kernel,
        h: &Hyperparameters,
        terms: &Terms<'_>,
        query: [f32; 3],
    ) -> f32 {
        let mut a = [0.0_f32; LANES];
        for (i, (term, w)) in terms.iter().enumerate() {
            a[i % LANES] += w * documented_kernel(kernel, h, query, term);
        }
        h.prior_mean + (((a[0] + a[1]) + (a[2] + a[3])) + ((a[4] + a[5]) + (a[6] + a[7])))
    }

    /// As [`documented_mean`], of compact terms as they lie in a file.
    fn documented_compact_mean(
        kernel: Kernel,
        h: &Hyperparameters,
        (scale, run): (f32, &[([i8; 3], i16)]),
        u: [f32; 3],
    ) -> f32 {
        let query = [u[0] * 127.0, u[1] * 127.0, u[2] * 127.0];
        let mut a = [0.0_f32; LANES];
        for (i, ([x, y, z], w)) in run.iter().enumerate() {
            let steps = [f32::from(*x), f32::from(*y), f32::from(*z)];
            a[i % LANES] += f32::from(*w) * documented_kernel(kernel, h, query, steps);
        }
        let sum = ((a[0] + a[1]) + (a[2] + a[3])) + ((a[4] + a[5]) + (a[6] + a[7]));
        h.prior_mean + scale * sum
    }

    fn documented_kernel(kernel: Kernel, h: &Hyperparameters, a: [f32; 3], b: [f32; 3]) -> f32 {
        let (l, p) = (h.length_scale, h.parameter);
        let d = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        let s = (d[0] * d[0] + d[1] * d[1]) + d[2] * d[2];
        let q = (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
        match kernel {
            Kernel::RationalQuadratic(Exponent::One) => 1.0 / (1.0 + s * (1.0 / ((2.0 * l) * l))),
            Kernel::RationalQuadratic(Exponent::Half) => {
                1.0 / (1.0 + s * (1.0 / (l * l))).square_root()
            }
            Kernel::RationalQuadratic(Exponent::Free) => {
                (1.0 + s * (1.0 / (((2.0 * p) * l) * l))).power(-p)
            }
            Kernel::RadialBasis => math::exp(-(s * (1.0 / ((2.0 * l) * l)))),
            Kernel::Matern(Smoothness::Half) => math::exp(-(s.square_root() * (1.0 / l))),
            Kernel::Matern(Smoothness::ThreeHalves) => {
                let z = s.square_root() * (3.0_f32.square_root() / l);
                (1.0 + z) * math::exp(-z)
            }
            Kernel::Matern(Smoothness::FiveHalves) => {
                let z = s.square_root() * (5.0_f32.square_root() / l);
                ((1.0 + z) + z * z / 3.0) * math::exp(-z)
            }
            Kernel::Linear => q,
            Kernel::Polynomial => ((q + p) * (q + p)) * (q + p),
            Kernel::Periodic => {
                let [x, y, z] = d.map(|d| (d * (PI / p)).sine());
                math::exp(-(((x * x + y * y) + z * z) * (2.0 / (l * l))))
            }
        }
    }

    #[test]
    fn the_mean_has_the_bits_of_the_documented_order_for_every_length_kernel_and_metric() {
        let mut state = 1_u32;
        let mut number = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / (1 << 23) as f32 - 1.0
        };
        for count in 0..70 {
            let words: Vec<Word> = (0..4 * count)
                .map(|i| number() * if i < 3 * count { 1.0 } else { 300.0 })
                .map(f32::to_le_bytes)
                .collect();
            let terms = Terms::from_words(&words).unwrap();
            let u = Unit::new_normalize(Vector3::new(number(), number(), number()));
            let hyperparameters = Hyperparameters {
                length_scale: 0.3 + 0.2 * number(),
                parameter: 0.7 + 0.2 * number(),
                prior_mean: 40.0 * number(),
            };
            for kernel in Kernel::ALL {
                for metric in Metric::ALL {
                    let query = match metric {
                        Metric::Chord => [u.x, u.y, u.z],
                        Metric::Angles => [
                            libm::atan2f((u.x * u.x + u.y * u.y).square_root(), u.z),
                            libm::atan2f(u.y, u.x),
                            0.0,
                        ],
                    };
                    let model = Model { metric, kernel };
                    let mean = posterior_mean(model, &hyperparameters, &terms, &u);
                    let documented = documented_mean(kernel, &hyperparameters, &terms, query);
                    assert_eq!(mean.to_bits(), documented.to_bits(), "{model:?} {count}");
                }
            }
        }
    }

    #[test]
    fn the_mean_of_compact_terms_has_the_bits_of_the_documented_order() {
        let mut state = 7_u32;
        let mut number = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / (1 << 23) as f32 - 1.0
        };
        for count in 0..70 {
            let run: Vec<([i8; 3], i16)> = (0..count)
                .map(|_| {
                    let direction = [number(), number(), number()].map(|x| (127.0 * x) as i8);
                    (direction, (32767.0 * number()) as i16)
                })
                .collect();
            let mut bytes: Vec<u8> = Vec::new();
            for axis in 0..3 {
                bytes.extend(run.iter().map(|(direction, _)| direction[axis] as u8));
            }
            bytes.extend(run.iter().flat_map(|(_, weight)| weight.to_le_bytes()));
            let scale = 0.01 + 0.005 * number();
            let terms = Terms::from_compact(scale, bytes.as_chunks().0);
            assert_eq!(terms.len(), count);
            let u = Unit::new_normalize(Vector3::new(number(), number(), number()));
            let hyperparameters = Hyperparameters {
                length_scale: 40.0 + 20.0 * number(),
                parameter: 0.7 + 0.2 * number(),
                prior_mean: 40.0 * number(),
            };
            for kernel in Kernel::ALL {
                let model = Model::chord(kernel);
                let mean = posterior_mean(model, &hyperparameters, &terms, &u);
                let documented = documented_compact_mean(
                    kernel,
                    &hyperparameters,
                    (scale, &run),
                    [u.x, u.y, u.z],
                );
                assert_eq!(mean.to_bits(), documented.to_bits(), "{kernel:?} {count}");
            }
            let inspected = terms.iter().zip(&run);
            for ((direction, weight), (steps, w)) in inspected {
                assert_eq!(direction, steps.map(|s| f32::from(s) / 127.0));
                assert_eq!(weight, f32::from(*w) * scale);
            }
        }
    }
}
