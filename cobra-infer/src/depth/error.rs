//! What can be wrong with the settings and the memory of a check.

use super::settings::DepthSettings;
use crate::error::ScoreError;
use core::fmt;

/// Why a pose could not be checked.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u32)]
pub enum DepthError {
    /// The template cannot be scored with the room or the noise given.
    Score(ScoreError),
    /// The template's components may speak everywhere, so that it does not say where its surface is.
    NoValidity,
    /// σ_m is not positive and finite.
    Noise {
        /// What it comes to, in the template's unit.
        found: f32,
    },
    /// The depth buffer's side is out of range.
    Side {
        /// The side asked for, in cells.
        found: u16,
    },
    /// Steps without pixels.
    StepPixels,
    /// The thresholds are not 0 ≤ reject ≤ accept ≤ 1.
    Thresholds {
        /// From where on is accepted.
        accept: f32,
        /// Below where is rejected.
        reject: f32,
    },
    /// The scratch memory is too small.
    Cells {
        /// How many cells are needed.
        expected: usize,
        /// How many there are.
        found: usize,
    },
}

impl fmt::Display for DepthError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            DepthError::Score(error) => error.fmt(f),
            DepthError::NoValidity => f.write_str(
                "the template's components may speak everywhere, so that it does not say where its \
                 surface is: train it with verified validity",
            ),
            DepthError::Noise { found } => write!(
                f,
                "the measurement's standard deviation must be positive and finite, found {found}"
            ),
            DepthError::Side { found } => write!(
                f,
                "a depth buffer has {} to {} cells along a side, found {found}",
                DepthSettings::SMALLEST_SIDE,
                DepthSettings::LARGEST_SIDE
            ),
            DepthError::StepPixels => {
                f.write_str("refinement needs at least one pixel a step, found 0")
            }
            DepthError::Thresholds { accept, reject } => write!(
                f,
                "thresholds must be 0 <= reject <= accept <= 1, found reject {reject}, accept \
                 {accept}"
            ),
            DepthError::Cells { expected, found } => {
                write!(f, "the depth buffer needs {expected} cells, found {found}")
            }
        }
    }
}

impl core::error::Error for DepthError {}

impl From<ScoreError> for DepthError {
    fn from(error: ScoreError) -> Self {
        Self::Score(error)
    }
}
