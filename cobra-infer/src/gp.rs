//! The posterior mean of a Gaussian process over borrowed arrays.
//!
//! Owns the sum μ(u) = m + Σᵢ wᵢ k(u, uᵢ) (Eq. 5 with w = K⁻¹(d − m) precomputed) and the order in
//! which it is added, which is part of the template format. Does not own where the arrays lie
//! ([`crate::template`]) or the kernels ([`crate::kernel`]).
//!
//! # Order of summation
//! Term i goes to accumulator i mod 8. Within an accumulator terms are added by rising i, starting
//! from +0. The mean is m + (((a₀+a₁)+(a₂+a₃)) + ((a₄+a₅)+(a₆+a₇))). A term is wᵢ·k. This is what
//! vector code on the host and scalar code on a controller both compute.

use crate::kernel::{Covariance, Model, Visitor};
use crate::math::{self, Real};
use nalgebra::{Unit, Vector3};

#[cfg(test)]
pub(crate) mod evaluations;
mod sum;

/// How many accumulators the sum is interleaved over.
pub const LANES: usize = 8;

/// A direction: a unit vector.
pub type UnitDirection = Unit<Vector3<f32>>;

/// A little-endian `f32` as it lies in a template.
pub type Word = [u8; 4];

/// The directions and weights of one component: four borrowed arrays of the same length behind each
/// other, each a run of little-endian `f32`, at any alignment.
///
/// A direction lies in the coordinates of the template's metric: a unit vector, or (φ, θ, 0).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Terms<'a> {
    /// As many as there are terms. What lies in four are not a term's words: they are four of them
    /// only so that their number needs no check.
    quads: &'a [[Word; 4]],
}

impl<'a> Terms<'a> {
    #[inline]
    pub(crate) const fn from_quads(quads: &'a [[Word; 4]]) -> Self {
        Self { quads }
    }

    /// Of all x, all y, all z, all weights. `None` when the length is not a multiple of four.
    #[must_use]
    pub fn from_words(words: &'a [Word]) -> Option<Self> {
        let (quads, rest) = words.as_chunks();
        rest.is_empty().then_some(Self { quads })
    }

    /// How many terms there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.quads.len()
    }

    /// Whether there is no term.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.quads.is_empty()
    }

    /// All x, all y, all z, all weights; always some, but for the compiler, which then sees that
    /// the four are of one length.
    #[inline]
    fn arrays(&self) -> Option<[&'a [Word]; 4]> {
        let count = self.quads.len();
        let (x, rest) = self.quads.as_flattened().split_at_checked(count)?;
        let (y, rest) = rest.split_at_checked(count)?;
        let (z, rest) = rest.split_at_checked(count)?;
        let (weights, _) = rest.split_at_checked(count)?;
        Some([x, y, z, weights])
    }

    /// The terms one by one: direction, in the metric's coordinates, and weight.
    pub fn iter(&self) -> impl Iterator<Item = ([f32; 3], f32)> + use<'a> {
        let read = |word: &Word| f32::from_le_bytes(*word);
        let [x, y, z, weights] = self.arrays().unwrap_or([&[]; 4]);
        x.iter()
            .zip(y)
            .zip(z)
            .zip(weights)
            .map(move |(((x, y), z), w)| ([read(x), read(y), read(z)], read(w)))
    }
}

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
/// The order of summation is the module's. NaN where this build does not contain the model's kernel
/// or metric, which [`crate::Template::from_bytes`] refuses.
#[must_use]
#[inline(never)]
pub fn posterior_mean(
    model: Model,
    hyperparameters: &Hyperparameters,
    terms: &Terms<'_>,
    u: &UnitDirection,
) -> f32 {
    let Some(query) = model.metric.coordinates([u.x, u.y, u.z]) else {
        return f32::NAN;
    };
    let sum = model.kernel.visit(
        hyperparameters.length_scale,
        hyperparameters.parameter,
        WeightedSum { terms, query },
    );
    sum.map_or(f32::NAN, |sum| hyperparameters.prior_mean + sum)
}

/// Σᵢ wᵢ k(query, uᵢ).
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
        sum::weighted_sum(&kernel, terms, query)
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
}
