//! What charts are chosen for: points like those that the template will be asked about.
//!
//! Owns which samples still ask for charts. Samples lie evenly, so that cavities can be verified;
//! cameras see little of a cavity and much of what stands free, and what a chart explains between the
//! samples that it was fitted to is not what it explains at them.

use crate::surface::{NearestPoints, SurfacePoint};
use nalgebra::Point3;

/// How many samples beside a point are looked at for one that faces its way.
const BESIDE: usize = 3;

/// Normals of one face differ by no more than this cosine says: the other side of a sheet, or of an
/// edge, is not what the point lies on.
const FACING: f64 = 0.5;

/// A point that some chart should explain.
pub(super) struct Asked {
    pub(super) position: Point3<f64>,
    /// The sample beside it.
    pub(super) sample: usize,
    /// Whether it is that sample: what a chart that was fitted to it says of it proves nothing.
    pub(super) is_sample: bool,
}

/// All points that the samples were drawn from: the samples and the `others`.
pub(super) fn asked(samples: &[SurfacePoint], others: &[SurfacePoint]) -> Vec<Asked> {
    let positions: Vec<[f64; 3]> = samples.iter().map(|p| p.position.into()).collect();
    let tree = NearestPoints::new(&positions);
    let own = samples.iter().enumerate().map(|(sample, point)| Asked {
        position: point.position,
        sample,
        is_sample: true,
    });
    let others = others.iter().filter_map(|point| {
        let near: Vec<usize> = tree
            .nearest(&point.position.into(), BESIDE)
            .map(|near| near.index)
            .collect();
        let facing = |sample: &&usize| samples[**sample].normal.dot(&point.normal) > FACING;
        near.iter()
            .find(facing)
            .or(near.first())
            .map(|&sample| Asked {
                position: point.position,
                sample,
                is_sample: false,
            })
    });
    own.chain(others).collect()
}

/// Of each of `samples` samples, how many of the points beside it nothing that is `explained` holds.
pub(super) fn demand<'a>(
    asked: &[Asked],
    samples: usize,
    explained: impl Iterator<Item = &'a [u32]>,
) -> Vec<f64> {
    let mut open = vec![true; asked.len()];
    for &index in explained.flatten() {
        open[index as usize] = false;
    }
    let mut demand = vec![0.0; samples];
    for (asked, _) in asked.iter().zip(open).filter(|(_, open)| *open) {
        demand[asked.sample] += 1.0;
    }
    demand
}
