//! The rational quadratic k = (1 + s/(2αl²))^(−α), the paper's kernel, by what its exponent costs.

use super::{Covariance, along, squared_distance};
use crate::math::Real;

/// The rational quadratic with α = 1: k = 1 / (1 + s/(2l²)).
#[derive(Clone, Copy, Debug)]
pub struct RationalQuadraticOne<T> {
    inverse: T,
}

impl<T: Real> RationalQuadraticOne<T> {
    /// With length scale `l > 0`, in units of the distance.
    #[must_use]
    pub fn new(length_scale: T) -> Self {
        Self {
            inverse: T::ONE / (T::TWO * length_scale * length_scale),
        }
    }
}

impl<T: Real> Covariance<T> for RationalQuadraticOne<T> {
    #[inline(always)]
    fn between(&self, a: [T; 3], b: [T; 3]) -> T {
        T::ONE / (T::ONE + squared_distance(a, b) * self.inverse)
    }

    #[inline(always)]
    fn gradient(&self, a: [T; 3], b: [T; 3]) -> [T; 3] {
        let k = self.between(a, b);
        along(-(T::TWO * self.inverse * (k * k)), a, b)
    }
}

/// The rational quadratic with α = ½: k = 1 / √(1 + s/l²).
#[derive(Clone, Copy, Debug)]
pub struct RationalQuadraticHalf<T> {
    inverse: T,
}

impl<T: Real> RationalQuadraticHalf<T> {
    /// With length scale `l > 0`, in units of the distance.
    #[must_use]
    pub fn new(length_scale: T) -> Self {
        Self {
            inverse: T::ONE / (length_scale * length_scale),
        }
    }
}

impl<T: Real> Covariance<T> for RationalQuadraticHalf<T> {
    #[inline(always)]
    fn between(&self, a: [T; 3], b: [T; 3]) -> T {
        T::ONE / (T::ONE + squared_distance(a, b) * self.inverse).square_root()
    }

    #[inline(always)]
    fn gradient(&self, a: [T; 3], b: [T; 3]) -> [T; 3] {
        let k = self.between(a, b);
        along(-(self.inverse * ((k * k) * k)), a, b)
    }
}

/// The rational quadratic with any α > 0: k = (1 + s/(2αl²))^(−α).
#[derive(Clone, Copy, Debug)]
pub struct RationalQuadraticFree<T> {
    inverse: T,
    minus_exponent: T,
}

impl<T: Real> RationalQuadraticFree<T> {
    /// With length scale `l > 0`, in units of the distance, and exponent `α > 0`.
    #[must_use]
    pub fn new(length_scale: T, exponent: T) -> Self {
        Self {
            inverse: T::ONE / (T::TWO * exponent * length_scale * length_scale),
            minus_exponent: -exponent,
        }
    }
}

impl<T: Real> Covariance<T> for RationalQuadraticFree<T> {
    #[inline(always)]
    fn between(&self, a: [T; 3], b: [T; 3]) -> T {
        (T::ONE + squared_distance(a, b) * self.inverse).power(self.minus_exponent)
    }

    #[inline(always)]
    fn gradient(&self, a: [T; 3], b: [T; 3]) -> [T; 3] {
        let base = T::ONE + squared_distance(a, b) * self.inverse;
        let k = base.power(self.minus_exponent);
        along(
            T::TWO * self.minus_exponent * self.inverse * (k / base),
            a,
            b,
        )
    }
}
