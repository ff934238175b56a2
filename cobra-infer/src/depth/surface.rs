//! The surface that a pose is checked against, as far as the check needs to know it.
//!
//! Owns the questions, and how a template answers them. On a host the exact mesh can answer as well, which
//! is how it is measured what a template loses.

use super::error::DepthError;
use super::settings::DepthSettings;
use crate::mixture::{Mixture, Settings, Sigma};
use crate::pose::Pose;
use crate::template::Template;
use nalgebra::Point3;

/// What a surface says of a point near it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Nearby {
    /// The signed distance to the surface along the normal, in the surface's unit.
    pub distance: f32,
    /// The unit vector along which the distance grows.
    pub normal: [f32; 3],
    /// exp(−distance²/2σ²), between 0 and 1.
    pub likelihood: f32,
}

/// A surface in the object's frame.
pub trait Surface {
    /// The middle of a sphere that holds it.
    fn centre(&self) -> [f32; 3];

    /// That sphere's radius.
    fn radius(&self) -> f32;

    /// The largest distance between two of its points.
    fn diameter(&self) -> f32;

    /// σ_m, which its likelihoods are made with.
    fn noise(&self) -> f32;

    /// What it says of a point; `None` where that is nothing.
    fn nearby(&self, point: &Point3<f32>) -> Option<Nearby>;

    /// Hands over points of it, all sides of it, no farther apart than about `spacing`, in an order that
    /// is always the same; `None` for every place where it looked for one and there is none, so that who
    /// has to feed a watchdog can count them.
    fn sample(&self, spacing: f32, take: &mut impl FnMut(Option<&Point3<f32>>));
}

/// A template of at most `COMPONENTS` components as a surface.
#[derive(Clone, Debug)]
pub struct TemplateSurface<'t, const COMPONENTS: usize> {
    template: &'t Template<'t>,
    mixture: Mixture<'t, COMPONENTS>,
    noise: f32,
}

impl<'t, const COMPONENTS: usize> TemplateSurface<'t, COMPONENTS> {
    /// With σ² = σ̂_k² + `noise`², `noise` being σ_m in the template's unit.
    ///
    /// # Errors
    /// [`DepthError::NoValidity`]; [`DepthError::Score`] where there are too many components or `noise` is
    /// negative or not finite.
    pub fn new(template: &'t Template<'t>, noise: f32) -> Result<Self, DepthError> {
        if !template.has_validity() {
            return Err(DepthError::NoValidity);
        }
        let mut settings = Settings::for_template(template, 1.0);
        settings.sigma = Sigma::Template { noise };
        Mixture::<COMPONENTS>::check(template, &settings)?;
        // Filled inside the result: a mixture moved into it would lie on the stack twice.
        let mut result = Ok(Self {
            template,
            mixture: Mixture::unprepared(template, &settings),
            noise,
        });
        if let Ok(surface) = &mut result {
            surface.mixture.prepare(&settings);
        }
        result
    }

    /// The same with the noise that the settings give the object where the pose puts it.
    ///
    /// # Errors
    /// As [`TemplateSurface::new`]; [`DepthError::Noise`] where the noise is not positive and finite.
    pub fn at_pose(
        template: &'t Template<'t>,
        settings: &DepthSettings,
        pose: &Pose,
    ) -> Result<Self, DepthError> {
        let middle = pose.to_camera(&Point3::from(template.centre()));
        match settings.noise.at(template.diameter(), middle.z) {
            Ok(noise) => Self::new(template, noise),
            Err(error) => Err(error),
        }
    }
}

impl<const COMPONENTS: usize> Surface for TemplateSurface<'_, COMPONENTS> {
    fn centre(&self) -> [f32; 3] {
        self.template.centre()
    }

    fn radius(&self) -> f32 {
        self.template.radius()
    }

    fn diameter(&self) -> f32 {
        self.template.diameter()
    }

    fn noise(&self) -> f32 {
        self.noise
    }

    fn nearby(&self, point: &Point3<f32>) -> Option<Nearby> {
        let found = self.mixture.evaluate(point)?;
        let slope = self.mixture.slope(point, &found)?;
        let distance = found.residual() / slope.length;
        Some(Nearby {
            distance,
            normal: slope.normal,
            likelihood: self.mixture.peak(&found, distance),
        })
    }

    fn sample(&self, spacing: f32, take: &mut impl FnMut(Option<&Point3<f32>>)) {
        self.mixture.sample(spacing, take);
    }
}
