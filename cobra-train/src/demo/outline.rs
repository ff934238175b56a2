//! Plane outlines of machined parts: polygons with rounded corners, circles, slots.
//!
//! Owns points in the plane only; `solid` makes bodies of them. Sines and cosines come from
//! `libm`, so that the same outline has the same bits on every host.

use nalgebra::{Point2, Vector2};

/// Chords of a full circle; an arc gets its share.
pub(super) const CHORDS: usize = 72;

/// A corner of an outline: where its straight sides would meet, and the radius that rounds it
/// (0 for a sharp corner), in millimetres.
pub(super) type Corner = (f64, f64, f64);

/// The closed polygon with these corners, in their order, each rounded by a tangent arc.
///
/// The sides must be longer than the tangents that their corners' arcs take from them.
pub(super) fn rounded(corners: &[Corner]) -> Vec<Point2<f64>> {
    let count = corners.len();
    let at = |i: usize| Point2::new(corners[i % count].0, corners[i % count].1);
    let mut outline = Vec::new();
    for (i, &(x, y, radius)) in corners.iter().enumerate() {
        let corner = Point2::new(x, y);
        let arriving = (corner - at(i + count - 1)).normalize();
        let leaving = (at(i + 1) - corner).normalize();
        let sine = arriving.perp(&leaving);
        let cosine = arriving.dot(&leaving);
        if radius == 0.0 {
            outline.push(corner);
            continue;
        }
        let tangent = radius * sine.abs() / (1.0 + cosine);
        let turn = libm::atan2(sine, cosine);
        let towards_centre = Vector2::new(-arriving.y, arriving.x) * radius.copysign(sine);
        let start = corner - arriving * tangent;
        outline.extend(arc(start, start + towards_centre, turn));
    }
    outline
}

/// A circle, anticlockwise.
pub(super) fn circle(x: f64, y: f64, radius: f64) -> Vec<Point2<f64>> {
    let centre = Point2::new(x, y);
    let mut points = arc(
        centre + Vector2::new(radius, 0.0),
        centre,
        core::f64::consts::TAU,
    );
    points.pop();
    points
}

/// A slot, anticlockwise: everything within `radius` of the segment between two points.
pub(super) fn slot(from: Point2<f64>, to: Point2<f64>, radius: f64) -> Vec<Point2<f64>> {
    let along = (to - from).normalize();
    let right = Vector2::new(along.y, -along.x) * radius;
    let mut points = arc(to + right, to, core::f64::consts::PI);
    points.extend(arc(from - right, from, core::f64::consts::PI));
    points
}

/// Points on an arc, both ends included, turning by `turn` radians about the centre.
fn arc(start: Point2<f64>, centre: Point2<f64>, turn: f64) -> Vec<Point2<f64>> {
    let share = turn.abs() / core::f64::consts::TAU * CHORDS as f64;
    let chords = (share.round() as usize).max(3);
    let arm = start - centre;
    (0..=chords)
        .map(|i| {
            let angle = turn * i as f64 / chords as f64;
            let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
            centre + Vector2::new(arm.x * cosine - arm.y * sine, arm.x * sine + arm.y * cosine)
        })
        .collect()
}
