//! Stack and instructions of load and score.
//!
//! Prints what was counted, one line a template; dividing it up is the host's work.

use crate::footprint::{Refusal, load_and_score};
use crate::footprint_depth::{CELLS, load_and_check};
use crate::stack;
use crate::{Board, Failed};
use cobra_agreement::depth::{self, Depth, Scene};
use cobra_agreement::vectors::Points;
use cobra_infer::depth::{Cell, DepthReport, DepthWords, Observed};
use cobra_infer::{Camera, Pose, Report};
use core::fmt::Write;
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

/// Templates with a scene to check them against.
static SCENES: [(&str, &[u8], Depth); 2] = [scene(3), scene(4)];

const fn scene(index: usize) -> (&'static str, &'static [u8], Depth) {
    let set = &cobra_agreement::SETS[index];
    match set.depth {
        Some(depth) => (set.name, set.template, depth),
        None => panic!("a set without a scene"),
    }
}

/// Points near the sphere that these templates are of.
static POINTS: &[u8] = include_bytes!("../../../tests/golden/budget/sphere.points");

/// Measures and prints.
///
/// # Errors
/// [`Failed`] when something cannot be scored, or when `out` fails.
pub fn run(board: &mut impl Board, out: &mut impl Write) -> Result<(), Failed> {
    let Some(points) = Points::read(black_box(POINTS)) else {
        writeln!(out, "the points do not read")?;
        return Err(Failed);
    };
    let (Some(camera), Some(pose)) = (points.camera(), points.pose(0, false)) else {
        writeln!(out, "camera or pose does not read")?;
        return Err(Failed);
    };
    for (name, template) in TEMPLATES {
        board.feed_watchdog();
        let mut counted = |count: usize| {
            let start = board.instructions();
            let report = score(
                black_box(template),
                &camera,
                &pose,
                &points,
                black_box(count),
            );
            let instructions = board.instructions().wrapping_sub(start);
            report.map(|report| (report, instructions))
        };
        let all = points.correspondences().len();
        let (Ok((_, without)), Ok((report, with))) = (counted(0), counted(all)) else {
            writeln!(out, "{name} cannot be scored")?;
            return Err(Failed);
        };
        writeln!(
            out,
            "cost {name} points={} instructions={} inliers={:.2}",
            report.points,
            with.wrapping_sub(without),
            report.inlier_share
        )?;
    }
    for (name, template) in REAL {
        let mut sound = false;
        let depth = stack::depth_of(|| {
            let report = score(template, &camera, &pose, &points, usize::MAX);
            sound = report.is_ok();
        });
        writeln!(out, "stack {name} bytes={depth} scored={sound}")?;
    }
    stack_of_checks(out)
}

/// Of a check against depth, by terms and by maps, in which all of it happens: something is judged, and the
/// pose is refined.
fn stack_of_checks(out: &mut impl Write) -> Result<(), Failed> {
    let mut room = [depth::NO_PIXEL; depth::PIXELS];
    let mut cells = [Cell::EMPTY; CELLS];
    for (name, template, known) in SCENES {
        let scene = Scene::read(known.scene);
        let read = scene.and_then(|scene| {
            let image = scene.image(known.image)?;
            Some((scene, image, scene.camera()?, scene.poses().nth(1)?))
        });
        let Some((scene, image, camera, pose)) = read else {
            writeln!(out, "the scene of {name} does not read")?;
            return Err(Failed);
        };
        let observed = Observed::Pixels(scene.observed(&image, &mut room));
        let mut sound = false;
        let depth = stack::depth_of(|| {
            let report = check(template, &camera, &pose, observed, &image, &mut cells);
            sound = report.is_ok_and(|report| report.judged > 0 && report.displacement > 0.0);
        });
        writeln!(out, "depth-stack {name} bytes={depth} scored={sound}")?;
    }
    Ok(())
}

/// What is measured, in one place, as it is in one place in a firmware.
#[inline(never)]
fn check(
    template: &[u8],
    camera: &Camera,
    pose: &Pose,
    observed: Observed<'_>,
    image: &DepthWords<'_>,
    cells: &mut [Cell],
) -> Result<DepthReport, Refusal> {
    load_and_check(template, camera, pose, observed, image, cells, || ())
}

/// What is measured, in one place, as it is in one place in a firmware: the first `count` points.
#[inline(never)]
fn score(
    template: &[u8],
    camera: &Camera,
    pose: &Pose,
    points: &Points<'_>,
    count: usize,
) -> Result<Report, Refusal> {
    let stream = points.correspondences().take(count);
    load_and_score(template, camera, pose, stream, || ())
}
