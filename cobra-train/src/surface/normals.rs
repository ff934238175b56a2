//! Normals of points that come without: of a cloud, or of points drawn on faces whose own normals
//! say nothing of inside and outside.
//!
//! Owns the fit of a plane to each point's neighbours, and one orientation for all of them, which is
//! passed on from neighbour to neighbour, first where the planes agree best.
//!
//! Reference: H. Hoppe et al., Surface reconstruction from unorganized points, 1992.

use super::near::NearestPoints;
use super::sample::SurfacePoint;
use nalgebra::{Matrix3, Point3, SymmetricEigen, UnitVector3, Vector3};
use rayon::prelude::*;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// How many neighbours a plane is fitted to.
const NEIGHBOURS: usize = 12;

/// The points with a normal each: the direction of least spread among the 12 nearest points, turned
/// outward at the point that lies farthest from the middle, and elsewhere as its neighbours'.
///
/// Where points are too few for a plane, the normal points away from their middle. Separate pieces
/// are oriented separately. The same points in the same order give the same bits.
#[must_use]
pub fn with_estimated_normals(points: &[Point3<f64>]) -> Vec<SurfacePoint> {
    let neighbours = neighbours(points);
    let mut normals: Vec<UnitVector3<f64>> = neighbours
        .par_iter()
        .enumerate()
        .map(|(index, near)| plane_normal(points, index, near))
        .collect();
    orient(points, &neighbours, &mut normals);
    points
        .iter()
        .zip(normals)
        .map(|(position, normal)| SurfacePoint {
            position: *position,
            normal,
        })
        .collect()
}

fn neighbours(points: &[Point3<f64>]) -> Vec<Vec<u32>> {
    let coordinates: Vec<[f64; 3]> = points.iter().map(|p| (*p).into()).collect();
    let tree = NearestPoints::new(&coordinates);
    coordinates
        .par_iter()
        .map(|point| {
            let near = tree.nearest(point, NEIGHBOURS + 1);
            near.map(|near| near.index as u32).collect()
        })
        .collect()
}

fn plane_normal(points: &[Point3<f64>], index: usize, near: &[u32]) -> UnitVector3<f64> {
    let mut middle = Vector3::zeros();
    for &other in near {
        middle += points[other as usize].coords;
    }
    middle /= near.len().max(1) as f64;
    let mut scatter = Matrix3::zeros();
    for &other in near {
        let offset = points[other as usize].coords - middle;
        scatter += offset * offset.transpose();
    }
    let eigen = SymmetricEigen::new(scatter);
    let least = eigen.eigenvalues.imin();
    let normal = eigen.eigenvectors.column(least).into_owned();
    UnitVector3::try_new(normal, 0.5)
        .or_else(|| UnitVector3::try_new(points[index].coords, 0.0))
        .unwrap_or_else(Vector3::z_axis)
}

/// Prim's minimum spanning tree over the neighbours, of weight 1 − |nᵢ·nⱼ|.
fn orient(points: &[Point3<f64>], neighbours: &[Vec<u32>], normals: &mut [UnitVector3<f64>]) {
    let count = points.len();
    let mut edges = vec![Vec::new(); count];
    for (index, near) in neighbours.iter().enumerate() {
        for &other in near {
            edges[index].push(other);
            edges[other as usize].push(index as u32);
        }
    }
    let middle = points.iter().map(|p| p.coords).sum::<Vector3<f64>>() / count.max(1) as f64;
    let mut outermost: Vec<usize> = (0..count).collect();
    let reach = |index: &usize| (points[*index].coords - middle).norm_squared();
    outermost.sort_by(|a, b| reach(b).total_cmp(&reach(a)).then(a.cmp(b)));
    let mut done = vec![false; count];
    for root in outermost {
        if done[root] {
            continue;
        }
        if normals[root].dot(&(points[root].coords - middle)) < 0.0 {
            normals[root] = -normals[root];
        }
        // A non-negative float's bits are in its order.
        let mut heap = BinaryHeap::from([Reverse((0_u64, root as u32, root as u32))]);
        while let Some(Reverse((_, index, from))) = heap.pop() {
            let (index, from) = (index as usize, from as usize);
            if done[index] {
                continue;
            }
            done[index] = true;
            if normals[index].dot(&normals[from]) < 0.0 {
                normals[index] = -normals[index];
            }
            for &next in &edges[index] {
                if !done[next as usize] {
                    let bend = 1.0 - normals[index].dot(&normals[next as usize]).abs();
                    heap.push(Reverse((bend.max(0.0).to_bits(), next, index as u32)));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sphere(count: usize) -> Vec<Point3<f64>> {
        (0..count)
            .map(|i| {
                let height = 1.0 - 2.0 * (i as f64 + 0.5) / count as f64;
                let turn = 2.399_963 * i as f64;
                let width = (1.0 - height * height).sqrt();
                Point3::new(width * turn.cos(), width * turn.sin(), height)
            })
            .collect()
    }

    #[test]
    fn a_spheres_normals_point_outward_everywhere() {
        for point in with_estimated_normals(&sphere(2000)) {
            assert!(point.normal.dot(&point.position.coords) > 0.99);
        }
    }

    #[test]
    fn a_shell_has_normals_of_both_sides() {
        // The inner wall of a thick shell is a piece of its own; its normals agree among themselves.
        let mut points = sphere(2000);
        points.extend(sphere(1000).iter().map(|p| p * 0.6));
        let found = with_estimated_normals(&points);
        let inner = &found[2000..];
        let side = |p: &SurfacePoint| p.normal.dot(&p.position.coords) > 0.0;
        assert!(inner.iter().all(|p| side(p) == side(&inner[0])));
    }

    #[test]
    fn a_handful_of_points_has_normals_as_well() {
        for count in 0..6 {
            let points: Vec<_> = (0..count)
                .map(|i| Point3::new(f64::from(i), 0.0, 0.0))
                .collect();
            assert_eq!(with_estimated_normals(&points).len(), points.len());
        }
    }
}
