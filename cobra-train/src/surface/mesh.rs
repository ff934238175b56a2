//! The triangle mesh as the trainer sees it: validated once, then trusted.
//!
//! Owns the checks that make a list of vertices and faces a surface that rays can hit. The sphere
//! that normalises it is `surface::bounds`'s; reading files is `surface::read`'s work, ray casting
//! `surface::raycast`'s.

use nalgebra::{Point3, Vector3};

use super::bounds::{BoundingSphere, CoordinateError, check_coordinates};
use super::diameter::diameter;

/// Steps in the unit of rounded coordinates.
const STEPS: f64 = 4_294_967_296.0;

/// A triangle mesh with at least one triangle of non-zero area, all of whose vertices are finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    vertices: Vec<Point3<f64>>,
    triangles: Vec<[u32; 3]>,
    dropped: usize,
}

/// Why a list of vertices and faces is not a surface.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// There is not a single face.
    #[error("the mesh has {vertices} vertices and no faces: rays need faces to hit")]
    NoFaces {
        /// How many vertices it has.
        vertices: usize,
    },
    /// A coordinate cannot be computed with.
    #[error(transparent)]
    Coordinate(#[from] CoordinateError),
    /// A face names a vertex that does not exist.
    #[error("face {face} names vertex {index}, but the mesh has {vertices} vertices")]
    MissingVertex {
        /// The face, counted from 0.
        face: usize,
        /// The vertex it names.
        index: u32,
        /// How many there are.
        vertices: usize,
    },
    /// Every face is a point or a line.
    #[error("all {faces} faces have zero area: the mesh has no surface")]
    NoArea {
        /// How many faces were given.
        faces: usize,
    },
}

impl Mesh {
    /// Checks the vertices and faces and keeps the triangles that have an area.
    ///
    /// A triangle counts as degenerate when twice its area is at most 1e-12 of the square of its
    /// longest edge; such triangles are dropped and counted ([`Mesh::dropped_triangles`]).
    ///
    /// # Errors
    /// [`MeshError`]: no faces, a coordinate that is not finite or too large, a face that names a vertex that
    /// does not exist, or no triangle with an area.
    pub fn new(
        vertices: Vec<Point3<f64>>,
        mut triangles: Vec<[u32; 3]>,
    ) -> Result<Self, MeshError> {
        if triangles.is_empty() {
            return Err(MeshError::NoFaces {
                vertices: vertices.len(),
            });
        }
        check_coordinates(&vertices)?;
        for (face, triangle) in triangles.iter().enumerate() {
            if let Some(&index) = triangle.iter().find(|&&i| i as usize >= vertices.len()) {
                return Err(MeshError::MissingVertex {
                    face,
                    index,
                    vertices: vertices.len(),
                });
            }
        }
        let given = triangles.len();
        triangles.retain(|t| has_area(t.map(|i| vertices[i as usize])));
        if triangles.is_empty() {
            return Err(MeshError::NoArea { faces: given });
        }
        Ok(Self {
            dropped: given - triangles.len(),
            vertices,
            triangles,
        })
    }

    /// The vertices, in the mesh's unit.
    #[must_use]
    pub fn vertices(&self) -> &[Point3<f64>] {
        &self.vertices
    }

    /// The triangles, as indices into [`Mesh::vertices`].
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// How many faces were dropped because they have no area.
    #[must_use]
    pub fn dropped_triangles(&self) -> usize {
        self.dropped
    }

    /// The vertices that some triangle uses, each once, in their order.
    pub(crate) fn used_vertices(&self) -> impl Iterator<Item = &Point3<f64>> + Clone {
        let mut used = vec![false; self.vertices.len()];
        for &i in self.triangles.iter().flatten() {
            used[i as usize] = true;
        }
        self.vertices
            .iter()
            .zip(used)
            .filter_map(|(v, used)| used.then_some(v))
    }

    /// Centre of the bounding box and the distance to the farthest vertex from there, as the
    /// paper's data preparation does. Vertices that no triangle uses do not count.
    #[must_use]
    pub fn bounding_sphere(&self) -> BoundingSphere {
        BoundingSphere::around(self.used_vertices())
    }

    /// The largest distance between two vertices (BOP's `diameter`), exact. Vertices that no
    /// triangle uses do not count.
    #[must_use]
    pub fn diameter(&self) -> f64 {
        diameter(self.used_vertices().copied().collect())
    }

    /// The same mesh with coordinates rounded to 2⁻³²: of an object in metres, normalised, the vertices
    /// that it has in millimetres, so that what chooses among charts by small differences chooses the same.
    #[must_use]
    pub(crate) fn rounded(mut self) -> Self {
        for vertex in &mut self.vertices {
            *vertex = vertex.map(|x| (x * STEPS).round() / STEPS);
        }
        self
    }

    /// The same mesh, moved and scaled so that `sphere` becomes the unit sphere at the origin.
    #[must_use]
    pub fn normalised(&self, sphere: &BoundingSphere) -> Self {
        Self {
            vertices: self.vertices.iter().map(|v| sphere.normalise(v)).collect(),
            triangles: self.triangles.clone(),
            dropped: self.dropped,
        }
    }
}

fn has_area([a, b, c]: [Point3<f64>; 3]) -> bool {
    let (ab, ac, bc): (Vector3<f64>, _, _) = (b - a, c - a, c - b);
    let longest = ab
        .norm_squared()
        .max(ac.norm_squared())
        .max(bc.norm_squared());
    ab.cross(&ac).norm() > 1e-12 * longest
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corners() -> Vec<Point3<f64>> {
        vec![
            Point3::origin(),
            Point3::new(4.0, 0.0, 0.0),
            Point3::new(0.0, 3.0, 0.0),
            Point3::new(2.0, 0.0, 0.0),
            Point3::new(0.0, 0.0, 1000.0),
        ]
    }

    #[test]
    fn what_is_no_surface_is_refused() {
        let refused = |vertices, triangles| Mesh::new(vertices, triangles).unwrap_err();
        assert_eq!(
            refused(corners(), vec![]),
            MeshError::NoFaces { vertices: 5 }
        );
        assert_eq!(
            refused(corners(), vec![[0, 1, 3], [1, 1, 2]]),
            MeshError::NoArea { faces: 2 }
        );
        assert_eq!(
            refused(corners(), vec![[0, 1, 2], [0, 1, 5]]),
            MeshError::MissingVertex {
                face: 1,
                index: 5,
                vertices: 5
            }
        );
        let mut vertices = corners();
        vertices[1].y = f64::NEG_INFINITY;
        assert!(matches!(
            refused(vertices.clone(), vec![[0, 1, 2]]),
            MeshError::Coordinate(CoordinateError::NotFinite { index: 1, .. })
        ));
        vertices[1].y = -1e61;
        let error = refused(vertices, vec![[0, 1, 2]]);
        assert_eq!(
            error.to_string(),
            "vertex 1 has the coordinate -1e61: at most 1e60 is expected"
        );
    }

    #[test]
    fn faces_without_area_are_dropped_and_counted() {
        let mesh = Mesh::new(corners(), vec![[0, 1, 3], [0, 1, 2], [2, 2, 2]]).unwrap();
        assert_eq!(mesh.triangles(), [[0, 1, 2]]);
        assert_eq!(mesh.dropped_triangles(), 2);
    }

    #[test]
    fn vertices_that_no_triangle_uses_do_not_count() {
        let mesh = Mesh::new(corners(), vec![[0, 1, 2]]).unwrap();
        assert_eq!(mesh.diameter(), 5.0);
        let sphere = mesh.bounding_sphere();
        assert_eq!(sphere.centre, Point3::new(2.0, 1.5, 0.0));
        assert_eq!(sphere.radius, 2.5);
    }

    #[test]
    fn a_normalised_mesh_fills_the_unit_sphere() {
        let mesh = Mesh::new(corners(), vec![[0, 1, 2]]).unwrap();
        let unit = mesh.normalised(&mesh.bounding_sphere());
        let sphere = unit.bounding_sphere();
        assert!(sphere.centre.coords.norm() < 1e-15);
        assert!((sphere.radius - 1.0).abs() < 1e-15);
    }
}
