//! What a mesh and a cloud ask of their points alike: usable coordinates, and the sphere around
//! them.
//!
//! Owns the largest coordinate and the sphere that normalises an object. The diameter is
//! `surface::diameter`'s.

use nalgebra::Point3;

/// The largest coordinate that is accepted, in the file's unit: areas are squared, and the square
/// must stay finite.
const MAX_COORDINATE: f64 = 1e60;

/// A coordinate that nothing can be computed with.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CoordinateError {
    /// A coordinate is NaN or infinite.
    #[error("vertex {index} is not finite: ({x}, {y}, {z})")]
    NotFinite {
        /// The vertex, counted from 0.
        index: usize,
        /// Its x coordinate.
        x: f64,
        /// Its y coordinate.
        y: f64,
        /// Its z coordinate.
        z: f64,
    },
    /// A coordinate is too large to be squared twice without overflow.
    #[error(
        "vertex {index} has the coordinate {coordinate:e}: at most {MAX_COORDINATE:e} is expected"
    )]
    TooFar {
        /// The vertex, counted from 0.
        index: usize,
        /// The coordinate.
        coordinate: f64,
    },
}

/// Finds the first point that is not finite or too far away.
pub(super) fn check_coordinates(points: &[Point3<f64>]) -> Result<(), CoordinateError> {
    for (index, point) in points.iter().enumerate() {
        if !point.iter().all(|c| c.is_finite()) {
            return Err(CoordinateError::NotFinite {
                index,
                x: point.x,
                y: point.y,
                z: point.z,
            });
        }
        if let Some(&coordinate) = point.iter().find(|c| c.abs() > MAX_COORDINATE) {
            return Err(CoordinateError::TooFar { index, coordinate });
        }
    }
    Ok(())
}

/// The sphere that normalises an object: the centre of its bounding box, and the distance to the
/// farthest vertex from there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundingSphere {
    /// Centre, in the object's unit.
    pub centre: Point3<f64>,
    /// Radius, in the object's unit.
    pub radius: f64,
}

impl BoundingSphere {
    /// Around at least one point, as the paper's data preparation does it; around none, a point
    /// at the origin.
    pub(super) fn around<'a>(points: impl Iterator<Item = &'a Point3<f64>> + Clone) -> Self {
        let first = points.clone().next().copied().unwrap_or_default();
        let (low, high) = points
            .clone()
            .fold((first, first), |(low, high), v| (low.inf(v), high.sup(v)));
        let centre = nalgebra::center(&low, &high);
        let radius = points.map(|v| (v - centre).norm()).fold(0.0, f64::max);
        Self { centre, radius }
    }

    /// From the object's frame to the unit sphere.
    #[must_use]
    pub fn normalise(&self, point: &Point3<f64>) -> Point3<f64> {
        Point3::from((point - self.centre) / self.radius)
    }

    /// From the unit sphere to the object's frame.
    #[must_use]
    pub fn denormalise(&self, point: &Point3<f64>) -> Point3<f64> {
        self.centre + point.coords * self.radius
    }
}
