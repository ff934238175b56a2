//! What can be wrong with a camera, a pose or a setting. What can be wrong with a template is
//! [`crate::template`]'s.
//!
//! Every error says what was found and, where there is a choice, what was expected. All are small
//! `Copy` values: a controller can store one and report it later.

use core::fmt;

/// Why numbers are not a pinhole camera.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum CameraError {
    /// An entry of K is NaN or infinite.
    NotFinite {
        /// Its row, from 0.
        row: usize,
        /// Its column, from 0.
        column: usize,
    },
    /// A focal length is not positive.
    FocalLength {
        /// `fx` or `fy`.
        name: &'static str,
        /// Its value, in pixels.
        value: f32,
    },
    /// K does not have the form (fx s cx; 0 fy cy; 0 0 1).
    Shape {
        /// The entries below the diagonal: (1,0), (2,0), (2,1).
        below: [f32; 3],
        /// The last entry.
        last: f32,
    },
    /// A distortion coefficient is not 0.
    Distorted {
        /// Which coefficient, from 0.
        index: usize,
        /// Its value.
        value: f32,
    },
}

impl fmt::Display for CameraError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            CameraError::NotFinite { row, column } => write!(
                f,
                "the camera matrix's entry in row {}, column {} is not finite",
                row.saturating_add(1),
                column.saturating_add(1)
            ),
            CameraError::FocalLength { name, value } => write!(
                f,
                "the camera's {name} must be positive (pixels), found {value}"
            ),
            CameraError::Shape {
                below: [a, b, c],
                last,
            } => write!(
                f,
                "the camera matrix must be (fx s cx; 0 fy cy; 0 0 1), found {a}, {b}, {c} below \
                 the diagonal and {last} at its end"
            ),
            CameraError::Distorted { index, value } => write!(
                f,
                "distortion coefficient {index} is {value}: the camera model is a pinhole, \
                 undistort the image points first and pass no coefficients"
            ),
        }
    }
}

/// Why numbers are not a pose.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum PoseError {
    /// An entry of R or t is NaN or infinite.
    NotFinite,
    /// RᵀR is not I.
    NotARotation {
        /// The largest entry of RᵀR − I in magnitude.
        deviation: f32,
        /// What is allowed.
        tolerance: f32,
    },
    /// R mirrors: det R ≤ 0.
    Reflection {
        /// det R.
        determinant: f32,
    },
}

impl fmt::Display for PoseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            PoseError::NotFinite => f.write_str("an entry of R or t is not finite"),
            PoseError::NotARotation {
                deviation,
                tolerance,
            } => write!(
                f,
                "R is no rotation: R\u{1d40}R differs from the identity by {deviation}, allowed is \
                 {tolerance}"
            ),
            PoseError::Reflection { determinant } => {
                write!(f, "R mirrors instead of rotating: det R = {determinant}")
            }
        }
    }
}

/// Why a scorer could not start.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
// A tag of a word, so that errors are moved in words, not by `memcpy`.
#[repr(u32)]
pub enum ScoreError {
    /// The template has more components than the caller made room for.
    TooManyComponents {
        /// How many fit.
        capacity: usize,
        /// How many there are.
        found: usize,
    },
    /// δ is not a positive number.
    Delta {
        /// Its value.
        found: f32,
    },
    /// The fixed σ is not a positive number.
    Sigma {
        /// Its value.
        found: f32,
    },
    /// σ_m is not a number ≥ 0.
    Noise {
        /// Its value.
        found: f32,
    },
}

impl fmt::Display for ScoreError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            ScoreError::TooManyComponents { capacity, found } => write!(
                f,
                "the template has {found} components, the scorer has room for {capacity}"
            ),
            ScoreError::Delta { found } => {
                write!(
                    f,
                    "the tolerance delta must be finite and at least 1.2e-38, found {found:e}"
                )
            }
            ScoreError::Sigma { found } => {
                write!(
                    f,
                    "the fixed sigma must be finite and at least 1.2e-38, found {found:e}"
                )
            }
            ScoreError::Noise { found } => {
                write!(f, "the measurement noise must be at least 0, found {found}")
            }
        }
    }
}

impl core::error::Error for CameraError {}
impl core::error::Error for PoseError {}
impl core::error::Error for ScoreError {}
