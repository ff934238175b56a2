//! √ by the shortest way the target has: std's on a host, one instruction on a controller with a
//! floating-point unit, else `libm`'s.
//!
//! IEEE 754 asks for the correctly rounded result, so that all ways give the same bits for the same
//! input; `tests/` of this crate checks every `f32`. Only a NaN's own bits may differ. It is here
//! and not in `cobra-infer` because of what the shortest way needs: `std` for loops that vectorise
//! on a host (`libm`'s inline assembly keeps them scalar), and `unsafe` for the instruction, which
//! `core` does not give a name on Arm and RISC-V (`libm` computes it in software there, in 52
//! instructions).
#![no_std]

#[cfg(way = "std")]
extern crate std;

#[cfg(any(way = "arm", way = "riscv"))]
mod instruction;

/// √x in single precision; NaN for x < 0.
#[inline(always)]
#[must_use]
pub fn square_root_f32(x: f32) -> f32 {
    #[cfg(way = "std")]
    return x.sqrt();
    #[cfg(any(way = "arm", way = "riscv"))]
    return instruction::square_root(x);
    #[cfg(way = "libm")]
    return libm::sqrtf(x);
}

/// √x in double precision; NaN for x < 0. Where the floating-point unit has single precision only,
/// as on most controllers, this is `libm`'s.
#[inline(always)]
#[must_use]
pub fn square_root_f64(x: f64) -> f64 {
    #[cfg(way = "std")]
    return x.sqrt();
    #[cfg(not(way = "std"))]
    return libm::sqrt(x);
}
