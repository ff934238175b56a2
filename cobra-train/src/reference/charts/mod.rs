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
mod split;

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
pub use split::split;

/// Rounds in which charts are added for what is left and the whole surface is distributed anew.
const SETTLING: u64 = 3;

/// How many charts are looked for in a round, whatever a template has room for: the best of many are
/// better than the first few.
const SOUGHT: usize = 64;

/// How far charts reach from their centres. With some that reach farther, fewer points are covered and
/// more wrongly accepted, likely since a grid of directions has at most 64 cells a side.
const REACH: f64 = 0.42;

/// How far a chart is fitted beyond its own samples.
const RING: f64 = 0.04;

/// What charts are chosen for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aim {
    /// As much as can be explained, however many charts it takes.
    Coverage,
    /// Few bytes: a chart takes some for its cells and its terms.
    Bytes,
    /// Little time: a chart takes some wherever its box is, whatever it adds. Of the screwdriver's map on an
    /// M4F, 15 charts take 1,685 instructions a point, 11 take 1,468, and F is 99.4 and 99.2.
    Time,
}

/// How far an aim goes. All shares are of what is asked for.
struct Effort {
    /// Rounds after which nothing is added for what is left, the first ones included.
    rounds: u64,
    /// So many rounds that are no better, and no more are made.
    patience: u64,
    /// A round that leaves less than this share less is no better.
    worthwhile: f64,
    /// When this share is left, it is left.
    left: f64,
    /// A centre is judged only if it sees this share of what is left.
    least_seen: f64,
    /// A chart is chosen only if it explains this share that others do not,
    least_added: f64,
    /// and this as long as more is left than may be.
    least_wanted: f64,
}

impl Aim {
    fn effort(self) -> Effort {
        let thrifty = Effort {
            rounds: 12,
            patience: 3,
            worthwhile: 0.001,
            left: 0.006,
            least_seen: 0.015,
            least_added: 0.0016,
            least_wanted: 0.0016,
        };
        match self {
            // What an object in many small pieces lacks is many small charts.
            Self::Coverage => Effort {
                rounds: 14,
                patience: 4,
                worthwhile: 0.0005,
                left: 0.005,
                least_seen: 0.005,
                least_wanted: 0.0003,
                ..thrifty
            },
            Self::Bytes => thrifty,
            Self::Time => Effort {
                least_added: 0.004,
                least_wanted: 0.004,
                ..thrifty
            },
        }
    }
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
/// They are fitted to `points`, and chosen by what they explain of these and, for [`Aim::Coverage`], of
/// `others`: together those are to be such points as the template will be asked about.
///
/// The same points, limit and seed give the same charts, whatever the number of threads.
///
/// # Errors
/// [`FitError`].
pub fn charts(
    points: &[SurfacePoint],
    others: &[SurfacePoint],
    most: usize,
    aim: Aim,
    seed: u64,
) -> Result<Vec<Chart>, FitError> {
    let mut samples = Samples::new(points.to_vec(), sparsity(points.len()));
    // With a budget more and smaller charts would be chosen, whose terms then are too few: seed 0 of
    // trimesh_chair_model in 14,336 bytes had F 93.5 instead of 98.8.
    samples.members_alone = aim != Aim::Coverage;
    samples.asked = asked(points, if samples.members_alone { &[] } else { others });
    let all = samples.asked.len();
    let sought = most.max(SOUGHT);
    let mut judged = settled(&samples, sought, aim, seed)?;
    let mut chosen = choice(&judged, all, most, aim);
    let mut left = all as f64;
    let mut improved = SETTLING;
    let effort = aim.effort();
    for round in SETTLING..effort.rounds {
        let explained = chosen.iter().map(|&index| &judged[index].explained[..]);
        let demand = demand(&samples.asked, points.len(), explained);
        let now: f64 = demand.iter().sum();
        if now < effort.left * all as f64 {
            break;
        }
        if now < left - effort.worthwhile * all as f64 {
            left = now;
            improved = round;
        } else if round >= improved + effort.patience {
            break;
        }
        let added = new_candidates(&samples, &demand, sought, aim, round, seed);
        judged.extend(of_needy(&samples, &demand, added, seed)?);
        chosen = choice(&judged, all, most, aim);
    }
    Ok(shared_out(&judged, &chosen, aim, &samples))
}

/// What charts come to in rounds in which the whole surface is distributed among them anew.
fn settled(samples: &Samples, most: usize, aim: Aim, seed: u64) -> Result<Vec<Fitted>, FitError> {
    let count = samples.points.len();
    let mut candidates: Vec<Candidate> = Vec::new();
    let mut wanted = demand(&samples.asked, count, std::iter::empty());
    let mut judged = Vec::new();
    for round in 0..SETTLING {
        let room = most.saturating_sub(candidates.len());
        candidates.extend(new_candidates(samples, &wanted, room, aim, round, seed));
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
    aim: Aim,
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
        least_gain: if first {
            0.0015
        } else {
            aim.effort().least_seen
        },
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
