//! Where the surface is that no component reproduces.
//!
//! Owns the grouping of uncovered points into regions, so that a report says where and not only how
//! much.

use crate::surface::NearestPoints;
use nalgebra::{Point3, Vector3, distance};

/// Points nearer to one another than this share of the radius lie in one region.
const TOGETHER: f64 = 0.06;

/// How many neighbours are looked at.
const NEIGHBOURS: usize = 12;

/// A part of the surface that no component reproduces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UncoveredRegion {
    /// The mean of its points, in the object's frame and unit.
    pub centre: Point3<f64>,
    /// How far its points reach from there.
    pub reach: f64,
    /// Its share of all test points.
    pub share: f64,
}

/// The regions of `points`, of `total` in all, the largest first.
pub(crate) fn regions(points: &[Point3<f64>], total: usize, radius: f64) -> Vec<UncoveredRegion> {
    let coordinates: Vec<[f64; 3]> = points.iter().map(|p| (*p).into()).collect();
    let tree = NearestPoints::new(&coordinates);
    let mut region_of = vec![usize::MAX; points.len()];
    let mut regions: Vec<Vec<usize>> = Vec::new();
    for start in 0..points.len() {
        if region_of[start] != usize::MAX {
            continue;
        }
        let mut members = vec![start];
        region_of[start] = regions.len();
        let mut next = 0;
        while let Some(&index) = members.get(next) {
            next += 1;
            for near in tree.nearest(&coordinates[index], NEIGHBOURS) {
                if near.distance <= TOGETHER * radius && region_of[near.index] == usize::MAX {
                    region_of[near.index] = regions.len();
                    members.push(near.index);
                }
            }
        }
        regions.push(members);
    }
    regions.sort_by(|a, b| b.len().cmp(&a.len()).then(a.cmp(b)));
    regions
        .into_iter()
        .map(|members| {
            let sum: Vector3<f64> = members.iter().map(|&i| points[i].coords).sum();
            let centre = Point3::from(sum / members.len() as f64);
            let reach = members.iter().map(|&i| distance(&points[i], &centre));
            UncoveredRegion {
                centre,
                reach: reach.fold(0.0, f64::max),
                share: members.len() as f64 / total.max(1) as f64,
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_are_told_apart_and_the_largest_comes_first() {
        let line = |from: f64, count: u32| {
            (0..count).map(move |i| Point3::new(from + 0.01 * f64::from(i), 0.0, 0.0))
        };
        let points: Vec<_> = line(5.0, 3).chain(line(0.0, 11)).collect();
        let found = regions(&points, 100, 1.0);
        let shares: Vec<f64> = found.iter().map(|region| region.share).collect();
        assert_eq!(shares, [0.11, 0.03]);
        assert!((found[0].centre.x - 0.05).abs() < 1e-12);
        assert!((found[0].reach - 0.05).abs() < 1e-12);
        assert_eq!(regions(&[], 100, 1.0), []);
    }
}
