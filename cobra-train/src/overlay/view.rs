//! Which part of the image a panel shows, and how large.

use nalgebra::Point2;

/// A panel of `width` × `height` pixels of the page, showing the image from a corner on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct View {
    corner: Point2<f32>,
    /// Pixels of the page a pixel of the image.
    zoom: f32,
    width: u32,
    height: u32,
}

/// What a close-up leaves free around what it shows, as a share of its size.
const MARGIN: f32 = 0.12;

/// A close-up shows no fewer pixels of the image than this.
const LEAST: f32 = 24.0;

impl View {
    /// All of an image, as wide as the panel.
    pub(super) fn whole(image: (u32, u32), width: u32) -> Self {
        let zoom = width as f32 / image.0 as f32;
        Self {
            corner: Point2::new(-0.5, -0.5),
            zoom,
            width,
            height: (image.1 as f32 * zoom).round() as u32,
        }
    }

    /// A close-up of points that lie in the image or no farther beside it than it is large; `None` where there
    /// are none.
    pub(super) fn around(
        points: impl Iterator<Item = Point2<f32>>,
        image: (u32, u32),
        side: u32,
    ) -> Option<Self> {
        let [width, height] = [image.0 as f32, image.1 as f32];
        let near = |p: &Point2<f32>| {
            p.x > -width && p.x < 2.0 * width && p.y > -height && p.y < 2.0 * height
        };
        let mut points = points.filter(near);
        let first = points.next()?;
        let (low, high) = points.fold((first, first), |(low, high), p| (low.inf(&p), high.sup(&p)));
        let across = (high - low).max().max(LEAST) * (1.0 + 2.0 * MARGIN);
        let middle = nalgebra::center(&low, &high);
        Some(Self {
            corner: middle - nalgebra::Vector2::repeat(0.5 * across),
            zoom: side as f32 / across,
            width: side,
            height: side,
        })
    }

    /// All of an image in a square, where there is nothing to look at closely.
    pub(super) fn all(image: (u32, u32), side: u32) -> Self {
        let across = image.0.max(image.1) as f32;
        let margin = [image.0, image.1].map(|t| 0.5 * (across - t as f32) + 0.5);
        Self {
            corner: Point2::new(-margin[0], -margin[1]),
            zoom: side as f32 / across,
            width: side,
            height: side,
        }
    }

    pub(super) fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    pub(super) fn zoom(&self) -> f32 {
        self.zoom
    }

    /// The point of the image that a pixel of the page shows.
    pub(super) fn pixel(&self, column: u32, row: u32) -> Point2<f32> {
        let along = |at: u32, corner: f32| corner + (at as f32 + 0.5) / self.zoom;
        Point2::new(along(column, self.corner.x), along(row, self.corner.y))
    }

    /// Where the page shows a point of the image, in pixels of the page from the panel's corner.
    pub(super) fn place(&self, pixel: Point2<f32>) -> Point2<f32> {
        Point2::from((pixel - self.corner) * self.zoom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_of_the_image_is_shown_where_the_page_shows_it() {
        let corners = [Point2::new(100.0, 50.0), Point2::new(180.0, 90.0)];
        let view = View::around(corners.into_iter(), (640, 480), 300).unwrap();
        for pixel in corners {
            let at = view.place(pixel);
            assert!(at.x > 20.0 && at.x < 280.0 && at.y > 20.0 && at.y < 280.0);
            let shown = view.pixel(at.x as u32, at.y as u32);
            assert!((shown - pixel).norm() * view.zoom() < 1.0);
        }
        let whole = View::whole((640, 480), 1280);
        assert_eq!(whole.size(), (1280, 960));
        assert_eq!(whole.place(Point2::new(-0.5, -0.5)), Point2::origin());
        assert!(View::around([].into_iter(), (640, 480), 300).is_none());
    }
}
