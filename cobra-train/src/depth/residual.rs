//! The residuals of one pose, pixel by pixel and point by point of its surface.
//!
//! Owns the list of them, and how it is written for other programs. The residuals are the scorer's own
//! ([`cobra_infer::depth::PixelResidual`], [`SurfacePoint`]); pictures of them are `overlay`'s business.

use crate::depth_image::DepthImage;
use cobra_infer::depth::{
    Cell, DepthCheck, DepthError, DepthPixel, DepthSettings, PixelResidual, Seen, Surface,
    SurfacePoint,
};
use cobra_infer::{Camera, Pose};
use nalgebra::Point3;
use std::collections::BTreeSet;

/// What was seen, against one pose. Lengths are in the surface's unit; what was seen behind where the pose puts
/// the surface is positive, what was seen in front of it negative.
#[derive(Clone, Debug, PartialEq)]
pub struct ResidualMap {
    /// The observed pixels that have a depth, with the distance of their back-projection from the surface;
    /// `None` where nothing of the surface speaks for it.
    pub pixels: Vec<(DepthPixel, Option<PixelResidual>)>,
    /// The points of the surface that the pose says are visible, with what was seen there.
    pub surface: Vec<SurfacePoint>,
    /// How far these points lie apart, in pixels.
    pub spacing: f32,
    /// σ_m.
    pub noise: f32,
}

/// Points of the surface lie a pixel apart, but no more of them than this across the object: a template knows
/// its surface no finer.
const MOST_POINTS: f32 = 96.0;

impl ResidualMap {
    /// Of a pose: `pixels` are the observed ones of a mask; without, those in which the pose itself says that
    /// the object is seen, and nothing else hides it.
    ///
    /// # Errors
    /// [`DepthError`], as [`DepthCheck::new`].
    pub fn of(
        surface: &impl Surface,
        camera: &Camera,
        settings: &DepthSettings,
        pose: &Pose,
        pixels: Option<&[DepthPixel]>,
        image: &DepthImage,
    ) -> Result<Self, DepthError> {
        let across = pixels_across(surface, camera, pose);
        let side = across.clamp(f32::from(DepthSettings::SMALLEST_SIDE), MOST_POINTS) as u16;
        let settings = DepthSettings { side, ..*settings };
        let check = DepthCheck::new(surface, camera, &settings)?;
        let mut cells = vec![Cell::EMPTY; settings.cells()];
        let mut points = Vec::new();
        check.visible_surface(pose, image, &mut cells, &mut || {}, &mut |point| {
            points.push(*point);
        })?;
        let silhouette;
        let observed = match pixels {
            Some(pixels) => pixels,
            None => {
                silhouette = pixels_of(&points, image);
                &silhouette
            }
        };
        let mut residuals = Vec::with_capacity(observed.len());
        check.pixel_residuals(pose, observed, &mut |pixel, residual| {
            residuals.push((*pixel, residual));
        });
        Ok(Self {
            pixels: residuals,
            surface: points,
            spacing: across / f32::from(side),
            noise: surface.noise(),
        })
    }

    /// As CSV: `kind,column,row,depth,seen,residual`, a line each, lengths in the surface's unit.
    ///
    /// - `pixel`: an observed pixel, its measured depth, `surface` or `silent`, and the signed distance of its
    ///   back-projection from the surface along the normal; empty where it is silent.
    /// - `surface`: a point that the pose says is visible, where it falls, the depth that it would have,
    ///   `surface`, `through`, `hidden` or `unmeasured`, and how far behind it something was measured along
    ///   the camera's axis; `inf` where nothing is there, empty where nothing was measured.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut text = String::from("kind,column,row,depth,seen,residual\n");
        for (pixel, residual) in &self.pixels {
            let (seen, residual) = match residual {
                Some(residual) => ("surface", format!("{:.3}", residual.distance)),
                None => ("silent", String::new()),
            };
            let DepthPixel { column, row, depth } = pixel;
            text += &format!("pixel,{column},{row},{depth:.3},{seen},{residual}\n");
        }
        for point in &self.surface {
            let (seen, residual) = match point.seen {
                Seen::Surface { behind } => ("surface", format!("{behind:.3}")),
                Seen::Through { behind } => ("through", format!("{behind:.3}")),
                Seen::Hidden { in_front } => ("hidden", format!("{:.3}", -in_front)),
                Seen::Unmeasured => ("unmeasured", String::new()),
            };
            let (x, y, depth) = (point.pixel.x, point.pixel.y, point.depth);
            text += &format!("surface,{x:.2},{y:.2},{depth:.3},{seen},{residual}\n");
        }
        text
    }
}

/// How many pixels the object's bounding sphere is across, about; 0 where it is not in front of the camera.
fn pixels_across(surface: &impl Surface, camera: &Camera, pose: &Pose) -> f32 {
    let [x, y, z] = surface.centre();
    let near = pose.to_camera(&Point3::new(x, y, z)).z - surface.radius();
    let [fx, _, _, _, fy, ..] = camera.to_matrix();
    let across = 2.0 * fx.max(fy) * surface.radius() / near;
    if across > 0.0 { across } else { 0.0 }
}

/// The pixels below points of the surface that were seen, with what was measured there; each once.
fn pixels_of(points: &[SurfacePoint], image: &DepthImage) -> Vec<DepthPixel> {
    let seen = points
        .iter()
        .filter(|point| matches!(point.seen, Seen::Surface { .. } | Seen::Through { .. }));
    let places: BTreeSet<(u16, u16)> = seen
        .map(|point| ((point.pixel.y + 0.5) as u16, (point.pixel.x + 0.5) as u16))
        .collect();
    places
        .into_iter()
        .filter_map(|(row, column)| {
            let depth = image.at(u32::from(column), u32::from(row))?;
            Some(DepthPixel { column, row, depth })
        })
        .collect()
}
