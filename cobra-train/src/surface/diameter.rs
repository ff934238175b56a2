//! The exact diameter of a set of points.
//!
//! Owns a branch and bound over pairs of boxes of a k-d tree. It stays fast where a search by
//! distance from the centre, or over the vertices of the convex hull, does not: on a sphere, where
//! every point is a candidate.

use nalgebra::{Point3, Unit, center};

/// More than rounding takes from a bound, as a share of it.
const ROUNDING: f64 = 1e-12;

/// Boxes with at most this many points are compared point by point.
const LEAF: usize = 4;

/// Boxes with at most this many points are bounded by the points themselves as well.
const PATCH: usize = 64;

/// The largest distance between two of the points; 0 for fewer than two.
pub(super) fn diameter(mut points: Vec<Point3<f64>>) -> f64 {
    if points.len() < 2 {
        return 0.0;
    }
    let mut best = far_apart(&points);
    let mut boxes = Vec::with_capacity(points.len());
    grow(&mut points, 0, &mut boxes);
    let mut pairs = vec![(0_usize, 0_usize)];
    while let Some((i, j)) = pairs.pop() {
        let (a, b) = (&boxes[i], &boxes[j]);
        if a.farthest_squared(b) <= best {
            continue;
        }
        let few = LEAF + 1..=PATCH;
        if few.contains(&a.count())
            && few.contains(&b.count())
            && patches_squared(a, b, &points) <= best
        {
            continue;
        }
        match (a.children, b.children) {
            (None, None) => {
                for p in a.points(&points) {
                    for q in b.points(&points) {
                        best = best.max(distance_squared(p, q));
                    }
                }
            }
            (Some((l, r)), _) if i == j => pairs.extend([(l, l), (r, r), (l, r)]),
            (Some((l, r)), None) => push_farther_last(&mut pairs, &boxes, (l, j), (r, j)),
            (Some((l, r)), Some(_)) if a.count() >= b.count() => {
                push_farther_last(&mut pairs, &boxes, (l, j), (r, j));
            }
            (_, Some((l, r))) => push_farther_last(&mut pairs, &boxes, (i, l), (i, r)),
        }
    }
    best.sqrt()
}

/// The box of some of the points, and the two boxes that its points are divided into.
struct Node {
    low: Point3<f64>,
    high: Point3<f64>,
    first: usize,
    end: usize,
    children: Option<(usize, usize)>,
}

impl Node {
    fn count(&self) -> usize {
        self.end - self.first
    }

    fn points<'a>(&self, all: &'a [Point3<f64>]) -> &'a [Point3<f64>] {
        &all[self.first..self.end]
    }

    /// No point of the box is farther from its centre.
    fn radius(&self, centre: &Point3<f64>) -> f64 {
        (self.high - centre).sup(&(centre - self.low)).norm()
    }

    /// No point of the one box is farther from a point of the other. Computed in the order of
    /// [`distance_squared`], all of whose steps are monotone, so that rounding cannot break this.
    fn farthest_squared(&self, other: &Self) -> f64 {
        let along = |axis: usize| {
            (self.high[axis] - other.low[axis])
                .abs()
                .max((other.high[axis] - self.low[axis]).abs())
        };
        let (x, y, z) = (along(0), along(1), along(2));
        x * x + y * y + z * z
    }
}

fn distance_squared(p: &Point3<f64>, q: &Point3<f64>) -> f64 {
    let (x, y, z) = (p.x - q.x, p.y - q.y, p.z - q.z);
    x * x + y * y + z * z
}

/// A bound on the squared distances between the points of two boxes that knows that opposite
/// patches of a round surface are flat along the line between them, where boxes are thick: the
/// exact extent along that line, and the boxes' radii across it.
fn patches_squared(a: &Node, b: &Node, points: &[Point3<f64>]) -> f64 {
    let (from, to) = (center(&a.low, &a.high), center(&b.low, &b.high));
    let Some((line, length)) = Unit::try_new_and_get(from - to, 0.0) else {
        return f64::INFINITY;
    };
    let beyond_from = |p: &Point3<f64>| (p - from).dot(&line);
    let beyond_to = |p: &Point3<f64>| (to - p).dot(&line);
    let largest = |largest: f64, next: f64| largest.max(next);
    let extent = length
        + a.points(points)
            .iter()
            .map(beyond_from)
            .fold(f64::MIN, largest)
        + b.points(points)
            .iter()
            .map(beyond_to)
            .fold(f64::MIN, largest);
    let across = a.radius(&from) + b.radius(&to);
    // Boxes that overlap may also extend past each other the other way.
    let along = extent.max(across - length);
    (along * along + across * across) * (1.0 + ROUNDING)
}

fn push_farther_last(
    pairs: &mut Vec<(usize, usize)>,
    boxes: &[Node],
    one: (usize, usize),
    other: (usize, usize),
) {
    let bound = |(i, j): (usize, usize)| boxes[i].farthest_squared(&boxes[j]);
    if bound(one) <= bound(other) {
        pairs.extend([one, other]);
    } else {
        pairs.extend([other, one]);
    }
}

/// The squared length of a long chord: from the first point to the farthest from it, and on from
/// there a few times. A good start prunes most pairs.
fn far_apart(points: &[Point3<f64>]) -> f64 {
    let mut from = points[0];
    let mut best = 0.0;
    for _ in 0..4 {
        for p in points {
            let squared = distance_squared(&from, p);
            if squared > best {
                (best, from) = (squared, *p);
            }
        }
    }
    best
}

/// Appends the box of `points`, which begin at `first` of all, and the boxes below it; returns its
/// place.
fn grow(points: &mut [Point3<f64>], first: usize, boxes: &mut Vec<Node>) -> usize {
    let (low, high) = points
        .iter()
        .fold((points[0], points[0]), |(low, high), p| {
            (low.inf(p), high.sup(p))
        });
    let place = boxes.len();
    let count = points.len();
    boxes.push(Node {
        low,
        high,
        first,
        end: first + count,
        children: None,
    });
    if count > LEAF {
        let axis = (high - low).imax();
        points.select_nth_unstable_by(count / 2, |p, q| p[axis].total_cmp(&q[axis]));
        let (left, right) = points.split_at_mut(count / 2);
        let left = grow(left, first, boxes);
        let right = grow(right, first + count / 2, boxes);
        boxes[place].children = Some((left, right));
    }
    place
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    fn by_comparing_all(points: &[Point3<f64>]) -> f64 {
        let mut best = 0.0_f64;
        for (i, p) in points.iter().enumerate() {
            for q in &points[i + 1..] {
                best = best.max((p - q).norm());
            }
        }
        best
    }

    fn uv_sphere(rings: u32, segments: u32) -> Vec<Point3<f64>> {
        let mut points = Vec::new();
        for ring in 0..=rings {
            let polar = std::f64::consts::PI * f64::from(ring) / f64::from(rings);
            for segment in 0..segments {
                let turn = std::f64::consts::TAU * f64::from(segment) / f64::from(segments);
                let (z, r) = (polar.cos(), polar.sin());
                points.push(Point3::new(r * turn.cos(), r * turn.sin(), z));
            }
        }
        points
    }

    #[test]
    fn the_diameter_is_that_of_comparing_all_pairs() {
        let mut rng = ChaCha8Rng::seed_from_u64(7);
        for count in [2, 3, 5, 9, 100, 1500] {
            for stretch in [1.0, 0.01, 0.0] {
                let aside = if count % 2 == 0 { 1e6 } else { 0.0 };
                let points: Vec<_> = (0..count)
                    .map(|_| Point3::from(rng.random::<[f64; 3]>().map(|c| c + aside)))
                    .map(|p| Point3::new(p.x, p.y * stretch, p.z))
                    .collect();
                assert_eq!(diameter(points.clone()), by_comparing_all(&points));
            }
        }
        let sphere = uv_sphere(40, 41);
        assert_eq!(diameter(sphere.clone()), by_comparing_all(&sphere));
    }

    #[test]
    fn coinciding_points_have_no_diameter() {
        assert_eq!(diameter(vec![Point3::new(1.0, 2.0, 3.0); 50]), 0.0);
        assert_eq!(diameter(vec![Point3::origin()]), 0.0);
    }
}
