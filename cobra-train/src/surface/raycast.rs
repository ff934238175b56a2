//! Rays against the mesh, and the distance from a point to it.
//!
//! The only file that knows `parry3d-f64`: its types are converted here, at the edge.

use nalgebra::{Point3, Unit, UnitVector3, Vector3};
use parry3d_f64::math::Vector;
use parry3d_f64::query::{PointQueryWithLocation, Ray, RayCast};
use parry3d_f64::shape::TriMesh;

use super::mesh::Mesh;

/// The triangles of a [`Mesh`] in a hierarchy that finds the first one on a ray.
#[derive(Clone)]
pub struct RayCaster {
    triangles: TriMesh,
}

/// Where a ray meets the mesh first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance from the ray's origin, in the mesh's unit.
    pub distance: f64,
    /// The point on the mesh.
    pub point: Point3<f64>,
    /// The triangle's geometric normal, turned against the ray.
    pub normal: UnitVector3<f64>,
    /// The triangle, as an index into [`Mesh::triangles`].
    pub triangle: u32,
}

/// The point of a mesh that is nearest to another point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// How far it is, in the mesh's unit.
    pub distance: f64,
    /// From it to the other point; of a point on the mesh the triangle's normal.
    pub away: UnitVector3<f64>,
}

impl RayCaster {
    /// Builds the hierarchy over the mesh's triangles.
    #[must_use]
    pub fn new(mesh: &Mesh) -> Self {
        let vertices = mesh.vertices().iter().map(to_parry).collect();
        let triangles = TriMesh::new(vertices, mesh.triangles().to_vec())
            .expect("a mesh has at least one triangle, which is all that is asked for");
        Self { triangles }
    }

    /// The first point of the mesh on the ray, from whichever side of a triangle: meshes may be
    /// open, and their triangles wound either way.
    ///
    /// `direction` need not be a unit vector; `None` for the zero vector, and for a ray that
    /// misses.
    #[must_use]
    pub fn cast(&self, origin: &Point3<f64>, direction: &Vector3<f64>) -> Option<Hit> {
        let direction = Unit::try_new(*direction, 0.0)?;
        let ray = Ray::new(
            to_parry(origin),
            Vector::new(direction.x, direction.y, direction.z),
        );
        let hit = self
            .triangles
            .cast_local_ray_and_get_normal(&ray, f64::MAX, false)?;
        let normal = Vector3::new(hit.normal.x, hit.normal.y, hit.normal.z);
        let normal = Unit::try_new(normal, 0.0)?;
        Some(Hit {
            distance: hit.time_of_impact,
            point: origin + direction.into_inner() * hit.time_of_impact,
            normal: if normal.dot(&direction) > 0.0 {
                -normal
            } else {
                normal
            },
            triangle: hit.subshape,
        })
    }

    /// The distance from a point to the nearest point of the mesh, in the mesh's unit; infinite
    /// for a point with a coordinate that is not finite.
    #[must_use]
    pub fn distance(&self, point: &Point3<f64>) -> f64 {
        self.nearest(point)
            .map_or(f64::INFINITY, |nearest| nearest.distance)
    }

    /// The nearest point of the mesh; `None` for a point with a coordinate that is not finite.
    #[must_use]
    pub fn nearest(&self, point: &Point3<f64>) -> Option<Nearest> {
        if !point.iter().all(|c| c.is_finite()) {
            return None;
        }
        let (nearest, (triangle, _)) = self
            .triangles
            .project_local_point_and_get_location(to_parry(point), false);
        let found = Point3::new(nearest.point.x, nearest.point.y, nearest.point.z);
        let offset = point - found;
        let across = || {
            let triangle = self.triangles.triangle(triangle);
            let normal = (triangle.b - triangle.a).cross(triangle.c - triangle.a);
            Unit::try_new(Vector3::new(normal.x, normal.y, normal.z), 0.0)
        };
        let away = Unit::try_new(offset, 0.0).or_else(across)?;
        Some(Nearest {
            distance: offset.norm(),
            away,
        })
    }
}

fn to_parry(point: &Point3<f64>) -> Vector {
    Vector::new(point.x, point.y, point.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two parallel unit squares at z = 0 and z = 1, wound the same way.
    fn two_squares() -> Mesh {
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let vertices = [0.0, 1.0]
            .into_iter()
            .flat_map(|z| corners.map(|[x, y]| Point3::new(x, y, z)))
            .collect();
        let triangles = vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]];
        Mesh::new(vertices, triangles).unwrap()
    }

    #[test]
    fn the_first_triangle_is_hit_from_either_side() {
        let caster = RayCaster::new(&two_squares());
        let above = Point3::new(0.25, 0.5, 3.0);
        let down = caster.cast(&above, &Vector3::new(0.0, 0.0, -5.0)).unwrap();
        assert_eq!(down.distance, 2.0);
        assert_eq!(down.point, Point3::new(0.25, 0.5, 1.0));
        assert_eq!(down.triangle, 3);
        assert_eq!(down.normal, Vector3::z_axis());
        let below = Point3::new(0.75, 0.5, -3.0);
        let up = caster.cast(&below, &Vector3::z()).unwrap();
        assert_eq!(up.distance, 3.0);
        assert_eq!(up.triangle, 0);
        assert_eq!(up.normal, -Vector3::z_axis());
    }

    #[test]
    fn a_ray_that_misses_or_has_no_direction_hits_nothing() {
        let caster = RayCaster::new(&two_squares());
        let beside = Point3::new(2.0, 0.5, 3.0);
        assert_eq!(caster.cast(&beside, &-Vector3::z()), None);
        let above = Point3::new(0.5, 0.5, 3.0);
        assert_eq!(caster.cast(&above, &Vector3::z()), None);
        assert_eq!(caster.cast(&above, &Vector3::zeros()), None);
        assert_eq!(caster.cast(&above, &Vector3::new(f64::NAN, 0.0, 0.0)), None);
    }

    #[test]
    fn distances_are_to_the_nearest_triangle() {
        let caster = RayCaster::new(&two_squares());
        assert_eq!(caster.distance(&Point3::new(0.5, 0.5, 0.25)), 0.25);
        assert_eq!(caster.distance(&Point3::new(4.0, 1.0, 5.0)), 5.0);
        assert_eq!(
            caster.distance(&Point3::new(f64::NAN, 0.0, 0.0)),
            f64::INFINITY
        );
    }
}
