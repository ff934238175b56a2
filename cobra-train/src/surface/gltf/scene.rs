//! The scene of a glTF file: its nodes, their transforms, and the meshes that hang from them.
//!
//! Owns the walk over the nodes and how much a file may amount to: a mesh may hang from many nodes,
//! so that a small file can describe any number of triangles.

use std::collections::HashMap;

use gltf::scene::Transform;
use gltf::{Document, Node, Primitive, Semantic};
use nalgebra::{Matrix4, Point3, Quaternion, Translation3, UnitQuaternion, Vector3};

use super::super::content::{BadContent, Place, Soup};
use super::accessor::AccessorReader;
use super::buffers::Buffers;
use super::primitive::Shape;

/// The most vertices, triangles or points that a scene may have with all of its instances.
const LARGEST_SCENE: usize = 20_000_000;

/// What has been collected of a scene.
pub(super) struct Assembly<'a> {
    buffers: &'a Buffers<'a>,
    vertices: Vec<Point3<f64>>,
    triangles: Vec<[u32; 3]>,
    points: Vec<Point3<f64>>,
}

impl<'a> Assembly<'a> {
    pub(super) fn new(buffers: &'a Buffers<'a>) -> Self {
        Self {
            buffers,
            vertices: Vec::new(),
            triangles: Vec::new(),
            points: Vec::new(),
        }
    }

    /// The triangles, or without any the points.
    pub(super) fn into_soup(self) -> Soup {
        if self.triangles.is_empty() {
            (self.points, self.triangles)
        } else {
            (self.vertices, self.triangles)
        }
    }

    /// Appends the default scene, or the first, or all nodes that are nobody's child.
    pub(super) fn append_scene(&mut self, document: &Document) -> Result<(), BadContent> {
        let scene = document
            .default_scene()
            .or_else(|| document.scenes().next());
        let mut waiting: Vec<(Node<'_>, Matrix4<f64>)> = match scene {
            Some(scene) => scene.nodes().map(|n| (n, Matrix4::identity())).collect(),
            None => roots(document).map(|n| (n, Matrix4::identity())).collect(),
        };
        waiting.reverse();
        let mut seen = vec![false; document.nodes().len()];
        while let Some((node, parent)) = waiting.pop() {
            if std::mem::replace(&mut seen[node.index()], true) {
                return Err(BadContent::new(
                    None,
                    "nodes that form trees",
                    format!("node {} in two places", node.index()),
                ));
            }
            let global = parent * matrix(&node.transform());
            self.append_mesh(&node, &global)?;
            let children: Vec<_> = node.children().map(|child| (child, global)).collect();
            waiting.extend(children.into_iter().rev());
        }
        Ok(())
    }

    fn append_mesh(&mut self, node: &Node<'_>, global: &Matrix4<f64>) -> Result<(), BadContent> {
        let Some(mesh) = node.mesh() else {
            return Ok(());
        };
        // Primitives that differ in material alone share their vertices.
        let mut first_of = HashMap::new();
        for primitive in mesh.primitives() {
            let place = Place::Primitive {
                mesh: mesh.index(),
                primitive: primitive.index(),
            };
            self.append_primitive(&primitive, global, place, &mut first_of)?;
        }
        Ok(())
    }

    fn append_primitive(
        &mut self,
        primitive: &Primitive<'_>,
        global: &Matrix4<f64>,
        place: Place,
        first_of: &mut HashMap<usize, u32>,
    ) -> Result<(), BadContent> {
        let (Some(shape), Some(positions)) = (
            Shape::of(primitive.mode()),
            primitive.get(&Semantic::Positions),
        ) else {
            return Ok(());
        };
        let reader = AccessorReader {
            buffers: self.buffers,
            place,
        };
        let count = positions.count();
        let transformed = |[x, y, z]: [f64; 3]| global.transform_point(&Point3::new(x, y, z));
        if shape == Shape::Points {
            check_size(self.points.len(), count, place)?;
            let read = reader.positions(&positions)?;
            self.points.extend(read.into_iter().map(transformed));
            return Ok(());
        }
        let listed = primitive.indices();
        let corners = listed.as_ref().map_or(count, |indices| indices.count());
        check_size(self.triangles.len(), corners, place)?;
        let first = match first_of.get(&positions.index()) {
            Some(&first) => first,
            None => {
                check_size(self.vertices.len(), count, place)?;
                let read = reader.positions(&positions)?;
                // Below LARGEST_SCENE.
                let first = self.vertices.len() as u32;
                self.vertices.extend(read.into_iter().map(transformed));
                first_of.insert(positions.index(), first);
                first
            }
        };
        let mut corners = match listed {
            Some(indices) => reader.indices(&indices)?,
            None => (0..count as u32).collect(),
        };
        for corner in &mut corners {
            if *corner as usize >= count {
                let expected = format!("indices of the {count} vertices, counted from 0");
                return Err(BadContent::new(Some(place), expected, corner));
            }
            *corner += first;
        }
        shape.triangles(&corners, &mut self.triangles);
        Ok(())
    }
}

fn check_size(before: usize, more: usize, place: Place) -> Result<(), BadContent> {
    match before.checked_add(more) {
        Some(sum) if sum <= LARGEST_SCENE => Ok(()),
        _ => Err(BadContent::new(
            Some(place),
            format!("at most {LARGEST_SCENE} vertices and triangles in the scene"),
            format!("{more} after {before}"),
        )),
    }
}

fn roots(document: &Document) -> impl Iterator<Item = Node<'_>> {
    let mut is_child = vec![false; document.nodes().len()];
    for child in document.nodes().flat_map(|node| node.children()) {
        is_child[child.index()] = true;
    }
    document.nodes().filter(move |node| !is_child[node.index()])
}

/// In `f64`: the crate's own product is in `f32`.
fn matrix(transform: &Transform) -> Matrix4<f64> {
    match transform {
        Transform::Matrix { matrix } => {
            Matrix4::from_fn(|row, column| f64::from(matrix[column][row]))
        }
        Transform::Decomposed {
            translation,
            rotation: [x, y, z, w],
            scale,
        } => {
            let quaternion = Quaternion::new(*w, *x, *y, *z).cast();
            Translation3::from(translation.map(f64::from)).to_homogeneous()
                * UnitQuaternion::from_quaternion(quaternion).to_homogeneous()
                * Matrix4::new_nonuniform_scaling(&Vector3::from(scale.map(f64::from)))
        }
    }
}
