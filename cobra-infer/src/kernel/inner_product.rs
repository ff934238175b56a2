//! Kernels of the inner product: the linear one and the polynomial of degree 3.
//!
//! Neither is stationary, and a Gram matrix of either has low rank: 3 and 20. The paper's ablation
//! has them as what a kernel should not be.

use super::Covariance;
use crate::math::Real;

#[inline(always)]
fn inner_product<T: Real>([a0, a1, a2]: [T; 3], [b0, b1, b2]: [T; 3]) -> T {
    (a0 * b0 + a1 * b1) + a2 * b2
}

/// k = a·b.
#[derive(Clone, Copy, Debug)]
pub struct Linear;

impl<T: Real> Covariance<T> for Linear {
    #[inline(always)]
    fn between(&self, a: [T; 3], b: [T; 3]) -> T {
        inner_product(a, b)
    }

    #[inline(always)]
    fn gradient(&self, _: [T; 3], b: [T; 3]) -> [T; 3] {
        b
    }
}

/// k = (a·b + c)³.
#[derive(Clone, Copy, Debug)]
pub struct Polynomial<T> {
    offset: T,
}

impl<T: Real> Polynomial<T> {
    /// With offset `c > 0`.
    #[must_use]
    pub fn new(offset: T) -> Self {
        Self { offset }
    }
}

impl<T: Real> Covariance<T> for Polynomial<T> {
    #[inline(always)]
    fn between(&self, a: [T; 3], b: [T; 3]) -> T {
        let q = inner_product(a, b) + self.offset;
        (q * q) * q
    }

    #[inline(always)]
    fn gradient(&self, a: [T; 3], b: [T; 3]) -> [T; 3] {
        let q = inner_product(a, b) + self.offset;
        let slope = T::THREE * (q * q);
        b.map(|coordinate| slope * coordinate)
    }
}
