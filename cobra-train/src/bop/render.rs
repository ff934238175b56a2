//! The depth that a camera would measure of objects at known poses.
//!
//! Owns which object a pixel shows, how far it is, and the noise. Shading is `demo`'s business. What
//! is not among the objects - a table, a hand - is not there: such pixels are far, not unmeasured.

use crate::depth_image::DepthImage;
use crate::input::ImageSize;
use crate::pixel_mask::PixelMask;
use crate::random::{Purpose, normal, stream};
use crate::surface::{Mesh, RayCaster};
use cobra_infer::Camera;
use nalgebra::{Isometry3, Point2, Point3};
use rayon::prelude::*;
use std::ops::Range;

/// A mesh, in millimetres, that can be rendered at any pose.
pub struct RenderModel {
    caster: RayCaster,
    vertices: Vec<Point3<f64>>,
}

/// An object in front of the camera.
#[derive(Clone, Copy)]
pub struct PlacedModel<'a> {
    /// What it looks like.
    pub model: &'a RenderModel,
    /// Its pose, object to camera, in millimetres.
    pub pose: Isometry3<f64>,
}

/// Noise on simulated depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthNoise {
    /// Standard deviation along the camera's axis, in millimetres; 0 leaves depths as they are.
    pub standard_deviation: f64,
    /// Same seed, same noise.
    pub seed: u64,
    /// The scene that the image is of.
    pub scene: u32,
    /// The image: each has its own noise, whichever others are rendered.
    pub image: u32,
}

/// A rendered image: depth, and which object each pixel shows.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulatedFrame {
    depth: DepthImage,
    shown: Vec<Option<u16>>,
}

/// What one pixel shows.
#[derive(Clone, Copy)]
struct Seen {
    depth: f32,
    object: Option<u16>,
}

const NOTHING: Seen = Seen {
    depth: f32::INFINITY,
    object: None,
};

impl DepthNoise {
    /// The standard deviation of simulated depth unless somebody says otherwise, in millimetres.
    pub const MILLIMETRES: f64 = 1.5;
}

impl RenderModel {
    /// Prepares a mesh for rendering.
    #[must_use]
    pub fn new(mesh: &Mesh) -> Self {
        Self {
            caster: RayCaster::new(mesh),
            vertices: mesh.used_vertices().copied().collect(),
        }
    }
}

/// Renders the objects, one ray through the centre of each pixel; where several are hit, the nearest
/// is seen, and of two equally near the first.
///
/// # Panics
/// If there are more than 65,536 objects.
#[must_use]
pub fn render(camera: &Camera, size: ImageSize, objects: &[PlacedModel<'_>]) -> SimulatedFrame {
    let views: Vec<View<'_>> = objects
        .iter()
        .enumerate()
        .map(|(index, object)| {
            let number = u16::try_from(index).expect("at most 65,536 objects in an image");
            View::new(number, object, camera, size)
        })
        .collect();
    let width = size.width as usize;
    let mut pixels = vec![NOTHING; width * size.height as usize];
    pixels
        .par_chunks_mut(width)
        .zip(0_u32..size.height)
        .for_each(|(line, row)| {
            for view in views.iter().filter(|view| view.rows.contains(&row)) {
                for column in view.columns.clone() {
                    let seen = &mut line[column as usize];
                    let depth = view.depth(camera, column, row);
                    if let Some(depth) = depth.filter(|depth| *depth < seen.depth) {
                        *seen = Seen {
                            depth,
                            object: Some(view.number),
                        };
                    }
                }
            }
        });
    SimulatedFrame {
        depth: DepthImage::new(size, pixels.iter().map(|seen| seen.depth).collect()),
        shown: pixels.iter().map(|seen| seen.object).collect(),
    }
}

/// One object as the camera sees it.
struct View<'a> {
    number: u16,
    caster: &'a RayCaster,
    to_object: Isometry3<f64>,
    /// The pixels outside of which no ray can hit.
    columns: Range<u32>,
    rows: Range<u32>,
}

impl<'a> View<'a> {
    fn new(number: u16, object: &PlacedModel<'a>, camera: &Camera, size: ImageSize) -> Self {
        let [columns, rows] = bounds(object, camera, size);
        Self {
            number,
            caster: &object.model.caster,
            to_object: object.pose.inverse(),
            columns,
            rows,
        }
    }

    /// z of the first point on a pixel's ray, in millimetres.
    fn depth(&self, camera: &Camera, column: u32, row: u32) -> Option<f32> {
        let ray = camera
            .ray(&Point2::new(column as f32, row as f32))
            .cast::<f64>();
        let eye = Point3::from(self.to_object.translation.vector);
        let hit = self.caster.cast(&eye, &(self.to_object * ray))?;
        // The ray's z is 1.
        Some((hit.distance / ray.norm()) as f32)
    }
}

/// The columns and rows that the object's projection lies in: those of its vertices where all are in
/// front of the camera, none where none is, all of the image else.
fn bounds(object: &PlacedModel<'_>, camera: &Camera, size: ImageSize) -> [Range<u32>; 2] {
    let seen = |vertex: &Point3<f64>| (object.pose * vertex).cast::<f32>();
    let vertices = &object.model.vertices;
    let in_front = vertices
        .iter()
        .filter(|vertex| seen(vertex).z > 0.0)
        .count();
    if in_front == 0 {
        return [0..0, 0..0];
    }
    if in_front < vertices.len() {
        return [0..size.width, 0..size.height];
    }
    let projected = vertices
        .iter()
        .filter_map(|vertex| camera.project(&seen(vertex)));
    let none = (
        Point2::new(f32::MAX, f32::MAX),
        Point2::new(f32::MIN, f32::MIN),
    );
    let (low, high) = projected.fold(none, |(low, high), p| (low.inf(&p), high.sup(&p)));
    // A pixel more on each side, for the rounding of the projection.
    let range = |low: f32, high: f32, end: u32| {
        let start = (low.floor() - 1.0).max(0.0) as u32;
        start..((high.ceil() + 2.0).max(0.0) as u32).min(end)
    };
    [
        range(low.x, high.x, size.width),
        range(low.y, high.y, size.height),
    ]
}

impl SimulatedFrame {
    /// Depth: infinite, measured and far, where no object is.
    #[must_use]
    pub fn depth(&self) -> &DepthImage {
        &self.depth
    }

    /// Which of the objects a pixel shows, as an index among those that were rendered; `None` where
    /// it shows none, and outside of the image.
    #[must_use]
    pub fn object_at(&self, column: u32, row: u32) -> Option<usize> {
        let shown = self.shown.get(self.depth.size().index(column, row)?)?;
        shown.map(usize::from)
    }

    /// The pixels that show an object, by its index among those that were rendered.
    #[must_use]
    pub fn visible(&self, object: usize) -> PixelMask {
        let shows = |shown: &Option<u16>| shown.map(usize::from) == Some(object);
        PixelMask::new(self.depth.size(), self.shown.iter().map(shows).collect())
    }

    /// The same frame with Gaussian noise on every depth that is an object's; what falls to 0 or
    /// below is not measured.
    #[must_use]
    pub fn with_noise(self, noise: &DepthNoise) -> Self {
        if noise.standard_deviation == 0.0 {
            return self;
        }
        let image = u64::from(noise.scene) << 32 | u64::from(noise.image);
        let mut rng = stream(noise.seed, Purpose::DepthNoise, image);
        let exact = self.depth.millimetres().iter().zip(&self.shown);
        let noisy = exact.map(|(depth, shown)| match shown {
            Some(_) => {
                let moved = f64::from(*depth) + noise.standard_deviation * normal(&mut rng);
                moved.max(0.0) as f32
            }
            None => *depth,
        });
        Self {
            depth: DepthImage::new(self.depth.size(), noisy.collect()),
            shown: self.shown,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    const SIZE: ImageSize = ImageSize {
        width: 64,
        height: 48,
    };

    fn camera() -> Camera {
        Camera::from_matrix([60., 0.5, 31.5, 0., 62., 23.5, 0., 0., 1.]).unwrap()
    }

    /// A rectangle of 40 by 20 mm at z = 0.
    fn card() -> RenderModel {
        let corners = [[-20., -10.], [20., -10.], [20., 10.], [-20., 10.]];
        let corners = corners.map(|[x, y]| Point3::new(x, y, 0.0)).to_vec();
        RenderModel::new(&Mesh::new(corners, vec![[0, 1, 2], [0, 2, 3]]).unwrap())
    }

    fn at(model: &RenderModel, x: f64, z: f64) -> PlacedModel<'_> {
        PlacedModel {
            model,
            pose: Isometry3::translation(x, 0.0, z),
        }
    }

    fn noise(seed: u64, scene: u32, image: u32) -> DepthNoise {
        DepthNoise {
            standard_deviation: 1.5,
            seed,
            scene,
            image,
        }
    }

    #[test]
    fn depth_is_along_the_axis_and_far_where_nothing_is() {
        let card = card();
        let frame = render(&camera(), SIZE, &[at(&card, 0.0, 100.0)]);
        let visible = frame.visible(0);
        // 40 · 60 / 100 by 20 · 62 / 100 pixels.
        assert!(
            visible.count().abs_diff(24 * 12) <= 24,
            "{}",
            visible.count()
        );
        for row in 0..SIZE.height {
            for column in 0..SIZE.width {
                let depth = frame.depth().at(column, row).unwrap();
                if visible.contains(column, row) {
                    assert!((depth - 100.0).abs() < 1e-4, "{depth}");
                    assert_eq!(frame.object_at(column, row), Some(0));
                } else {
                    assert_eq!(depth, f32::INFINITY);
                    assert_eq!(frame.object_at(column, row), None);
                }
            }
        }
        assert_eq!(frame.object_at(64, 0), None);
    }

    #[test]
    fn a_tilted_surface_lies_on_its_plane() {
        let card = card();
        let pose = Isometry3::new(Vector3::new(2.0, 1.0, 90.0), Vector3::new(0.4, -0.7, 0.2));
        let frame = render(&camera(), SIZE, &[PlacedModel { model: &card, pose }]);
        let visible = frame.visible(0);
        assert!(visible.count() > 50);
        for (column, row) in visible.pixels() {
            let depth = frame.depth().at(column, row).unwrap();
            let ray = camera().ray(&Point2::new(column as f32, row as f32));
            let point = pose.inverse() * Point3::from(ray * depth).cast::<f64>();
            assert!(point.z.abs() < 1e-4, "{point}");
            assert!(point.x.abs() < 20.001 && point.y.abs() < 10.001, "{point}");
        }
    }

    #[test]
    fn the_nearest_object_is_seen_whatever_the_order() {
        let card = card();
        let (near, far) = (at(&card, 8.0, 80.0), at(&card, 0.0, 100.0));
        let alone = render(&camera(), SIZE, &[near]).visible(0);
        let first = render(&camera(), SIZE, &[near, far]);
        let last = render(&camera(), SIZE, &[far, near]);
        assert_eq!(first.depth(), last.depth());
        assert_eq!(first.visible(0), alone);
        assert_eq!(last.visible(1), alone);
        assert!(last.visible(0).count() > 0);
        assert!(last.visible(0).pixels().all(|(c, r)| !alone.contains(c, r)));
    }

    #[test]
    fn the_rectangle_around_the_projection_leaves_nothing_out() {
        let card = card();
        for pose in [
            Isometry3::new(Vector3::new(30.0, -5.0, 60.0), Vector3::new(0.3, 0.2, 0.9)),
            Isometry3::new(Vector3::new(-55.0, 20.0, 70.0), Vector3::new(1.0, 0.0, 0.0)),
            // Through the camera's plane, behind it, and beside the image.
            Isometry3::new(Vector3::new(5.0, 3.0, 10.0), Vector3::new(0.0, 1.4, 0.0)),
            Isometry3::translation(0.0, 0.0, -100.0),
            Isometry3::translation(500.0, 0.0, 100.0),
        ] {
            let placed = PlacedModel { model: &card, pose };
            let frame = render(&camera(), SIZE, &[placed]);
            let mut view = View::new(0, &placed, &camera(), SIZE);
            (view.columns, view.rows) = (0..SIZE.width, 0..SIZE.height);
            for row in view.rows.clone() {
                for column in view.columns.clone() {
                    let everywhere = view.depth(&camera(), column, row);
                    assert_eq!(
                        frame.depth().at(column, row),
                        Some(everywhere.unwrap_or(f32::INFINITY))
                    );
                }
            }
        }
    }

    #[test]
    fn noise_has_its_size_and_leaves_what_is_far() {
        let card = card();
        let exact = render(&camera(), SIZE, &[at(&card, 0.0, 60.0)]);
        let noisy = exact.clone().with_noise(&noise(0, 2, 3));
        let pixels: Vec<_> = exact.visible(0).pixels().collect();
        let off = |(column, row): &(u32, u32)| {
            let [a, b] = [&noisy, &exact].map(|frame| frame.depth().at(*column, *row).unwrap());
            f64::from(a - b)
        };
        let mean = pixels.iter().map(off).sum::<f64>() / pixels.len() as f64;
        let square = pixels.iter().map(|p| off(p).powi(2)).sum::<f64>() / pixels.len() as f64;
        assert!(mean.abs() < 0.3, "{mean}");
        assert!((square.sqrt() - 1.5).abs() < 0.2, "{}", square.sqrt());
        assert_eq!(noisy.depth().at(0, 0), Some(f32::INFINITY));
        assert_eq!(noisy.visible(0), exact.visible(0));
    }

    #[test]
    fn noise_depends_on_seed_scene_and_image_and_not_on_threads() {
        let card = card();
        let objects = [at(&card, 0.0, 100.0), at(&card, 10.0, 90.0)];
        let noisy = |n: &DepthNoise| render(&camera(), SIZE, &objects).with_noise(n);
        let frame = noisy(&noise(0, 2, 3));
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            let again = pool.build().unwrap().install(|| noisy(&noise(0, 2, 3)));
            assert_eq!(again, frame);
        }
        for other in [
            noise(1, 2, 3),
            noise(0, 1, 3),
            noise(0, 2, 4),
            noise(0, 3, 2),
        ] {
            assert_ne!(noisy(&other).depth(), frame.depth());
        }
    }
}
