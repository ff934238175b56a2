//! What a template is written from: the trainer's side of the format.
//!
//! Owns the content as it is handed over, and the mistakes in it that bytes could not show.

use super::Precision;
use super::depth::DepthSource;
use super::encode_error::EncodeError;
use super::wire::{NAME_CAPACITY, TermEncoding};
use crate::gp::{Hyperparameters, UnitDirection};
use crate::kernel::Model;
use crate::unit::Unit;
use crate::validity::{LARGEST_SIDE, Pole};

/// The content of a template, borrowed from whoever trained it.
#[derive(Clone, Copy, Debug)]
pub struct TemplateSource<'a> {
    /// The object's name, at most [`NAME_CAPACITY`] bytes.
    pub name: &'a str,
    /// The unit of every length.
    pub unit: Unit,
    /// Centre of the bounding sphere.
    pub centre: [f32; 3],
    /// Radius of the bounding sphere.
    pub radius: f32,
    /// Largest distance between two points of the object.
    pub diameter: f32,
    /// Metric and covariance function.
    pub model: Model,
    /// The components, in the order in which the scorer visits them.
    pub components: &'a [ComponentSource<'a>],
    /// What was measured of it, for whoever inspects it; scoring does not read it.
    pub quality: Option<QualitySource<'a>>,
    /// What it knows for depth mode.
    pub depth: Option<DepthSource<'a>>,
}

/// The content of one component.
#[derive(Clone, Copy, Debug)]
pub struct ComponentSource<'a> {
    /// C_k.
    pub centre: [f32; 3],
    /// σ̂_k.
    pub sigma_hat: f32,
    /// Q_k, in 1/unit²: of all components or, for the identity in the unit sphere, of none.
    pub precision: Option<Precision>,
    /// The hyperparameters that the mean needs; with compact terms, in grid steps
    /// ([`crate::gp::compact`]).
    pub hyperparameters: Hyperparameters,
    /// Directions and weights: of all components in the same encoding.
    pub terms: TermsSource<'a>,
    /// Where it may speak: of all components or, for everywhere, of none.
    pub validity: Option<ValiditySource<'a>>,
}

/// Directions, and as many weights K⁻¹(d − m), times the signal variance.
#[derive(Clone, Copy, Debug)]
pub enum TermsSource<'a> {
    /// As `f32`.
    Exact {
        /// Unit vectors, which are written in the metric's coordinates.
        directions: &'a [UnitDirection],
        /// The weights.
        weights: &'a [f32],
    },
    /// On the grid of [`crate::gp::compact`], for the metric of the chord alone.
    Compact {
        /// In grid steps: unit vectors times 127, each coordinate rounded.
        directions: &'a [[i8; 3]],
        /// In units of `scale`.
        weights: &'a [i16],
        /// What the weights are multiplied by; positive, finite and no subnormal.
        scale: f32,
    },
    /// A map ([`crate::gp::map`]), which needs a validity of the same pole.
    Map {
        /// Which half axis points at the middle of the square.
        pole: Pole,
        /// Nodes in a row, and rows; at least four each.
        size: [u8; 2],
        /// Nodes in a unit of the square; positive, finite and no subnormal.
        spacing: f32,
        /// The place of the middle of the square, in nodes.
        origin: [f32; 2],
        /// What the sum over the nodes is multiplied by; positive, finite and no subnormal.
        scale: f32,
        /// Row by row.
        nodes: &'a [i8],
    },
}

impl TermsSource<'_> {
    /// How many directions and how many weights there are; of a map, how many nodes there must be and
    /// how many there are.
    pub(super) const fn lengths(&self) -> (usize, usize) {
        match self {
            Self::Exact {
                directions,
                weights,
            } => (directions.len(), weights.len()),
            Self::Compact {
                directions,
                weights,
                ..
            } => (directions.len(), weights.len()),
            Self::Map {
                size: [columns, rows],
                nodes,
                ..
            } => (*columns as usize * *rows as usize, nodes.len()),
        }
    }

    /// How they are written.
    pub(super) const fn encoding(&self) -> TermEncoding {
        match self {
            Self::Exact { .. } => TermEncoding::Float32,
            Self::Compact { .. } => TermEncoding::Compact,
            Self::Map { .. } => TermEncoding::Map,
        }
    }
}

/// The directions in which a component may speak, and the box that what it says must lie in.
#[derive(Clone, Copy, Debug)]
pub struct ValiditySource<'a> {
    /// Which half axis points at the middle of the map of directions.
    pub pole: Pole,
    /// Cells along a side of the map: a multiple of 4, at most [`LARGEST_SIDE`].
    pub side: u8,
    /// Which cells are valid, at least one: row·side + column.
    pub cells: &'a [bool],
    /// The least position in [`crate::validity::BoxGrid`], along each axis.
    pub low: [u8; 3],
    /// The largest, at most 127.
    pub high: [u8; 3],
}

/// What was measured of a template on points that training did not see.
#[derive(Clone, Copy, Debug)]
pub struct QualitySource<'a> {
    /// The share of held-out surface points that some component speaks for and explains, 0 to 1.
    pub covered: f32,
    /// The largest deviation of the written mean from the one that was fitted, in units of σ̂; 0 for
    /// terms as they were fitted.
    pub deviation_max: f32,
    /// The rms of it.
    pub deviation_rms: f32,
    /// For each component, the share of the held-out points in its care that it does not explain, 0
    /// to 1; written in steps of 1/65535.
    pub unexplained: &'a [f32],
}

/// What bytes could not show.
pub(super) fn check(source: &TemplateSource<'_>) -> Result<(), EncodeError> {
    if source.name.len() > NAME_CAPACITY {
        return Err(EncodeError::Name {
            capacity: NAME_CAPACITY,
            found: source.name.len(),
        });
    }
    for (component, c) in source.components.iter().enumerate() {
        let (directions, weights) = c.terms.lengths();
        if directions != weights {
            return Err(EncodeError::TermCount {
                component,
                directions,
                weights,
            });
        }
        if let Some(validity) = c.validity {
            let side = usize::from(validity.side);
            let whole = validity.side.is_multiple_of(4) && validity.side <= LARGEST_SIDE;
            if !whole || side == 0 || validity.cells.len() != side * side {
                return Err(EncodeError::ValidityCells {
                    component,
                    side: validity.side,
                    found: validity.cells.len(),
                });
            }
        }
    }
    let some = |has: fn(&ComponentSource<'_>) -> bool| {
        let count = source.components.iter().filter(|c| has(c)).count();
        count != 0 && count != source.components.len()
    };
    if some(|c| c.precision.is_some()) {
        return Err(EncodeError::Precisions);
    }
    let mut encodings = source.components.iter().map(|c| c.terms.encoding());
    let first = encodings.next();
    if encodings.any(|encoding| Some(encoding) != first) {
        return Err(EncodeError::TermEncodings);
    }
    if some(|c| c.validity.is_some()) {
        return Err(EncodeError::Validities);
    }
    Ok(())
}
