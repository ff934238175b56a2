//! Whatever way this target takes, its square root has the bits of `libm`'s and is correctly
//! rounded.

use cobra_square_root::{square_root_f32, square_root_f64};

/// `Ok` where the bits agree or both are NaN.
fn compare(bits: u32) -> Result<(), u32> {
    let x = f32::from_bits(bits);
    let (found, expected) = (square_root_f32(x), libm::sqrtf(x));
    let same = found.to_bits() == expected.to_bits() || (found.is_nan() && expected.is_nan());
    same.then_some(()).ok_or(bits)
}

#[test]
fn every_f32_has_the_bits_of_libm() {
    let half = |from: u32| (from..=from | 0x7fff_ffff).try_for_each(compare);
    let (positive, negative) = std::thread::scope(|scope| {
        let negative = scope.spawn(|| half(0x8000_0000));
        (half(0), negative.join().expect("the thread ends"))
    });
    assert_eq!((positive, negative), (Ok(()), Ok(())));
}

/// The exact condition in integers: with x = m·4ᵏ, m of 47 or 48 bits, the nearest 24-bit root q has
/// (2q − 1)² < 4m < (2q + 1)².
fn is_nearest(x: f32, root: f32) -> bool {
    // Exact in f64, whose exponent is even or odd as x's.
    let wide = f64::from(x).to_bits();
    let exponent = (wide >> 52) as i64 - 1023;
    let mantissa = (wide & 0x000f_ffff_ffff_ffff) | 0x0010_0000_0000_0000;
    let m = u128::from(mantissa >> 29) << (23 + exponent.rem_euclid(2));
    let half_exponent = exponent.div_euclid(2);
    let root = f64::from(root).to_bits();
    let q = u128::from((root & 0x000f_ffff_ffff_ffff | 0x0010_0000_0000_0000) >> 29);
    let same_exponent = (root >> 52) as i64 - 1023 == half_exponent;
    same_exponent && (2 * q - 1).pow(2) < 4 * m && 4 * m < (2 * q + 1).pow(2)
}

#[test]
fn every_mantissa_and_every_exponent_is_correctly_rounded() {
    let mantissas = (1.0_f32.to_bits()..4.0_f32.to_bits()).map(f32::from_bits);
    let subnormals = (1..0x0080_0000).map(f32::from_bits);
    let exponents = (1..255_u32).flat_map(|exponent| {
        let stride = (0..1 << 23).step_by(99_991);
        stride.map(move |mantissa| f32::from_bits(exponent << 23 | mantissa))
    });
    for x in mantissas.chain(subnormals).chain(exponents) {
        let root = square_root_f32(x);
        assert!(is_nearest(x, root), "{x:e} {root:e}");
    }
}

#[test]
fn f64s_have_the_bits_of_libm_in_every_class() {
    let mut bits: u64 = 0x9e37_79b9_7f4a_7c15;
    for step in 0..4_000_000_u64 {
        bits = bits.wrapping_mul(0xd129_0e12_5c6f_4b65).wrapping_add(step);
        let x = f64::from_bits(bits & !(1 << 63));
        let (found, expected) = (square_root_f64(x), libm::sqrt(x));
        let same = found.to_bits() == expected.to_bits() || (found.is_nan() && expected.is_nan());
        assert!(same, "{x:e}");
    }
    for x in [
        0.0,
        -0.0,
        f64::INFINITY,
        f64::MIN_POSITIVE,
        5e-324,
        1.0,
        4.0,
    ] {
        assert_eq!(square_root_f64(x).to_bits(), libm::sqrt(x).to_bits());
    }
    assert!(square_root_f64(-1.0).is_nan() && square_root_f32(-1.0).is_nan());
}
