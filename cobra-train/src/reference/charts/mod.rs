//! Reference points that place themselves: charts.
//!
//! A chart is a centre, inside or outside of the object, and the connected piece of surface that it
//! sees well. Owns the rounds. In the first ones, charts are chosen to cover the surface, each sample
//! goes to one of them, each chart is fitted to its samples and verified; samples that a chart cannot
//! explain are banned from it, go to another, and ask for more charts. Later ones leave charts as they
//! are and add some for what none explains, which distributing anew would only exchange for something
//! else. Whatever was judged in any round may be chosen in the end, and what is chosen is what explains
//! most: how many charts there are is the data's to say.
//!
//! Needs points and normals alone, and of normals that neighbours agree which side is which: a mesh
//! need be neither closed nor consistently oriented. Everything is in the unit sphere.

mod candidate;
mod choice;
mod cover;
mod ownership;
mod process;
mod region;
mod split;

use crate::gp::{FitError, Hyperparameters};
use crate::surface::SurfacePoint;
use crate::validity::sparsity;
use candidate::{Candidate, Fitted};
use choice::{choice, disjoint, needy};
use cover::Search;
use nalgebra::Point3;
use ownership::{Sighted, owners};
use rayon::prelude::*;
use region::{Samples, Sight, region};
pub use split::split;

/// Rounds in which charts are added for what is left and the whole surface is distributed anew.
const SETTLING: u64 = 3;

/// Rounds after which nothing is added for what is left, the first ones included.
const ROUNDS: u64 = 12;

/// When this share of the samples is left, it is left.
const LEFT: f64 = 0.006;

/// So many rounds that are no better, and no more are made.
const PATIENCE: u64 = 3;

/// A round that leaves less than this much less is no better.
const WORTHWHILE: f64 = 0.001;

/// How far charts reach from their centres. With some that reach farther, fewer points are covered and
/// more wrongly accepted, likely since a grid of directions has at most 64 cells a side.
const REACH: f64 = 0.42;

/// How far a chart is fitted beyond its own samples.
const RING: f64 = 0.04;

/// A centre and the samples around it.
#[derive(Clone, Debug)]
pub struct Chart {
    /// The reference point.
    pub centre: Point3<f64>,
    /// The samples that belong to it, by rising index.
    pub own: Vec<usize>,
    /// The samples that it is to be fitted to: its own and a ring around them, without those that
    /// it does not explain.
    pub training: Vec<usize>,
    /// Hyperparameters of the rational quadratic with α = ½ under which it explains its samples.
    pub hyperparameters: Hyperparameters,
}

/// Charts for the surface that `points` lie on, at most `most`; none where no piece of it can be
/// seen.
///
/// The same points, limit and seed give the same charts, whatever the number of threads.
///
/// # Errors
/// [`FitError`].
pub fn charts(points: &[SurfacePoint], most: usize, seed: u64) -> Result<Vec<Chart>, FitError> {
    let samples = Samples::new(points.to_vec(), sparsity(points.len()));
    let mut judged = settled(&samples, most, seed)?;
    let mut chosen = choice(&judged, points.len(), most);
    let mut left = points.len();
    let mut improved = SETTLING;
    for round in SETTLING..ROUNDS {
        let needy = needy(&judged, &chosen, points.len());
        let now = needy.iter().filter(|needy| **needy).count();
        if (now as f64) < LEFT * points.len() as f64 {
            break;
        }
        if (now as f64) < left as f64 - WORTHWHILE * points.len() as f64 {
            left = now;
            improved = round;
        } else if round >= improved + PATIENCE {
            break;
        }
        let added = new_candidates(&samples, &needy, most, round, seed);
        judged.extend(of_needy(&samples, &needy, added, seed)?);
        chosen = choice(&judged, points.len(), most);
    }
    Ok(disjoint(&judged, &chosen, &samples))
}

/// What charts come to in rounds in which the whole surface is distributed among them anew.
fn settled(samples: &Samples, most: usize, seed: u64) -> Result<Vec<Fitted>, FitError> {
    let count = samples.points.len();
    let mut candidates: Vec<Candidate> = Vec::new();
    let mut needy = vec![true; count];
    let mut judged = Vec::new();
    for round in 0..SETTLING {
        let room = most.saturating_sub(candidates.len());
        candidates.extend(new_candidates(samples, &needy, room, round, seed));
        let sighted: Vec<Sighted<'_>> = candidates.iter().map(Candidate::sighted).collect();
        let owner = owners(&sighted, count);
        candidates
            .par_iter_mut()
            .enumerate()
            .try_for_each(|(index, candidate)| candidate.judge(samples, &owner, index, seed))?;
        needy.fill(true);
        for (index, candidate) in candidates.iter_mut().enumerate() {
            candidate.take(index, &owner, &mut needy);
        }
        judged.extend(
            candidates
                .iter()
                .filter_map(|candidate| candidate.fitted.clone()),
        );
        // What came to nothing takes no place of those that may yet be found.
        candidates.retain(|candidate| candidate.fitted.is_some());
    }
    Ok(judged)
}

/// What `candidates` come to if they own needy samples alone; their rings take in others.
fn of_needy(
    samples: &Samples,
    needy: &[bool],
    mut candidates: Vec<Candidate>,
    seed: u64,
) -> Result<Vec<Fitted>, FitError> {
    let sighted: Vec<Sighted<'_>> = candidates.iter().map(Candidate::sighted).collect();
    let mut owner = owners(&sighted, needy.len());
    for (owner, needy) in owner.iter_mut().zip(needy) {
        *owner = owner.filter(|_| *needy);
    }
    candidates
        .par_iter_mut()
        .enumerate()
        .try_for_each(|(index, candidate)| candidate.judge(samples, &owner, index, seed))?;
    Ok(candidates
        .into_iter()
        .filter_map(|candidate| candidate.fitted)
        .collect())
}

fn new_candidates(
    samples: &Samples,
    needy: &[bool],
    most: usize,
    round: u64,
    seed: u64,
) -> Vec<Candidate> {
    let first = round == 0;
    let sight = Sight {
        incidence: 0.3,
        nearest: 0.05,
        reach: REACH,
        fewest: 3,
    };
    let search = Search {
        sight,
        samples: 1200,
        needy: if first { 0 } else { 600 },
        bases: if first { 90 } else { 40 },
        rest: 0.01,
        least_gain: if first { 0.0015 } else { 0.015 },
        most,
        seed,
        round,
    };
    let priority: Vec<f64> = needy
        .iter()
        .map(|needy| match (first, needy) {
            (true, _) => 1.0,
            (false, true) => 1.05,
            (false, false) => 0.05,
        })
        .collect();
    // More of the surface than the search asked for: reassignment may want it.
    let sight = Sight {
        incidence: 0.85 * sight.incidence,
        nearest: 0.8 * sight.nearest,
        reach: REACH,
        fewest: 5,
    };
    search
        .centres(&samples.points, needy)
        .into_par_iter()
        .filter_map(|centre| Candidate::new(centre, region(samples, &centre, &sight, &priority)))
        .collect()
}

#[cfg(test)]
mod tests;
