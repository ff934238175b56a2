//! A template of maps in a budget of bytes.
//!
//! Owns how fine each component's map is, and what it is fitted to: the exact Gaussian process in the
//! directions in which the component is valid. The fit itself is [`crate::gp::bake`]'s.

use super::assemble::{Frame, ScaledComponent};
use super::squeeze::{measured_bytes, verify_parts};
use super::{Deviation, Part, TrainError};
use crate::gp::{
    Baked, Coordinates, FittedGp, Hyperparameters, Sample, bake, coordinates, covariances,
};
use crate::surface::SurfacePoint;
use crate::validity::{FINE_CELLS, ValidCells};
use cobra_infer::Template;
use cobra_infer::gp::UnitDirection;
use cobra_infer::validity::direction;
use nalgebra::UnitVector3;
use rayon::prelude::*;

/// Where in a valid cell the mean is looked at, along each side, for the fit.
const FITTED: [f64; 3] = [0.02, 0.5, 0.98];

/// And for how good the fit is.
const HELD_OUT: [f64; 2] = [0.25, 0.75];

/// And for how far the written mean is off at most.
const DENSE: [f64; 6] = [0.01, 0.2, 0.4, 0.6, 0.8, 0.99];

/// Cells along a side of the coarsest map, each map's more than the one before it, and of the finest.
const COARSEST: f64 = 1.0;
const FINER: f64 = 1.19;
const FINEST: f64 = 45.0;

/// A finer map is worth having if it leaves so much less of the squared error.
const BETTER: f64 = 0.97;

/// Bytes before a map's nodes.
const HEADER: usize = 20;

/// The maps of one component, each larger and better than the one before it.
struct Choice {
    maps: Vec<(Baked, f64)>,
    taken: usize,
}

impl Choice {
    fn bytes(&self, index: usize) -> usize {
        HEADER + self.maps[index].0.nodes.len()
    }

    /// The finer map that leaves the least error for its bytes, and what it leaves less by a byte.
    fn next(&self, room: usize) -> Option<(usize, f64)> {
        let (now, error) = (self.bytes(self.taken), self.maps[self.taken].1);
        let finer = (self.taken + 1..self.maps.len()).filter(|i| self.bytes(*i) - now <= room);
        finer
            .map(|i| (i, (error - self.maps[i].1) / (self.bytes(i) - now) as f64))
            .max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)))
    }
}

/// Gives the exact, verified `parts` maps in the place of terms, as fine as `budget` bytes allow, and
/// verifies them anew. Parts that do not fit or may no longer speak anywhere are left out, those of
/// fewest points first.
pub(super) fn bake_parts(
    frame: &Frame<'_>,
    exact: Vec<Part>,
    training: &[SurfacePoint],
    budget: usize,
) -> Result<Vec<Part>, TrainError> {
    let mut parts: Vec<(Part, Choice)> = exact
        .into_par_iter()
        .filter_map(|part| {
            let maps = maps_of(&part)?;
            Some((part, Choice { maps, taken: 0 }))
        })
        .collect();
    let mut room = budget;
    loop {
        for (_, choice) in &mut parts {
            choice.taken = 0;
        }
        let coarsest = length(frame, &baked(&parts, frame))?;
        let Some(spare) = room.checked_sub(coarsest) else {
            if parts.len() <= 1 {
                return Err(TrainError::Budget {
                    budget,
                    least: coarsest + (budget - room),
                });
            }
            let sizes = parts.iter().map(|(part, _)| part.patch.own.len());
            if let Some((least, _)) = sizes.enumerate().min_by_key(|(_, size)| *size) {
                parts.remove(least);
            }
            continue;
        };
        refine(&mut parts, spare);
        let verified = verify_parts(frame, baked(&parts, frame), training, FINE_CELLS)?;
        let verified = fitted_cells(verified, &parts);
        // What is verified may have other cells than the exact components had.
        let found = length(frame, &verified)?;
        let Some(over) = found.checked_sub(budget).filter(|over| *over > 0) else {
            return Ok(verified);
        };
        room = room.checked_sub(over).ok_or(TrainError::Budget {
            budget,
            least: found,
        })?;
    }
}

/// The parts without the cells that their maps were not fitted in: what a map says there is near the
/// surface by accident, and far from the exact mean.
fn fitted_cells(verified: Vec<Part>, parts: &[(Part, Choice)]) -> Vec<Part> {
    let restricted = |part: Part| {
        let same = |(exact, _): &&(Part, Choice)| exact.patch.own == part.patch.own;
        let (exact, _) = parts.iter().find(same)?;
        let scaled = part.scaled.valid_within(exact.scaled.cells()?)?;
        Some(Part { scaled, ..part })
    };
    verified.into_iter().filter_map(restricted).collect()
}

/// Spends `spare` bytes, those first that take most of the squared error away.
fn refine(parts: &mut [(Part, Choice)], mut spare: usize) {
    loop {
        let mut best: Option<(f64, usize, usize)> = None;
        for (component, (_, choice)) in parts.iter().enumerate() {
            if let Some((map, gain)) = choice.next(spare)
                && best.is_none_or(|(most, ..)| gain > most)
            {
                best = Some((gain, component, map));
            }
        }
        let Some((_, component, map)) = best else {
            return;
        };
        let choice = &mut parts[component].1;
        spare -= choice.bytes(map) - choice.bytes(choice.taken);
        choice.taken = map;
    }
}

fn baked(parts: &[(Part, Choice)], frame: &Frame<'_>) -> Vec<Part> {
    let with_map = |(part, choice): &(Part, Choice)| Part {
        scaled: part
            .scaled
            .baked(&choice.maps[choice.taken].0, frame.sphere),
        ..part.clone()
    };
    parts.iter().map(with_map).collect()
}

fn length(frame: &Frame<'_>, parts: &[Part]) -> Result<usize, TrainError> {
    let scaled: Vec<ScaledComponent> = parts.iter().map(|part| part.scaled.clone()).collect();
    Ok(frame.provisional(&scaled)?.len() + measured_bytes(parts.len()))
}

/// The maps that a component may have, with their squared error over its own points.
fn maps_of(part: &Part) -> Option<Vec<(Baked, f64)>> {
    let cells = part.scaled.cells()?;
    let mean = Mean::new(&part.fitted);
    let (fitted, held_out) = (mean.samples(cells, &FITTED), mean.samples(cells, &HELD_OUT));
    let points = part.patch.own.len() as f64 / held_out.len() as f64;
    let mut maps: Vec<(Baked, f64)> = Vec::new();
    let mut fineness = COARSEST;
    while fineness < FINEST {
        if let Some(map) = bake(&fitted, fineness) {
            let error = points * map.squared_error(&held_out);
            let better = maps.last().is_none_or(|(last, least)| {
                map.nodes.len() > last.nodes.len() && error < BETTER * least
            });
            if better {
                maps.push((map, error));
            }
        }
        fineness *= FINER;
    }
    (!maps.is_empty()).then_some(maps)
}

/// The mean of the exact process, in double precision.
struct Mean<'a> {
    fitted: &'a FittedGp,
    unit: Hyperparameters,
    points: Coordinates,
}

impl<'a> Mean<'a> {
    fn new(fitted: &'a FittedGp) -> Self {
        Self {
            fitted,
            unit: Hyperparameters {
                signal_variance: 1.0,
                ..fitted.learned.hyperparameters
            },
            points: Coordinates::new(fitted.model.metric, &fitted.directions),
        }
    }

    fn at(&self, u: &UnitVector3<f64>) -> f64 {
        let model = self.fitted.model;
        let query = coordinates(model.metric, u);
        let row = covariances(model.kernel, &self.unit, &self.points, query);
        let weights = row.iter().zip(&self.fitted.weights);
        self.fitted.prior_mean + weights.map(|(k, weight)| k * weight).sum::<f64>()
    }

    /// The mean at these places of each valid cell.
    fn samples(&self, cells: &ValidCells, places: &[f64]) -> Vec<Sample> {
        inside(cells, places)
            .map(|(square, u)| Sample {
                square,
                distance: self.at(&u),
            })
            .collect()
    }
}

/// These places of each valid cell: on the map, and as directions.
fn inside<'a>(
    cells: &'a ValidCells,
    places: &'a [f64],
) -> impl Iterator<Item = ([f64; 2], UnitVector3<f64>)> + 'a {
    let side = f64::from(cells.side);
    places.iter().flat_map(move |&row| {
        places.iter().flat_map(move |&column| {
            cells.valid().map(move |cell| {
                let on_map = |index: u8, at: f64| 2.0 * (f64::from(index) + at) / side - 1.0;
                let square = [on_map(cell.column, column), on_map(cell.row, row)];
                let at = [column as f32, row as f32];
                let u = direction(cells.pole, cells.side, cell, at);
                (
                    square,
                    UnitVector3::new_normalize(nalgebra::Vector3::from(u).cast()),
                )
            })
        })
    })
}

/// The largest deviation of the written mean from the exact one, over all of the valid directions,
/// where `deviation` is what test points say.
pub(super) fn bounded(
    deviation: Deviation,
    template: &Template<'_>,
    parts: &[Part],
    sigma_hats: &[f32],
) -> Deviation {
    let components: Vec<_> = template.components().collect();
    let radius = f64::from(template.radius());
    let max = components
        .par_iter()
        .zip(parts)
        .zip(sigma_hats)
        .map(|((component, part), sigma_hat)| {
            let Some(cells) = part.scaled.cells() else {
                return 0.0;
            };
            let mean = Mean::new(&part.fitted);
            let off = inside(cells, &DENSE).map(|(_, u)| {
                let single = UnitDirection::new_unchecked(u.cast::<f32>().into_inner());
                let written = component.posterior_mean(template.model(), &single);
                (f64::from(written) - radius * mean.at(&u)).abs()
            });
            off.fold(0.0, f64::max) / f64::from(*sigma_hat)
        })
        .reduce(|| 0.0, f64::max);
    Deviation {
        max: deviation.max.max(max),
        ..deviation
    }
}
