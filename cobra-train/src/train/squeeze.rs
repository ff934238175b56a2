//! A template in a budget of bytes.
//!
//! Owns how many terms, and if need be how many components, fit; which terms is
//! [`crate::gp::compress`]'s question.

use super::assemble::{Frame, ScaledComponent};
use super::verify::validities;
use super::{Part, ReferencePoints, TrainError};
use crate::gp::{Uncompressed, compress};
use crate::surface::SurfacePoint;
use crate::validity::{COARSE_CELLS, FINE_CELLS};
use cobra_infer::Metric;
use cobra_infer::template::DEPTH_CAPACITY;
use nalgebra::UnitVector3;

/// Bytes of a term, and of a component's run of them besides.
const TERM: usize = 5;
const RUN: usize = 4;

/// With fewer terms a component on average, cells are coarser; if that is not enough, components go
/// before more terms do. Of 8,704 bytes, F on the screwdriver is 98.2 with 64, 96.2 with 48 and 90.9
/// with 14.
const FEWEST_TERMS: usize = 64;

/// A chart has no more terms, even where there are too many charts for the large ones to be split: terms are
/// most of what a point costs, and the largest chart is asked most often.
const MOST_TERMS: usize = 256;

/// A compressed template has no more components: as many as a controller makes room for unless it is
/// told otherwise.
const MOST_COMPONENTS: usize = 32;

/// Bytes of a component besides its terms, of which validity takes most.
const COMPONENT: usize = 110;

/// As many charts as `budget` bytes have room for: what is to be left out is better never chosen, since
/// those that stay then make up for it.
pub(super) fn most_charts(budget: usize) -> usize {
    MOST_COMPONENTS
        .min(budget / (FEWEST_TERMS * TERM + COMPONENT))
        .max(1)
}

/// Bytes for what grows by a byte or two as lengths do.
const SLACK: usize = 16;

/// Bytes of an exact term.
const EXACT_TERM: usize = 16;

/// Compresses the exact `parts` into `budget` bytes, those included that are written when it is measured.
/// Where they have validity, it is verified anew. Of charts those of fewest points are left out where
/// too few terms remain for each; parts that may no longer speak anywhere are left out always.
pub(super) fn squeeze(
    frame: &Frame<'_>,
    mut parts: Vec<Part>,
    training: &[SurfacePoint],
    verified: bool,
    budget: usize,
) -> Result<Vec<Part>, TrainError> {
    let model = frame.options.fit.model;
    if model.metric != Metric::Chord {
        return Err(TrainError::BudgetNeedsChord);
    }
    // How many components there are is the data's to say only where nobody else has.
    let may_go = matches!(frame.options.reference_points, ReferencePoints::Auto { .. });
    let most = if may_go { MOST_TERMS } else { usize::MAX };
    let mut cell_width = FINE_CELLS;
    let mut terms = loop {
        let fixed = fixed_bytes(frame, &parts)?;
        let room = budget.saturating_sub(fixed) / TERM;
        let few_enough = !may_go || parts.len() <= MOST_COMPONENTS;
        if few_enough && room >= FEWEST_TERMS * parts.len() {
            break room;
        }
        if few_enough && verified && cell_width < COARSE_CELLS {
            cell_width = COARSE_CELLS;
            parts = verify_parts(frame, parts, training, cell_width)?;
            continue;
        }
        let least = parts
            .iter()
            .enumerate()
            .min_by_key(|(_, part)| part.patch.own.len());
        match least {
            Some((least, _)) if may_go && parts.len() > 1 => {
                parts.remove(least);
            }
            _ if room >= parts.len() => break room,
            _ => {
                let least = fixed + TERM * parts.len();
                return Err(TrainError::Budget { budget, least });
            }
        }
    };
    loop {
        let sources: Vec<Uncompressed> = parts
            .iter()
            .map(|part| uncompressed(part, training, model.kernel))
            .collect();
        let compressed = compress(&sources, terms, most).map_err(TrainError::Compress)?;
        let mut compact: Vec<Part> = parts
            .iter()
            .zip(&compressed)
            .map(|(part, compressed)| Part {
                scaled: part.scaled.compact(model.kernel, compressed, frame.sphere),
                ..part.clone()
            })
            .collect();
        if verified {
            compact = verify_parts(frame, compact, training, cell_width)?;
        }
        let scaled: Vec<ScaledComponent> = compact.iter().map(|p| p.scaled.clone()).collect();
        let length = frame.provisional(&scaled)?.len() + measured_bytes(compact.len());
        if length <= budget {
            return Ok(compact);
        }
        terms = terms.saturating_sub((length - budget).div_ceil(TERM));
        if terms < parts.len() {
            return Err(TrainError::Budget {
                budget,
                least: length,
            });
        }
    }
}

/// The parts with the validity of what they now say, without those that may speak nowhere.
pub(super) fn verify_parts(
    frame: &Frame<'_>,
    parts: Vec<Part>,
    training: &[SurfacePoint],
    cell_width: f64,
) -> Result<Vec<Part>, TrainError> {
    let scaled: Vec<ScaledComponent> = parts.iter().map(|part| part.scaled.clone()).collect();
    let patches: Vec<_> = parts.iter().map(|part| part.patch.clone()).collect();
    let found = validities(frame, &scaled, &patches, training, cell_width)?;
    let verified: Vec<Part> = parts
        .into_iter()
        .zip(found)
        .filter_map(|(part, validity)| {
            Some(Part {
                scaled: part.scaled.with_validity(validity?),
                ..part
            })
        })
        .collect();
    if verified.is_empty() {
        return Err(TrainError::NothingVerified);
    }
    Ok(verified)
}

/// What the template takes without terms.
fn fixed_bytes(frame: &Frame<'_>, parts: &[Part]) -> Result<usize, TrainError> {
    let scaled: Vec<ScaledComponent> = parts.iter().map(|part| part.scaled.clone()).collect();
    let exact: usize = scaled.iter().map(ScaledComponent::term_count).sum();
    let whole = frame.provisional(&scaled)?.len();
    Ok(whole - EXACT_TERM * exact + RUN * parts.len() + measured_bytes(parts.len()) + SLACK)
}

/// Of what is written once the rest is measured: the quality section, its header, three numbers and two
/// bytes a component, and as much as calibration may add later.
pub(super) fn measured_bytes(components: usize) -> usize {
    8 + 3 * 4 + 3 + 2 * components + DEPTH_CAPACITY
}

/// All the points that a component is fitted to, also those that the exact process leaves out.
fn uncompressed(
    part: &Part,
    training: &[SurfacePoint],
    kernel: cobra_infer::Kernel,
) -> Uncompressed {
    let centre = part.patch.cluster.centre();
    let prior_mean = part.fitted.prior_mean;
    let (directions, targets) = part
        .patch
        .training
        .iter()
        .filter_map(|&index| UnitVector3::try_new_and_get(training[index].position - centre, 1e-4))
        .map(|(direction, distance)| (direction, distance - prior_mean))
        .unzip();
    Uncompressed {
        kernel,
        hyperparameters: part.fitted.learned.hyperparameters,
        directions,
        targets,
        prior_mean,
    }
}
