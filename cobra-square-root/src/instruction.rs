//! The one instruction, on controllers whose floating-point unit has it.

#[cfg(way = "arm")]
#[allow(unsafe_code, reason = "`core` has no name for VSQRT")]
#[inline(always)]
pub(crate) fn square_root(x: f32) -> f32 {
    let bits: u32;
    // Through core registers, because the register class of `s0` needs a target feature that the
    // stable compiler does not name.
    // SAFETY: VSQRT reads and writes registers alone. Every target whose ABI passes floats in them
    // has it. What it overwrites is declared.
    unsafe {
        core::arch::asm!(
            "vmov s15, {bits}",
            "vsqrt.f32 s15, s15",
            "vmov {bits}, s15",
            bits = inlateout(reg) x.to_bits() => bits,
            out("s15") _,
            options(pure, nomem, nostack),
        );
    }
    f32::from_bits(bits)
}

#[cfg(way = "riscv")]
#[allow(unsafe_code, reason = "`core` has no name for fsqrt.s")]
#[inline(always)]
pub(crate) fn square_root(x: f32) -> f32 {
    let root: f32;
    // SAFETY: fsqrt.s reads and writes registers alone, and the target's name says that it is there.
    // The exception flags that it may set are not read by Rust code.
    unsafe {
        core::arch::asm!(
            "fsqrt.s {root}, {x}",
            x = in(freg) x,
            root = lateout(freg) root,
            options(pure, nomem, nostack),
        );
    }
    root
}
