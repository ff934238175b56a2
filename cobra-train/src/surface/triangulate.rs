//! Polygons become triangles, the same way in every format.
//!
//! Owns the choice between a fan and ear clipping; `earcut` owns the clipping. Which indices are
//! valid is the business of the format.

use earcut::Earcut;
use earcut::utils3d::project3d_to_2d;
use nalgebra::{Point3, Vector3};

/// Polygons with more corners become fans, right or wrong: ear clipping may take the square of
/// their number.
const MOST_CORNERS: usize = 2000;

/// The triangles of a fan may be turned against the polygon by this share of the longest edge's
/// square: rounding.
const ROUNDING: f64 = 1e-12;

/// Ear clipping must cover the polygon's area up to this share; it does not where edges cross.
const COVERED: f64 = 1e-6;

/// Turns polygons into triangles and keeps its buffers between them.
#[derive(Default)]
pub(super) struct Triangulator {
    earcut: Earcut<f64>,
    corners: Vec<[f64; 3]>,
    flat: Vec<[f64; 2]>,
    ears: Vec<u32>,
}

impl Triangulator {
    /// Appends the triangles of `polygon`, whose indices all name one of the `vertices`; nothing
    /// for fewer than three corners.
    ///
    /// The triangles are the fan around the first corner where that is right, as for every
    /// triangle and every convex polygon, and the ears of the polygon elsewhere. A polygon that
    /// has no area, crosses itself, or has thousands of corners becomes a fan.
    pub(super) fn append(
        &mut self,
        polygon: &[u32],
        vertices: &[Point3<f64>],
        triangles: &mut Vec<[u32; 3]>,
    ) {
        let at = |i: u32| vertices[i as usize];
        let clip = (4..=MOST_CORNERS).contains(&polygon.len())
            && !fan_is_right(polygon, &at)
            && self.clip_ears(polygon, &at);
        if clip {
            let ears = self.ears.chunks_exact(3);
            triangles.extend(ears.map(|t| [t[0], t[1], t[2]].map(|i| polygon[i as usize])));
        } else if let [first, rest @ ..] = polygon {
            triangles.extend(rest.windows(2).map(|edge| [*first, edge[0], edge[1]]));
        }
    }

    /// Whether ear clipping covers the polygon; then `ears` holds its places in the polygon.
    fn clip_ears(&mut self, polygon: &[u32], at: &impl Fn(u32) -> Point3<f64>) -> bool {
        let (Some(&first), Some(size)) = (polygon.first(), size(polygon, at)) else {
            return false;
        };
        let origin = at(first);
        self.corners.clear();
        // The projection takes small polygons for degenerate ones.
        self.corners.extend(
            polygon
                .iter()
                .map(|&i| <[f64; 3]>::from((at(i) - origin) / size)),
        );
        if !project3d_to_2d(&self.corners, self.corners.len(), &mut self.flat) {
            return false;
        }
        self.earcut.earcut_slice(&self.flat, &[], &mut self.ears);
        let left: f64 = earcut::deviation(self.flat.iter().copied(), &[], &self.ears);
        !self.ears.is_empty() && left < COVERED
    }
}

/// The largest extent along an axis, where it can be divided by.
fn size(polygon: &[u32], at: &impl Fn(u32) -> Point3<f64>) -> Option<f64> {
    let origin = at(*polygon.first()?);
    let size = polygon
        .iter()
        .map(|&i| (at(i) - origin).amax())
        .fold(0.0, f64::max);
    (size.is_normal()).then_some(size)
}

/// Whether no triangle of the fan is turned against the polygon as a whole. For a polygon whose
/// edges do not cross, the triangles then tile it. NaN is never right nor wrong: the fan stays.
fn fan_is_right(polygon: &[u32], at: &impl Fn(u32) -> Point3<f64>) -> bool {
    let Some(size) = size(polygon, at) else {
        return true;
    };
    let origin = at(polygon[0]);
    let fan: Vec<Vector3<f64>> = polygon[1..]
        .windows(2)
        .map(|edge| {
            let [a, b] = [edge[0], edge[1]].map(|i| (at(i) - origin) / size);
            a.cross(&b)
        })
        .collect();
    let whole: Vector3<f64> = fan.iter().sum();
    let Some(normal) = whole.try_normalize(ROUNDING) else {
        return true;
    };
    fan.iter()
        .all(|triangle| triangle.dot(&normal) >= -ROUNDING)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangles(corners: &[[f64; 3]]) -> Vec<[u32; 3]> {
        let vertices: Vec<Point3<f64>> = corners.iter().map(|&c| c.into()).collect();
        let polygon: Vec<u32> = (0..vertices.len() as u32).collect();
        let mut triangles = Vec::new();
        Triangulator::default().append(&polygon, &vertices, &mut triangles);
        triangles
    }

    fn fan(corners: u32) -> Vec<[u32; 3]> {
        (1..corners - 1).map(|i| [0, i, i + 1]).collect()
    }

    /// The sum of the triangles' areas, and of their area vectors' lengths along `normal`.
    fn areas(corners: &[[f64; 3]], triangles: &[[u32; 3]], normal: Vector3<f64>) -> (f64, f64) {
        let at = |i: u32| Point3::from(corners[i as usize]);
        let crosses = triangles
            .iter()
            .map(|t| (at(t[1]) - at(t[0])).cross(&(at(t[2]) - at(t[0]))));
        crosses.fold((0.0, 0.0), |(all, along), c| {
            (all + c.norm() / 2.0, along + c.dot(&normal) / 2.0)
        })
    }

    /// An L of area 3 whose first corner does not see all others.
    const L: [[f64; 2]; 6] = [
        [2.0, 0.0],
        [2.0, 1.0],
        [1.0, 1.0],
        [1.0, 2.0],
        [0.0, 2.0],
        [0.0, 0.0],
    ];

    #[test]
    fn convex_polygons_become_fans() {
        let square = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.1],
            [0.0, 1.0, 0.0],
        ];
        assert_eq!(triangles(&square), fan(4));
        let ring: Vec<[f64; 3]> = (0..30)
            .map(|i| f64::from(i) / 30.0 * std::f64::consts::TAU)
            .map(|turn| [turn.cos(), 7.0, turn.sin()])
            .collect();
        assert_eq!(triangles(&ring), fan(30));
        let with_a_corner_on_an_edge = [
            [0.0, 0.0, 0.0],
            [0.3, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
        ];
        assert_eq!(triangles(&with_a_corner_on_an_edge), fan(5));
    }

    #[test]
    fn concave_polygons_are_covered_once_in_every_plane_and_size() {
        for size in [1e-40, 1e-3, 1.0, 1e40] {
            for turn in 0..6 {
                for (tilt, normal) in [(0.0, [0.0, 0.0, 1.0]), (1.0, [-1.0, 0.0, 1.0])] {
                    for direction in [1.0, -1.0] {
                        let mut corners: Vec<[f64; 3]> = (0..6)
                            .map(|i| L[(i + turn) % 6])
                            .map(|[x, y]| [x * size, y * size, tilt * x * size])
                            .collect();
                        if direction < 0.0 {
                            corners.reverse();
                        }
                        let normal = Vector3::from(normal).normalize() * direction;
                        let area = 3.0 * size * size * (1.0 + tilt * tilt).sqrt();
                        let (all, along) = areas(&corners, &triangles(&corners), normal);
                        assert!((all / area - 1.0).abs() < 1e-9, "{size} {turn} {tilt}");
                        assert!((along / area - 1.0).abs() < 1e-9, "{size} {turn} {tilt}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_concave_quad_is_divided_along_the_right_diagonal() {
        let arrow = [
            [0.0, 0.0, 0.0],
            [4.0, -2.0, 0.0],
            [1.0, 0.0, 0.0],
            [4.0, 2.0, 0.0],
        ];
        assert_eq!(triangles(&arrow), fan(4));
        let turned = [arrow[1], arrow[2], arrow[3], arrow[0]];
        let (all, _) = areas(&turned, &triangles(&turned), Vector3::z());
        assert!((all - 2.0).abs() < 1e-12, "{all}");
    }

    #[test]
    fn degenerate_polygons_become_fans() {
        assert_eq!(triangles(&[[1.0, 2.0, 3.0]; 5]), fan(5));
        let line: Vec<[f64; 3]> = (0..6).map(|i| [f64::from(i % 4), 0.0, 0.0]).collect();
        assert_eq!(triangles(&line), fan(6));
        let mut unusable = [[0.0; 3]; 5];
        for bad in [f64::NAN, f64::INFINITY, f64::MAX, 1e-310] {
            unusable[2] = [bad, 1.0, 0.0];
            unusable[3] = [bad, -bad, 1.0];
            assert_eq!(triangles(&unusable).len(), 3, "{bad}");
        }
        let bow_tie = [
            [0.0, 0.0, 0.0],
            [2.0, 2.0, 0.0],
            [2.0, 0.0, 0.0],
            [0.0, 3.0, 0.0],
        ];
        assert_eq!(triangles(&bow_tie).len(), 2);
        assert!(triangles(&[[0.0; 3]; 2]).is_empty());
        assert!(triangles(&[]).is_empty());
    }

    #[test]
    fn a_polygon_of_many_corners_comes_to_an_end() {
        for corners in [MOST_CORNERS, 200_000] {
            let comb: Vec<[f64; 3]> = (0..corners)
                .map(|i| [i as f64, if i % 2 == 0 { 0.0 } else { 1e6 }, 0.0])
                .collect();
            assert!(!triangles(&comb).is_empty());
        }
    }
}
