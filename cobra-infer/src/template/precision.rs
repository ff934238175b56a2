//! The precision Q_k of a component's neighbourhood.

use super::wire::PrecisionRecord;
use crate::gp::Word;
use crate::math;

/// Q = LLᵀ of Eq. 8, by its factor L, a lower triangle with a positive diagonal: whatever its
/// numbers, Q is positive definite, which no six entries of Q itself would say after rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Precision {
    lower: [f32; 6],
}

impl Precision {
    /// L row by row: (0,0), (1,0), (1,1), (2,0), (2,1), (2,2), in 1/length. `None` unless all are
    /// finite and the diagonal is positive and no subnormal.
    #[must_use]
    pub fn from_factor(lower: [f32; 6]) -> Option<Self> {
        let precision = Self { lower };
        precision.is_valid().then_some(precision)
    }

    /// A factor as it lies in the file: valid where loading has checked it.
    #[inline]
    pub(super) fn from_record(factor: &PrecisionRecord) -> Self {
        // Written out: a `map` over the array copies it first, by `memcpy`.
        let [a, b, c, d, e, f] = factor;
        let read = |word: &Word| f32::from_le_bytes(*word);
        Self {
            lower: [read(a), read(b), read(c), read(d), read(e), read(f)],
        }
    }

    /// As [`Precision::from_factor`].
    pub(super) fn is_valid(&self) -> bool {
        let [xx, yx, yy, zx, zy, zz] = self.lower;
        let positive = |d: f32| d >= f32::MIN_POSITIVE && d.is_finite();
        let finite = yx.is_finite() && zx.is_finite() && zy.is_finite();
        positive(xx) && positive(yy) && positive(zz) && finite
    }

    /// L row by row.
    #[must_use]
    pub const fn factor(&self) -> [f32; 6] {
        self.lower
    }

    /// rᵀQr = ‖Lᵀr‖², a pure number where `r` is in the template's unit: with v = Lᵀr,
    /// v₀ = (L₀₀r₀ + L₁₀r₁) + L₂₀r₂, v₁ = L₁₁r₁ + L₂₁r₂, v₂ = L₂₂r₂.
    #[must_use]
    pub fn form(&self, [x, y, z]: [f32; 3]) -> f32 {
        let [xx, yx, yy, zx, zy, zz] = self.lower;
        let v = [math::dot([xx, yx, zx], [x, y, z]), yy * y + zy * z, zz * z];
        math::dot(v, v)
    }
}

#[cfg(test)]
mod tests {
    use super::Precision;

    #[test]
    fn the_form_is_that_of_the_product_of_the_factor_and_its_transpose() {
        let lower = nalgebra::Matrix3::new(2.0_f32, 0.0, 0.0, -0.5, 1.0, 0.0, 0.25, 3.0, 0.5);
        let precision = Precision::from_factor([2.0, -0.5, 1.0, 0.25, 3.0, 0.5]).unwrap();
        let r = nalgebra::Vector3::new(1.0, -2.0, 4.0);
        let expected = (r.transpose() * lower * lower.transpose() * r)[(0, 0)];
        assert_eq!(precision.form(r.into()), expected);
    }

    #[test]
    fn a_factor_that_is_none_is_refused() {
        for (index, value) in [(0, 0.0), (2, -1.0), (5, f32::NAN), (1, f32::INFINITY)] {
            let mut lower = [1.0; 6];
            lower[index] = value;
            assert_eq!(Precision::from_factor(lower), None);
        }
    }
}
