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
