//! The recorded vectors, scored here and compared bit by bit.

use crate::Board;
use cobra_agreement::{SETS, vectors};
use core::fmt::{self, Write};

/// Compares every set and says how many bits differ; whether none do.
///
/// # Errors
/// Those of `out`.
pub fn run(board: &mut impl Board, out: &mut impl Write) -> Result<bool, fmt::Error> {
    let mut agrees = true;
    for set in &SETS {
        board.feed_watchdog();
        match vectors::compare(set) {
            Ok(outcome) => {
                agrees &= outcome.mismatched_bits == 0;
                writeln!(
                    out,
                    "agreement {} points={} words={} mismatched_bits={}",
                    set.name, outcome.points, outcome.words, outcome.mismatched_bits
                )?;
            }
            Err(unreadable) => {
                agrees = false;
                writeln!(out, "agreement {} {unreadable:?}", set.name)?;
            }
        }
    }
    let differ = square_roots_that_differ();
    writeln!(out, "square roots that differ from libm's: {differ}")?;
    agrees &= differ == 0;
    #[cfg(feature = "golden")]
    {
        for (index, (template, vectors, cases)) in
            cobra_agreement::golden::GOLDEN.iter().enumerate()
        {
            board.feed_watchdog();
            let replayed = cobra_agreement::golden::replay(template, vectors);
            if replayed != Ok(*cases) {
                agrees = false;
                writeln!(out, "golden vectors {index}: {replayed:?}")?;
            }
        }
        writeln!(
            out,
            "golden vectors of {} templates and settings replayed",
            cobra_agreement::golden::GOLDEN.len()
        )?;
    }
    Ok(agrees)
}

/// Some 2,000 numbers of every exponent and sign, zeros, subnormals, infinities and NaNs among
/// them; two NaNs count as equal.
fn square_roots_that_differ() -> u32 {
    (0..1 << 20)
        .map(|step: u32| f32::from_bits(step << 12 | step.wrapping_mul(0x9e37) >> 20))
        .filter(|x| {
            use cobra_infer::math::Real;
            let (found, expected) = (x.square_root(), libm::sqrtf(*x));
            found.to_bits() != expected.to_bits() && !(found.is_nan() && expected.is_nan())
        })
        .count() as u32
}
