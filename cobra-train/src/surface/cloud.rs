//! The point cloud as the trainer sees it: validated once, then trusted.
//!
//! Owns the checks that make a list of points an object, and its division into training and test
//! points. Unlike a mesh, a cloud is not sampled: its points are the surface, as far as it is
//! known. Reading files is `surface::read`'s work.

use std::collections::HashSet;

use nalgebra::Point3;
use rand::seq::SliceRandom;

use super::bounds::{BoundingSphere, CoordinateError, check_coordinates};
use super::diameter::diameter;
use crate::random::{Purpose, stream};

/// Fewer distinct points than this are no object.
const FEWEST_POINTS: usize = 10;

/// Distinct points on an object's surface: at least 10, all finite, and not all in one place.
#[derive(Clone, Debug, PartialEq)]
pub struct PointCloud {
    points: Vec<Point3<f64>>,
    dropped: usize,
}

/// Why a list of points is no point cloud.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CloudError {
    /// A coordinate cannot be computed with.
    #[error(transparent)]
    Coordinate(#[from] CoordinateError),
    /// There are too few points.
    #[error(
        "{distinct} distinct points among {given}: without faces, at least {FEWEST_POINTS} are \
         needed"
    )]
    TooFew {
        /// How many points differ.
        distinct: usize,
        /// How many were given.
        given: usize,
    },
    /// The points are so close together that their distances vanish.
    #[error("all {given} points coincide: the cloud has no extent")]
    NoExtent {
        /// How many points were given.
        given: usize,
    },
}

/// A cloud's points, divided by [`PointCloud::split`].
#[derive(Clone, Debug, PartialEq)]
pub struct SplitCloud {
    /// What a template is fitted to.
    pub training: Vec<Point3<f64>>,
    /// What σ̂ is measured on; none of the training points.
    pub test: Vec<Point3<f64>>,
}

impl PointCloud {
    /// Checks the points and keeps each once, in the order of their first mention; what repeats an
    /// earlier point exactly is dropped and counted ([`PointCloud::dropped_duplicates`]).
    ///
    /// # Errors
    /// [`CloudError`]: a coordinate that is not finite or too large, fewer than 10 distinct
    /// points, or points without extent.
    pub fn new(mut points: Vec<Point3<f64>>) -> Result<Self, CloudError> {
        check_coordinates(&points)?;
        let given = points.len();
        let mut seen = HashSet::with_capacity(given);
        // Adding zero makes -0 and 0 the same.
        points.retain(|p| seen.insert(<[f64; 3]>::from(*p).map(|c| (c + 0.0).to_bits())));
        let extent = BoundingSphere::around(points.iter()).radius;
        if given >= FEWEST_POINTS && extent <= 0.0 {
            return Err(CloudError::NoExtent { given });
        }
        if points.len() < FEWEST_POINTS {
            let distinct = points.len();
            return Err(CloudError::TooFew { distinct, given });
        }
        Ok(Self {
            dropped: given - points.len(),
            points,
        })
    }

    /// The points, in the file's unit.
    #[must_use]
    pub fn points(&self) -> &[Point3<f64>] {
        &self.points
    }

    /// How many points were dropped because they repeat another.
    #[must_use]
    pub fn dropped_duplicates(&self) -> usize {
        self.dropped
    }

    /// Centre of the bounding box and the distance to the farthest point from there, as
    /// [`super::Mesh::bounding_sphere`].
    #[must_use]
    pub fn bounding_sphere(&self) -> BoundingSphere {
        BoundingSphere::around(self.points.iter())
    }

    /// The largest distance between two points (BOP's `diameter`), exact.
    #[must_use]
    pub fn diameter(&self) -> f64 {
        diameter(self.points.clone())
    }

    /// The same cloud, moved and scaled so that `sphere` becomes the unit sphere at the origin.
    #[must_use]
    pub fn normalised(&self, sphere: &BoundingSphere) -> Self {
        Self {
            points: self.points.iter().map(|p| sphere.normalise(p)).collect(),
            dropped: self.dropped,
        }
    }

    /// Divides the cloud into training and test points, in random order and without overlap.
    ///
    /// Of n points, the training gets as many as wanted, but at most 3n/4, rounded down; the test
    /// gets as many as wanted of the rest. Each gets at least one, even where none is wanted.
    /// The same cloud, numbers and seed give the same points in the same order; the stream is
    /// [`Purpose::CloudSplit`].
    #[must_use]
    pub fn split(&self, training_wanted: usize, test_wanted: usize, seed: u64) -> SplitCloud {
        let mut training = self.shuffled(seed);
        let most = self.most_training_points();
        let mut test = training.split_off(training_wanted.clamp(1, most));
        test.truncate(test_wanted.max(1));
        SplitCloud { training, test }
    }

    /// At most `wanted` points, at least one, that no [`PointCloud::split`] with this seed gives to
    /// the training, however many it wants.
    #[must_use]
    pub fn test_points(&self, wanted: usize, seed: u64) -> Vec<Point3<f64>> {
        let mut test = self.shuffled(seed).split_off(self.most_training_points());
        test.truncate(wanted.max(1));
        test
    }

    fn shuffled(&self, seed: u64) -> Vec<Point3<f64>> {
        let mut points = self.points.clone();
        points.shuffle(&mut stream(seed, Purpose::CloudSplit, 0));
        points
    }

    /// 3n/4, rounded down.
    fn most_training_points(&self) -> usize {
        let count = self.points.len();
        count / 4 * 3 + count % 4 * 3 / 4
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(count: usize) -> Vec<Point3<f64>> {
        (0..count)
            .map(|i| Point3::new(i as f64, 0.0, 0.0))
            .collect()
    }

    fn bits(points: &[Point3<f64>]) -> HashSet<u64> {
        points.iter().map(|p| p.x.to_bits()).collect()
    }

    #[test]
    fn what_is_no_object_is_refused() {
        let few = PointCloud::new([line(9), line(9)].concat()).unwrap_err();
        let (distinct, given) = (9, 18);
        assert_eq!(few, CloudError::TooFew { distinct, given });
        let one = PointCloud::new(vec![Point3::new(1.0, 2.0, 3.0); 40]).unwrap_err();
        assert_eq!(one, CloudError::NoExtent { given: 40 });
        let close = line(20).iter().map(|p| p * 1e-200).collect();
        let close = PointCloud::new(close).unwrap_err();
        assert_eq!(close, CloudError::NoExtent { given: 20 });
        assert_eq!(
            PointCloud::new(vec![]).unwrap_err().to_string(),
            "0 distinct points among 0: without faces, at least 10 are needed"
        );
        for bad in [f64::NAN, f64::INFINITY, -1e61] {
            let mut points = line(20);
            points[7].z = bad;
            let error = PointCloud::new(points).unwrap_err();
            assert!(error.to_string().contains("vertex 7"), "{error}");
        }
    }

    #[test]
    fn exact_duplicates_are_dropped_and_counted() {
        let mut points = [line(12), line(5)].concat();
        points.push(Point3::new(-0.0, -0.0, 0.0));
        let cloud = PointCloud::new(points).unwrap();
        assert_eq!(cloud.points(), line(12));
        assert_eq!(cloud.dropped_duplicates(), 6);
    }

    #[test]
    fn sphere_and_diameter_are_those_of_the_points() {
        let cloud = PointCloud::new(line(11)).unwrap();
        let sphere = cloud.bounding_sphere();
        assert_eq!(sphere.centre, Point3::new(5.0, 0.0, 0.0));
        assert_eq!((sphere.radius, cloud.diameter()), (5.0, 10.0));
        let unit = cloud.normalised(&sphere).bounding_sphere();
        assert_eq!((unit.centre, unit.radius), (Point3::origin(), 1.0));
    }

    #[test]
    fn test_points_are_in_no_training_of_the_same_seed() {
        let cloud = PointCloud::new(line(103)).unwrap();
        let test = bits(&cloud.test_points(usize::MAX, 5));
        assert_eq!(test.len(), 26);
        for wanted in [1, 40, 1000] {
            let training = bits(&cloud.split(wanted, 10, 5).training);
            assert!(training.is_disjoint(&test));
        }
    }

    #[test]
    fn training_and_test_points_are_disjoint_and_the_rest_of_the_cloud() {
        let cloud = PointCloud::new(line(101)).unwrap();
        let split = cloud.split(10_000, 30_000, 3);
        assert_eq!((split.training.len(), split.test.len()), (75, 26));
        let (training, test) = (bits(&split.training), bits(&split.test));
        assert!(training.is_disjoint(&test));
        assert_eq!(training.len() + test.len(), 101);
    }

    #[test]
    fn no_more_points_are_handed_out_than_wanted_and_never_none() {
        let cloud = PointCloud::new(line(10)).unwrap();
        for (wanted, got) in [
            ((4, 3), (4, 3)),
            ((0, 0), (1, 1)),
            ((8, 8), (7, 3)),
            ((1, usize::MAX), (1, 9)),
        ] {
            let split = cloud.split(wanted.0, wanted.1, 0);
            assert_eq!((split.training.len(), split.test.len()), got);
        }
    }

    #[test]
    fn the_seed_decides_the_split() {
        let cloud = PointCloud::new(line(200)).unwrap();
        assert_eq!(cloud.split(50, 50, 1), cloud.split(50, 50, 1));
        assert_ne!(cloud.split(50, 50, 1), cloud.split(50, 50, 2));
    }
}
