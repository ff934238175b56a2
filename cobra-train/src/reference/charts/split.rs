//! Large charts as several around the same reference point.
//!
//! Owns which charts are split and where. What a point costs is the terms of the charts that are asked, and
//! a chart that has many samples has many terms and is asked often.

use super::Chart;
use super::candidate::FEWEST_OWNED;
use super::choice::keep_around;
use crate::surface::SurfacePoint;
use nalgebra::{Matrix3, Vector3};

/// Charts of a smaller share of all samples are not split.
const LARGEST_SHARE: f64 = 0.08;

/// The largest charts in halves, across the axis along which their samples lie farthest apart, until none
/// is large or there are `most`.
#[must_use]
pub fn split(mut charts: Vec<Chart>, points: &[SurfacePoint], most: usize) -> Vec<Chart> {
    while charts.len() < most {
        let sizes = charts.iter().map(|chart| chart.own.len()).enumerate();
        // Of equals the first, whichever way the maximum is found.
        let largest = sizes.reduce(|best, next| if next.1 > best.1 { next } else { best });
        let Some((index, size)) = largest else {
            break;
        };
        let small = (size as f64) < LARGEST_SHARE * points.len() as f64;
        // Half of it has to be a chart still: of few points every chart is a large share.
        if small || size < 2 * FEWEST_OWNED {
            break;
        }
        let [first, second] = halves(&charts[index], points);
        charts[index] = first;
        charts.push(second);
    }
    charts
}

fn halves(chart: &Chart, points: &[SurfacePoint]) -> [Chart; 2] {
    let position = |sample: usize| points[sample].position.coords;
    let places = chart.own.iter().map(|&sample| position(sample));
    let mean = places.clone().sum::<Vector3<f64>>() / chart.own.len().max(1) as f64;
    let scatter: Matrix3<f64> = places
        .map(|place| (place - mean) * (place - mean).transpose())
        .sum();
    let eigen = scatter.symmetric_eigen();
    let axis = eigen.eigenvectors.column(eigen.eigenvalues.imax());
    let mut along: Vec<(f64, usize)> = chart
        .own
        .iter()
        .map(|&sample| (position(sample).dot(&axis), sample))
        .collect();
    along.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let (low, high) = along.split_at(along.len() / 2);
    [low, high].map(|half| {
        let mut own: Vec<usize> = half.iter().map(|(_, sample)| *sample).collect();
        own.sort_unstable();
        let mut training = chart.training.clone();
        keep_around(&mut training, &own, points);
        Chart {
            own,
            training,
            ..chart.clone()
        }
    })
}
