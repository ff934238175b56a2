//! One simulated scene: the object, what it stands before and behind, and the depth that a camera sees.

use crate::bop::render::{PlacedModel, RenderModel, render};
use crate::bop::score::ScoreOptions;
use crate::depth_image::DepthImage;
use crate::input::ImageSize;
use crate::pixel_mask::PixelMask;
use crate::pose::single_pose;
use crate::random::normal;
use cobra_infer::depth::{DepthPixel, Surface};
use cobra_infer::{Camera, Pose, PoseError};
use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion};
use rand::{Rng, RngExt};

const SIZE: ImageSize = ImageSize {
    width: 640,
    height: 480,
};
const FOCAL_LENGTH: f32 = 570.0;

/// Distance of the object, in diameters.
const DISTANCE: std::ops::Range<f64> = 4.0..10.0;

/// How far the plane behind the object is from its middle, and the wall in front, in diameters.
const BACKGROUND: std::ops::Range<f64> = 0.6..4.0;
const WALL: std::ops::Range<f64> = 0.6..2.0;

/// The share of scenes with a wall, and of the square around the object that it hides.
const WALLS: f64 = 0.5;
const HIDDEN: std::ops::Range<f64> = 0.0..0.7;

/// Points of a surface that is rendered lie this share of a pixel apart.
const SPACING: f32 = 0.4;

/// A pixel with nothing on it is filled where so many around it show the object.
const FILLING: usize = 5;

/// A scene.
pub(super) struct Scene {
    camera: Camera,
    truth: Isometry3<f64>,
    depth: DepthImage,
    shown: PixelMask,
}

impl Scene {
    pub(super) fn draw<S: Surface>(
        surface: &S,
        model: Option<&RenderModel>,
        noise: f64,
        rng: &mut impl Rng,
    ) -> Result<Self, PoseError> {
        let camera = Camera::new(FOCAL_LENGTH, FOCAL_LENGTH, 319.5, 239.5)
            .expect("positive focal lengths make a camera");
        let diameter = f64::from(surface.diameter());
        let middle = Point3::from(surface.centre()).cast::<f64>();
        let rotation = UnitQuaternion::new_normalize(nalgebra::Quaternion::new(
            normal(rng),
            normal(rng),
            normal(rng),
            normal(rng),
        ));
        let distance = diameter * rng.random_range(DISTANCE);
        let truth = Translation3::new(0.0, 0.0, distance)
            * Isometry3::from_parts(Translation3::identity(), rotation)
            * Translation3::from(-middle.coords);
        let object = match model {
            Some(model) => {
                let placed = PlacedModel { model, pose: truth };
                render(&camera, SIZE, &[placed])
                    .depth()
                    .millimetres()
                    .to_vec()
            }
            None => of_surface(surface, &camera, &single_pose(&truth)?),
        };
        let background = distance + diameter * rng.random_range(BACKGROUND);
        let wall = Wall::draw(surface, distance, diameter, rng);
        let mut shown = vec![false; object.len()];
        let mut depths = Vec::with_capacity(object.len());
        for (index, on_object) in object.into_iter().enumerate() {
            let (column, row) = (index as u32 % SIZE.width, index as u32 / SIZE.width);
            let exact = match &wall {
                Some(wall) if wall.hides(column, row) => wall.depth,
                _ if on_object.is_finite() => {
                    shown[index] = true;
                    f64::from(on_object)
                }
                _ => background,
            };
            depths.push((exact + noise * normal(rng)).max(0.0) as f32);
        }
        Ok(Self {
            camera,
            truth,
            depth: DepthImage::new(SIZE, depths),
            shown: PixelMask::new(SIZE, shown),
        })
    }

    pub(super) fn camera(&self) -> &Camera {
        &self.camera
    }

    pub(super) fn truth(&self) -> &Isometry3<f64> {
        &self.truth
    }

    pub(super) fn depth(&self) -> &DepthImage {
        &self.depth
    }

    /// At most as many of the pixels that show the object as scoring uses, spread evenly.
    pub(super) fn mask(&self) -> Vec<DepthPixel> {
        self.depth.pixels_in(&self.shown, ScoreOptions::PIXELS)
    }
}

/// What hides a part of the image: all on one side of a line.
struct Wall {
    across: [f64; 2],
    edge: f64,
    depth: f64,
}

impl Wall {
    fn draw<S: Surface>(
        surface: &S,
        distance: f64,
        diameter: f64,
        rng: &mut impl Rng,
    ) -> Option<Self> {
        let (there, angle) = (rng.random::<f64>(), rng.random::<f64>());
        let (hidden, front) = (rng.random_range(HIDDEN), rng.random_range(WALL));
        let half = f64::from(FOCAL_LENGTH) * f64::from(surface.radius()) / distance;
        (there < WALLS).then(|| Self {
            across: libm::sincos(std::f64::consts::TAU * angle).into(),
            edge: half * (2.0 * hidden - 1.0),
            depth: distance - diameter * front,
        })
    }

    fn hides(&self, column: u32, row: u32) -> bool {
        let (x, y) = (f64::from(column) - 319.5, f64::from(row) - 239.5);
        let [a, b] = self.across;
        a * x + b * y < self.edge
    }
}

/// The depth of a surface's own points, infinite where there is none.
fn of_surface<S: Surface>(surface: &S, camera: &Camera, pose: &Pose) -> Vec<f32> {
    let (width, height) = (SIZE.width as usize, SIZE.height as usize);
    let mut depths = vec![f32::INFINITY; width * height];
    let near = pose.to_camera(&surface.centre().into()).z - surface.radius();
    surface.sample(SPACING * near / FOCAL_LENGTH, &mut |point| {
        let Some(seen) = point.map(|point| pose.to_camera(point)) else {
            return;
        };
        let Some(pixel) = camera.project(&seen) else {
            return;
        };
        let (column, row) = ((pixel.x + 0.5).floor(), (pixel.y + 0.5).floor());
        let inside = |t: f32, end: usize| t >= 0.0 && t < end as f32;
        if inside(column, width) && inside(row, height) {
            let depth = &mut depths[row as usize * width + column as usize];
            *depth = depth.min(seen.z);
        }
    });
    let filled: Vec<f32> = (0..depths.len())
        .map(|index| {
            if depths[index].is_finite() {
                return depths[index];
            }
            let (column, row) = (index % width, index / width);
            let columns = column.saturating_sub(1)..(column + 2).min(width);
            let around = (row.saturating_sub(1)..(row + 2).min(height))
                .flat_map(|row| columns.clone().map(move |column| row * width + column))
                .map(|index| depths[index])
                .filter(|depth| depth.is_finite());
            if around.clone().count() < FILLING {
                return f32::INFINITY;
            }
            let count = around.clone().count() as f32;
            around.sum::<f32>() / count
        })
        .collect();
    filled
}
