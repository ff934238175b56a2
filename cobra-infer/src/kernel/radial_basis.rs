//! The radial basis function, or squared exponential.

use super::{Covariance, along, squared_distance};
use crate::math::Real;

/// k = exp(−s/(2l²)).
#[derive(Clone, Copy, Debug)]
pub struct RadialBasis<T> {
    inverse: T,
}

impl<T: Real> RadialBasis<T> {
    /// With length scale `l > 0`, in units of the distance.
    #[must_use]
    pub fn new(length_scale: T) -> Self {
        Self {
            inverse: T::ONE / (T::TWO * length_scale * length_scale),
        }
    }
}

impl<T: Real> Covariance<T> for RadialBasis<T> {
    #[inline(always)]
    fn between(&self, a: [T; 3], b: [T; 3]) -> T {
        (-(squared_distance(a, b) * self.inverse)).exponential()
    }

    #[inline(always)]
    fn gradient(&self, a: [T; 3], b: [T; 3]) -> [T; 3] {
        along(-(T::TWO * self.inverse * self.between(a, b)), a, b)
    }
}
