//! Which cluster a point belongs to.
//!
//! Owns the one rule: the smallest (P − C_k)ᵀ Q_k (P − C_k), the first of equals. It is Eq. 8's
//! largest weight. Training sorts its points by it; `cobra_infer::Mixture` is the scorer's side.

use super::Cluster;
use nalgebra::Point3;
use rayon::prelude::*;

/// The index of the cluster that each point belongs to; 0 where there is no cluster.
///
/// Between clusters without a shape that is the nearest centre.
#[must_use]
pub fn assign(points: &[Point3<f64>], clusters: &[Cluster]) -> Vec<usize> {
    points
        .par_iter()
        .map(|point| {
            let distance = |cluster: &Cluster| cluster.squared_distance(point);
            least(clusters, distance).0
        })
        .collect()
}

/// The points of each cluster, in their order.
#[must_use]
pub fn members(points: &[Point3<f64>], clusters: &[Cluster]) -> Vec<Vec<Point3<f64>>> {
    let mut members = vec![Vec::new(); clusters.len()];
    if !clusters.is_empty() {
        for (point, label) in points.iter().zip(assign(points, clusters)) {
            members[label].push(*point);
        }
    }
    members
}

/// For each point the index of the nearest centre and the squared distance to it; the first of
/// equals.
///
/// Points go through in groups, for each of which the compiler makes vectors; k-means does little
/// else than this.
pub(super) fn nearest_to_each(
    points: &[Point3<f64>],
    centres: &[Point3<f64>],
) -> Vec<(usize, f64)> {
    const GROUP: usize = 4;
    let (groups, rest) = points.as_chunks::<GROUP>();
    let mut found = Vec::with_capacity(points.len());
    for group in groups {
        let mut indices = [0; GROUP];
        let mut least = [f64::INFINITY; GROUP];
        for (index, centre) in centres.iter().enumerate() {
            let squared = group.map(|point| (point - centre).norm_squared());
            for ((best, least), squared) in indices.iter_mut().zip(&mut least).zip(squared) {
                // Both are written every time: a branch could not be foretold.
                let nearer = squared < *least;
                *best = if nearer { index } else { *best };
                *least = if nearer { squared } else { *least };
            }
        }
        found.extend(indices.into_iter().zip(least));
    }
    found.extend(rest.iter().map(|point| {
        let distance = |centre: &Point3<f64>| (point - centre).norm_squared();
        least(centres, distance)
    }));
    found
}

/// The index of the one with the least distance, and that distance; the first of equals.
fn least<T>(among: &[T], distance: impl Fn(&T) -> f64) -> (usize, f64) {
    let mut best = (0, f64::INFINITY);
    for (index, candidate) in among.iter().enumerate() {
        let distance = distance(candidate);
        if distance < best.1 {
            best = (index, distance);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;

    fn cloud(count: u32) -> Vec<Point3<f64>> {
        (0..count)
            .map(|i| {
                let t = f64::from(i);
                Point3::new((t * 0.7).sin(), (t * 1.3).cos(), (t * 0.37).sin())
            })
            .collect()
    }

    #[test]
    fn without_shapes_and_with_identities_the_nearest_centre_is_chosen() {
        let points = cloud(1003);
        let centres = cloud(11);
        let nearest: Vec<usize> = nearest_to_each(&points, &centres)
            .into_iter()
            .map(|(label, _)| label)
            .collect();
        let round: Vec<_> = centres.iter().copied().map(Cluster::round).collect();
        assert_eq!(assign(&points, &round), nearest);
        let shaped: Vec<_> = centres
            .iter()
            .map(|centre| Cluster::shaped(*centre, Matrix3::identity()).unwrap())
            .collect();
        assert_eq!(assign(&points, &shaped), nearest);
    }

    #[test]
    fn a_long_cluster_speaks_for_points_nearer_to_another_centre() {
        let long = Matrix3::from_diagonal(&[0.1, 100.0, 100.0].into());
        let clusters = [
            Cluster::round(Point3::new(2.0, 0.0, 0.0)),
            Cluster::shaped(Point3::origin(), long).unwrap(),
        ];
        let points = [Point3::new(1.5, 0.0, 0.0), Point3::new(1.1, 0.1, 0.0)];
        assert_eq!(assign(&points, &clusters), [1, 0]);
    }

    #[test]
    fn members_are_all_points_in_their_order() {
        let points = cloud(50);
        let clusters: Vec<_> = cloud(3).into_iter().map(Cluster::round).collect();
        let members = members(&points, &clusters);
        assert_eq!(members.iter().map(Vec::len).sum::<usize>(), 50);
        let labels = assign(&points, &clusters);
        for (index, own) in members.iter().enumerate() {
            let expected = points.iter().zip(&labels).filter(|(_, l)| **l == index);
            assert!(own.iter().eq(expected.map(|(point, _)| point)));
        }
        assert_eq!(super::members(&points, &[]), Vec::<Vec<_>>::new());
    }
}
