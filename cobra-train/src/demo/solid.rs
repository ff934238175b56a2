//! Closed bodies with outward normals: extruded outlines and lathed profiles.
//!
//! Owns how one body is tessellated. What the bodies of the demonstration part are is `part`'s
//! business, their outlines are `outline`'s.

use earcut::Earcut;
use nalgebra::{Point2, Point3, Vector2};

use super::outline::CHORDS;

/// The surface of one body: every edge belongs to two triangles, which run along it in opposite
/// directions and turn anticlockwise when seen from outside.
#[derive(Clone, Debug)]
pub(super) struct Solid {
    pub(super) vertices: Vec<Point3<f64>>,
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Solid {
    /// The body after a rigid motion that `place` does to each of its points.
    pub(super) fn placed(mut self, place: impl Fn(Point3<f64>) -> Point3<f64>) -> Self {
        for vertex in &mut self.vertices {
            *vertex = place(*vertex);
        }
        self
    }
}

/// A plate of an anticlockwise outline with anticlockwise holes, from z = 0 to `height`, all of
/// whose edges are broken by a 45° chamfer of width `chamfer`.
///
/// The outline may not have three points on a line, and its hollows must be wider than the
/// chamfer.
pub(super) fn extrude(
    outline: &[Point2<f64>],
    holes: &[Vec<Point2<f64>>],
    height: f64,
    chamfer: f64,
) -> Solid {
    let mut rings = vec![outline.to_vec()];
    rings.extend(
        holes
            .iter()
            .map(|hole| hole.iter().rev().copied().collect()),
    );

    let mut starts = Vec::new();
    let mut count = 0;
    for ring in &rings {
        starts.push(count);
        count += ring.len() as u32;
    }
    let face: Vec<[f64; 2]> = rings
        .iter()
        .flat_map(|ring| inset(ring, chamfer))
        .map(|p| [p.x, p.y])
        .collect();
    let full = || rings.iter().flatten().map(|p| [p.x, p.y]);

    let lift = |z: f64| move |[x, y]: [f64; 2]| Point3::new(x, y, z);
    let mut vertices: Vec<Point3<f64>> = face.iter().copied().map(lift(0.0)).collect();
    vertices.extend(full().map(lift(chamfer)));
    vertices.extend(full().map(lift(height - chamfer)));
    vertices.extend(face.iter().copied().map(lift(height)));

    let mut triangles = Vec::new();
    for level in 0..3 {
        for (ring, &start) in rings.iter().zip(&starts) {
            let size = ring.len() as u32;
            for i in 0..size {
                let a = level * count + start + i;
                let b = level * count + start + (i + 1) % size;
                triangles.push([a, b, b + count]);
                triangles.push([a, b + count, a + count]);
            }
        }
    }

    let mut cap: Vec<u32> = Vec::new();
    Earcut::new().earcut(face.iter().copied(), &starts[1..], &mut cap);
    for corner in cap.as_chunks::<3>().0 {
        let [a, b, c] = anticlockwise(*corner, &face);
        triangles.push([a, c, b]);
        triangles.push([a, b, c].map(|i| i + 3 * count));
    }
    Solid {
        vertices,
        triangles,
    }
}

/// The body that an anticlockwise profile in (radius, z) sweeps around the z axis. Points of the
/// profile on the axis itself become poles.
pub(super) fn lathe(profile: &[Point2<f64>]) -> Solid {
    let mut vertices = Vec::new();
    let mut rings: Vec<Vec<u32>> = Vec::new();
    for p in profile {
        let first = vertices.len() as u32;
        if p.x == 0.0 {
            vertices.push(Point3::new(0.0, 0.0, p.y));
            rings.push(vec![first; CHORDS]);
            continue;
        }
        for i in 0..CHORDS {
            let angle = core::f64::consts::TAU * i as f64 / CHORDS as f64;
            vertices.push(Point3::new(
                p.x * libm::cos(angle),
                p.x * libm::sin(angle),
                p.y,
            ));
        }
        rings.push((first..first + CHORDS as u32).collect());
    }
    let mut triangles = Vec::new();
    for (i, ring) in rings.iter().enumerate() {
        let next = &rings[(i + 1) % rings.len()];
        for a in 0..CHORDS {
            let b = (a + 1) % CHORDS;
            triangles.push([ring[a], ring[b], next[b]]);
            triangles.push([ring[a], next[b], next[a]]);
        }
    }
    triangles.retain(|[a, b, c]| a != b && b != c && c != a);
    Solid {
        vertices,
        triangles,
    }
}

/// The ring moved by `width` into the material, which lies on its left.
fn inset(ring: &[Point2<f64>], width: f64) -> Vec<Point2<f64>> {
    let count = ring.len();
    (0..count)
        .map(|i| {
            let normal = |from: Point2<f64>, to: Point2<f64>| {
                let along = (to - from).normalize();
                Vector2::new(-along.y, along.x)
            };
            let before = normal(ring[(i + count - 1) % count], ring[i]);
            let after = normal(ring[i], ring[(i + 1) % count]);
            ring[i] + (before + after) * (width / (1.0 + before.dot(&after)))
        })
        .collect()
}

fn anticlockwise([a, b, c]: [u32; 3], points: &[[f64; 2]]) -> [u32; 3] {
    let at = |i: u32| Point2::from(points[i as usize]);
    if (at(b) - at(a)).perp(&(at(c) - at(a))) < 0.0 {
        [a, c, b]
    } else {
        [a, b, c]
    }
}

#[cfg(test)]
mod tests {
    use super::super::outline::{circle, rounded};
    use super::*;

    fn volume(solid: &Solid) -> f64 {
        solid
            .triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|i| solid.vertices[i as usize].coords);
                a.dot(&b.cross(&c)) / 6.0
            })
            .sum()
    }

    #[test]
    fn an_extruded_plate_has_the_volume_of_its_outline_less_its_holes() {
        let square = rounded(&[
            (0.0, 0.0, 0.0),
            (10.0, 0.0, 0.0),
            (10.0, 10.0, 0.0),
            (0.0, 10.0, 0.0),
        ]);
        let plate = extrude(&square, &[circle(5.0, 5.0, 2.0)], 3.0, 0.0);
        let chords = CHORDS as f64;
        let hole = chords / 2.0 * 4.0 * (core::f64::consts::TAU / chords).sin();
        assert!((volume(&plate) - (100.0 - hole) * 3.0).abs() < 1e-9);
    }

    #[test]
    fn a_lathed_cylinder_has_an_outward_surface() {
        let profile = [[0.0, 0.0], [2.0, 0.0], [2.0, 5.0], [0.0, 5.0]].map(Point2::from);
        let exact = core::f64::consts::PI * 4.0 * 5.0;
        let found = volume(&lathe(&profile));
        assert!(found < exact && found > 0.99 * exact, "{found} of {exact}");
    }
}
