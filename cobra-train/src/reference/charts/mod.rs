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

mod asked;
mod candidate;
mod choice;
mod cover;
mod ownership;
mod process;
mod region;

use crate::gp::{FitError, Hyperparameters};
use crate::surface::SurfacePoint;
use crate::validity::sparsity;
use asked::{asked, demand};
use candidate::{Candidate, Fitted};
use choice::{choice, shared_out};
use cover::Search;
use nalgebra::Point3;
use ownership::{Sighted, owners};
use rayon::prelude::*;
use region::{Samples, Sight, region};

/// Rounds in which charts are added for what is left and the whole surface is distributed anew.
const SETTLING: u64 = 3;

/// Rounds after which nothing is added for what is left, the first ones included.
const ROUNDS: u64 = 14;

/// When this share of what is asked for is left, it is left.
const LEFT: f64 = 0.006;

/// So many rounds that are no better, and no more are made.
const PATIENCE: u64 = 4;

/// A round that leaves less than this much less is no better.
const WORTHWHILE: f64 = 0.0005;

/// How many charts are looked for in a round, whatever a template has room for: the best of many are
/// better than the first few.
const SOUGHT: usize = 64;

/// How far charts reach from their centres. With some that reach farther, fewer points are covered and
/// more wrongly accepted, likely since a grid of directions has at most 64 cells a side.
const REACH: f64 = 0.42;

/// How far a chart is fitted beyond its own samples.
const RING: f64 = 0.04;

/// What charts own where they meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Borders {
    /// A sample is one chart's: cells cost bytes.
    Sharp,
    /// A chart keeps what it explains around its own, since the cells of two charts need not meet.
    Overlapping,
}

/// A centre and the samples around it.
#[derive(Clone, Debug)]
pub struct Chart {
    /// The reference point.
    pub centre: Point3<f64>,
    /// The samples that it may speak of, by rising index: those that belong to it, and around them
    /// others that it explains as well.
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
/// They are fitted to `points`, and chosen by what they explain of these and of `others`: together
/// those are to be such points as the template will be asked about.
///
/// The same points, limit and seed give the same charts, whatever the number of threads.
///
/// # Errors
/// [`FitError`].
pub fn charts(
    points: &[SurfacePoint],
    others: &[SurfacePoint],
    most: usize,
    borders: Borders,
    seed: u64,
) -> Result<Vec<Chart>, FitError> {
    let mut samples = Samples::new(points.to_vec(), sparsity(points.len()));
    samples.asked = asked(points, others);
    let all = samples.asked.len();
    let sought = most.max(SOUGHT);
    let mut judged = settled(&samples, sought, seed)?;
    let mut chosen = choice(&judged, all, most);
    let mut left = all as f64;
    let mut improved = SETTLING;
    for round in SETTLING..ROUNDS {
        let explained = chosen.iter().map(|&index| &judged[index].explained[..]);
        let demand = demand(&samples.asked, points.len(), explained);
        let now: f64 = demand.iter().sum();
        if now < LEFT * all as f64 {
            break;
        }
        if now < left - WORTHWHILE * all as f64 {
            left = now;
            improved = round;
        } else if round >= improved + PATIENCE {
            break;
        }
        let added = new_candidates(&samples, &demand, sought, round, seed);
        judged.extend(of_needy(&samples, &demand, added, seed)?);
        chosen = choice(&judged, all, most);
    }
    Ok(shared_out(&judged, &chosen, borders, &samples))
}

/// What charts come to in rounds in which the whole surface is distributed among them anew.
fn settled(samples: &Samples, most: usize, seed: u64) -> Result<Vec<Fitted>, FitError> {
    let count = samples.points.len();
    let mut candidates: Vec<Candidate> = Vec::new();
    let mut wanted = demand(&samples.asked, count, std::iter::empty());
    let mut judged = Vec::new();
    for round in 0..SETTLING {
        let room = most.saturating_sub(candidates.len());
        candidates.extend(new_candidates(samples, &wanted, room, round, seed));
        let sighted: Vec<Sighted<'_>> = candidates.iter().map(Candidate::sighted).collect();
        let owner = owners(&sighted, count);
        candidates
            .par_iter_mut()
            .enumerate()
            .try_for_each(|(index, candidate)| candidate.judge(samples, &owner, index, seed))?;
        for (index, candidate) in candidates.iter_mut().enumerate() {
            candidate.ban_unexplained(index, &owner);
        }
        let fitted = candidates.iter().filter_map(|c| c.fitted.as_ref());
        let explained = fitted.map(|fitted| &fitted.explained[..]);
        wanted = demand(&samples.asked, count, explained);
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
    demand: &[f64],
    mut candidates: Vec<Candidate>,
    seed: u64,
) -> Result<Vec<Fitted>, FitError> {
    let sighted: Vec<Sighted<'_>> = candidates.iter().map(Candidate::sighted).collect();
    let mut owner = owners(&sighted, demand.len());
    for (owner, demand) in owner.iter_mut().zip(demand) {
        *owner = owner.filter(|_| *demand > 0.0);
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
    demand: &[f64],
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
        least_gain: if first { 0.0015 } else { 0.008 },
        most,
        seed,
        round,
    };
    let priority: Vec<f64> = demand
        .iter()
        .map(|demand| match (first, *demand > 0.0) {
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
        .centres(&samples.points, demand)
        .into_par_iter()
        .filter_map(|centre| Candidate::new(centre, region(samples, &centre, &sight, &priority)))
        .collect()
}

#[cfg(test)]
mod tests;
