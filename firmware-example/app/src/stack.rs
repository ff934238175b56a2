//! How deep a call reaches into the stack: what lies below is painted first, and what the call has
//! written over is counted afterwards.

const PAINT: u32 = 0x5bad_c0de;

/// Words painted. A board must have as much stack left.
const DEPTH: usize = 1536;

/// Bytes of stack that `work` uses, its own frame and all below it. Exact to a word where `work`
/// writes all that it reserves, else a lower bound, as painting always is.
///
/// Interrupts must be off: their handlers use the same stack.
pub fn depth_of(work: impl FnOnce()) -> usize {
    let top = paint();
    run(work);
    used_below(top)
}

#[inline(never)]
fn run(work: impl FnOnce()) {
    work();
}

/// The top of what was painted; 0 where this does not know how to.
///
/// One block of assembly, so that nothing is pushed between reading the stack pointer and painting
/// below it.
#[inline(never)]
fn paint() -> usize {
    let top: usize;
    // SAFETY: below the stack pointer is memory that belongs to nobody, on boards with as much
    // stack and interrupts off.
    #[cfg(target_arch = "arm")]
    unsafe {
        core::arch::asm!(
            "mov {top}, sp",
            "subs {end}, {top}, {depth}",
            "mov {place}, {top}",
            "2:",
            "subs {place}, {place}, #4",
            "str {paint}, [{place}]",
            "cmp {place}, {end}",
            "bne 2b",
            top = out(reg) top,
            end = out(reg) _,
            place = out(reg) _,
            depth = in(reg) 4 * DEPTH,
            paint = in(reg) PAINT,
        );
    }
    // SAFETY: as above.
    #[cfg(target_arch = "riscv32")]
    unsafe {
        core::arch::asm!(
            "mv {top}, sp",
            "sub {end}, {top}, {depth}",
            "mv {place}, {top}",
            "2:",
            "addi {place}, {place}, -4",
            "sw {paint}, 0({place})",
            "bne {place}, {end}, 2b",
            top = out(reg) top,
            end = out(reg) _,
            place = out(reg) _,
            depth = in(reg) 4 * DEPTH,
            paint = in(reg) PAINT,
        );
    }
    #[cfg(not(any(target_arch = "arm", target_arch = "riscv32")))]
    {
        top = 0;
    }
    top
}

#[inline(never)]
fn used_below(top: usize) -> usize {
    if top == 0 {
        return 0;
    }
    let untouched = (1..=DEPTH)
        .rev()
        // SAFETY: as in `paint`.
        .take_while(|word| unsafe {
            core::ptr::with_exposed_provenance::<u32>(top - 4 * word).read_volatile() == PAINT
        })
        .count();
    4 * (DEPTH - untouched)
}
