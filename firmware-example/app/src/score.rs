//! The example: a template in flash, a stream of correspondences, a watchdog, a report.

use crate::footprint::{COMPONENTS, Refusal, load_and_score, settings};
use crate::{Board, Failed};
use cobra_agreement::vectors::Points;
use cobra_infer::{Correspondence, Report, Scorer, Template};
use core::fmt::{self, Write};

/// Linked into flash and read there: nothing of it is copied to RAM.
pub static TEMPLATE: &[u8] = cobra_agreement::SETS[0].template;

/// What a camera and an estimator would deliver.
pub static STREAM: &[u8] = cobra_agreement::SETS[0].points;

/// Which poses of the stream are judged, and what they are called.
pub const POSES: [(usize, &str); 2] = [(0, "right pose"), (1, "wrong pose")];

/// Scores the right pose and a wrong one, then shows what is refused.
///
/// # Errors
/// [`Failed`] when a pose cannot be scored, when something is accepted that should not be, or when
/// `out` fails.
pub fn run(board: &mut impl Board, out: &mut impl Write) -> Result<(), Failed> {
    writeln!(out, "COBRA on {}", board.name())?;
    let template = match Template::from_bytes(TEMPLATE) {
        Ok(template) => template,
        Err(error) => {
            writeln!(out, "the template is refused: {error}")?;
            return Err(Failed);
        }
    };
    writeln!(
        out,
        "template `{}` in {} bytes of flash: {} components, at most {} kernel evaluations a point",
        template.name(),
        TEMPLATE.len(),
        template.component_count(),
        template.cost().nearest
    )?;
    let Some((points, camera)) = Points::read(STREAM).and_then(|p| Some((p, p.camera()?))) else {
        writeln!(out, "the stream does not read")?;
        return Err(Failed);
    };
    for (index, title) in POSES {
        let Some(pose) = points.pose(index, false) else {
            writeln!(out, "the {title} does not read")?;
            return Err(Failed);
        };
        let stream = points.correspondences().filter(is_sound);
        let report = load_and_score(TEMPLATE, &camera, &pose, stream, || board.feed_watchdog());
        match report {
            Ok(report) => print(&report, title, out)?,
            Err(refusal) => {
                match refusal {
                    Refusal::Template(error) => writeln!(out, "{title}: {error}")?,
                    Refusal::Score(error) => writeln!(out, "{title}: {error}")?,
                    Refusal::Depth(error) => writeln!(out, "{title}: {error}")?,
                }
                return Err(Failed);
            }
        }
    }
    refusals(out)
}

/// What an estimator should not deliver, but the vectors hold, would make every pose undecided.
#[must_use]
pub fn is_sound(correspondence: &Correspondence) -> bool {
    correspondence.is_finite() && correspondence.weight >= 0.0
}

/// One line on a pose, with the bits of what was computed: programs are compared by it.
///
/// # Errors
/// Those of `out`.
pub fn print(report: &Report, title: &str, out: &mut impl Write) -> fmt::Result {
    writeln!(
        out,
        "{title}: {} points, confidence {:.3} ({:08x}), threshold {:.3} ({:08x}): {}, {}",
        report.points,
        report.confidence,
        report.confidence.to_bits(),
        report.threshold,
        report.threshold.to_bits(),
        report.decision.name(),
        report.decision.reason()
    )
}

/// Every board must refuse the same input for the same reason as the host.
fn refusals(out: &mut impl Write) -> Result<(), Failed> {
    let mut corrupted = [0; cobra_agreement::SETS[2].template.len()];
    for (index, (byte, sound)) in corrupted
        .iter_mut()
        .zip(cobra_agreement::SETS[2].template)
        .enumerate()
    {
        *byte = if index == 300 { sound ^ 0x10 } else { *sound };
    }
    let short = TEMPLATE
        .split_at_checked(1000)
        .map_or(TEMPLATE, |(head, _)| head);
    for (title, bytes) in [
        ("corrupted template", &corrupted[..]),
        ("cut template", short),
    ] {
        match Template::from_bytes(bytes) {
            Ok(_) => {
                writeln!(out, "{title}: NOT REFUSED")?;
                return Err(Failed);
            }
            Err(error) => writeln!(out, "{title} refused: {error}")?,
        }
    }
    let points = Points::read(STREAM);
    let (Ok(template), Some(camera), Some(pose)) = (
        Template::from_bytes(TEMPLATE),
        points.and_then(|points| points.camera()),
        points.and_then(|points| points.pose(0, false)),
    ) else {
        writeln!(out, "the template or the stream does not read")?;
        return Err(Failed);
    };
    match Scorer::<2>::new(&template, &camera, &pose, &settings(&template)) {
        Ok(_) => {
            writeln!(out, "template too large for the scorer: NOT REFUSED")?;
            return Err(Failed);
        }
        Err(error) => writeln!(out, "template too large for the scorer refused: {error}")?,
    }
    writeln!(out, "room for components: {COMPONENTS}")?;
    Ok(())
}
