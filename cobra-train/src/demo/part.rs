//! The demonstration's object: a machined bracket, made by code.
//!
//! Owns the bracket's dimensions. The bodies overlap where they meet, as a welded part's do before
//! welding: only first hits of rays are asked of them, so nothing is gained by uniting them.

use nalgebra::{Point2, Point3};

use super::outline::{circle, rounded, slot};
use super::solid::{Solid, extrude, lathe};
use crate::surface::Mesh;

/// A bracket of 142 × 96 × 92 mm, in millimetres, with the origin in the middle of its bounding
/// box and z upwards from the base plate.
///
/// It consists of a base plate with a slot and bolt holes, a stepped boss with a bore away from
/// the middle, a locating pin, and an L-shaped upright flange with a bearing seat and a gusset
/// rib. No rotation maps it onto itself, and no wall is thinner than 4 mm. Every call returns the
/// same bits.
///
/// # Panics
/// Never: the dimensions are constants of which the tests know that they make a mesh.
#[must_use]
pub fn mechanical_part() -> Mesh {
    let middle = Point3::new(71.0, 48.0, 46.0);
    let mut vertices = Vec::new();
    let mut triangles = Vec::new();
    for body in bodies() {
        let first = vertices.len() as u32;
        vertices.extend(body.vertices.iter().map(|v| Point3::from(v - middle)));
        triangles.extend(body.triangles.iter().map(|t| t.map(|i| i + first)));
    }
    Mesh::new(vertices, triangles).expect("the bracket's dimensions make a mesh")
}

/// The closed bodies, with the corner of the base plate's bounding box at the origin.
fn bodies() -> Vec<Solid> {
    vec![
        base_plate(),
        boss(),
        locating_pin(),
        flange(),
        bearing_seat(),
        gusset_rib(),
    ]
}

fn base_plate() -> Solid {
    let outline = rounded(&[
        (0.0, 0.0, 12.0),
        (142.0, 0.0, 26.0),
        (142.0, 58.0, 8.0),
        (118.0, 96.0, 8.0),
        (0.0, 96.0, 8.0),
    ]);
    let holes = [
        slot(Point2::new(38.0, 50.0), Point2::new(56.0, 25.0), 7.5),
        circle(96.0, 36.0, 14.0),
        circle(14.0, 15.0, 5.5),
        circle(126.0, 13.0, 4.5),
        circle(120.0, 72.0, 4.5),
    ];
    extrude(&outline, &holes, 14.0, 1.2)
}

/// Stepped, with a casting fillet at its foot and a bore that the plate's hole widens below.
fn boss() -> Solid {
    let profile = rounded(&[
        (10.5, 5.0, 0.0),
        (29.0, 5.0, 0.0),
        (29.0, 15.0, 0.0),
        (25.0, 15.0, 3.0),
        (25.0, 42.0, 0.0),
        (23.5, 43.5, 0.0),
        (18.0, 43.5, 1.0),
        (18.0, 56.5, 0.0),
        (16.5, 58.0, 0.0),
        (12.0, 58.0, 0.0),
        (10.5, 56.5, 0.0),
    ]);
    lathe(&profile).placed(|p| Point3::new(p.x + 96.0, p.y + 36.0, p.z))
}

fn locating_pin() -> Solid {
    let profile = [
        [0.0, 8.0],
        [6.0, 8.0],
        [6.0, 24.0],
        [4.0, 27.0],
        [0.0, 27.0],
    ]
    .map(Point2::from);
    lathe(&profile).placed(|p| Point3::new(p.x + 74.0, p.y + 70.0, p.z))
}

/// Stands on the back edge: drawn in (x, z), 12 mm thick along −y.
fn flange() -> Solid {
    let outline = rounded(&[
        (4.0, 4.0, 0.0),
        (104.0, 4.0, 0.0),
        (104.0, 42.0, 9.0),
        (62.0, 42.0, 10.0),
        (62.0, 92.0, 20.0),
        (4.0, 92.0, 12.0),
    ]);
    let holes = [circle(38.0, 66.0, 12.5), circle(88.0, 27.0, 5.0)];
    extrude(&outline, &holes, 12.0, 1.2).placed(upright(96.0))
}

/// The turned ring around the flange's large hole.
fn bearing_seat() -> Solid {
    let profile = [
        [10.0, 8.0],
        [20.0, 8.0],
        [20.0, 18.5],
        [18.5, 20.0],
        [11.5, 20.0],
        [10.0, 18.5],
    ]
    .map(Point2::from);
    let stand = upright(96.0);
    lathe(&profile).placed(|p| stand(Point3::new(p.x + 38.0, p.y + 66.0, p.z)))
}

/// Drawn in (y, z), 9 mm thick along x.
fn gusset_rib() -> Solid {
    let outline = rounded(&[
        (30.0, 10.0, 0.0),
        (90.0, 10.0, 0.0),
        (90.0, 80.0, 0.0),
        (79.0, 80.0, 4.0),
        (30.0, 20.0, 3.0),
    ]);
    extrude(&outline, &[], 9.0, 0.8).placed(|p| Point3::new(p.z + 8.0, p.x, p.y))
}

/// Raises what was drawn in (x, y) into (x, z), its height growing along −y from `back`.
fn upright(back: f64) -> impl Fn(Point3<f64>) -> Point3<f64> {
    move |p| Point3::new(p.x, back - p.z, p.y)
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use nalgebra::{Matrix3, Rotation3, SymmetricEigen, UnitVector3, Vector3};

    use super::*;

    #[test]
    fn the_part_is_closed() {
        for (number, body) in bodies().iter().enumerate() {
            let mut edges: HashMap<(u32, u32), (u32, u32)> = HashMap::new();
            for t in &body.triangles {
                for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                    let uses = edges.entry((a.min(b), a.max(b))).or_default();
                    if a < b { uses.0 += 1 } else { uses.1 += 1 }
                }
            }
            assert!(
                edges.values().all(|&uses| uses == (1, 1)),
                "body {number} has an edge that is not shared by two faces of one orientation"
            );
        }
    }

    #[test]
    fn the_normals_of_every_body_point_outwards() {
        for body in bodies() {
            let volume: f64 = body
                .triangles
                .iter()
                .map(|t| {
                    let [a, b, c] = t.map(|i| body.vertices[i as usize].coords);
                    a.dot(&b.cross(&c)) / 6.0
                })
                .sum();
            assert!(volume > 100.0, "{volume} mm³");
        }
    }

    #[test]
    fn the_part_has_the_stated_size_and_no_degenerate_triangle() {
        let part = mechanical_part();
        let extent = part
            .vertices()
            .iter()
            .fold(Vector3::zeros(), |extent, v| v.coords.abs().sup(&extent));
        assert!((extent * 2.0 - Vector3::new(142.0, 96.0, 92.0)).norm() < 1e-9);
        assert_eq!(part.dropped_triangles(), 0);
        assert!((2_000..20_000).contains(&part.triangles().len()));
    }

    #[test]
    fn the_part_is_the_same_every_time() {
        assert_eq!(mechanical_part(), mechanical_part());
    }

    /// A rotation that maps a body onto itself keeps its centre and its principal axes. When the
    /// three moments differ, only half turns about those axes can be symmetries.
    #[test]
    fn the_part_has_no_rotational_symmetry() {
        let part = mechanical_part();
        let faces: Vec<(f64, Vector3<f64>)> = part
            .triangles()
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|i| part.vertices()[i as usize].coords);
                ((b - a).cross(&(c - a)).norm() / 2.0, (a + b + c) / 3.0)
            })
            .collect();
        let area: f64 = faces.iter().map(|f| f.0).sum();
        let centre = faces.iter().map(|f| f.1 * f.0).sum::<Vector3<f64>>() / area;
        let spread = faces
            .iter()
            .map(|(weight, p)| (p - centre) * (p - centre).transpose() * *weight)
            .sum::<Matrix3<f64>>()
            / area;
        let axes = SymmetricEigen::new(spread);
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let ratio = axes.eigenvalues[i] / axes.eigenvalues[j];
            assert!(!(0.9..1.1).contains(&ratio), "moments {i} and {j}: {ratio}");
        }
        for axis in axes.eigenvectors.column_iter() {
            let turn = Rotation3::from_axis_angle(
                &UnitVector3::new_normalize(axis.into_owned()),
                core::f64::consts::PI,
            );
            let farthest = part
                .vertices()
                .iter()
                .step_by(41)
                .map(|v| {
                    let turned = turn * (v.coords - centre) + centre;
                    part.vertices()
                        .iter()
                        .map(|w| (w.coords - turned).norm_squared())
                        .fold(f64::INFINITY, f64::min)
                })
                .fold(0.0, f64::max);
            assert!(farthest.sqrt() > 20.0, "{} mm", farthest.sqrt());
        }
    }
}
