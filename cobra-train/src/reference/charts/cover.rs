//! Choosing centres whose regions cover the surface: greedy set cover.
//!
//! Owns the candidates and the choice among them.

use super::region::{Region, Samples, Sight, region};
use crate::random::{Purpose, stream};
use crate::reference::kmeans;
use crate::surface::SurfacePoint;
use nalgebra::Point3;
use rand::seq::{SliceRandom, index};
use rayon::prelude::*;

/// How far candidates lie from the surface along its normals, to either side.
const OFFSETS: [f64; 10] = [
    -0.5, -0.25, -0.12, -0.06, -0.03, 0.03, 0.06, 0.12, 0.25, 0.5,
];

/// Numbers of clusters whose centres are candidates as well.
const CLUSTERS: [usize; 5] = [1, 2, 4, 8, 16];

/// A sample that is seen with at least this |u·n| counts in full.
const FULL_INCIDENCE: f64 = 0.8;

/// How a cover is looked for.
pub(super) struct Search {
    pub(super) sight: Sight,
    /// Samples that the cover is judged by, besides needy ones.
    pub(super) samples: usize,
    /// Needy samples more.
    pub(super) needy: usize,
    /// Samples that candidates are placed beside.
    pub(super) bases: usize,
    /// The share of what is wanted that may stay uncovered.
    pub(super) rest: f64,
    /// A centre must add this share of what is wanted.
    pub(super) least_gain: f64,
    /// The most centres.
    pub(super) most: usize,
    pub(super) seed: u64,
    /// The round: each draws its own samples.
    pub(super) round: u64,
}

impl Search {
    /// Centres whose regions cover the needy samples, the most useful first.
    pub(super) fn centres(&self, points: &[SurfacePoint], demand: &[f64]) -> Vec<Point3<f64>> {
        let mut rng = stream(self.seed, Purpose::Charts, self.round);
        let pool: Vec<usize> = (0..points.len()).filter(|&i| demand[i] > 0.0).collect();
        if pool.is_empty() {
            return Vec::new();
        }
        let mut chosen =
            index::sample(&mut rng, points.len(), self.samples.min(points.len())).into_vec();
        let mut more = pool.clone();
        more.shuffle(&mut rng);
        chosen.extend(more.iter().take(self.needy));
        chosen.sort_unstable();
        chosen.dedup();
        let bases: Vec<usize> = index::sample(&mut rng, pool.len(), self.bases.min(pool.len()))
            .into_iter()
            .map(|i| pool[i])
            .collect();

        let few: Vec<SurfacePoint> = chosen.iter().map(|&i| points[i]).collect();
        let mut left: Vec<f64> = chosen.iter().map(|&i| demand[i]).collect();
        let mut candidates: Vec<Point3<f64>> = OFFSETS
            .iter()
            .flat_map(|offset| bases.iter().map(move |&base| (offset, base)))
            .map(|(offset, base)| points[base].position + points[base].normal.scale(*offset))
            .collect();
        if pool.len() == points.len() {
            candidates.extend(cluster_centres(&few, self.seed));
        }
        let samples = Samples::new(few, crate::validity::sparsity(chosen.len()));
        let regions: Vec<Region> = candidates
            .par_iter()
            .map(|centre| region(&samples, centre, &self.sight, &left))
            .collect();
        self.greedy(&regions, &mut left)
            .into_iter()
            .map(|index| candidates[index])
            .collect()
    }

    /// The regions that add most, one after the other.
    fn greedy(&self, regions: &[Region], left: &mut [f64]) -> Vec<usize> {
        let total: f64 = left.iter().sum();
        let mut chosen = Vec::new();
        while chosen.len() < self.most && left.iter().sum::<f64>() > self.rest * total {
            let gains = regions.iter().map(|region| {
                let seen = region.members.iter().zip(&region.incidence);
                seen.map(|(&index, incidence)| {
                    left[index as usize] * (f64::from(*incidence) / FULL_INCIDENCE).min(1.0)
                })
                .sum::<f64>()
            });
            let best = gains
                .enumerate()
                .reduce(|best, next| if next.1 > best.1 { next } else { best });
            let Some((index, gain)) = best else { break };
            if gain < (self.least_gain * total).max(self.sight.fewest as f64) {
                break;
            }
            for &member in &regions[index].members {
                left[member as usize] = 0.0;
            }
            chosen.push(index);
        }
        chosen
    }
}

fn cluster_centres(points: &[SurfacePoint], seed: u64) -> Vec<Point3<f64>> {
    let positions: Vec<Point3<f64>> = points.iter().map(|p| p.position).collect();
    CLUSTERS
        .into_iter()
        .filter_map(|count| kmeans(&positions, count, 1, seed).ok())
        .flatten()
        .flatten()
        .collect()
}
