//! The square root's bits beside `libm`'s.

use cobra_infer::math::Real;

/// How many square roots differ from `libm`'s, among 2,048 numbers of each exponent and sign, zeros,
/// subnormals, infinities and NaNs with them; two NaNs count as equal. Where the target's way is
/// `libm`'s there is nothing to differ; the test of `cobra-square-root` compares every number.
#[must_use]
pub fn differing() -> u32 {
    (0..1 << 20)
        .map(|step: u32| f32::from_bits(step << 12 | step.wrapping_mul(0x9e37) >> 20))
        .filter(|x| {
            let (found, expected) = (x.square_root(), libm::sqrtf(*x));
            found.to_bits() != expected.to_bits() && !(found.is_nan() && expected.is_nan())
        })
        .count() as u32
}
