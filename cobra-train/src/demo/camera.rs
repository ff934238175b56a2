//! The pinhole camera of the pictures, and close-ups of its image.
//!
//! Owns projection and its inverse for drawing only: the scorer's camera is `cobra-infer`'s.

use nalgebra::{Point2, Point3, Vector2, Vector3};

/// A pinhole camera: +Z forward, x to the right, y downwards, pixel centres at integers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Focal length in pixels, along x.
    pub fx: f64,
    /// Focal length in pixels, along y.
    pub fy: f64,
    /// The principal point's column.
    pub cx: f64,
    /// The principal point's row.
    pub cy: f64,
    /// Columns of the image.
    pub width: u32,
    /// Rows of the image.
    pub height: u32,
}

impl Camera {
    /// A close-up of `width` × `height` pixels: the part of this camera's image plane that shows
    /// all of `observed` and as much of `estimate` as lies near it, with a margin. Points are in
    /// the camera's frame, in any unit.
    ///
    /// `None` if there is no observed point, or one is not in front of the camera. Such points of
    /// the estimate are left out.
    #[must_use]
    pub fn framing(
        &self,
        observed: &[Point3<f64>],
        estimate: &[Point3<f64>],
        width: u32,
        height: u32,
    ) -> Option<Self> {
        let observed: Option<Vec<_>> = observed.iter().map(|p| self.project(p)).collect();
        let (low, high) = bounds(observed?.into_iter())?;
        let near = Vector2::repeat(NEAR * (high - low).max());
        let (low, high) = bounds(
            estimate
                .iter()
                .filter_map(|p| self.project(p))
                .map(|p| p.sup(&(low - near)).inf(&(high + near)))
                .chain([low, high]),
        )?;
        let (size, middle) = (high - low, nalgebra::center(&low, &high));
        let scale =
            (f64::from(width) / size.x).min(f64::from(height) / size.y) / (1.0 + 2.0 * MARGIN);
        let place = |principal: f64, middle: f64, pixels: u32| {
            (principal - middle) * scale + (f64::from(pixels) - 1.0) / 2.0
        };
        Some(Self {
            fx: self.fx * scale,
            fy: self.fy * scale,
            cx: place(self.cx, middle.x, width),
            cy: place(self.cy, middle.y, height),
            width,
            height,
        })
    }

    /// The pixel that shows a point, or `None` if the point is not in front of the camera.
    fn project(&self, point: &Point3<f64>) -> Option<Point2<f64>> {
        (point.z > 0.0).then(|| {
            Point2::new(
                self.fx * point.x / point.z + self.cx,
                self.fy * point.y / point.z + self.cy,
            )
        })
    }

    /// The ray through a pixel's centre, with z = 1.
    pub(super) fn ray(&self, column: usize, row: usize) -> Vector3<f64> {
        Vector3::new(
            (column as f64 - self.cx) / self.fx,
            (row as f64 - self.cy) / self.fy,
            1.0,
        )
    }
}

/// How far beyond the observed object's larger side a close-up follows the estimate.
const NEAR: f64 = 0.25;
/// What a close-up leaves free around the objects, as a share of their size.
const MARGIN: f64 = 0.06;

fn bounds(mut points: impl Iterator<Item = Point2<f64>>) -> Option<(Point2<f64>, Point2<f64>)> {
    let first = points.next()?;
    Some(points.fold((first, first), |(low, high), p| (low.inf(&p), high.sup(&p))))
}

#[cfg(test)]
mod tests {
    use super::*;

    const CAMERA: Camera = Camera {
        fx: 600.0,
        fy: 620.0,
        cx: 319.5,
        cy: 239.5,
        width: 640,
        height: 480,
    };

    fn square(x: f64, half: f64) -> [Point3<f64>; 2] {
        [
            Point3::new(x - half, 30.0 - half, 500.0),
            Point3::new(x + half, 30.0 + half, 500.0),
        ]
    }

    #[test]
    fn a_close_up_centres_what_it_shows() {
        let object = square(-40.0, 50.0);
        let view = CAMERA.framing(&object, &object, 200, 120).unwrap();
        let [low, high] = object.map(|p| view.project(&p).unwrap());
        assert!((nalgebra::center(&low, &high) - Point2::new(99.5, 59.5)).norm() < 1e-9);
        assert!((high.y - low.y - 120.0 / (1.0 + 2.0 * MARGIN)).abs() < 1e-9);
    }

    #[test]
    fn a_wild_estimate_does_not_make_the_observed_object_small() {
        let object = square(0.0, 50.0);
        let view = CAMERA
            .framing(&object, &square(9_000.0, 50.0), 200, 200)
            .unwrap();
        let [low, high] = object.map(|p| view.project(&p).unwrap());
        assert!(high.x - low.x > 120.0 && low.x > 0.0 && high.x < 200.0);
        let behind = square(0.0, 50.0).map(|p| Point3::from(-p.coords));
        let view = CAMERA.framing(&object, &behind, 200, 200).unwrap();
        assert_eq!(Some(view), CAMERA.framing(&object, &object, 200, 200));
    }

    #[test]
    fn an_object_behind_the_camera_has_no_close_up() {
        let behind = square(0.0, 50.0).map(|p| Point3::from(-p.coords));
        assert!(CAMERA.framing(&behind, &[], 200, 200).is_none());
        assert!(CAMERA.framing(&[], &[], 200, 200).is_none());
    }
}
