//! What a file describes: a mesh, or a cloud of points.
//!
//! Owns what both have in common, and the move into the unit sphere. What each must fulfil is
//! [`Mesh::new`]'s and [`PointCloud::new`]'s business.

use super::bounds::BoundingSphere;
use super::cloud::PointCloud;
use super::mesh::Mesh;

/// An object's surface, as faces or as points.
#[derive(Clone, Debug, PartialEq)]
pub enum Geometry {
    /// Faces, which rays can hit.
    Mesh(Mesh),
    /// Points, which is all that is known.
    Cloud(PointCloud),
}

impl Geometry {
    /// Centre of the bounding box and the distance to the farthest vertex from there, in the
    /// file's unit.
    #[must_use]
    pub fn bounding_sphere(&self) -> BoundingSphere {
        match self {
            Self::Mesh(mesh) => mesh.bounding_sphere(),
            Self::Cloud(cloud) => cloud.bounding_sphere(),
        }
    }

    /// The largest distance between two points, in the file's unit.
    #[must_use]
    pub fn diameter(&self) -> f64 {
        match self {
            Self::Mesh(mesh) => mesh.diameter(),
            Self::Cloud(cloud) => cloud.diameter(),
        }
    }

    /// Moves the bounding sphere's centre to the origin and scales the radius to 1. The sphere
    /// that is returned is the one before: it takes points there ([`BoundingSphere::normalise`])
    /// and back.
    #[must_use]
    pub fn into_unit_sphere(self) -> (Self, BoundingSphere) {
        let sphere = self.bounding_sphere();
        let moved = match self {
            Self::Mesh(mesh) => Self::Mesh(mesh.normalised(&sphere)),
            Self::Cloud(cloud) => Self::Cloud(cloud.normalised(&sphere)),
        };
        (moved, sphere)
    }
}

impl From<Mesh> for Geometry {
    fn from(mesh: Mesh) -> Self {
        Self::Mesh(mesh)
    }
}

impl From<PointCloud> for Geometry {
    fn from(cloud: PointCloud) -> Self {
        Self::Cloud(cloud)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;

    #[test]
    fn into_the_unit_sphere_and_back() {
        let corners = vec![
            Point3::new(10.0, 0.0, 0.0),
            Point3::new(14.0, 0.0, 0.0),
            Point3::new(10.0, 3.0, 0.0),
        ];
        let mesh = Mesh::new(corners.clone(), vec![[0, 1, 2]]).unwrap();
        let grid = (0..27).map(|i| Point3::new((i % 3) as f64, (i / 3 % 3) as f64, (i / 9) as f64));
        let cloud = PointCloud::new(grid.collect()).unwrap();
        for geometry in [Geometry::from(mesh), Geometry::from(cloud)] {
            let before = geometry.bounding_sphere();
            let diameter = geometry.diameter();
            let (unit, sphere) = geometry.into_unit_sphere();
            assert_eq!(sphere, before);
            assert!((unit.bounding_sphere().radius - 1.0).abs() < 1e-15);
            assert!(unit.bounding_sphere().centre.coords.norm() < 1e-15);
            assert!((unit.diameter() * sphere.radius - diameter).abs() < 1e-12);
            let there = sphere.normalise(&corners[1]);
            assert!((sphere.denormalise(&there) - corners[1]).norm() < 1e-12);
        }
    }
}
