//! The triangle mesh as the trainer sees it: validated once, then trusted.
//!
//! Owns the checks that make a list of vertices and faces a surface that rays can hit, and the
//! sphere that normalises it. Reading files is `surface::read`'s work, ray casting
//! `surface::raycast`'s.

use nalgebra::{Point3, Vector3};

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

/// The sphere that normalises an object: the centre of its bounding box, and the distance to the
/// farthest vertex from there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundingSphere {
    /// Centre, in the mesh's unit.
    pub centre: Point3<f64>,
    /// Radius, in the mesh's unit.
    pub radius: f64,
}

impl BoundingSphere {
    /// From the mesh's frame to the unit sphere.
    #[must_use]
    pub fn normalise(&self, point: &Point3<f64>) -> Point3<f64> {
        Point3::from((point - self.centre) / self.radius)
    }

    /// From the unit sphere to the mesh's frame.
    #[must_use]
    pub fn denormalise(&self, point: &Point3<f64>) -> Point3<f64> {
        self.centre + point.coords * self.radius
    }
}

impl Mesh {
    /// Checks the vertices and faces and keeps the triangles that have an area.
    ///
    /// A triangle counts as degenerate when twice its area is at most 1e-12 of the square of its
    /// longest edge; such triangles are dropped and counted ([`Mesh::dropped_triangles`]).
    ///
    /// # Errors
    /// [`MeshError`]: no faces, a coordinate that is not finite, a face that names a vertex that
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
        for (index, vertex) in vertices.iter().enumerate() {
            if !vertex.iter().all(|c| c.is_finite()) {
                return Err(MeshError::NotFinite {
                    index,
                    x: vertex.x,
                    y: vertex.y,
                    z: vertex.z,
                });
            }
        }
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
    fn used_vertices(&self) -> impl Iterator<Item = &Point3<f64>> {
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
        let first = self.vertices[self.triangles[0][0] as usize];
        let (low, high) = self
            .used_vertices()
            .fold((first, first), |(low, high), v| (low.inf(v), high.sup(v)));
        let centre = nalgebra::center(&low, &high);
        let radius = self
            .used_vertices()
            .map(|v| (v - centre).norm())
            .fold(0.0, f64::max);
        BoundingSphere { centre, radius }
    }

    /// The largest distance between two vertices (BOP's `diameter`).
    ///
    /// Exact: pairs are visited by falling distance from the centre, and a pair is skipped only
    /// when the triangle inequality rules it out.
    #[must_use]
    pub fn diameter(&self) -> f64 {
        let sphere = self.bounding_sphere();
        let mut by_distance: Vec<(f64, Point3<f64>)> = self
            .used_vertices()
            .map(|v| ((v - sphere.centre).norm(), *v))
            .collect();
        by_distance.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut best = 0.0_f64;
        for (i, (ri, vi)) in by_distance.iter().enumerate() {
            if ri + ri <= best {
                break;
            }
            for (rj, vj) in &by_distance[i + 1..] {
                if ri + rj <= best {
                    break;
                }
                best = best.max((vi - vj).norm());
            }
        }
        best
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
