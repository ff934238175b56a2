//! The periodic kernel: the product of one periodic kernel a coordinate.
//!
//! A sine of the Euclidean distance instead would not be positive semidefinite in more than one
//! dimension. Reference: D. J. C. MacKay, Introduction to Gaussian processes, 1998.

use super::Covariance;
use crate::math::Real;

/// k = exp(−2 Σᵢ sin²(π(aᵢ − bᵢ)/p)/l²).
#[derive(Clone, Copy, Debug)]
pub struct Periodic<T> {
    frequency: T,
    twice_inverse: T,
}

impl<T: Real> Periodic<T> {
    /// With length scale `l > 0`, a pure number, and period `p > 0`, in units of the coordinates.
    #[must_use]
    pub fn new(length_scale: T, period: T) -> Self {
        Self {
            frequency: T::PI / period,
            twice_inverse: T::TWO / (length_scale * length_scale),
        }
    }
}

impl<T: Real> Covariance<T> for Periodic<T> {
    #[inline(always)]
    fn between(&self, [a0, a1, a2]: [T; 3], [b0, b1, b2]: [T; 3]) -> T {
        let square = |difference: T| {
            let sine = (difference * self.frequency).sine();
            sine * sine
        };
        let squares = (square(a0 - b0) + square(a1 - b1)) + square(a2 - b2);
        (-(squares * self.twice_inverse)).exponential()
    }

    /// The derivative of sin²x is sin 2x.
    #[inline(always)]
    fn gradient(&self, a: [T; 3], b: [T; 3]) -> [T; 3] {
        let slope = -(self.twice_inverse * self.frequency * self.between(a, b));
        let twice = T::TWO * self.frequency;
        let along = |a: T, b: T| slope * ((a - b) * twice).sine();
        let ([a0, a1, a2], [b0, b1, b2]) = (a, b);
        [along(a0, b0), along(a1, b1), along(a2, b2)]
    }
}
