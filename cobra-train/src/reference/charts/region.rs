//! What one reference point sees well: a connected piece of surface that is a function of direction.
//!
//! Owns the rule by which samples belong to the region around a centre. Which regions are chosen is
//! `charts::cover`'s question.

use super::asked::Asked;
use crate::surface::{NearestPoints, SurfacePoint};
use nalgebra::{Point3, Vector3};

/// How many neighbours of a sample are its edges.
const NEIGHBOURS: usize = 8;

/// How many neighbours in direction a sample's distance is compared with.
const FOLD_NEIGHBOURS: usize = 6;

/// With more contradictions than this a sample lies on a fold.
const FOLD_LIMIT: usize = 2;

/// How much farther than the steepest surface that is seen a distance may change; and by how much in
/// any case, since samples of one surface lie apart.
const FOLD_SLOPE: f64 = 1.5;
const FOLD_SLACK: f64 = 0.02;

/// Surface samples and which of them lie side by side.
pub(super) struct Samples {
    pub(super) points: Vec<SurfacePoint>,
    /// What charts are chosen for.
    pub(super) asked: Vec<Asked>,
    /// Whether a chart explains its members alone, and nothing is asked but the samples.
    pub(super) members_alone: bool,
    /// The neighbours of sample i are `neighbours[starts[i]..starts[i + 1]]`: each edge both ways.
    starts: Vec<u32>,
    neighbours: Vec<u32>,
    /// 1, or how much farther samples lie apart than they usually do.
    sparsity: f64,
}

impl Samples {
    pub(super) fn new(points: Vec<SurfacePoint>, sparsity: f64) -> Self {
        let positions: Vec<[f64; 3]> = points.iter().map(|p| p.position.into()).collect();
        let tree = NearestPoints::new(&positions);
        let mut edges = Vec::with_capacity(2 * NEIGHBOURS * points.len());
        for (index, position) in positions.iter().enumerate() {
            for near in tree.nearest(position, NEIGHBOURS + 1) {
                if near.index != index {
                    edges.push((index as u32, near.index as u32));
                    edges.push((near.index as u32, index as u32));
                }
            }
        }
        edges.sort_unstable();
        edges.dedup();
        let mut starts = vec![0; points.len() + 1];
        for (from, _) in &edges {
            starts[*from as usize + 1] += 1;
        }
        for index in 0..points.len() {
            starts[index + 1] += starts[index];
        }
        Self {
            points,
            asked: Vec::new(),
            members_alone: false,
            starts,
            neighbours: edges.into_iter().map(|(_, to)| to).collect(),
            sparsity,
        }
    }

    fn neighbours(&self, index: usize) -> &[u32] {
        &self.neighbours[self.starts[index] as usize..self.starts[index + 1] as usize]
    }
}

/// What a reference point must see of a sample, in the unit sphere.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sight {
    /// The least |u·n|: a surface that is seen at a flat angle is a poor function of direction.
    pub(super) incidence: f64,
    /// The least distance.
    pub(super) nearest: f64,
    /// The largest distance.
    pub(super) reach: f64,
    /// Connected pieces of fewer samples are none.
    pub(super) fewest: usize,
}

/// Samples that one reference point sees, by rising index.
#[derive(Clone, Debug, Default)]
pub(super) struct Region {
    pub(super) members: Vec<u32>,
    /// |u·n| of each.
    pub(super) incidence: Vec<f32>,
}

/// The region around `centre`: of the samples that it sees as `sight` asks, all from one side of the
/// surface, the connected piece of most `priority` in all, without samples that lie on a fold: whose
/// distance differs from those in neighbouring directions by more than a surface seen at that angle
/// can bend.
pub(super) fn region(
    samples: &Samples,
    centre: &Point3<f64>,
    sight: &Sight,
    priority: &[f64],
) -> Region {
    let seen: Vec<Option<Seen>> = samples
        .points
        .iter()
        .map(|point| Seen::new(point, centre, sight))
        .collect();
    let mut piece_of = vec![false; samples.points.len()];
    let mut best: Vec<u32> = Vec::new();
    let mut most = 0.0;
    let mut stack = Vec::new();
    for start in 0..seen.len() {
        let Some(first) = &seen[start] else { continue };
        if piece_of[start] {
            continue;
        }
        let mut piece = Vec::new();
        let mut weight = 0.0;
        piece_of[start] = true;
        stack.push(start as u32);
        while let Some(index) = stack.pop() {
            piece.push(index);
            weight += priority[index as usize] + 1e-3;
            for &next in samples.neighbours(index as usize) {
                let same_side = seen[next as usize]
                    .as_ref()
                    .is_some_and(|seen| (seen.incidence > 0.0) == (first.incidence > 0.0));
                if same_side && !piece_of[next as usize] {
                    piece_of[next as usize] = true;
                    stack.push(next);
                }
            }
        }
        if piece.len() >= sight.fewest && weight > most {
            most = weight;
            best = piece;
        }
    }
    best.sort_unstable();
    let members = unfolded(best, &seen, sight, samples.sparsity);
    Region {
        incidence: members
            .iter()
            .filter_map(|&index| seen[index as usize].as_ref())
            .map(|seen| seen.incidence.abs() as f32)
            .collect(),
        members,
    }
}

/// A sample as it is seen from a centre.
struct Seen {
    direction: Vector3<f64>,
    distance: f64,
    /// u·n.
    incidence: f64,
}

impl Seen {
    fn new(point: &SurfacePoint, centre: &Point3<f64>, sight: &Sight) -> Option<Self> {
        let offset = point.position - centre;
        let squared = offset.norm_squared();
        if squared >= sight.reach * sight.reach || squared <= sight.nearest * sight.nearest {
            return None;
        }
        let distance = squared.sqrt();
        let direction = offset / distance;
        let incidence = direction.dot(&point.normal);
        (incidence.abs() > sight.incidence).then_some(Self {
            direction,
            distance,
            incidence,
        })
    }
}

/// Those of `piece` that contradict at most two of their six neighbours in direction.
fn unfolded(piece: Vec<u32>, seen: &[Option<Seen>], sight: &Sight, sparsity: f64) -> Vec<u32> {
    let all: Vec<&Seen> = piece
        .iter()
        .filter_map(|&index| seen[index as usize].as_ref())
        .collect();
    if all.len() <= FOLD_NEIGHBOURS + 2 {
        return piece;
    }
    let directions: Vec<[f64; 3]> = all.iter().map(|seen| seen.direction.into()).collect();
    let tree = NearestPoints::new(&directions);
    let sine = (1.0 - sight.incidence * sight.incidence).sqrt();
    let slope = sine / sight.incidence * FOLD_SLOPE;
    piece
        .into_iter()
        .zip(&all)
        .zip(&directions)
        .filter(|((_, own), direction)| {
            let contradictions = tree
                .nearest(direction, FOLD_NEIGHBOURS + 1)
                .filter(|near| {
                    let other = all[near.index].distance;
                    let allowed = slope * near.distance * other.max(own.distance);
                    (other - own.distance).abs() > allowed + FOLD_SLACK * sparsity
                })
                .count();
            contradictions <= FOLD_LIMIT
        })
        .map(|((index, _), _)| index)
        .collect()
}
