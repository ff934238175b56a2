//! A chart while it is looked for: what it sees, what it owns, what it explains.
//!
//! Owns the fit of one candidate and the verdict on it. Who owns what is `charts::ownership`'s
//! question, which candidates become charts `charts::choice`'s.

use super::ownership::Sighted;
use super::process::Process;
use super::region::{Region, Samples};
use super::{Chart, RING};
use crate::gp::{FitError, Hyperparameters};
use crate::random::{Purpose, stream};
use crate::surface::{NearestPoints, SurfacePoint};
use crate::validity::{FINE_CELLS, sparsity, verify};
use nalgebra::Point3;
use rand::seq::SliceRandom;

/// A sample is explained whose residual is at most this: the paper's τ.
const EXPLAINED: f64 = crate::evaluate::TAU;

/// Charts of fewer samples are none.
const FEWEST_SEEN: usize = 12;
pub(super) const FEWEST_OWNED: usize = 8;
const FEWEST_EXPLAINED: usize = 6;

/// The most samples that a chart is fitted to while it is judged.
const FITTED: usize = 700;

/// A residual is an outlier's beyond this, and beyond this many times the median.
const OUTLIER: f64 = 0.015;
const OUTLIER_MEDIANS: f64 = 5.0;

/// A chart that may yet get or lose samples.
pub(super) struct Candidate {
    centre: Point3<f64>,
    members: Vec<u32>,
    incidence: Vec<f32>,
    /// Of the last fit.
    hyperparameters: Option<Hyperparameters>,
    /// The samples that it was last judged by, its own: the others are those of their ring.
    judged: Vec<usize>,
    /// What it then came to; `None` where that was too little.
    pub(super) fitted: Option<Fitted>,
}

/// What a candidate came to in a round.
#[derive(Clone)]
pub(super) struct Fitted {
    pub(super) chart: Chart,
    /// Its members that it explains, in a verified direction, by rising index, whoever owns them.
    well: Vec<usize>,
    /// The same of what charts are chosen for, members or not.
    pub(super) explained: Vec<u32>,
}

impl Fitted {
    /// Whether it explains a sample that is a member.
    pub(super) fn explains(&self, member: usize) -> bool {
        self.well.binary_search(&member).is_ok()
    }
}

impl Candidate {
    /// `None` where it sees too little.
    pub(super) fn new(centre: Point3<f64>, seen: Region) -> Option<Self> {
        (seen.members.len() >= FEWEST_SEEN).then_some(Self {
            centre,
            members: seen.members,
            incidence: seen.incidence,
            hyperparameters: None,
            judged: Vec::new(),
            fitted: None,
        })
    }

    pub(super) fn sighted(&self) -> Sighted<'_> {
        Sighted {
            members: &self.members,
            incidence: &self.incidence,
        }
    }

    /// Fits the chart to what it owns, unless that is what it was fitted to already.
    pub(super) fn judge(
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
        let speaks = |position: &Point3<f64>| cells.contains(&(position - self.centre));
        let mut well: Vec<usize> = members()
            .zip(residuals)
            .filter(|(member, residual)| residual.abs() < EXPLAINED && speaks(&position(*member)))
            .map(|(member, _)| member)
            .collect();
        well.sort_unstable();
        let distance = |position: &Point3<f64>| nalgebra::distance(position, &self.centre);
        // What lies nearer or farther than all of its own samples it cannot explain.
        let (near, far) = own
            .iter()
            .map(|&sample| distance(&position(sample)))
            .fold((f64::INFINITY, 0.0_f64), |(near, far), distance| {
                (near.min(distance), far.max(distance))
            });
        let range = near - EXPLAINED..far + EXPLAINED;
        let of_all = samples
            .asked
            .iter()
            .enumerate()
            .filter(|(_, asked)| {
                range.contains(&distance(&asked.position)) && speaks(&asked.position)
            })
            .filter(|(_, asked)| {
                let residual = left_out[asked.sample]
                    .filter(|_| asked.is_sample)
                    .unwrap_or_else(|| process.residual(&asked.position));
                residual.abs() < EXPLAINED
            })
            .map(|(index, _)| index as u32);
        let explained = if samples.members_alone {
            well.iter().map(|&member| member as u32).collect()
        } else {
            of_all.collect()
        };
        Ok(Some(Fitted {
            chart: Chart {
                centre: self.centre,
                own,
                training,
                hyperparameters: process.hyperparameters(),
            },
            well,
            explained,
        }))
    }

    /// Leaves to others what it owned and does not explain.
    pub(super) fn ban_unexplained(&mut self, index: usize, owner: &[Option<u32>]) {
        let fitted = self.fitted.as_ref();
        let keep: Vec<bool> = self
            .members
            .iter()
            .map(|&member| {
                owner[member as usize] != Some(index as u32)
                    || fitted.is_some_and(|fitted| fitted.explains(member as usize))
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
