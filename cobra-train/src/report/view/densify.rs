//! Triangles small enough that what lies between their corners is as at the corners.

use crate::surface::Mesh;
use nalgebra::{Point3, center, distance};
use std::collections::HashMap;

/// How many times `longest` the edges are that are halved first.
const FIRST: i32 = 64;

/// The mesh with edges longer than `longest` halved, and those of the halves, the longest first, as long as there
/// are at most `most` triangles. An edge is halved for both triangles that share it, so that no gap opens.
pub(super) fn densified(
    mesh: &Mesh,
    longest: f64,
    most: usize,
) -> (Vec<Point3<f64>>, Vec<[u32; 3]>) {
    let mut vertices = mesh.vertices().to_vec();
    let mut triangles = mesh.triangles().to_vec();
    let mut times = FIRST;
    while times > 0 {
        match halved(&mut vertices, &triangles, f64::from(times) * longest, most) {
            Some(finer) => triangles = finer,
            None => times /= 2,
        }
    }
    (vertices, triangles)
}

/// The triangles with edges longer than `longest` halved, whose middles are then among the vertices; `None` where
/// there is none or there would be more than `most` triangles.
fn halved(
    vertices: &mut Vec<Point3<f64>>,
    triangles: &[[u32; 3]],
    longest: f64,
    most: usize,
) -> Option<Vec<[u32; 3]>> {
    let edges = |[a, b, c]: [u32; 3]| [(a, b), (b, c), (c, a)];
    let long = |vertices: &[Point3<f64>], (a, b): (u32, u32)| {
        distance(&vertices[a as usize], &vertices[b as usize]) > longest
    };
    // Each edge that is halved makes one triangle more of each that has it.
    let more = triangles
        .iter()
        .flat_map(|triangle| edges(*triangle))
        .filter(|edge| long(vertices, *edge))
        .count();
    if more == 0 || triangles.len() + more > most {
        return None;
    }
    let mut middles: HashMap<(u32, u32), u32> = HashMap::new();
    let mut finer = Vec::with_capacity(triangles.len() + more);
    for triangle in triangles {
        let split = edges(*triangle).map(|(a, b)| {
            long(vertices, (a, b)).then(|| {
                *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    let middle = center(&vertices[a as usize], &vertices[b as usize]);
                    vertices.push(middle);
                    (vertices.len() - 1) as u32
                })
            })
        });
        halve(*triangle, split, vertices, &mut finer);
    }
    Some(finer)
}

/// The parts of a triangle of which some edges (a b, b c, c a) have a corner in their middle.
fn halve(
    [a, b, c]: [u32; 3],
    split: [Option<u32>; 3],
    vertices: &[Point3<f64>],
    out: &mut Vec<[u32; 3]>,
) {
    let apart = |p: u32, q: u32| distance(&vertices[p as usize], &vertices[q as usize]);
    match split {
        [None, None, None] => out.push([a, b, c]),
        [Some(ab), None, None] => out.extend([[a, ab, c], [ab, b, c]]),
        [None, Some(_), None]
        | [None, None, Some(_)]
        | [None, Some(_), Some(_)]
        | [Some(_), None, Some(_)] => {
            halve([b, c, a], [split[1], split[2], split[0]], vertices, out);
        }
        [Some(ab), Some(bc), None] => {
            out.push([ab, b, bc]);
            // Of both ways to cut what is left, the shorter.
            if apart(a, bc) < apart(ab, c) {
                out.extend([[a, ab, bc], [a, bc, c]]);
            } else {
                out.extend([[a, ab, c], [ab, bc, c]]);
            }
        }
        [Some(ab), Some(bc), Some(ca)] => {
            out.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::RayCaster;

    fn tetrahedron() -> Mesh {
        let vertices = vec![
            Point3::new(0.0, 0.0, 0.0),
            Point3::new(10.0, 0.0, 0.0),
            Point3::new(0.0, 1.0, 0.0),
            Point3::new(0.0, 0.0, 3.0),
        ];
        Mesh::new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).unwrap()
    }

    fn area(vertices: &[Point3<f64>], triangles: &[[u32; 3]]) -> f64 {
        let of = |[a, b, c]: [u32; 3]| {
            let [a, b, c] = [a, b, c].map(|i| vertices[i as usize]);
            (b - a).cross(&(c - a)).norm() / 2.0
        };
        triangles.iter().copied().map(of).sum()
    }

    #[test]
    fn edges_become_short_and_the_surface_stays_whole() {
        let mesh = tetrahedron();
        let (vertices, triangles) = densified(&mesh, 0.4, 100_000);
        let mut uses: HashMap<(u32, u32), usize> = HashMap::new();
        for [a, b, c] in &triangles {
            for (p, q) in [(a, b), (b, c), (c, a)] {
                assert!(distance(&vertices[*p as usize], &vertices[*q as usize]) <= 0.4);
                *uses.entry((*p.min(q), *p.max(q))).or_default() += 1;
            }
        }
        assert!(uses.values().all(|count| *count == 2));
        let before = area(mesh.vertices(), mesh.triangles());
        assert!((area(&vertices, &triangles) / before - 1.0).abs() < 1e-9);
        let caster = RayCaster::new(&mesh);
        assert!(vertices.iter().all(|vertex| caster.distance(vertex) < 1e-9));
    }

    #[test]
    fn there_are_never_more_triangles_than_asked_for() {
        let (_, triangles) = densified(&tetrahedron(), 1e-6, 500);
        assert!(
            (100..=500).contains(&triangles.len()),
            "{}",
            triangles.len()
        );
    }
}
