//! The few numerical functions the crate needs, each with the same bits on every target.
//!
//! Owns all knowledge of `libm` and of square roots, and the sums whose order matters. Addition,
//! subtraction, multiplication, division and the square root are correctly rounded by IEEE 754, so
//! they agree everywhere, whoever computes them ([`cobra_square_root`] takes the shortest way that a
//! target has); the transcendental functions agree because they are always `libm`'s own code, never
//! the platform's.

use core::ops::{Add, Div, Mul, Neg, Sub};

/// √(2π), the normaliser of the Gaussian density.
pub const SQRT_TWO_PI: f32 = 2.506_628_3;

/// The floating-point numbers that kernels are evaluated in: `f32` on the controller, `f64` in the
/// trainer's Gram matrices.
pub trait Real:
    Copy
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
    /// 2.
    const TWO: Self;
    /// 3.
    const THREE: Self;
    /// 5.
    const FIVE: Self;
    /// π, rounded.
    const PI: Self;
    /// Square root, correctly rounded.
    fn square_root(self) -> Self;
    /// `self` raised to `power`.
    fn power(self, power: Self) -> Self;
    /// e raised to `self`.
    fn exponential(self) -> Self;
    /// Sine, in radians.
    fn sine(self) -> Self;
    /// The angle of (x, `self`) from the x axis, in [−π, π].
    fn arctangent(self, x: Self) -> Self;
}

impl Real for f32 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const TWO: Self = 2.0;
    const THREE: Self = 3.0;
    const FIVE: Self = 5.0;
    const PI: Self = core::f32::consts::PI;
    #[inline]
    fn square_root(self) -> Self {
        cobra_square_root::square_root_f32(self)
    }
    #[inline]
    fn power(self, power: Self) -> Self {
        libm::powf(self, power)
    }
    #[inline]
    fn exponential(self) -> Self {
        libm::expf(self)
    }
    #[inline]
    fn sine(self) -> Self {
        libm::sinf(self)
    }
    #[inline]
    fn arctangent(self, x: Self) -> Self {
        libm::atan2f(self, x)
    }
}

impl Real for f64 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const TWO: Self = 2.0;
    const THREE: Self = 3.0;
    const FIVE: Self = 5.0;
    const PI: Self = core::f64::consts::PI;
    #[inline]
    fn square_root(self) -> Self {
        cobra_square_root::square_root_f64(self)
    }
    #[inline]
    fn power(self, power: Self) -> Self {
        libm::pow(self, power)
    }
    #[inline]
    fn exponential(self) -> Self {
        libm::exp(self)
    }
    #[inline]
    fn sine(self) -> Self {
        libm::sin(self)
    }
    #[inline]
    fn arctangent(self, x: Self) -> Self {
        libm::atan2(self, x)
    }
}

/// eˣ.
#[inline]
#[must_use]
pub fn exp(x: f32) -> f32 {
    libm::expf(x)
}

/// eˣ − 1, accurate for small x.
#[inline]
#[must_use]
pub fn exp_minus_one(x: f32) -> f32 {
    libm::expm1f(x)
}

/// The error function, (2/√π) ∫₀ˣ e^(−t²) dt.
#[inline]
#[must_use]
pub fn error_function(x: f32) -> f32 {
    libm::erff(x)
}

/// Natural logarithm.
#[inline]
#[must_use]
pub fn ln(x: f32) -> f32 {
    libm::logf(x)
}

/// Absolute value, by the sign bit alone.
// Not libm's: at `opt-level = "s"` that is a call.
#[inline(always)]
#[must_use]
pub fn abs(x: f32) -> f32 {
    f32::from_bits(x.to_bits() & 0x7fff_ffff)
}

/// (a₀b₀ + a₁b₁) + a₂b₂, in that order.
///
/// nalgebra's own products state no order of summation, and the bits of a score depend on it.
#[inline]
#[must_use]
pub fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    let [a0, a1, a2] = a;
    let [b0, b1, b2] = b;
    (a0 * b0 + a1 * b1) + a2 * b2
}

/// Kahan's compensated sum: the rounding error of a long stream of terms ≥ 0 does not grow with
/// its length.
///
/// Reference: W. Kahan, Further remarks on reducing truncation errors, Comm. ACM 8 (1965).
#[derive(Clone, Copy, Debug, Default)]
pub struct CompensatedSum {
    sum: f32,
    excess: f32,
}

impl CompensatedSum {
    /// Adds one term.
    #[inline]
    pub fn add(&mut self, term: f32) {
        let corrected = term - self.excess;
        let sum = self.sum + corrected;
        self.excess = (sum - self.sum) - corrected;
        self.sum = sum;
    }

    /// The sum so far.
    #[inline]
    #[must_use]
    pub fn value(&self) -> f32 {
        self.sum
    }
}

#[cfg(test)]
mod tests {
    use super::CompensatedSum;

    #[test]
    fn a_long_sum_of_tenths_loses_no_digits() {
        let mut sum = CompensatedSum::default();
        let mut plain = 0.0_f32;
        for _ in 0..1_000_000 {
            sum.add(0.1);
            plain += 0.1;
        }
        let exact = 1.0e6 * f64::from(0.1_f32);
        assert!((f64::from(sum.value()) - exact).abs() / exact < 1e-7);
        assert!((f64::from(plain) - exact).abs() / exact > 1e-3);
    }
}
