//! Which of the charts that were judged make up the template.
//!
//! Owns the choice by what they were found to explain, and whose the samples are then.

use super::candidate::Fitted;
use super::region::Samples;
use super::{Chart, RING};
use crate::surface::{NearestPoints, SurfacePoint};
use crate::validity::sparsity;

/// A chart is chosen only if it explains this share of the samples that others do not: each costs a
/// controller time, however little it adds.
const LEAST_ADDED: f64 = 0.0016;

/// It explains so many in any case.
const FEWEST_ADDED: usize = 8;

fn fewest(samples: usize) -> usize {
    ((LEAST_ADDED * samples as f64).round() as usize).max(FEWEST_ADDED)
}

/// The charts that explain most together, at most `most`, the most useful first: greedy set cover.
pub(super) fn choice(judged: &[Fitted], samples: usize, most: usize) -> Vec<usize> {
    let mut explained = vec![false; samples];
    let mut gains: Vec<usize> = judged.iter().map(|chart| chart.explained.len()).collect();
    let mut chosen = Vec::new();
    while chosen.len() < most {
        // Gains only fall: those that were no larger need not be counted again.
        let mut best: Option<(usize, usize)> = None;
        for (index, gain) in gains.iter_mut().enumerate() {
            if best.is_some_and(|(_, best)| *gain <= best) {
                continue;
            }
            let new = judged[index].explained.iter().filter(|&&i| !explained[i]);
            *gain = new.count();
            if best.is_none_or(|(_, best)| *gain > best) {
                best = Some((index, *gain));
            }
        }
        let Some((index, _)) = best.filter(|(_, gain)| *gain >= fewest(samples)) else {
            break;
        };
        for &sample in &judged[index].explained {
            explained[sample] = true;
        }
        chosen.push(index);
    }
    needed(judged, chosen, samples)
}

/// Without those that the others make up for, the least useful first.
fn needed(judged: &[Fitted], mut chosen: Vec<usize>, samples: usize) -> Vec<usize> {
    let mut times = vec![0_u32; samples];
    for &chart in &chosen {
        for &sample in &judged[chart].explained {
            times[sample] += 1;
        }
    }
    loop {
        let alone = chosen.iter().map(|&chart| {
            let explained = judged[chart].explained.iter();
            explained.filter(|&&sample| times[sample] == 1).count()
        });
        let least = alone.enumerate().min_by_key(|(_, alone)| *alone);
        let Some((place, _)) = least.filter(|(_, alone)| *alone < fewest(samples)) else {
            return chosen;
        };
        for &sample in &judged[chosen.remove(place)].explained {
            times[sample] -= 1;
        }
    }
}

/// Whether none of the chosen charts explains a sample.
pub(super) fn needy(judged: &[Fitted], chosen: &[usize], samples: usize) -> Vec<bool> {
    let mut needy = vec![true; samples];
    for &chart in chosen {
        for &sample in &judged[chart].explained {
            needy[sample] = false;
        }
    }
    needy
}

/// The chosen charts, each sample with the first of its owners that explains it, else with the first
/// of its owners.
pub(super) fn disjoint(judged: &[Fitted], chosen: &[usize], samples: &Samples) -> Vec<Chart> {
    let mut owner = vec![None; samples.points.len()];
    for explained in [true, false] {
        for &index in chosen {
            let fitted = &judged[index];
            for &sample in &fitted.chart.own {
                if !explained || fitted.explained.binary_search(&sample).is_ok() {
                    owner[sample].get_or_insert(index);
                }
            }
        }
    }
    chosen
        .iter()
        .map(|&index| {
            let mut chart = judged[index].chart.clone();
            chart.own.retain(|&sample| owner[sample] == Some(index));
            keep_around(&mut chart, &samples.points);
            chart
        })
        .filter(|chart| !chart.own.is_empty())
        .collect()
}

/// Leaves a chart no more than its ring of what others own now: a compressed process has no terms to
/// spare for it.
pub(super) fn keep_around(chart: &mut Chart, points: &[SurfacePoint]) {
    let position = |sample: usize| -> [f64; 3] { points[sample].position.into() };
    let own: Vec<[f64; 3]> = chart.own.iter().map(|&sample| position(sample)).collect();
    let tree = NearestPoints::new(&own);
    let ring = RING * sparsity(points.len());
    chart
        .training
        .retain(|&sample| tree.distance(&position(sample)) < ring);
}
