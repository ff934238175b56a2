//! Reference points that place themselves: charts.
//!
//! A chart is a centre, inside or outside of the object, and the connected piece of surface that it
//! sees well. Owns the rounds: charts are chosen to cover the surface, each sample goes to one of
//! them, each chart is fitted to its samples and verified; samples that a chart cannot explain are
//! banned from it, go to another, and ask for more charts. How many there are is the data's to say.
//!
//! Needs points and normals alone, and of normals that neighbours agree which side is which: a mesh
//! need be neither closed nor consistently oriented. Everything is in the unit sphere.

mod cover;
mod ownership;
mod process;
mod region;

use crate::gp::{FitError, Hyperparameters};
use crate::random::{Purpose, stream};
use crate::surface::{NearestPoints, SurfacePoint};
use crate::validity::{FINE_CELLS, ValidCells, sparsity, verify};
use cover::Search;
use nalgebra::Point3;
use ownership::{Sighted, owners};
use process::Process;
use rand::seq::SliceRandom;
use rayon::prelude::*;
use region::{Samples, Sight, region};

/// A sample is explained whose residual is at most this: the paper's τ.
const EXPLAINED: f64 = crate::evaluate::TAU;

/// Times that charts are added for what is left, and once more that samples are only reassigned.
const ROUNDS: u64 = 12;

/// When this share of the samples is left, it is left.
const LEFT: f64 = 0.006;

/// So many rounds that are no better, and no more are made.
const PATIENCE: u64 = 3;

/// A round that leaves less than this much less is no better.
const WORTHWHILE: f64 = 0.001;

/// How far charts reach from their centres.
const REACH: f64 = 0.42;

/// Charts of fewer samples are none.
const FEWEST_SEEN: usize = 12;
const FEWEST_OWNED: usize = 8;
const FEWEST_EXPLAINED: usize = 6;

/// How far a chart is fitted beyond its own samples.
const RING: f64 = 0.04;

/// The most samples that a chart is fitted to while it is judged.
const FITTED: usize = 700;

/// A residual is an outlier's beyond this, and beyond this many times the median.
const OUTLIER: f64 = 0.015;
const OUTLIER_MEDIANS: f64 = 5.0;

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
    let sparsity = sparsity(points.len());
    let samples = Samples::new(points.to_vec(), sparsity);
    let mut candidates: Vec<Candidate> = Vec::new();
    let mut needy = vec![true; points.len()];
    let mut best: Option<(f64, Vec<Chart>)> = None;
    let mut improved = 0;
    for round in 0..ROUNDS {
        if round + 1 < ROUNDS {
            let room = most.saturating_sub(candidates.len());
            candidates.extend(new_candidates(&samples, &needy, room, round, seed));
        }
        let sighted: Vec<Sighted<'_>> = candidates.iter().map(Candidate::sighted).collect();
        let owner = owners(&sighted, points.len());
        candidates
            .par_iter_mut()
            .enumerate()
            .try_for_each(|(index, candidate)| candidate.judge(&samples, &owner, index, seed))?;
        needy.fill(true);
        for (index, candidate) in candidates.iter_mut().enumerate() {
            candidate.take(index, &owner, &mut needy);
        }
        let left = needy.iter().filter(|needy| **needy).count() as f64 / points.len() as f64;
        if best
            .as_ref()
            .is_none_or(|(least, _)| left < least - WORTHWHILE)
        {
            let charts = candidates
                .iter()
                .filter_map(|candidate| candidate.fitted.as_ref());
            best = Some((left, charts.map(|fitted| fitted.chart.clone()).collect()));
            improved = round;
        }
        if left < LEFT || round >= improved + PATIENCE {
            break;
        }
    }
    Ok(best.map(|(_, charts)| charts).unwrap_or_default())
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
        .map(|centre| {
            let found = region(samples, &centre, &sight, &priority);
            Candidate {
                centre,
                members: found.members,
                incidence: found.incidence,
                hyperparameters: None,
                judged: Vec::new(),
                fitted: None,
            }
        })
        .filter(|candidate| candidate.members.len() >= FEWEST_SEEN)
        .collect()
}

/// A chart that may yet get or lose samples.
struct Candidate {
    centre: Point3<f64>,
    members: Vec<u32>,
    incidence: Vec<f32>,
    /// Of the last fit.
    hyperparameters: Option<Hyperparameters>,
    /// The samples that it was last judged by, its own: the others are those of their ring.
    judged: Vec<usize>,
    /// What it then came to; `None` where that was too little.
    fitted: Option<Fitted>,
}

/// What a candidate came to in a round.
struct Fitted {
    chart: Chart,
    /// The candidate's members that are explained, in a verified direction, by rising index.
    explained: Vec<usize>,
}

impl Candidate {
    fn sighted(&self) -> Sighted<'_> {
        Sighted {
            members: &self.members,
            incidence: &self.incidence,
        }
    }

    /// Fits the chart to what it owns, unless that is what it was fitted to already.
    fn judge(
        &mut self,
        samples: &Samples,
        owner: &[Option<u32>],
        index: usize,
        seed: u64,
    ) -> Result<(), FitError> {
        let members = self.members.iter().map(|&member| member as usize);
        let (own, other): (Vec<usize>, Vec<usize>) =
            members.partition(|&member| owner[member] == Some(index as u32));
        if own != self.judged {
            self.fitted = self.fit(samples, &own, other, index, seed)?;
            if let Some(fitted) = &self.fitted {
                self.hyperparameters = Some(fitted.chart.hyperparameters);
            }
            self.judged = own;
        }
        Ok(())
    }

    /// Fits the chart to its `own` samples and those of the `other` members that lie around them;
    /// `None` where that is too little.
    fn fit(
        &self,
        samples: &Samples,
        own: &[usize],
        other: Vec<usize>,
        index: usize,
        seed: u64,
    ) -> Result<Option<Fitted>, FitError> {
        let position = |member: usize| samples.points[member].position;
        let members = || self.members.iter().map(|&member| member as usize);
        if own.len() < FEWEST_OWNED {
            return Ok(None);
        }
        let mut owned = vec![false; samples.points.len()];
        for &member in own {
            owned[member] = true;
        }
        let positions: Vec<[f64; 3]> = own.iter().map(|&m| position(m).into()).collect();
        let tree = NearestPoints::new(&positions);
        let ring = RING * sparsity(samples.points.len());
        let mut around: Vec<usize> = other
            .into_iter()
            .filter(|&member| tree.distance(&position(member).into()) < ring)
            .collect();
        around.shuffle(&mut stream(seed, Purpose::ChartRings, index as u64));
        let whole: Vec<usize> = own.iter().chain(&around).copied().collect();
        let mut training = whole.clone();
        training.truncate(FITTED);
        let places = |training: &[usize]| -> Vec<Point3<f64>> {
            training.iter().map(|&member| position(member)).collect()
        };
        let mut process = Process::fit(self.centre, &places(&training), self.hyperparameters)?;
        let limit = OUTLIER.max(OUTLIER_MEDIANS * median_magnitude(&process.residuals));
        let kept: Vec<usize> = training
            .iter()
            .zip(&process.residuals)
            .filter(|(_, residual)| residual.abs() <= limit)
            .map(|(member, _)| *member)
            .collect();
        if kept.len() < training.len() && kept.len() >= FEWEST_OWNED {
            training = kept;
            let known = Some(process.hyperparameters());
            process = Process::fit(self.centre, &places(&training), known)?;
        }
        let mut left_out = vec![None; samples.points.len()];
        for (&member, residual) in training.iter().zip(&process.residuals) {
            left_out[member] = Some(*residual);
        }
        // Of samples that it was fitted to, what the others say; of the rest, what it says.
        let residuals: Vec<f64> = members()
            .map(|member| left_out[member].unwrap_or_else(|| process.residual(&position(member))))
            .collect();
        let mut residual_of = vec![0.0_f64; samples.points.len()];
        for (member, residual) in members().zip(&residuals) {
            residual_of[member] = *residual;
        }
        let mut training: Vec<usize> = whole
            .into_iter()
            .filter(|m| residual_of[*m].abs() <= limit)
            .collect();
        training.sort_unstable();
        let own: Vec<usize> = members()
            .zip(&residuals)
            .filter(|(member, residual)| {
                owned[*member] && (left_out[*member].is_some() || residual.abs() < OUTLIER)
            })
            .map(|(member, _)| member)
            .collect();
        if own.len() < FEWEST_EXPLAINED {
            return Ok(None);
        }
        let witnesses: Vec<SurfacePoint> = own.iter().map(|&m| samples.points[m]).collect();
        let sparsity = sparsity(samples.points.len());
        let mean = |direction: &_| process.mean(direction);
        let Some(cells) = verify(&self.centre, &witnesses, mean, sparsity, FINE_CELLS) else {
            return Ok(None);
        };
        let speaks =
            |member: usize, cells: &ValidCells| cells.contains(&(position(member) - self.centre));
        let explained = members()
            .zip(&residuals)
            .map(|(member, residual)| residual.abs() < EXPLAINED && speaks(member, &cells));
        Ok(Some(Fitted {
            chart: Chart {
                centre: self.centre,
                own,
                training,
                hyperparameters: process.hyperparameters(),
            },
            explained: members()
                .zip(explained)
                .filter(|(_, explained)| *explained)
                .map(|(member, _)| member)
                .collect(),
        }))
    }

    /// Takes the round's result: explained samples are needy no longer, own ones that are not
    /// explained are banned.
    fn take(&mut self, index: usize, owner: &[Option<u32>], needy: &mut [bool]) {
        let explained = self
            .fitted
            .as_ref()
            .map_or(&[][..], |fitted| &fitted.explained);
        for &member in explained {
            needy[member] = false;
        }
        let keep: Vec<bool> = self
            .members
            .iter()
            .map(|&member| {
                owner[member as usize] != Some(index as u32)
                    || explained.binary_search(&(member as usize)).is_ok()
            })
            .collect();
        let mut kept = keep.iter();
        self.members.retain(|_| *kept.next().unwrap_or(&true));
        let mut kept = keep.iter();
        self.incidence.retain(|_| *kept.next().unwrap_or(&true));
    }
}

fn median_magnitude(residuals: &[f64]) -> f64 {
    let mut magnitudes: Vec<f64> = residuals.iter().map(|r| r.abs()).collect();
    magnitudes.sort_by(f64::total_cmp);
    magnitudes.get(magnitudes.len() / 2).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests;
