//! Why a template could not be written.

use super::error::TemplateError;
use core::fmt;

/// Why a template could not be written.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum EncodeError {
    /// The object's name does not fit.
    Name {
        /// Bytes that fit.
        capacity: usize,
        /// Bytes there are.
        found: usize,
    },
    /// Some components have a precision and some have none.
    Precisions,
    /// Components have terms of different encodings.
    TermEncodings,
    /// Some components have a validity and some have none.
    Validities,
    /// A component's grid of directions has not side² cells, or its side is no multiple of 4 from 4 to
    /// [`crate::validity::LARGEST_SIDE`].
    ValidityCells {
        /// Which component.
        component: usize,
        /// Cells along a side.
        side: u8,
        /// Cells there are.
        found: usize,
    },
    /// The quality has not one share for each component, or a number that is no share or no deviation.
    Quality,
    /// The words that say where a calibration comes from do not fit; without a calibration none does.
    Provenance {
        /// Bytes that fit.
        capacity: usize,
        /// Bytes there are.
        found: usize,
    },
    /// A component has not as many directions as weights, or not the nodes that its map needs.
    TermCount {
        /// Which component.
        component: usize,
        /// How many directions; of a map, columns times rows.
        directions: usize,
        /// How many weights; of a map, nodes.
        weights: usize,
    },
    /// More than a file of this format can hold.
    TooLarge,
    /// The buffer is too small.
    Buffer {
        /// Bytes there are.
        found: usize,
    },
    /// What was written would be refused.
    Invalid(TemplateError),
}

impl fmt::Display for EncodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            EncodeError::Name { capacity, found } => write!(
                f,
                "the object's name has {found} bytes, at most {capacity} fit"
            ),
            EncodeError::Precisions => {
                f.write_str("either all components have a precision or none has")
            }
            EncodeError::TermEncodings => {
                f.write_str("all components must have terms of the same encoding")
            }
            EncodeError::Validities => {
                f.write_str("either all components have a validity or none has")
            }
            EncodeError::ValidityCells {
                component,
                side,
                found,
            } => write!(
                f,
                "component {component}: {found} cells with {side} along a side, which must be a \
                 multiple of 4 up to {}",
                crate::validity::LARGEST_SIDE
            ),
            EncodeError::Quality => f.write_str(
                "the quality needs a share from 0 to 1 for each component, and deviations of at \
                 least 0",
            ),
            EncodeError::Provenance { capacity, found } => write!(
                f,
                "the calibration's provenance has {found} bytes, at most {capacity} fit"
            ),
            EncodeError::TermCount {
                component,
                directions,
                weights,
            } => write!(
                f,
                "component {component} has {directions} directions and {weights} weights"
            ),
            EncodeError::TooLarge => f.write_str("a template cannot exceed 4 GiB"),
            EncodeError::Buffer { found } => {
                write!(f, "the template does not fit into {found} bytes")
            }
            EncodeError::Invalid(error) => write!(f, "the template would be refused: {error}"),
        }
    }
}

impl core::error::Error for EncodeError {}
