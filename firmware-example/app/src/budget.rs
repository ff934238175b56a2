//! Stack and instructions of load and score.
//!
//! Prints what was counted, one line a template; dividing it up is the host's work.

use crate::Board;
use crate::footprint::{COMPONENTS, load_and_score};
use crate::stack;
use cobra_agreement::vectors::Points;
use cobra_infer::{Correspondence, Scorer, Settings, Template};
use core::fmt::{self, Write};
use core::hint::black_box;

macro_rules! measured {
    ($($name:literal),*) => {
        [$((
            $name,
            include_bytes!(concat!("../../../tests/golden/budget/", $name, ".cobra")).as_slice(),
        )),*]
    };
}

/// Templates that differ in one thing each, so that differences of what they cost are the cost of
/// that thing: by exponent, components and terms a component.
static TEMPLATES: [(&str, &[u8]); 7] = measured![
    "one-1x32",
    "one-1x192",
    "one-9x32",
    "one-9x32-precisions",
    "half-1x32",
    "half-1x192",
    "half-9x32"
];

/// Templates of an object, without and with precisions. By themselves: with their vectors they would
/// not fit into 256 KB.
static REAL: [(&str, &[u8]); 2] = [
    ("k-means", cobra_agreement::SETS[0].template),
    ("em", cobra_agreement::SETS[1].template),
];

/// Which of the vectors' correspondences are scored: the first that an estimator could deliver.
const POINTS: usize = 64;

/// Measures and prints.
///
/// # Errors
/// Those of `out`.
pub fn run(board: &mut impl Board, out: &mut impl Write) -> fmt::Result {
    let Some(points) = Points::read(black_box(cobra_agreement::SETS[0].points)) else {
        return writeln!(out, "the stream does not read");
    };
    let (Some(camera), Some(pose)) = (points.camera(), points.pose(0, false)) else {
        return writeln!(out, "camera or pose does not read");
    };
    let stream = || points.correspondences().filter(is_ordinary).take(POINTS);
    for (name, bytes) in TEMPLATES {
        let Ok(template) = Template::from_bytes(black_box(bytes)) else {
            return writeln!(out, "{name} does not load");
        };
        let settings = Settings::for_template(&template, 2.0);
        let mut buffer = [Correspondence::new([0.0; 2].into(), [0.0; 3].into()); POINTS];
        for (place, correspondence) in buffer.iter_mut().zip(stream()) {
            *place = correspondence;
        }
        let Ok(mut scorer) = Scorer::<COMPONENTS>::new(&template, &camera, &pose, &settings) else {
            return writeln!(out, "{name} does not fit");
        };
        board.feed_watchdog();
        let start = board.instructions();
        push_all(&mut scorer, &buffer);
        let pushed = board.instructions().wrapping_sub(start);
        writeln!(
            out,
            "cost {name} points={POINTS} components={} evaluations={} instructions={pushed} \
             inliers={:.2}",
            template.component_count(),
            template.cost().nearest,
            scorer.finish().inlier_share
        )?;
    }
    for (name, template) in REAL {
        let mut sound = false;
        let depth = stack::depth_of(|| {
            let report = load_and_score(template, &camera, &pose, stream(), || ());
            sound = report.is_ok();
        });
        writeln!(out, "stack {name} bytes={depth} scored={sound}")?;
    }
    Ok(())
}

/// By itself, as in a firmware that keeps its scorer: not mixed up with how it was prepared.
#[inline(never)]
fn push_all(scorer: &mut Scorer<'_, COMPONENTS>, correspondences: &[Correspondence]) {
    for correspondence in correspondences {
        scorer.push(correspondence);
    }
}

/// In front of the camera and near the object, so that a point goes all the way.
fn is_ordinary(correspondence: &Correspondence) -> bool {
    let limit = 100.0;
    correspondence.is_finite()
        && correspondence.weight > 1e-3
        && correspondence
            .point
            .iter()
            .all(|c| (-limit..limit).contains(c))
        && correspondence
            .pixel
            .iter()
            .all(|c| (1.0..2000.0).contains(c))
}
