//! The points that lie nearest to a place.
//!
//! Owns the few questions that this crate asks a k-d tree; the tree is `kiddo`'s.

use kiddo::{ImmutableKdTree, SquaredEuclidean};
use std::num::NonZeroUsize;

/// A k-d tree over points that stay as they are.
pub(crate) struct NearestPoints {
    tree: Option<ImmutableKdTree<f64, 3>>,
}

/// A point of the tree.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Near {
    /// Its index among the points that the tree was built from.
    pub(crate) index: usize,
    /// How far it lies from the place that was asked about.
    pub(crate) distance: f64,
}

impl NearestPoints {
    pub(crate) fn new(points: &[[f64; 3]]) -> Self {
        Self {
            // A tree of no points answers no question.
            tree: (!points.is_empty())
                .then(|| ImmutableKdTree::new_from_slice(points).ok())
                .flatten(),
        }
    }

    /// The `count` nearest points, the nearest first; fewer where there are fewer.
    pub(crate) fn nearest(&self, place: &[f64; 3], count: usize) -> impl Iterator<Item = Near> {
        let found = self.tree.as_ref().zip(NonZeroUsize::new(count));
        found.into_iter().flat_map(move |(tree, count)| {
            tree.query(place)
                .nearest_n::<SquaredEuclidean<f64>>(count)
                .execute()
                .into_iter()
                .map(|found| Near {
                    index: found.item as usize,
                    distance: found.distance.sqrt(),
                })
        })
    }

    /// How far the nearest point lies; infinitely far where there is none.
    pub(crate) fn distance(&self, place: &[f64; 3]) -> f64 {
        self.tree.as_ref().map_or(f64::INFINITY, |tree| {
            tree.query(place)
                .nearest_one::<SquaredEuclidean<f64>>()
                .execute()
                .distance
                .sqrt()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_come_first_and_never_more_than_there_are() {
        let line: Vec<[f64; 3]> = (0..10).map(|i| [f64::from(i * i), 2.0, 0.0]).collect();
        let tree = NearestPoints::new(&line);
        let found = |count| -> Vec<(usize, f64)> {
            tree.nearest(&[4.5, 2.0, 0.0], count)
                .map(|near| (near.index, near.distance))
                .collect()
        };
        assert_eq!(found(0), []);
        assert_eq!(found(2), [(2, 0.5), (1, 3.5)]);
        assert_eq!(found(100).len(), 10);
        assert_eq!(tree.distance(&[4.0, 2.0, 3.0]), 3.0);
    }

    #[test]
    fn of_no_points_nothing_is_near() {
        let tree = NearestPoints::new(&[]);
        assert_eq!(tree.nearest(&[0.0; 3], 5).count(), 0);
        assert!(tree.distance(&[0.0; 3]).is_infinite());
    }

    #[test]
    fn points_in_one_plane_and_points_in_one_place_are_found() {
        // k-d trees dislike coordinates that occur often.
        let plane: Vec<[f64; 3]> = (0..2500)
            .map(|i| [f64::from(i % 50), f64::from(i / 50), 0.0])
            .collect();
        let tree = NearestPoints::new(&plane);
        for (index, point) in plane.iter().enumerate() {
            let nearest = tree.nearest(point, 5).next().map(|near| near.index);
            assert_eq!(nearest, Some(index));
        }
        let same = NearestPoints::new(&[[1.0, 2.0, 3.0]; 500]);
        assert_eq!(same.nearest(&[1.0, 2.0, 3.0], 40).count(), 40);
        assert_eq!(same.distance(&[1.0, 2.0, 4.0]), 1.0);
    }
}
