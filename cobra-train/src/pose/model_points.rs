//! The points of a model that errors of poses are measured on.
//!
//! Owns that the tree over them is built once, however many poses are compared.

use crate::surface::{Geometry, NearestPoints};
use nalgebra::{Isometry3, Point3};

/// A model's points, in the object's frame, and a tree over them.
pub struct ModelPoints {
    points: Vec<Point3<f64>>,
    tree: NearestPoints,
}

impl ModelPoints {
    /// From points in the object's frame, in the unit in which errors are wanted.
    #[must_use]
    pub fn new(points: Vec<Point3<f64>>) -> Self {
        let places: Vec<[f64; 3]> = points.iter().map(|p| (*p).into()).collect();
        Self {
            tree: NearestPoints::new(&places),
            points,
        }
    }

    /// All vertices of a mesh, or all points of a cloud, in the file's unit: those that
    /// `bop_toolkit` measures on, whether or not a face uses them.
    #[must_use]
    pub fn of(geometry: &Geometry) -> Self {
        Self::new(match geometry {
            Geometry::Mesh(mesh) => mesh.vertices().to_vec(),
            Geometry::Cloud(cloud) => cloud.points().to_vec(),
        })
    }

    /// The points.
    #[must_use]
    pub fn points(&self) -> &[Point3<f64>] {
        &self.points
    }

    /// The mean distance of the points, moved, from the nearest of the points where they were.
    pub(super) fn mean_distance_to_nearest(&self, motion: &Isometry3<f64>) -> f64 {
        let distances = self
            .points
            .iter()
            .map(|point| self.tree.distance(&(motion * point).into()));
        distances.sum::<f64>() / self.points.len().max(1) as f64
    }
}
