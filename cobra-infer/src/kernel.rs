//! Covariance functions over directions.
//!
//! Owns the formulas, once, for the controller's `f32` sums and the trainer's `f64` Gram matrices
//! alike. Does not own the sum over a template's terms ([`crate::gp`]) or hyperparameter gradients
//! (the trainer's).
//!
//! The distance between two directions is the chord ‖u − u′‖ (the alternative that the paper names
//! where it introduces the rational quadratic): it has no seam and no pole, and needs no arctangent.

use crate::math::Real;
use serde::{Deserialize, Serialize};

/// What is taken for the distance between two directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Metric {
    /// ‖u − u′‖ of the unit vectors.
    Chord,
}

/// Which covariance function a template was trained with.
///
/// Every kernel has unit variance: the trainer folds the signal variance into the weights.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Kernel {
    /// The paper's rational quadratic, k = (1 + s/(2αl²))^(−α) with s the squared distance.
    RationalQuadratic(Exponent),
}

/// The exponent α of the rational quadratic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Exponent {
    /// α = 1: needs only + − × ÷. The default.
    One,
    /// α = ½: needs a square root besides.
    Half,
    /// Any α > 0, learned for each component: needs `powf`.
    Free,
}

impl Exponent {
    /// The value that this choice fixes, if it fixes one.
    #[must_use]
    pub const fn fixed(self) -> Option<f32> {
        match self {
            Exponent::One => Some(1.0),
            Exponent::Half => Some(0.5),
            Exponent::Free => None,
        }
    }
}

/// A covariance function of the squared distance, with k(0) = 1.
pub trait Covariance<T: Real>: Copy {
    /// k at squared distance `s ≥ 0`.
    fn at(&self, s: T) -> T;
}

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
    fn at(&self, s: T) -> T {
        T::ONE / (T::ONE + s * self.inverse)
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
    fn at(&self, s: T) -> T {
        T::ONE / (T::ONE + s * self.inverse).square_root()
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
    fn at(&self, s: T) -> T {
        (T::ONE + s * self.inverse).power(self.minus_exponent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fixed_exponents_are_special_cases_of_the_free_one() {
        for s in [0.0, 1e-6, 0.01, 0.5, 2.0, 4.0_f64] {
            for l in [0.05, 0.3, 1.7] {
                let one = RationalQuadraticOne::new(l).at(s);
                let half = RationalQuadraticHalf::new(l).at(s);
                assert!((one - RationalQuadraticFree::new(l, 1.0).at(s)).abs() < 1e-14);
                assert!((half - RationalQuadraticFree::new(l, 0.5).at(s)).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn every_kernel_is_one_at_zero_distance() {
        assert_eq!(RationalQuadraticOne::new(0.3_f32).at(0.0), 1.0);
        assert_eq!(RationalQuadraticHalf::new(0.3_f32).at(0.0), 1.0);
        assert_eq!(RationalQuadraticFree::new(0.3_f32, 0.7).at(0.0), 1.0);
    }
}
