//! How a pose is checked against depth: the choices, their defaults, and where these come from.
//!
//! The defaults were chosen on 4,390 estimates of three estimators on LineMOD-Occlusion with simulated
//! depth; `docs/DEPTH.md` says what others come to.

use super::error::DepthError;
use crate::template::{DepthRecord, Template};

/// The standard deviation σ_m that measurements are granted beside the template's own σ̂.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Noise {
    /// This share of the object's diameter, above 0.
    Share(f32),
    /// The sensor's own: σ_m = constant + linear·z + quadratic·z² at the depth z of the object's middle, in
    /// the template's unit.
    Sensor {
        /// In the template's unit.
        constant: f32,
        /// A share of the depth.
        linear: f32,
        /// In 1/unit.
        quadratic: f32,
    },
}

impl Noise {
    /// σ_m of an object of this diameter at this depth. What is not in front of the camera counts as one
    /// diameter away: a sensor's model says nothing of it, and no confidence will depend on it.
    ///
    /// # Errors
    /// [`DepthError::Noise`] where it is not positive and finite.
    pub fn at(self, diameter: f32, depth: f32) -> Result<f32, DepthError> {
        let sigma = match self {
            Self::Share(share) => share * diameter,
            Self::Sensor {
                constant,
                linear,
                quadratic,
            } => {
                let depth = if depth > 0.0 { depth } else { diameter };
                constant + (linear + quadratic * depth) * depth
            }
        };
        positive(sigma)
    }
}

/// σ_m itself, if it is one.
pub(super) fn positive(sigma: f32) -> Result<f32, DepthError> {
    if sigma.is_finite() && sigma >= f32::MIN_POSITIVE {
        Ok(sigma)
    } else {
        Err(DepthError::Noise { found: sigma })
    }
}

/// What confidences are accepted and rejected; between the two the answer is undecided.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Thresholds {
    /// From this confidence on a pose is accepted.
    pub accept: f32,
    /// Below this it is rejected; not above `accept`.
    pub reject: f32,
}

/// How a pose is checked.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct DepthSettings {
    /// σ_m.
    pub noise: Noise,
    /// What is accepted; `None` leaves every pose undecided that is not rejected for another reason.
    pub thresholds: Option<Thresholds>,
    /// With fewer observed pixels, or fewer points of the surface that the depth says something of, the
    /// decision is undecided.
    pub minimum_points: u32,
    /// Cells along a side of the depth buffer, from [`DepthSettings::SMALLEST_SIDE`] to
    /// [`DepthSettings::LARGEST_SIDE`]: memory and the number of visible points grow with its square.
    pub side: u16,
    /// Gauss-Newton steps.
    pub steps: u16,
    /// How many observed pixels a step uses at most: every so many-th.
    pub step_pixels: u16,
}

impl DepthSettings {
    /// Depth buffers of fewer cells along a side show too little of the object.
    pub const SMALLEST_SIDE: u16 = 8;

    /// More cells than there are pixels of most objects.
    pub const LARGEST_SIDE: u16 = 256;

    /// The noise of templates that do not say theirs, a buffer of 32² cells, four steps on at most 150
    /// pixels, at least ten points, and no thresholds.
    pub const DEFAULT: Self = Self {
        noise: Noise::Share(DepthRecord::NOISE_SHARE),
        thresholds: None,
        minimum_points: 10,
        side: 32,
        steps: 4,
        step_pixels: 150,
    };

    /// What the template knows: its σ_m, and its thresholds where it was calibrated; the rest as in
    /// [`DepthSettings::DEFAULT`].
    #[must_use]
    pub fn for_template(template: &Template<'_>) -> Self {
        let mut settings = Self::DEFAULT;
        let Some(record) = template.depth() else {
            return settings;
        };
        settings.noise = Noise::Share(record.noise_share);
        if let Some(calibration) = record.calibration {
            settings.thresholds = Some(Thresholds {
                accept: calibration.accept,
                reject: calibration.reject,
            });
            settings.minimum_points = calibration.minimum_points;
        }
        settings
    }

    /// How many [`super::Cell`]s the check needs as scratch memory, of four bytes each.
    #[must_use]
    pub const fn cells(&self) -> usize {
        self.side as usize * self.side as usize
    }

    /// Whether every number but the noise's, which depend on the object, lies in its range.
    ///
    /// # Errors
    /// [`DepthError`] of the one that does not.
    pub fn check(&self) -> Result<(), DepthError> {
        if !(Self::SMALLEST_SIDE..=Self::LARGEST_SIDE).contains(&self.side) {
            return Err(DepthError::Side { found: self.side });
        }
        if self.step_pixels == 0 {
            return Err(DepthError::StepPixels);
        }
        match self.thresholds {
            Some(Thresholds { accept, reject })
                if !(0.0 <= reject && reject <= accept && accept <= 1.0) =>
            {
                Err(DepthError::Thresholds { accept, reject })
            }
            _ => Ok(()),
        }
    }
}
