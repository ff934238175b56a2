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
use crate::math;
use nalgebra::{Unit, Vector3};

#[cfg(test)]
pub(crate) mod evaluations;

/// How many accumulators the sum is interleaved over.
pub const LANES: usize = 8;

/// A direction: a unit vector.
pub type UnitDirection = Unit<Vector3<f32>>;

/// A little-endian `f32` as it lies in a template.
pub type Word = [u8; 4];

/// The directions and weights of one component: four borrowed arrays of the same length, each a
/// run of little-endian `f32`, at any alignment.
///
/// A direction lies in the coordinates of the template's metric: a unit vector, or (φ, θ, 0).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Terms<'a> {
    x: &'a [Word],
    y: &'a [Word],
    z: &'a [Word],
    weights: &'a [Word],
}

impl<'a> Terms<'a> {
    pub(crate) const EMPTY: Self = Self {
        x: &[],
        y: &[],
        z: &[],
        weights: &[],
    };

    /// Splits `words` into its four equal parts: all x, all y, all z, all weights. `None` when the
    /// length is not a multiple of four.
    #[must_use]
    pub fn from_words(words: &'a [Word]) -> Option<Self> {
        let count = words.len() / 4;
        let (x, rest) = words.split_at_checked(count)?;
        let (y, rest) = rest.split_at_checked(count)?;
        let (z, weights) = rest.split_at_checked(count)?;
        (weights.len() == count).then_some(Self { x, y, z, weights })
    }

    /// How many terms there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// Whether there is no term.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    fn arrays(&self) -> [&'a [Word]; 4] {
        [self.x, self.y, self.z, self.weights]
    }

    /// The terms one by one: direction, in the metric's coordinates, and weight.
    pub fn iter(&self) -> impl Iterator<Item = ([f32; 3], f32)> + use<'a> {
        let read = |word: &Word| f32::from_le_bytes(*word);
        self.x
            .iter()
            .zip(self.y)
            .zip(self.z)
            .zip(self.weights)
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
        let mut lanes = sum_chunks(kernel, terms, query);
        let [xs, ys, zs, ws] = terms.arrays().map(|words| words.as_chunks::<LANES>().1);
        for ((((lane, x), y), z), w) in lanes.iter_mut().zip(xs).zip(ys).zip(zs).zip(ws) {
            let [x, y, z, w] = [x, y, z, w].map(|word| f32::from_le_bytes(*word));
            *lane += w * kernel.between(query, [x, y, z]);
        }
        let [a0, a1, a2, a3, a4, a5, a6, a7] = lanes;
        ((a0 + a1) + (a2 + a3)) + ((a4 + a5) + (a6 + a7))
    }
}

/// The accumulators after the terms that fill whole rounds of them.
///
/// A controller goes through the terms once for each half of the accumulators: with all eight, the
/// compiler loads more terms ahead than there are registers, and a term costs two instructions more.
fn sum_chunks<K: Covariance<f32>>(kernel: K, terms: &Terms<'_>, query: [f32; 3]) -> [f32; LANES] {
    let [a0, a1, a2, a3] = sum_four::<K, false>(&kernel, terms, query);
    let [a4, a5, a6, a7] = sum_four::<K, true>(&kernel, terms, query);
    [a0, a1, a2, a3, a4, a5, a6, a7]
}

/// Four accumulators from `FIRST` on, after the whole rounds.
///
/// Out of line on purpose: next to the sum over the accumulators, which adds them in pairs, the
/// compiler makes vectors of two lanes where four fit, and the loop takes three times as long.
/// Written out on purpose: a loop over the four is unrolled at `opt-level = 3` alone.
#[inline(never)]
fn sum_four<K: Covariance<f32>, const BACK: bool>(
    kernel: &K,
    terms: &Terms<'_>,
    query: [f32; 3],
) -> [f32; 4] {
    let term = |lane: f32, [x, y, z, w]: [Word; 4]| {
        let [x, y, z, w] = [x, y, z, w].map(f32::from_le_bytes);
        lane + w * kernel.between(query, [x, y, z])
    };
    let [mut a, mut b, mut c, mut d] = [0.0; 4];
    let [xs, ys, zs, ws] = terms.arrays().map(|words| words.as_chunks::<LANES>().0);
    for (((x, y), z), w) in xs.iter().zip(ys).zip(zs).zip(ws) {
        let [x, y, z, w] = [x, y, z, w].map(|round| {
            let [w0, w1, w2, w3, w4, w5, w6, w7] = *round;
            if BACK {
                [w4, w5, w6, w7]
            } else {
                [w0, w1, w2, w3]
            }
        });
        let ([x0, x1, x2, x3], [y0, y1, y2, y3]) = (x, y);
        let ([z0, z1, z2, z3], [w0, w1, w2, w3]) = (z, w);
        a = term(a, [x0, y0, z0, w0]);
        b = term(b, [x1, y1, z1, w1]);
        c = term(c, [x2, y2, z2, w2]);
        d = term(d, [x3, y3, z3, w3]);
    }
    [a, b, c, d]
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
    use crate::math::Real;
    let [px, py, pz] = point;
    let [ox, oy, oz] = origin;
    let (x, y, z) = (px - ox, py - oy, pz - oz);
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
