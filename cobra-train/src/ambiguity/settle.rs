//! From a candidate to the local optimum that the check itself suggests.

use super::AmbiguityError;
use super::gauge::{Gauge, double};
use super::views::{Judge, Look, Room, View};
use cobra_infer::depth::Surface;
use nalgebra::Isometry3;

/// How often a suggestion is followed, of four Gauss-Newton steps each.
const ROUNDS: usize = 6;

/// After so many rounds …
const PATIENCE: usize = 2;

/// … a candidate whose confidence is below this share of what it must reach is given up.
const HOPELESS: f32 = 0.25;

/// A candidate that reaches this share of it on a rough look deserves a full one.
const PROMISING: f32 = 0.8;

/// A candidate stays where it is when its suggestion moves it by less than this share of the diameter.
const STILL: f64 = 0.002;

/// Where a candidate came to rest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Settled {
    pub(super) motion: Isometry3<f64>,
    pub(super) confidence: f32,
}

/// Follows a motion's suggestions, from a rough look on to full ones; `None` where the pose in the end does
/// not score as well as the true one.
pub(super) fn settle<S: Surface + Sync>(
    judge: &Judge<'_, S>,
    gauge: &Gauge,
    look: Look,
    view: &View,
    start: &Isometry3<f64>,
    room: &mut Room,
) -> Result<Option<Settled>, AmbiguityError> {
    let enough = |share: f32| move |settled: &Settled| settled.confidence >= share * view.least;
    let mut motion = *start;
    if look == Look::Rough {
        let rough = rest(judge, gauge, look, view, motion, room)?;
        let Some(rough) = rough.filter(enough(PROMISING)) else {
            return Ok(None);
        };
        motion = rough.motion;
    }
    let settled = rest(judge, gauge, Look::Full, view, motion, room)?;
    Ok(settled.filter(enough(1.0)))
}

/// Follows suggestions of one kind of look; `None` where that is hopeless.
fn rest<S: Surface + Sync>(
    judge: &Judge<'_, S>,
    gauge: &Gauge,
    look: Look,
    view: &View,
    start: Isometry3<f64>,
    room: &mut Room,
) -> Result<Option<Settled>, AmbiguityError> {
    let back = view.truth.inverse();
    let mut motion = start;
    for round in 0..=ROUNDS {
        let Some(report) = judge.report(look, view, &motion, room)? else {
            return Ok(None);
        };
        let confidence = report.confidence;
        let still = f64::from(report.displacement) < STILL * gauge.diameter;
        if round == ROUNDS || still {
            return Ok(Some(Settled { motion, confidence }));
        }
        if round >= PATIENCE && confidence < HOPELESS * view.least {
            return Ok(None);
        }
        let Some(refined) = double(&report.refined) else {
            return Ok(None);
        };
        motion = back * refined;
    }
    Ok(None)
}
