//! What the image says against a pose, pixel by pixel and point by point.
//!
//! Owns the sign that both looks share: what was seen behind where the pose puts the surface is positive, what
//! was seen in front of it negative. What follows from them for the pose is the business of the check, which
//! sums the same distances.

use super::check::DepthCheck;
use super::error::DepthError;
use super::observed::{DepthImage, DepthPixel};
use super::pulse::Pulse;
use super::reverse::{Sight, look_up};
use super::surface::Surface;
use super::zbuffer::Cell;
use crate::math;
use crate::pose::Pose;
use nalgebra::Point2;

/// What an observed pixel comes to.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PixelResidual {
    /// The distance of its back-projection from the surface along the normal, in the template's unit: above 0
    /// behind the surface as the camera sees it, below 0 in front of it. It is the distance that the forward
    /// likelihood and refinement are made of.
    pub distance: f32,
    /// exp(−distance²/2σ²), between 0 and 1.
    pub likelihood: f32,
}

/// A point of the surface that a camera sees at the pose, and what it saw there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Where it falls on the image, pixel centres at integers; it may lie outside.
    pub pixel: Point2<f32>,
    /// Its depth along the camera's axis, in the template's unit.
    pub depth: f32,
    /// What was seen there.
    pub seen: Seen,
}

/// What was seen at a point that must be visible; lengths along the camera's axis, in the template's unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Seen {
    /// Nothing was measured there, or it lies outside of the image.
    Unmeasured,
    /// Something more than 3σ in front of it hides it: no evidence.
    Hidden {
        /// How far in front of the point that is, above 0.
        in_front: f32,
    },
    /// A surface within 3σ, or in front of it less than that: evidence.
    Surface {
        /// How far behind the point it is, below 0 in front of it.
        behind: f32,
    },
    /// Something more than 3σ behind it, or nothing at all: the camera sees through it, evidence against it.
    Through {
        /// How far behind the point that is; infinite where nothing is.
        behind: f32,
    },
}

impl<S: Surface> DepthCheck<'_, S> {
    /// Hands over every pixel that has a depth with what it comes to, in their order; `None` for those that
    /// nothing of the surface speaks for, which count with likelihood 0.
    ///
    /// These are all pixels, as the forward likelihood takes them.
    pub fn pixel_residuals(
        &self,
        pose: &Pose,
        pixels: &[DepthPixel],
        take: &mut impl FnMut(&DepthPixel, Option<PixelResidual>),
    ) {
        for pixel in pixels.iter().filter(|pixel| pixel.is_measured()) {
            take(pixel, self.pixel_residual(pose, pixel));
        }
    }

    fn pixel_residual(&self, pose: &Pose, pixel: &DepthPixel) -> Option<PixelResidual> {
        let (point, nearby) = self.look_back(pose, pixel)?;
        // Rᵀ(λK⁻¹p) is the way from the camera's centre to the point, in the object's frame.
        let eye = pose.to_object(&nalgebra::Point3::origin());
        let ray = [point.x - eye.x, point.y - eye.y, point.z - eye.z];
        let away = math::dot(ray, nearby.normal) >= 0.0;
        let distance = nearby.distance;
        Some(PixelResidual {
            distance: if away { distance } else { -distance },
            likelihood: nearby.likelihood,
        })
    }

    /// Hands over the points of the surface that a camera sees at the pose, as the reverse likelihood takes
    /// them: row by row of a depth buffer of [`super::DepthSettings::side`] cells a side. None where the pose
    /// does not put the object in front of the camera. `cells` and `alive` as of [`DepthCheck::run`].
    ///
    /// # Errors
    /// [`DepthError::Cells`] where the scratch memory is too small.
    pub fn visible_surface(
        &self,
        pose: &Pose,
        image: &impl DepthImage,
        cells: &mut [Cell],
        alive: &mut impl FnMut(),
        take: &mut impl FnMut(&SurfacePoint),
    ) -> Result<(), DepthError> {
        let pulse = &mut Pulse::new(alive);
        let Some(buffer) = self.depth_buffer(pose, cells, pulse)? else {
            return Ok(());
        };
        let sigma = self.noise();
        buffer.visible(pulse, &mut |visible| {
            take(&SurfacePoint {
                pixel: visible.pixel,
                depth: visible.depth,
                seen: match look_up(image, visible, sigma) {
                    Sight::Unmeasured => Seen::Unmeasured,
                    Sight::Hidden(depth) => Seen::Hidden {
                        in_front: visible.depth - depth,
                    },
                    Sight::Measured(_, behind) if through(behind, sigma) => {
                        Seen::Through { behind }
                    }
                    Sight::Measured(_, behind) => Seen::Surface { behind },
                },
            });
        });
        Ok(())
    }
}

/// Whether what is so far behind a point of the surface says that the camera sees through it.
pub(super) fn through(behind: f32, sigma: f32) -> bool {
    behind > super::reverse::HIDDEN_SIGMAS * sigma
}
