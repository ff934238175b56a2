//! Which of the charts that were judged make up the template.
//!
//! Owns the choice by what they were found to explain, and whose the samples are then.

use super::candidate::Fitted;
use super::region::Samples;
use super::{Borders, Chart, LEFT, RING};
use crate::surface::NearestPoints;
use crate::validity::sparsity;

/// A chart is chosen only if it explains this share of what is asked for that others do not: each
/// costs a controller time, however little it adds.
const LEAST_ADDED: f64 = 0.0016;

/// As long as more than [`LEFT`] is left, this little is enough: what an object in many small pieces
/// lacks is many small charts.
const LEAST_WANTED: f64 = 0.0005;

/// It explains so many in any case.
const FEWEST_ADDED: usize = 8;

fn fewest(share: f64, asked: usize) -> usize {
    ((share * asked as f64).round() as usize).max(FEWEST_ADDED)
}

/// The charts that explain most together, at most `most`, the most useful first: greedy set cover.
pub(super) fn choice(judged: &[Fitted], asked: usize, most: usize) -> Vec<usize> {
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
        let wanting = left as f64 > LEFT * asked as f64;
        let share = if wanting { LEAST_WANTED } else { LEAST_ADDED };
        let Some((index, gain)) = best.filter(|(_, gain)| *gain >= fewest(share, asked)) else {
            break;
        };
        for &point in &judged[index].explained {
            explained[point as usize] = true;
        }
        left -= gain;
        chosen.push(index);
    }
    needed(judged, chosen, asked)
}

/// Without those that the others make up for, the least useful first.
fn needed(judged: &[Fitted], mut chosen: Vec<usize>, asked: usize) -> Vec<usize> {
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
        let Some((place, _)) = least.filter(|(_, alone)| *alone < fewest(LEAST_WANTED, asked))
        else {
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
/// Where borders overlap, what a chart explains around its own it keeps as well: the cells of two charts
/// need not meet where their samples do, and what lies between is then nobody's.
pub(super) fn shared_out(
    judged: &[Fitted],
    chosen: &[usize],
    borders: Borders,
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
            around.retain(|&sample| borders == Borders::Overlapping && fitted.explains(sample));
            keep_around(&mut around, &own, samples);
            chart.own = [own, around].concat();
            chart.own.sort_unstable();
            // A compressed process has no terms to spare for what others own now.
            keep_around(&mut chart.training, &chart.own, samples);
            chart
        })
        .filter(|chart| !chart.own.is_empty())
        .collect()
}

/// Leaves of `some` samples those within the ring around `own`.
fn keep_around(some: &mut Vec<usize>, own: &[usize], samples: &Samples) {
    let position = |sample: usize| -> [f64; 3] { samples.points[sample].position.into() };
    let positions: Vec<[f64; 3]> = own.iter().map(|&sample| position(sample)).collect();
    let tree = NearestPoints::new(&positions);
    let ring = RING * sparsity(samples.points.len());
    some.retain(|&sample| tree.distance(&position(sample)) < ring);
}
