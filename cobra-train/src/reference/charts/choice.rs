//! Which of the charts that were judged make up the template.
//!
//! Owns the choice by what they were found to explain, and whose the samples are then.

use super::candidate::Fitted;
use super::region::Samples;
use super::{Aim, Chart, RING};
use crate::surface::{NearestPoints, SurfacePoint};
use crate::validity::sparsity;

/// It explains so many in any case.
const FEWEST_ADDED: usize = 8;

fn fewest(aim: Aim, left: usize, asked: usize) -> usize {
    let effort = aim.effort();
    let share = if left as f64 > effort.left * asked as f64 {
        effort.least_wanted
    } else {
        effort.least_added
    };
    ((share * asked as f64).round() as usize).max(FEWEST_ADDED)
}

/// The charts that explain most together, at most `most`, the most useful first: greedy set cover.
pub(super) fn choice(judged: &[Fitted], asked: usize, most: usize, aim: Aim) -> Vec<usize> {
    let mut explained = vec![false; asked];
    let mut gains: Vec<usize> = judged.iter().map(|chart| chart.explained.len()).collect();
    let mut left = asked;
    let mut chosen = Vec::new();
    while chosen.len() < most {
        // Gains only fall: those that were no larger need not be counted again.
        let mut best: Option<(usize, usize)> = None;
        for (index, gain) in gains.iter_mut().enumerate() {
            if best.is_some_and(|(_, best)| *gain <= best) {
                continue;
            }
            let new = judged[index]
                .explained
                .iter()
                .filter(|&&i| !explained[i as usize]);
            *gain = new.count();
            if best.is_none_or(|(_, best)| *gain > best) {
                best = Some((index, *gain));
            }
        }
        let Some((index, gain)) = best.filter(|(_, gain)| *gain >= fewest(aim, left, asked)) else {
            break;
        };
        for &point in &judged[index].explained {
            explained[point as usize] = true;
        }
        left -= gain;
        chosen.push(index);
    }
    needed(judged, chosen, asked, aim)
}

/// Without those that the others make up for, the least useful first.
fn needed(judged: &[Fitted], mut chosen: Vec<usize>, asked: usize, aim: Aim) -> Vec<usize> {
    let mut times = vec![0_u32; asked];
    for &chart in &chosen {
        for &point in &judged[chart].explained {
            times[point as usize] += 1;
        }
    }
    loop {
        let alone = chosen.iter().map(|&chart| {
            let explained = judged[chart].explained.iter();
            explained
                .filter(|&&point| times[point as usize] == 1)
                .count()
        });
        let least = alone.enumerate().min_by_key(|(_, alone)| *alone);
        let Some((place, _)) = least.filter(|(_, alone)| *alone < fewest(aim, asked, asked)) else {
            return chosen;
        };
        for &point in &judged[chosen.remove(place)].explained {
            times[point as usize] -= 1;
        }
    }
}

/// The chosen charts, each sample with the first of its owners that explains it, else with the first
/// of its owners.
///
/// For coverage, what a chart explains around its own it keeps as well: the cells of two charts
/// need not meet where their samples do, and what lies between is then nobody's.
pub(super) fn shared_out(
    judged: &[Fitted],
    chosen: &[usize],
    aim: Aim,
    samples: &Samples,
) -> Vec<Chart> {
    let mut owner = vec![None; samples.points.len()];
    for well in [true, false] {
        for &index in chosen {
            let fitted = &judged[index];
            for &sample in &fitted.chart.own {
                if !well || fitted.explains(sample) {
                    owner[sample].get_or_insert(index);
                }
            }
        }
    }
    chosen
        .iter()
        .map(|&index| {
            let fitted = &judged[index];
            let mut chart = fitted.chart.clone();
            let (own, mut around): (Vec<usize>, Vec<usize>) = chart
                .own
                .iter()
                .partition(|&&sample| owner[sample] == Some(index));
            around.retain(|&sample| aim == Aim::Coverage && fitted.explains(sample));
            keep_around(&mut around, &own, &samples.points);
            chart.own = [own, around].concat();
            chart.own.sort_unstable();
            // A compressed process has no terms to spare for what others own now.
            keep_around(&mut chart.training, &chart.own, &samples.points);
            chart
        })
        .filter(|chart| !chart.own.is_empty())
        .collect()
}

/// Leaves of `some` samples those within the ring around `own`.
pub(super) fn keep_around(some: &mut Vec<usize>, own: &[usize], points: &[SurfacePoint]) {
    let position = |sample: usize| -> [f64; 3] { points[sample].position.into() };
    let positions: Vec<[f64; 3]> = own.iter().map(|&sample| position(sample)).collect();
    let tree = NearestPoints::new(&positions);
    let ring = RING * sparsity(points.len());
    some.retain(|&sample| tree.distance(&position(sample)) < ring);
}
