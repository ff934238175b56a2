//! Straight lines between points of the image, cut off at the panel's rim.

use super::view::View;
use crate::demo::style::{Drawn, Page};
use nalgebra::Point2;
use plotters::prelude::*;

/// Draws a line of the image on a panel's page.
pub(super) fn line(
    page: &Page<'_>,
    view: &View,
    ends: [Point2<f32>; 2],
    style: ShapeStyle,
) -> Drawn {
    let (width, height) = view.size();
    let ends = ends.map(|end| view.place(end));
    match clipped(ends, [width as f32, height as f32]) {
        Some([a, b]) => {
            let [a, b] = [a, b].map(|p| (p.x.round() as i32, p.y.round() as i32));
            page.draw(&PathElement::new(vec![a, b], style))
        }
        None => Ok(()),
    }
}

/// The part of a segment that lies in 0 ≤ x ≤ width, 0 ≤ y ≤ height (Y.-D. Liang and B. Barsky, ACM Trans.
/// Graph. 3, 1984); `None` where there is none.
fn clipped([a, b]: [Point2<f32>; 2], size: [f32; 2]) -> Option<[Point2<f32>; 2]> {
    // What lies next to the camera's plane is projected so far away that single precision loses the panel.
    let (a, b) = (a.cast::<f64>(), b.cast::<f64>());
    let step = b - a;
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for axis in 0..2 {
        let end = f64::from(size[axis]);
        for (towards, room) in [(-step[axis], a[axis]), (step[axis], end - a[axis])] {
            if towards > 0.0 {
                to = to.min(room / towards);
            } else if towards < 0.0 {
                from = from.max(room / towards);
            } else if room < 0.0 || room.is_nan() {
                return None;
            }
        }
    }
    (from <= to).then(|| [from, to].map(|at| (a + step * at).cast()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_segment_ends_where_the_panel_does() {
        let points = |[x, y, u, v]: [f32; 4]| [Point2::new(x, y), Point2::new(u, v)];
        let size = [100.0, 50.0];
        for (segment, expected) in [
            ([10.0, 10.0, 90.0, 40.0], Some([10.0, 10.0, 90.0, 40.0])),
            ([-100.0, 25.0, 200.0, 25.0], Some([0.0, 25.0, 100.0, 25.0])),
            ([50.0, -1e9, 50.0, 1e9], Some([50.0, 0.0, 50.0, 50.0])),
            ([-10.0, -10.0, -10.0, 90.0], None),
            ([120.0, 0.0, 90.0, -40.0], None),
        ] {
            let found = clipped(points(segment), size);
            match (found, expected.map(points)) {
                (Some([a, b]), Some([c, d])) => {
                    assert!((a - c).norm() < 0.1 && (b - d).norm() < 0.1, "{a} {b}");
                }
                (found, expected) => assert_eq!(found, expected),
            }
        }
    }
}
