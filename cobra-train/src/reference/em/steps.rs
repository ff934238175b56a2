//! The two steps of EM: responsibilities, and the mixture that they make most probable.
//!
//! Owns the order of summation and what becomes of a component that lost its points; when to stop
//! is `em`'s question.

use super::component::Component;
use crate::reference::membership::nearest_to_each;
use nalgebra::{Matrix3, Point3, Vector3};
use rayon::prelude::*;

/// A component that holds less than this many points' worth of responsibility starts again. Below 1,
/// so that of as many components as points, whose shares may add up to a little less, none does.
const FEWEST_POINTS: f64 = 0.5;

/// Points whose sums are taken together; the order of summation does not depend on the threads.
const CHUNK: usize = 1024;

/// What the next mixture is made of: per component the responsibilities, and with them the sums of
/// the points' offsets from `origins` and of their outer products.
pub(super) struct Expected {
    origins: Vec<Point3<f64>>,
    sums: Vec<Sums>,
    pub(super) log_likelihood: f64,
    /// ln of each point's density, by which the worst explained is found.
    log_densities: Vec<f64>,
}

#[derive(Clone, Copy)]
struct Sums {
    points: f64,
    offsets: Vector3<f64>,
    products: Matrix3<f64>,
}

impl Sums {
    fn zero() -> Self {
        Self {
            points: 0.0,
            offsets: Vector3::zeros(),
            products: Matrix3::zeros(),
        }
    }

    fn add(&mut self, offset: &Vector3<f64>, share: f64) {
        let part = offset * share;
        self.points += share;
        self.offsets += part;
        self.products += part * offset.transpose();
    }
}

/// Responsibilities, by the sum of exponentials relative to the largest.
pub(super) fn expect(points: &[Point3<f64>], mixture: &[Component]) -> Expected {
    let chunks: Vec<(Vec<Sums>, Vec<f64>)> = points
        .par_chunks(CHUNK)
        .map(|chunk| {
            let mut sums = vec![Sums::zero(); mixture.len()];
            let mut logs = vec![0.0; mixture.len()];
            let densities = chunk
                .iter()
                .map(|point| {
                    for (log, component) in logs.iter_mut().zip(mixture) {
                        *log = component.log_density(point);
                    }
                    let largest = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                    for log in &mut logs {
                        *log = libm::exp(*log - largest);
                    }
                    let total: f64 = logs.iter().sum();
                    for ((sums, component), share) in sums.iter_mut().zip(mixture).zip(&logs) {
                        if *share > 0.0 {
                            sums.add(&(point - component.mean), share / total);
                        }
                    }
                    largest + libm::log(total)
                })
                .collect();
            (sums, densities)
        })
        .collect();
    let mut expected = Expected {
        origins: mixture.iter().map(|component| component.mean).collect(),
        sums: vec![Sums::zero(); mixture.len()],
        log_likelihood: 0.0,
        log_densities: Vec::with_capacity(points.len()),
    };
    for (sums, densities) in chunks {
        for (total, part) in expected.sums.iter_mut().zip(sums) {
            total.points += part.points;
            total.offsets += part.offsets;
            total.products += part.products;
        }
        expected.log_likelihood += densities.iter().sum::<f64>();
        expected.log_densities.extend(densities);
    }
    expected
}

impl Expected {
    /// The mean variance, over the axes, of the points around the origin that they belong to.
    pub(super) fn mean_variance(&self) -> f64 {
        let squares: f64 = self.sums.iter().map(|sums| sums.products.trace()).sum();
        squares / (3.0 * self.log_densities.len() as f64)
    }
}

/// Each point belongs wholly to its nearest centre.
pub(super) fn hard(points: &[Point3<f64>], centres: &[Point3<f64>]) -> Expected {
    let mut sums = vec![Sums::zero(); centres.len()];
    let nearest = nearest_to_each(points, centres);
    for (point, (label, _)) in points.iter().zip(&nearest) {
        sums[*label].add(&(point - centres[*label]), 1.0);
    }
    Expected {
        origins: centres.to_vec(),
        sums,
        log_likelihood: f64::NEG_INFINITY,
        log_densities: nearest.into_iter().map(|(_, squared)| -squared).collect(),
    }
}

pub(super) struct Maximised {
    pub(super) mixture: Vec<Component>,
    pub(super) restarted: bool,
}

/// The mixture that `expected` makes most probable; a component that lost its points starts again
/// at the worst explained one, as wide as the others are on average.
pub(super) fn maximise(points: &[Point3<f64>], expected: &Expected, floor: f64) -> Maximised {
    let moments = |sums: &Sums| {
        let shift = sums.offsets / sums.points;
        (
            shift,
            sums.products / sums.points - shift * shift.transpose(),
        )
    };
    let lost = |sums: &Sums| sums.points < FEWEST_POINTS;
    let restarted = expected.sums.iter().any(lost);
    let mut worst: Vec<usize> = Vec::new();
    let mut width = Matrix3::zeros();
    let mut kept = 0.0;
    if restarted {
        worst = (0..points.len()).collect();
        let densities = &expected.log_densities;
        worst.sort_by(|&a, &b| densities[b].total_cmp(&densities[a]).then(b.cmp(&a)));
        for sums in expected.sums.iter().filter(|sums| !lost(sums)) {
            width += moments(sums).1 * sums.points;
            kept += sums.points;
        }
        // Where none is kept, the floor alone is the width.
        width /= f64::max(kept, FEWEST_POINTS);
    }
    let fewest = points.len() as f64 / expected.sums.len() as f64;
    let weights: Vec<f64> = expected
        .sums
        .iter()
        .map(|sums| if lost(sums) { fewest } else { sums.points })
        .collect();
    let total: f64 = weights.iter().sum();
    let mixture = expected
        .sums
        .iter()
        .zip(&expected.origins)
        .zip(&weights)
        .map(|((sums, origin), weight)| {
            let replacement = if lost(sums) { worst.pop() } else { None };
            let (mean, covariance) = match replacement {
                Some(index) => (points[index], width),
                None => {
                    let (shift, covariance) = moments(sums);
                    (origin + shift, covariance)
                }
            };
            Component::new(mean, covariance, weight / total, floor)
        })
        .collect();
    Maximised { mixture, restarted }
}
