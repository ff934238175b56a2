//! First hits of rays on a mesh.

use nalgebra::{Point3, UnitVector3, Vector3};
use parry3d_f64::math::Vector;
use parry3d_f64::query::{Ray, RayCast};
use parry3d_f64::shape::TriMesh;

use super::Mesh;

/// Finds where rays first meet a mesh.
pub struct RayCaster {
    shape: TriMesh,
}

/// Where a ray first meets the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance from the ray's origin.
    pub distance: f64,
    /// The point on the surface.
    pub point: Point3<f64>,
    /// The triangle's normal.
    pub normal: UnitVector3<f64>,
    /// The triangle.
    pub triangle: u32,
}

impl RayCaster {
    /// Prepares a mesh for ray casting.
    #[must_use]
    pub fn new(mesh: &Mesh) -> Self {
        let vertices = mesh
            .vertices()
            .iter()
            .map(|v| Vector::new(v.x, v.y, v.z))
            .collect();
        Self {
            shape: TriMesh::new(vertices, mesh.triangles().to_vec()).expect("a mesh has triangles"),
        }
    }

    /// The first hit of a ray.
    #[must_use]
    pub fn cast(&self, origin: &Point3<f64>, direction: &Vector3<f64>) -> Option<Hit> {
        let direction = direction.normalize();
        let ray = Ray::new(
            Vector::new(origin.x, origin.y, origin.z),
            Vector::new(direction.x, direction.y, direction.z),
        );
        let hit = self
            .shape
            .cast_local_ray_and_get_normal(&ray, f64::MAX, false)?;
        Some(Hit {
            distance: hit.time_of_impact,
            point: origin + direction * hit.time_of_impact,
            normal: UnitVector3::new_normalize(Vector3::new(
                hit.normal.x,
                hit.normal.y,
                hit.normal.z,
            )),
            triangle: 0,
        })
    }
}
