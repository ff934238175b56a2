//! A large mesh with fewer triangles: vertices that share a cell of a grid become one of them.
//!
//! J. Rossignac and P. Borrel, Multi-resolution 3D approximations for rendering complex scenes (1993), with a
//! vertex of the mesh for each cell, so that every place that is shown lies on the object.

use crate::surface::Mesh;
use nalgebra::{Point3, Vector3, distance_squared};
use std::collections::HashMap;

/// Cells along the diameter to begin with.
const FINEST: f64 = 400.0;

pub(super) struct Merged {
    pub(super) vertices: Vec<Point3<f64>>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// The side of a cell.
    pub(super) cell: f64,
}

/// At most `most` triangles of the mesh's.
pub(super) fn merged(mesh: &Mesh, diameter: f64, most: usize) -> Merged {
    let mut cell = diameter / FINEST;
    loop {
        let merged = with_cells(mesh, cell);
        if merged.triangles.len() <= most {
            return merged;
        }
        cell *= 1.25;
    }
}

fn with_cells(mesh: &Mesh, cell: f64) -> Merged {
    let place = |vertex: &Point3<f64>| -> [i64; 3] {
        let place = vertex.coords.map(|c| (c / cell).floor() as i64);
        place.into()
    };
    let mut cells: HashMap<[i64; 3], usize> = HashMap::new();
    let mut members: Vec<Vec<usize>> = Vec::new();
    let mut cell_of = vec![0_u32; mesh.vertices().len()];
    for (index, vertex) in mesh.vertices().iter().enumerate() {
        let number = *cells.entry(place(vertex)).or_insert_with(|| {
            members.push(Vec::new());
            members.len() - 1
        });
        members[number].push(index);
        cell_of[index] = number as u32;
    }
    let vertices = members
        .iter()
        .map(|members| middle(mesh, members))
        .collect();
    let mut triangles: Vec<[u32; 3]> = mesh
        .triangles()
        .iter()
        .map(|triangle| triangle.map(|index| cell_of[index as usize]))
        .filter(|[a, b, c]| a != b && b != c && c != a)
        .map(smallest_first)
        .collect();
    triangles.sort_unstable();
    triangles.dedup();
    Merged {
        vertices,
        triangles,
        cell,
    }
}

/// The vertex that is nearest to the mean of all.
fn middle(mesh: &Mesh, members: &[usize]) -> Point3<f64> {
    let all = || members.iter().map(|index| mesh.vertices()[*index]);
    let sum: Vector3<f64> = all().map(|vertex| vertex.coords).sum();
    let mean = Point3::from(sum / members.len().max(1) as f64);
    all()
        .min_by(|a, b| distance_squared(a, &mean).total_cmp(&distance_squared(b, &mean)))
        .unwrap_or(mean)
}

/// The same triangle, the same way around.
fn smallest_first([a, b, c]: [u32; 3]) -> [u32; 3] {
    if a < b && a < c {
        [a, b, c]
    } else if b < c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of `side` by `side` pairs of triangles.
    fn sheet(side: u32) -> Mesh {
        let row = side + 1;
        let vertices = (0..row * row)
            .map(|i| Point3::new(f64::from(i % row), f64::from(i / row), 0.0))
            .collect();
        let triangles = (0..side * side)
            .flat_map(|i| {
                let a = i / side * row + i % side;
                [[a, a + 1, a + row], [a + 1, a + row + 1, a + row]]
            })
            .collect();
        Mesh::new(vertices, triangles).unwrap()
    }

    #[test]
    fn a_large_mesh_becomes_small_and_keeps_its_places() {
        let mesh = sheet(100);
        let merged = merged(&mesh, 141.4, 5_000);
        assert!(
            (1_000..=5_000).contains(&merged.triangles.len()),
            "{}",
            merged.triangles.len()
        );
        for vertex in &merged.vertices {
            assert!(mesh.vertices().contains(vertex));
        }
        for [a, b, c] in &merged.triangles {
            assert!(a != b && b != c && a != c);
        }
    }
}
