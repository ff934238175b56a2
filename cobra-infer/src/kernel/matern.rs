//! Matérn's kernels of smoothness ½, 3/2 and 5/2, with r = √s the distance.

use super::{Covariance, along, squared_distance};
use crate::math::Real;

/// Smoothness ½: k = exp(−r/l).
#[derive(Clone, Copy, Debug)]
pub struct MaternHalf<T> {
    inverse: T,
}

impl<T: Real> MaternHalf<T> {
    /// With length scale `l > 0`, in units of the distance.
    #[must_use]
    pub fn new(length_scale: T) -> Self {
        Self {
            inverse: T::ONE / length_scale,
        }
    }
}

impl<T: Real> Covariance<T> for MaternHalf<T> {
    #[inline(always)]
    fn between(&self, a: [T; 3], b: [T; 3]) -> T {
        (-(squared_distance(a, b).square_root() * self.inverse)).exponential()
    }

    /// 0 at a = b, where there is none.
    #[inline(always)]
    fn gradient(&self, a: [T; 3], b: [T; 3]) -> [T; 3] {
        let r = squared_distance(a, b).square_root();
        if r > T::ZERO {
            along(-(self.inverse * self.between(a, b) / r), a, b)
        } else {
            [T::ZERO; 3]
        }
    }
}

/// Smoothness 3/2: k = (1 + z)·exp(−z) with z = √3·r/l.
#[derive(Clone, Copy, Debug)]
pub struct MaternThreeHalves<T> {
    inverse: T,
}

impl<T: Real> MaternThreeHalves<T> {
    /// With length scale `l > 0`, in units of the distance.
    #[must_use]
    pub fn new(length_scale: T) -> Self {
        Self {
            inverse: T::THREE.square_root() / length_scale,
        }
    }
}

impl<T: Real> Covariance<T> for MaternThreeHalves<T> {
    #[inline(always)]
    fn between(&self, a: [T; 3], b: [T; 3]) -> T {
        let z = squared_distance(a, b).square_root() * self.inverse;
        (T::ONE + z) * (-z).exponential()
    }

    #[inline(always)]
    fn gradient(&self, a: [T; 3], b: [T; 3]) -> [T; 3] {
        let z = squared_distance(a, b).square_root() * self.inverse;
        along(-(self.inverse * self.inverse * (-z).exponential()), a, b)
    }
}

/// Smoothness 5/2: k = ((1 + z) + z²/3)·exp(−z) with z = √5·r/l.
#[derive(Clone, Copy, Debug)]
pub struct MaternFiveHalves<T> {
    inverse: T,
}

impl<T: Real> MaternFiveHalves<T> {
    /// With length scale `l > 0`, in units of the distance.
    #[must_use]
    pub fn new(length_scale: T) -> Self {
        Self {
            inverse: T::FIVE.square_root() / length_scale,
        }
    }
}

impl<T: Real> Covariance<T> for MaternFiveHalves<T> {
    #[inline(always)]
    fn between(&self, a: [T; 3], b: [T; 3]) -> T {
        let z = squared_distance(a, b).square_root() * self.inverse;
        ((T::ONE + z) + z * z / T::THREE) * (-z).exponential()
    }

    #[inline(always)]
    fn gradient(&self, a: [T; 3], b: [T; 3]) -> [T; 3] {
        let z = squared_distance(a, b).square_root() * self.inverse;
        let slope = self.inverse * self.inverse / T::THREE * (T::ONE + z);
        along(-(slope * (-z).exponential()), a, b)
    }
}
