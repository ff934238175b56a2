//! Points spread evenly over all faces of a mesh: Poisson-disk points by sample elimination.
//!
//! Owns the candidates and which of them stay. Faces that no camera sees are sampled like any other;
//! what cameras see is `surface::sample`'s work.
//!
//! Reference: C. Yuksel, Sample elimination for generating Poisson disk sample sets, 2015.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use kiddo::{ImmutableKdTree, SquaredEuclidean};
use nalgebra::{Point3, Vector3};
use rand::RngExt;
use rayon::prelude::*;

use super::mesh::Mesh;
use super::near::NearestPoints;
use super::sample::SurfacePoint;
use crate::random::{Purpose, stream};

/// Candidates a point, as the paper recommends.
const CANDIDATES: usize = 5;

/// The paper's α: the exponent of a neighbour's weight.
const SHARPNESS: i32 = 8;

/// The paper's β and γ, which bound how much the closest pairs count.
const BETA: f64 = 0.65;
const GAMMA: f64 = 1.5;

/// Draws exactly `count` points, evenly spread on all faces of `mesh`.
///
/// Five times as many candidates, uniform by area, are thinned: the one with the closest company
/// goes, until `count` are left. Distances are straight lines, so that the two sides of a thin sheet
/// thin each other. The same mesh, count and seed give the same points, bit for bit, on any number
/// of threads.
#[must_use]
pub fn sample_poisson(mesh: &Mesh, count: usize, seed: u64) -> Vec<Point3<f64>> {
    let areas = running_areas(mesh);
    let candidates = candidates(mesh, &areas, CANDIDATES * count, seed);
    eliminate(candidates, count, areas.last().copied().unwrap_or(0.0))
}

/// The largest distance that `count` points on a plane of this area can keep from one another: in a
/// hexagonal grid, twice the paper's r_max.
fn largest_spacing(area: f64, count: usize) -> f64 {
    (2.0 * area / (3.0_f64.sqrt() * count as f64)).sqrt()
}

/// The area of the triangles up to and with each.
fn running_areas(mesh: &Mesh) -> Vec<f64> {
    let mut sum = 0.0;
    mesh.triangles()
        .iter()
        .map(|triangle| {
            let (_, [ab, ac]) = sides(mesh, triangle);
            sum += 0.5 * ab.cross(&ac).norm();
            sum
        })
        .collect()
}

/// A corner, and the sides that leave it.
fn sides(mesh: &Mesh, triangle: &[u32; 3]) -> (Point3<f64>, [Vector3<f64>; 2]) {
    let [a, b, c] = triangle.map(|index| mesh.vertices()[index as usize]);
    (a, [b - a, c - a])
}

/// Points uniform by area.
fn candidates(mesh: &Mesh, areas: &[f64], count: usize, seed: u64) -> Vec<Point3<f64>> {
    let mut rng = stream(seed, Purpose::PoissonDisks, 0);
    let total = areas.last().copied().unwrap_or(0.0);
    (0..count)
        .map(|_| {
            let target = rng.random::<f64>() * total;
            let index = areas.partition_point(|area| *area <= target);
            let triangle = &mesh.triangles()[index.min(areas.len() - 1)];
            let (corner, [ab, ac]) = sides(mesh, triangle);
            let [s, t]: [f64; 2] = rng.random();
            // The root spreads points evenly between the corner and the side opposite.
            let s = s.sqrt();
            corner + ab * (s * (1.0 - t)) + ac * (s * t)
        })
        .collect()
}

/// Removes the candidate of the largest weight until `count` are left; of equals, the first.
fn eliminate(candidates: Vec<Point3<f64>>, count: usize, area: f64) -> Vec<Point3<f64>> {
    let kept = survivors(&candidates, count, area);
    candidates
        .into_iter()
        .zip(kept)
        .filter_map(|(point, kept)| kept.then_some(point))
        .collect()
}

/// `count` of `points` that are spread evenly over what they lie on, and the others, both in their
/// order.
#[must_use]
pub fn thin(points: Vec<SurfacePoint>, count: usize) -> (Vec<SurfacePoint>, Vec<SurfacePoint>) {
    if points.len() <= count {
        return (points, Vec::new());
    }
    let positions: Vec<Point3<f64>> = points.iter().map(|p| p.position).collect();
    let kept = survivors(&positions, count, estimated_area(&positions));
    let mut kept = kept.into_iter();
    points
        .into_iter()
        .partition(|_| kept.next().unwrap_or(false))
}

/// Of the surface that points lie on: each stands for an eighth of the disk that reaches to its eighth
/// neighbour.
fn estimated_area(points: &[Point3<f64>]) -> f64 {
    const NEIGHBOURS: usize = 8;
    let coordinates: Vec<[f64; 3]> = points.iter().map(|p| p.coords.into()).collect();
    let tree = NearestPoints::new(&coordinates);
    let shares: Vec<f64> = coordinates
        .par_iter()
        .map(|point| {
            let farthest = tree.nearest(point, NEIGHBOURS + 1).last();
            farthest.map_or(0.0, |near| {
                std::f64::consts::PI * near.distance * near.distance / NEIGHBOURS as f64
            })
        })
        .collect();
    shares.iter().sum()
}

/// Whether each candidate is left.
fn survivors(candidates: &[Point3<f64>], count: usize, area: f64) -> Vec<bool> {
    let coordinates: Vec<[f64; 3]> = candidates.iter().map(|p| p.coords.into()).collect();
    let Ok(tree) = ImmutableKdTree::<f64, 3>::new_from_slice(&coordinates) else {
        return vec![false; candidates.len()];
    };
    let reach = largest_spacing(area, count.max(1));
    let thinning = count as f64 / candidates.len().max(1) as f64;
    let closest = reach * BETA * (1.0 - libm::pow(thinning, GAMMA));
    let weight = |squared: f64| {
        let distance = squared.sqrt().max(closest).min(reach);
        (1.0 - distance / reach).powi(SHARPNESS)
    };
    let company = |index: usize| {
        let mut near: Vec<(usize, f64)> = tree
            .query(&coordinates[index])
            .within::<SquaredEuclidean<f64>>(reach * reach)
            .unsorted()
            .execute()
            .into_iter()
            .map(|found| (found.item as usize, weight(found.distance)))
            .filter(|(other, _)| *other != index)
            .collect();
        // Sums must not depend on how the tree was walked.
        near.sort_unstable_by_key(|(other, _)| *other);
        near
    };
    let mut weights: Vec<f64> = (0..candidates.len())
        .into_par_iter()
        .map(|index| company(index).iter().map(|(_, weight)| weight).sum())
        .collect();
    // An entry whose weight has fallen since is stale and passed over.
    let entry = |weight: f64, index: usize| (weight.max(0.0).to_bits(), Reverse(index));
    let mut heap: BinaryHeap<(u64, Reverse<usize>)> = weights
        .iter()
        .enumerate()
        .map(|(index, weight)| entry(*weight, index))
        .collect();
    let mut kept = vec![true; candidates.len()];
    let mut left = candidates.len();
    while left > count {
        let Some((bits, Reverse(index))) = heap.pop() else {
            break;
        };
        if !kept[index] || entry(weights[index], index).0 != bits {
            continue;
        }
        kept[index] = false;
        left -= 1;
        for (other, weight) in company(index) {
            if kept[other] {
                weights[other] -= weight;
                heap.push(entry(weights[other], other));
            }
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::RayCaster;

    /// A square plate of side 2 that hides a smaller one of side 1 below it, both cut unevenly.
    fn plates() -> Mesh {
        let vertices = [
            [-1.0, -1.0, 0.1],
            [1.0, -1.0, 0.1],
            [1.0, 1.0, 0.1],
            [-1.0, 1.0, 0.1],
            [-0.5, -0.5, -0.4],
            [0.5, -0.5, -0.4],
            [0.5, 0.5, -0.4],
            [-0.5, 0.5, -0.4],
            [-0.9, -1.0, 0.1],
        ];
        let triangles = vec![[0, 8, 3], [8, 1, 2], [8, 2, 3], [4, 5, 6], [4, 6, 7]];
        Mesh::new(vertices.map(Point3::from).to_vec(), triangles).unwrap()
    }

    fn nearest_distances(points: &[Point3<f64>]) -> Vec<f64> {
        points
            .iter()
            .enumerate()
            .map(|(index, point)| {
                let others = points
                    .iter()
                    .enumerate()
                    .filter(|(other, _)| *other != index);
                others
                    .map(|(_, other)| (point - other).norm())
                    .fold(f64::INFINITY, f64::min)
            })
            .collect()
    }

    #[test]
    fn exactly_the_wanted_number_of_points_lies_on_the_mesh() {
        let mesh = plates();
        let caster = RayCaster::new(&mesh);
        for count in [0, 1, 2, 777] {
            let points = sample_poisson(&mesh, count, 1);
            assert_eq!(points.len(), count);
            assert!(points.iter().all(|point| caster.distance(point) < 1e-12));
        }
    }

    #[test]
    fn points_keep_their_distance_from_one_another() {
        let mesh = plates();
        let count = 2000;
        let points = sample_poisson(&mesh, count, 2);
        let largest = largest_spacing(5.0, count);
        let nearest = nearest_distances(&points);
        let least = nearest.iter().copied().fold(f64::INFINITY, f64::min);
        let mean = nearest.iter().sum::<f64>() / count as f64;
        // The paper reports about 0.7 to 0.8 of the largest possible; independent points would have
        // a least distance near 0 and a mean near 0.47.
        assert!(
            least > 0.6 * largest && least <= largest,
            "{}",
            least / largest
        );
        assert!(mean > 0.75 * largest, "{}", mean / largest);
    }

    #[test]
    fn every_face_gets_its_share_of_the_area() {
        let points = sample_poisson(&plates(), 5000, 3);
        let below = points.iter().filter(|point| point.z < 0.0).count();
        assert!((below as f64 / 5000.0 - 0.2).abs() < 0.01, "{below}");
        let strip = points.iter().filter(|point| point.z > 0.0 && point.x < 0.0);
        assert!((strip.count() as f64 / 5000.0 - 0.4).abs() < 0.01);
    }

    #[test]
    fn seeds_draw_different_points_and_the_number_of_threads_does_not() {
        let mesh = plates();
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            pool.build()
                .unwrap()
                .install(|| sample_poisson(&mesh, 500, 4))
        };
        assert_eq!(with(1), with(3));
        assert_ne!(with(1), sample_poisson(&mesh, 500, 5));
    }

    /// Points of a square of side 1, nine in ten of them in its left half.
    fn uneven(count: usize) -> Vec<SurfacePoint> {
        let mut rng = stream(6, Purpose::Training, 0);
        (0..count)
            .map(|index| {
                let [s, t]: [f64; 2] = rng.random();
                let left = index % 10 != 0;
                let x = if left { 0.5 * s } else { 0.5 + 0.5 * s };
                SurfacePoint {
                    position: Point3::new(x, t, 0.0),
                    normal: Vector3::z_axis(),
                }
            })
            .collect()
    }

    #[test]
    fn what_is_thinned_lies_evenly() {
        let points = uneven(6000);
        let positions = |points: &[SurfacePoint]| -> Vec<Point3<f64>> {
            points.iter().map(|point| point.position).collect()
        };
        let count = 300;
        let (kept, _) = thin(points.clone(), count);
        let nearest = nearest_distances(&positions(&kept));
        let largest = largest_spacing(1.0, count);
        let least = nearest.iter().copied().fold(f64::INFINITY, f64::min);
        // Of as many that are taken as they come, some lie on top of one another.
        let taken = nearest_distances(&positions(&points[..count]));
        let least_taken = taken.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(least > 0.5 * largest, "{}", least / largest);
        assert!(least > 10.0 * least_taken, "{least} {least_taken}");
        let left = kept.iter().filter(|point| point.position.x < 0.5).count();
        assert!((120..=190).contains(&left), "{left}");
    }

    #[test]
    fn what_is_thinned_keeps_its_order_and_its_number() {
        let points = uneven(400);
        for count in [0, 1, 99, 399] {
            let (kept, _) = thin(points.clone(), count);
            assert_eq!(kept.len(), count);
            let mut rest = points.iter();
            assert!(kept.iter().all(|point| {
                rest.any(|other| (other.position, other.normal) == (point.position, point.normal))
            }));
        }
        for enough in [400, 401, 5000] {
            let (kept, _) = thin(points.clone(), enough);
            let same = kept
                .iter()
                .zip(&points)
                .all(|(a, b)| a.position == b.position);
            assert!(same && kept.len() == points.len());
        }
        assert!(thin(Vec::new(), 3).0.is_empty());
    }
}
