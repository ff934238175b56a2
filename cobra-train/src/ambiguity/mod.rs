//! Poses that score as well as the true one although they are far from it.
//!
//! Owns the search for them, on the host: symmetries of a shape, near-symmetries that the check's noise
//! covers, turns and slides of any amount, and what of all that a data set states. The check itself is
//! [`cobra_infer::depth`]'s, errors of poses are [`crate::pose`]'s.
//!
//! 1. **Views.** The object alone, rendered at true poses all around it; what the true pose's confidence is.
//! 2. **Paths.** Turns about an axis and slides along a direction, from the true pose on, as long as they are
//!    accepted.
//! 3. **Candidates.** In each view rotations about the object's middle, spread over all that there are; each
//!    follows the pose that the check suggests until it rests. It is accepted if its confidence is one with
//!    which the true pose would be, and wrong if its ADD is at least a tenth of the diameter.
//! 4. **Motions.** What no path explains is gathered into motions of the object in its own frame, and each
//!    is tried in all views: in all of them it is a symmetry of the shape, in some what decides is hidden.
//!
//! Texture is invisible to all of it. `docs/AMBIGUITY.md` has the constants and where they come from.

mod cluster;
mod document;
mod gauge;
mod measure;
mod rotations;
mod settle;
mod slide;
mod stated;
#[cfg(test)]
mod tests;
mod views;
mod words;

pub use document::{AmbiguityDocument, AmbiguityEntry, MotionDocument, SCHEMA, StatedSymmetries};
pub use gauge::Screw;
pub use slide::{Path, Range};

use crate::bop::symmetry::Symmetries;
use crate::depth::SampledSurface;
use crate::progress::Progress;
use crate::random::{Purpose, stream};
use crate::surface::Mesh;
use cluster::{Accepted, Freedom, clusters};
use cobra_infer::depth::{DepthError, DepthSettings, Surface};
use gauge::Gauge;
use measure::Measure;
use nalgebra::{Isometry3, Quaternion, UnitQuaternion};
use rayon::prelude::*;
use settle::settle;
use slide::{Family, families};
use views::{Judge, Look, Room};

/// Candidates a view unless the caller says otherwise: 23° apart, which refinement bridges.
pub const CANDIDATES: usize = 1_152;

/// Which pixels show the object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Masks {
    /// All in which it is seen.
    Visible,
    /// Those in which the candidate itself says that it is seen: less is known, more is ambiguous.
    Silhouette,
}

/// How ambiguities are looked for.
#[derive(Clone, Debug)]
pub struct SearchOptions {
    /// How many views of the object.
    pub views: usize,
    /// How many rotations are tried in each.
    pub candidates: usize,
    /// Which pixels.
    pub masks: Masks,
    /// Standard deviation of the depth's noise, in the mesh's unit; 0 for none.
    pub noise: f64,
    /// A candidate is accepted from this share of the true pose's confidence on, if the settings have no
    /// threshold.
    pub share: f32,
    /// Of the check; its noise is the surface's. With thresholds, what they accept is accepted.
    pub settings: DepthSettings,
    /// Same seed, same result.
    pub seed: u64,
}

impl SearchOptions {
    /// Twelve views, rotations 23° apart, all pixels that show the object, depth without noise, eight
    /// tenths of the true pose's confidence.
    #[must_use]
    pub fn new(settings: DepthSettings) -> Self {
        Self {
            views: 12,
            candidates: CANDIDATES,
            masks: Masks::Visible,
            noise: 0.0,
            share: 0.8,
            settings,
            seed: 0,
        }
    }

    /// How far apart neighbouring candidates are, in radians.
    #[must_use]
    pub fn spacing(&self) -> f64 {
        rotations::spacing(self.candidates)
    }
}

/// Why ambiguities could not be looked for.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AmbiguityError {
    /// The check could not be made.
    #[error("{0}")]
    Check(DepthError),
    /// The true pose itself scores badly.
    #[error(
        "the true pose has a mean confidence of {confidence:.3}, expected at least \
         {LEAST_TRUTH}: the mesh is of another object than the surface, or in another unit"
    )]
    Truth {
        /// The mean over the views.
        confidence: f64,
    },
    /// No view was asked for.
    #[error("expected at least one view, found 0")]
    NoView,
}

impl From<DepthError> for AmbiguityError {
    fn from(error: DepthError) -> Self {
        Self::Check(error)
    }
}

/// Below this mean confidence of the true poses nothing can be said.
const LEAST_TRUTH: f64 = 0.5;

/// What was found; lengths are in the mesh's unit.
#[derive(Clone, Debug)]
pub struct Ambiguities {
    /// How many views were looked at.
    pub views: usize,
    /// How many rotations were tried in each.
    pub candidates: usize,
    /// The object's diameter.
    pub diameter: f64,
    /// An ADD from which on a pose is wrong.
    pub limit: f64,
    /// The mean confidence of the true poses.
    pub truth: f64,
    /// The least confidence that was accepted in some view.
    pub least: f64,
    /// Paths first, then motions; those in most views first.
    pub found: Vec<Ambiguity>,
    /// Of the discrete symmetries and then the axes that were stated: whether each was found. Empty where nothing
    /// was stated.
    pub stated_found: Vec<bool>,
}

/// Wrong poses that score as well as the true one.
#[derive(Clone, Debug)]
pub struct Ambiguity {
    /// Which they are.
    pub what: What,
    /// In how many views.
    pub views: usize,
    /// Their mean confidence.
    pub confidence: f64,
    /// The largest ADD.
    pub add: f64,
    /// The largest ADD-S.
    pub add_s: f64,
    /// The largest MSSD, as if the object had no symmetries.
    pub mssd: f64,
    /// The largest MSSD with the stated symmetries, where there are some.
    pub mssd_stated: Option<f64>,
    /// Whether a stated symmetry is as near to each of them as a right pose is to the truth; `None` where
    /// nothing is known of what is stated.
    pub stated: Option<bool>,
}

/// The poses of an ambiguity, as motions of the object in its own frame before the true pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum What {
    /// Any amount of a motion.
    Path {
        /// The motion.
        path: Path,
        /// The amounts.
        range: Range,
    },
    /// One motion.
    Motion {
        /// The motion.
        motion: Isometry3<f64>,
        /// The same as a turn about a line.
        screw: Screw,
    },
}

/// Looks for ambiguities of a mesh that poses are judged by with a surface, a template's or the mesh's own;
/// with what a data set states of its symmetries, in the mesh's unit, if anything is known of that.
///
/// # Errors
/// [`AmbiguityError`]: settings out of range, no view, or a surface that is not the mesh's.
pub fn find_ambiguities<S: Surface + Sync>(
    mesh: &Mesh,
    surface: S,
    symmetries: Option<&Symmetries>,
    options: &SearchOptions,
    progress: &dyn Progress,
) -> Result<Ambiguities, AmbiguityError> {
    if options.views == 0 {
        return Err(AmbiguityError::NoView);
    }
    let surface = SampledSurface::new(surface);
    let gauge = Gauge::new(mesh);
    let judge = Judge::new(mesh, &surface, options)?;
    let truth = judge
        .views
        .iter()
        .map(|v| f64::from(v.confidence))
        .sum::<f64>();
    let truth = truth / judge.views.len() as f64;
    if truth < LEAST_TRUTH {
        return Err(AmbiguityError::Truth { confidence: truth });
    }
    let families = families(&judge, &gauge)?;
    let accepted = search(&judge, &gauge, &families, options, progress)?;
    let freedom = Freedom::new(&gauge, &families);
    let clusters = clusters(&judge, &freedom, accepted)?;
    let measure = Measure::new(mesh, &gauge, symmetries);
    let mut found: Vec<Ambiguity> = families.iter().map(|f| measure.family(f)).collect();
    found.sort_by_key(|ambiguity| std::cmp::Reverse(ambiguity.views));
    found.extend(clusters.iter().map(|cluster| measure.cluster(cluster)));
    // The search measures on fewer points.
    found.retain(|ambiguity| ambiguity.add >= gauge.limit());
    let least = judge
        .views
        .iter()
        .map(|v| v.least)
        .fold(f32::INFINITY, f32::min);
    Ok(Ambiguities {
        views: judge.views.len(),
        candidates: options.candidates,
        diameter: gauge.diameter,
        limit: gauge.limit(),
        truth,
        least: f64::from(least),
        found,
        stated_found: measure.stated_found(&families, &clusters),
    })
}

/// Tries all rotations in all views; what comes to rest at wrong poses that no path explains.
fn search<S: Surface + Sync>(
    judge: &Judge<'_, S>,
    gauge: &Gauge,
    families: &[Family],
    options: &SearchOptions,
    progress: &dyn Progress,
) -> Result<Vec<Accepted>, AmbiguityError> {
    let mut rng = stream(options.seed, Purpose::Ambiguity, 1);
    let mut draw = || crate::random::normal(&mut rng);
    // So that no rotation of the grid is the object's own by construction.
    let turned = Quaternion::new(draw(), draw(), draw(), draw());
    let turned = UnitQuaternion::from_quaternion(turned);
    let starts: Vec<Isometry3<f64>> = rotations::super_fibonacci(options.candidates)
        .into_iter()
        .map(|rotation| gauge.turn(rotation * turned))
        .collect();
    progress.start("trying poses", judge.views.len() as u64);
    let mut accepted = Vec::new();
    for (index, view) in judge.views.iter().enumerate() {
        let settled: Vec<Option<Accepted>> = starts
            .par_iter()
            .map_init(
                || judge.room(),
                |room: &mut Room, start| {
                    let settled = settle(judge, gauge, Look::Rough, view, start, room)?;
                    let wrong = settled.filter(|settled| {
                        let explained = |f: &Family| f.explains(gauge, index, &settled.motion);
                        gauge.is_wrong(&settled.motion) && !families.iter().any(explained)
                    });
                    Ok(wrong.map(|settled| Accepted {
                        view: index,
                        settled,
                    }))
                },
            )
            .collect::<Result<_, AmbiguityError>>()?;
        accepted.extend(settled.into_iter().flatten());
        progress.step();
    }
    progress.finish();
    Ok(accepted)
}
