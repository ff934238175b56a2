//! Everything that is compared, as the lines that every target prints.

use crate::depth::{self, Depth};
use crate::{Set, square_root, vectors};
use core::fmt::{self, Write};

/// How many words that differ are told of a set: the first ones point to the cause, and a kernel
/// with other bits has thousands.
const TOLD: u32 = 5;

/// Compares these sets, the square roots and, with the feature `golden`, the golden templates; whether
/// no bit differs. Calls `alive` before whatever takes long, for a watchdog.
///
/// # Errors
/// Those of `out`.
pub fn write(
    out: &mut impl Write,
    sets: &[Set],
    mut alive: impl FnMut(),
) -> Result<bool, fmt::Error> {
    let mut agrees = true;
    for set in sets {
        alive();
        let mut told = 0;
        let mut telling = Ok(());
        let compared = vectors::compare_telling(set, |difference| {
            if told < TOLD {
                told += 1;
                telling = telling.and_then(|()| writeln!(out, "{}: {difference}", set.name));
            }
        });
        telling?;
        match compared {
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
        alive();
        if let Some(depth) = &set.depth {
            agrees &= depth_checks(out, set, depth)?;
        }
    }
    alive();
    let differ = square_root::differing();
    writeln!(out, "square roots that differ from libm's: {differ}")?;
    agrees &= differ == 0;
    #[cfg(feature = "golden")]
    {
        agrees &= golden(out, alive)?;
    }
    Ok(agrees)
}

fn depth_checks(out: &mut impl Write, set: &Set, depth: &Depth) -> Result<bool, fmt::Error> {
    let mut told = 0;
    let mut telling = Ok(());
    let checked = depth::compare(
        depth.expected,
        |each| depth::words(set.template, depth.scene, depth.image, each),
        |difference| {
            if told < TOLD {
                told += 1;
                telling = telling.and_then(|()| writeln!(out, "{}: {difference}", set.name));
            }
        },
    );
    telling?;
    match checked {
        Ok(checked) => {
            writeln!(
                out,
                "depth {} words={} mismatched_bits={}",
                set.name, checked.words, checked.mismatched_bits
            )?;
            Ok(checked.mismatched_bits == 0)
        }
        Err(unreadable) => {
            writeln!(out, "depth {} {unreadable:?}", set.name)?;
            Ok(false)
        }
    }
}

#[cfg(feature = "golden")]
fn golden(out: &mut impl Write, mut alive: impl FnMut()) -> Result<bool, fmt::Error> {
    use crate::golden::{GOLDEN, replay};
    let mut agrees = true;
    for golden in &GOLDEN {
        alive();
        let replayed = replay(golden.template, golden.vectors);
        if replayed == Ok(golden.cases) {
            continue;
        }
        agrees = false;
        match replayed {
            Ok(cases) => writeln!(out, "{}: {cases} cases, not {}", golden.name, golden.cases)?,
            Err(mismatch) => writeln!(out, "{}: {mismatch}", golden.name)?,
        }
    }
    writeln!(
        out,
        "golden vectors of {} templates and settings replayed",
        GOLDEN.len()
    )?;
    for golden in &GOLDEN {
        alive();
        let compared = golden.compare_gradients();
        if compared != Ok(0) {
            agrees = false;
            writeln!(out, "{}: gradients: {compared:?}", golden.name)?;
        }
    }
    Ok(agrees)
}
