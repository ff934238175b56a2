//! The gradient of the posterior mean over the direction.
//!
//! Owns ∇μ(u) = Σᵢ wᵢ ∇k(u, uᵢ), of a map that of its splines, and how it is added. From it comes the
//! normal of the surface that a component describes ([`crate::mixture`]).
//!
//! # Order of summation
//! One accumulator an axis, from +0, terms by rising i; a term is wᵢ·∂k. What comes of compact terms is
//! multiplied by (127·scale), because their directions are compared in steps of 1/127.

use super::compact::GRID;
use super::terms::{self, Arrays, Encoded, Number, Terms};
use super::{Hyperparameters, UnitDirection};
use crate::kernel::{Covariance, Model, Visitor};
use crate::validity;

/// ∇μ(u) as a vector of the object's frame, in the template's unit: how the mean grows as u moves on the
/// sphere. What it says along u itself is without meaning, because directions do not leave the sphere.
///
/// Not finite where the mean has none (on a term of Matérn's kernel of smoothness ½ it is taken for 0), at
/// the poles of [`crate::Metric::Angles`], and where [`super::posterior_mean`] is NaN.
#[must_use]
pub fn posterior_gradient(
    model: Model,
    hyperparameters: &Hyperparameters,
    terms: &Terms<'_>,
    u: &UnitDirection,
) -> [f32; 3] {
    let u = [u.x, u.y, u.z];
    if let Some(map) = terms.map() {
        let square = validity::square(map.pole(), u);
        return validity::pull_back(map.pole(), u, map.gradient(square));
    }
    let Some(mut query) = model.metric.coordinates(u) else {
        return [f32::NAN; 3];
    };
    if terms.compact_scale().is_some() {
        query = query.map(|coordinate| coordinate * GRID);
    }
    let sum = model.kernel.visit(
        hyperparameters.length_scale,
        hyperparameters.parameter,
        WeightedGradients { terms, query },
    );
    model.metric.pull_back(u, sum.unwrap_or([f32::NAN; 3]))
}

struct WeightedGradients<'a> {
    terms: &'a Terms<'a>,
    query: [f32; 3],
}

impl Visitor<f32> for WeightedGradients<'_> {
    type Output = [f32; 3];

    fn visit(self, kernel: impl Covariance<f32>) -> [f32; 3] {
        let Self { terms, query } = self;
        match terms.0 {
            Encoded::Exact { quads, scale } => {
                let factor = scale.map_or(1.0, |scale| GRID * scale);
                summed(&kernel, terms::exact(quads), query, factor)
            }
            Encoded::Map(_) => [f32::NAN; 3],
            Encoded::Compact { scale, bytes } => {
                summed(&kernel, terms::compact(bytes), query, GRID * scale)
            }
        }
    }
}

#[inline]
fn summed<K: Covariance<f32>, C: Number, W: Number>(
    kernel: &K,
    terms: Option<Arrays<'_, C, W>>,
    query: [f32; 3],
    factor: f32,
) -> [f32; 3] {
    let Some(terms) = terms else {
        return [f32::NAN; 3];
    };
    let [mut x, mut y, mut z] = [0.0; 3];
    for (direction, weight) in terms.iter() {
        let [dx, dy, dz] = kernel.gradient(query, direction);
        x += weight * dx;
        y += weight * dy;
        z += weight * dz;
    }
    [factor * x, factor * y, factor * z]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gp::map::{Header, Map};
    use crate::gp::{Word, posterior_mean};
    use crate::kernel::{Kernel, Metric};
    use crate::math::Real;
    use crate::validity::Pole;
    use nalgebra::{Unit, Vector3};
    use std::vec::Vec;

    /// Numbers from −1 to 1.
    fn numbers() -> impl FnMut() -> f32 {
        let mut state = 3_u32;
        move || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / (1 << 23) as f32 - 1.0
        }
    }

    /// How far the gradient's tangential part is from central differences, as a share of `size`.
    fn deviation(model: Model, h: &Hyperparameters, terms: &Terms<'_>, u: [f32; 3]) -> f32 {
        let u = Unit::new_normalize(Vector3::from(u));
        let gradient = Vector3::from(posterior_gradient(model, h, terms, &u));
        let aside = if u.x * u.x < 0.5 {
            Vector3::x()
        } else {
            Vector3::y()
        };
        let first = u.cross(&aside).normalize();
        let second = u.cross(&first);
        let mut worst = 0.0_f32;
        for tangent in [first, second] {
            let at = |step: f32| {
                let moved = Unit::new_normalize(u.into_inner() + tangent * step);
                posterior_mean(model, h, terms, &moved)
            };
            let step = 1.0 / 256.0;
            let slope = (at(step) - at(-step)) / (2.0 * step);
            worst = worst.max((slope - gradient.dot(&tangent)).abs());
        }
        worst
    }

    #[test]
    fn the_gradient_is_that_of_central_differences_for_every_kernel_and_metric() {
        let mut number = numbers();
        for metric in Metric::ALL {
            for kernel in Kernel::ALL {
                let directions: Vec<[f32; 3]> = (0..24)
                    .map(|_| Unit::new_normalize(Vector3::from([number(), number(), number()])))
                    .map(|u| metric.coordinates([u.x, u.y, u.z]).unwrap())
                    .collect();
                let words: Vec<Word> = (0..3)
                    .flat_map(|axis| directions.iter().map(move |d| d[axis]))
                    .chain((0..24).map(|i| (i as f32 * 0.7).sine()))
                    .map(f32::to_le_bytes)
                    .collect();
                let terms = Terms::from_words(&words).unwrap();
                let h = Hyperparameters {
                    length_scale: 0.9,
                    parameter: 1.7,
                    prior_mean: 2.0,
                };
                let model = Model { metric, kernel };
                let mut worst = 0.0_f32;
                for _ in 0..20 {
                    // Away from the poles and the seam of the angles.
                    let u = [0.5 + 0.3 * number(), 0.6 * number(), 0.5 * number()];
                    worst = worst.max(deviation(model, &h, &terms, u));
                }
                // A kernel with a kink at every term is not smooth over a step.
                let allowed = match kernel {
                    Kernel::Matern(crate::kernel::Smoothness::Half) => 0.2,
                    Kernel::Polynomial => 0.05,
                    _ => 0.01,
                };
                assert!(worst < allowed, "{model:?}: {worst}");
            }
        }
    }

    #[test]
    fn the_gradient_of_compact_terms_is_that_of_central_differences_decoded_or_not() {
        let mut number = numbers();
        let model = Model::chord(Kernel::RationalQuadratic(crate::kernel::Exponent::Half));
        let h = Hyperparameters {
            length_scale: 60.0,
            parameter: 0.5,
            prior_mean: 10.0,
        };
        let run: Vec<([i8; 3], i16)> = (0..21)
            .map(|_| {
                let u = Unit::new_normalize(Vector3::from([number(), number(), number()]));
                let steps = [u.x, u.y, u.z].map(|x| (x * 127.0) as i8);
                (steps, (30_000.0 * number()) as i16)
            })
            .collect();
        let mut bytes: Vec<u8> = Vec::new();
        for axis in 0..3 {
            bytes.extend(run.iter().map(|(direction, _)| direction[axis] as u8));
        }
        bytes.extend(run.iter().flat_map(|(_, weight)| weight.to_le_bytes()));
        let compact = Terms::from_compact(1e-4, bytes.as_chunks().0);
        let words: Vec<Word> = (0..3)
            .flat_map(|axis| run.iter().map(move |(d, _)| f32::from(d[axis])))
            .chain(run.iter().map(|(_, weight)| f32::from(*weight)))
            .map(f32::to_le_bytes)
            .collect();
        let decoded = Terms::from_decoded(1e-4, words.as_chunks().0);
        for _ in 0..20 {
            let u = [number(), number(), number()];
            assert!(deviation(model, &h, &compact, u) < 0.01);
            let u = Unit::new_normalize(Vector3::from(u));
            let [a, b] = [&compact, &decoded].map(|t| posterior_gradient(model, &h, t, &u));
            assert_eq!(a.map(f32::to_bits), b.map(f32::to_bits));
        }
    }

    #[test]
    fn the_gradient_of_a_map_is_that_of_central_differences_for_every_pole() {
        let mut number = numbers();
        let nodes: Vec<u8> = (0..24 * 24)
            .map(|i: u32| ((i % 24) as f32 * 0.3, (i / 24) as f32 * 0.25))
            .map(|(x, y)| (60.0 * x.sine() + 60.0 * y.sine()) as i8 as u8)
            .collect();
        let model = Model::chord(Kernel::RationalQuadratic(crate::kernel::Exponent::Half));
        let h = Hyperparameters {
            length_scale: 1.0,
            parameter: 0.5,
            prior_mean: 10.0,
        };
        for pole in Pole::ALL {
            let [scale, spacing, x, y] = [1.0 / 3600.0, 10.0, 10.0, 10.5].map(f32::to_le_bytes);
            let header: Header = [scale, spacing, x, y, [24, 24, pole as u8, 0]];
            let terms = Terms::from_map(Map::new(&header, &nodes));
            let mut worst = 0.0_f32;
            for _ in 0..60 {
                let place = [0.9 * number(), 0.9 * number()];
                // Along the folds of the octahedron the mean has kinks.
                let [x, y] = place.map(crate::math::abs);
                if x.min(y).min(crate::math::abs(x + y - 1.0)) < 0.05 {
                    continue;
                }
                let [p, q] = place.map(|t| (t + 1.0) * 32.0);
                let cell = validity::Cell {
                    column: p as u8,
                    row: q as u8,
                };
                let u = validity::direction(pole, 64, cell, [0.5; 2]);
                worst = worst.max(deviation(model, &h, &terms, u));
            }
            assert!(worst < 0.02, "{pole:?}: {worst}");
        }
    }
}
