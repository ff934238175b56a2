//! The object as a depth camera sees it, alone, from all around.
//!
//! Owns the camera, the true poses, and what a confidence must reach there to be as good as the truth's.

use super::{AmbiguityError, Masks, SearchOptions};
use crate::bop::render::{DepthNoise, PlacedModel, RenderModel, render};
use crate::depth_image::DepthImage;
use crate::input::ImageSize;
use crate::pose::single_pose;
use crate::random::{Purpose, stream};
use crate::surface::{Mesh, fibonacci_sphere};
use cobra_infer::Camera;
use cobra_infer::depth::{
    Cell, DepthCheck, DepthPixel, DepthReport, DepthSettings, Observed, Surface,
};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use rand::RngExt;
use std::f64::consts::TAU;

/// Focal length of the camera in pixels, that of a depth camera with 640 columns and an angle of view of
/// 56°.
const FOCAL_LENGTH: f64 = 600.0;

/// The object's bounding sphere is so many pixels wide: a quarter of such a camera's columns.
const WIDTH: f64 = 160.0;

/// A window of the image of twice that width around the object, where wrong poses may be looked up.
const SIZE: ImageSize = ImageSize {
    width: 320,
    height: 320,
};

/// How many of the pixels that show the object are used, as when results are scored.
const PIXELS: usize = 500;

/// What is used of them while a candidate is still on its way, and of them in a step …
const FEW_PIXELS: usize = 100;
const FEW_STEP_PIXELS: u16 = 50;

/// … and cells along a side of the depth buffer: together a quarter of the time.
const FEW_CELLS: u16 = 16;

/// The camera that all views are taken with: the window's middle is where it looks.
pub(super) fn camera() -> Camera {
    let focal_length = FOCAL_LENGTH as f32;
    let [x, y] = [SIZE.width, SIZE.height].map(|side| 0.5 * (side as f32 - 1.0));
    Camera::new(focal_length, focal_length, x, y).expect("a focal length above 0")
}

/// The object at a known pose.
pub(super) struct View {
    pub(super) truth: Isometry3<f64>,
    depth: DepthImage,
    pixels: Vec<DepthPixel>,
    few_pixels: Vec<DepthPixel>,
    /// The true pose's confidence.
    pub(super) confidence: f32,
    /// What a confidence must reach.
    pub(super) least: f32,
}

impl View {
    /// The pixels that show the object.
    pub(super) fn pixels(&self) -> &[DepthPixel] {
        &self.pixels
    }
}

/// True poses: from directions along a golden spiral, the camera turned about its own axis by chance.
///
/// # Panics
/// Never: a camera's direction of view is a direction.
fn truths(mesh: &Mesh, options: &SearchOptions) -> Vec<Isometry3<f64>> {
    let sphere = mesh.bounding_sphere();
    let distance = FOCAL_LENGTH * 2.0 * sphere.radius / WIDTH;
    let mut rng = stream(options.seed, Purpose::Ambiguity, 0);
    fibonacci_sphere(options.views)
        .into_iter()
        .map(|from| {
            // The direction that the camera stands in is turned towards it, −z.
            let towards = UnitQuaternion::rotation_between(
                &from.into_inner(),
                &-Vector3::z_axis().into_inner(),
            )
            .unwrap_or_else(|| UnitQuaternion::from_axis_angle(&Vector3::x_axis(), TAU / 2.0));
            let about =
                UnitQuaternion::from_axis_angle(&Vector3::z_axis(), TAU * rng.random::<f64>());
            Translation3::new(0.0, 0.0, distance)
                * (about * towards)
                * Translation3::from(-sphere.centre.coords)
        })
        .collect()
}

/// Checks motions of the object in its views.
pub(super) struct Judge<'s, S> {
    pub(super) surface: &'s S,
    check: DepthCheck<'s, S>,
    rough: DepthCheck<'s, S>,
    cells: usize,
    masks: Masks,
    pub(super) views: Vec<View>,
}

/// How closely is looked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Look {
    /// At few pixels: good enough to find the way.
    Rough,
    /// As poses are checked.
    Full,
}

/// Scratch memory of a thread.
pub(super) type Room = Vec<Cell>;

impl<'s, S: Surface + Sync> Judge<'s, S> {
    /// Renders the views, and checks the true poses in them.
    pub(super) fn new(
        mesh: &Mesh,
        surface: &'s S,
        options: &SearchOptions,
    ) -> Result<Self, AmbiguityError> {
        let model = RenderModel::new(mesh);
        let views = truths(mesh, options).into_iter().zip(0_u32..);
        let views = views
            .map(|(pose, image)| {
                let placed = PlacedModel {
                    model: &model,
                    pose,
                };
                let frame = render(&camera(), SIZE, &[placed]).with_noise(&DepthNoise {
                    standard_deviation: options.noise,
                    seed: options.seed,
                    scene: 0,
                    image,
                });
                let mask = frame.visible(0);
                View {
                    truth: pose,
                    pixels: frame.depth().pixels_in(&mask, PIXELS),
                    few_pixels: frame.depth().pixels_in(&mask, FEW_PIXELS),
                    depth: frame.depth().clone(),
                    confidence: 0.0,
                    least: 1.0,
                }
            })
            .collect();
        let few = DepthSettings {
            side: options.settings.side.min(FEW_CELLS),
            step_pixels: options.settings.step_pixels.min(FEW_STEP_PIXELS),
            ..options.settings
        };
        let mut judge = Self {
            surface,
            rough: DepthCheck::new(surface, &camera(), &few)?,
            check: DepthCheck::new(surface, &camera(), &options.settings)?,
            cells: options.settings.cells(),
            masks: options.masks,
            views,
        };
        let none = Isometry3::identity();
        let mut room = judge.room();
        for index in 0..judge.views.len() {
            let report = judge.report(Look::Full, &judge.views[index], &none, &mut room)?;
            let confidence = report.map_or(0.0, |report| report.confidence);
            let accept = options.settings.thresholds.map(|both| both.accept);
            let view = &mut judge.views[index];
            view.confidence = confidence;
            view.least = accept.unwrap_or(options.share * confidence);
        }
        Ok(judge)
    }

    /// What [`Judge::report`] works in.
    pub(super) fn room(&self) -> Room {
        vec![Cell::EMPTY; self.cells]
    }

    /// Checks the pose that a motion leads to; `None` where it is none.
    pub(super) fn report(
        &self,
        look: Look,
        view: &View,
        motion: &Isometry3<f64>,
        room: &mut Room,
    ) -> Result<Option<DepthReport>, AmbiguityError> {
        let Ok(pose) = single_pose(&(view.truth * motion)) else {
            return Ok(None);
        };
        let (check, pixels) = match look {
            Look::Rough => (&self.rough, &view.few_pixels),
            Look::Full => (&self.check, &view.pixels),
        };
        let observed = match self.masks {
            Masks::Visible => Observed::Pixels(pixels),
            Masks::Silhouette => Observed::Silhouette,
        };
        let report = check.run(&pose, observed, &view.depth, room, &mut || {})?;
        Ok(Some(report))
    }
}
