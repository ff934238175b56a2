//! From a candidate to the local optimum that the check itself suggests.

use super::AmbiguityError;
use super::gauge::{Gauge, double};
use super::views::{Judge, Room, View};
use cobra_infer::depth::Surface;
use nalgebra::Isometry3;

/// How often a suggestion is followed, of four Gauss-Newton steps each.
const ROUNDS: usize = 6;

/// After so many rounds a candidate that reaches less than [`HOPELESS`] of what it must is given up: of those
/// on LineMOD-Occlusion that are accepted in the end one in a thousand would be.
const PATIENCE: usize = 2;
const HOPELESS: f32 = 0.25;

/// A candidate stays where it is when its suggestion moves it by less than this share of the diameter.
const STILL: f64 = 0.002;

/// Where a candidate came to rest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Settled {
    pub(super) motion: Isometry3<f64>,
    pub(super) confidence: f32,
}

/// Follows a motion's suggestions; `None` where the pose in the end does not score as well as the true one.
pub(super) fn settle<S: Surface + Sync>(
    judge: &Judge<'_, S>,
    gauge: &Gauge,
    view: &View,
    start: &Isometry3<f64>,
    room: &mut Room,
) -> Result<Option<Settled>, AmbiguityError> {
    let back = view.truth.inverse();
    let mut motion = *start;
    for round in 0..=ROUNDS {
        let Some(report) = judge.report(view, &motion, room)? else {
            return Ok(None);
        };
        let still = f64::from(report.displacement) < STILL * gauge.diameter;
        if round == ROUNDS || still {
            let confidence = report.confidence;
            return Ok((confidence >= view.least).then_some(Settled { motion, confidence }));
        }
        if round >= PATIENCE && report.confidence < HOPELESS * view.least {
            return Ok(None);
        }
        let Some(refined) = double(&report.refined) else {
            return Ok(None);
        };
        motion = back * refined;
    }
    Ok(None)
}
