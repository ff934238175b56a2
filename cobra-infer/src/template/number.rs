//! The numbers of a template that have a range, and the ranges.
//!
//! Owns their names. They are enums and not strings, so that an error is a few bytes and a
//! controller that prints none links no text.

use crate::kernel::{Exponent, Kernel};

/// A number of the object section, of a component or of the depth section.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Number {
    /// x of the bounding sphere's centre.
    CentreX,
    /// Its y.
    CentreY,
    /// Its z.
    CentreZ,
    /// The bounding sphere's radius.
    Radius,
    /// The object's diameter.
    Diameter,
    /// A coordinate of a reference point C_k.
    ReferencePoint,
    /// σ̂_k.
    SigmaHat,
    /// The kernel's length scale.
    LengthScale,
    /// The rational quadratic's exponent.
    Exponent,
    /// The polynomial's offset.
    Offset,
    /// The periodic kernel's period.
    Period,
    /// What stands where the kernel has no second parameter.
    NoParameter,
    /// The prior mean.
    PriorMean,
    /// The scale of compact weights.
    WeightScale,
    /// The scale of a map's nodes.
    MapScale,
    /// Nodes of a map in a unit of the square.
    MapSpacing,
    /// A coordinate of a map's origin.
    MapOrigin,
    /// σ_m as a share of the diameter.
    NoiseShare,
    /// The least confidence that is accepted.
    Accept,
    /// The least confidence that is not rejected.
    Reject,
    /// The share of wrong estimates that may be accepted.
    Target,
    /// The share of wrong estimates that were.
    FalseAccepts,
    /// The lower bound of that share.
    LowerBound,
    /// Its upper bound.
    UpperBound,
    /// How many wrong or right estimates a calibration is of.
    Estimates,
}

impl Number {
    /// Its name in messages.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::CentreX => "centre x",
            Self::CentreY => "centre y",
            Self::CentreZ => "centre z",
            Self::Radius => "radius",
            Self::Diameter => "diameter",
            Self::ReferencePoint => "the centre",
            Self::SigmaHat => "sigma-hat",
            Self::LengthScale => "the length scale",
            Self::Exponent => "the exponent",
            Self::Offset => "the offset",
            Self::Period => "the period",
            Self::NoParameter => "the parameter",
            Self::PriorMean => "the prior mean",
            Self::WeightScale => "the scale of the weights",
            Self::MapScale => "the scale of the map",
            Self::MapSpacing => "the spacing of the map",
            Self::MapOrigin => "the origin of the map",
            Self::NoiseShare => "noise as a share of the diameter",
            Self::Accept => "threshold to accept",
            Self::Reject => "threshold to reject",
            Self::Target => "false-accept rate aimed at",
            Self::FalseAccepts => "false-accept rate",
            Self::LowerBound => "lower bound of the false-accept rate",
            Self::UpperBound => "upper bound of the false-accept rate",
            Self::Estimates => "number of wrong or right estimates",
        }
    }

    /// The parameter besides the length scale that a kernel has.
    pub(super) const fn parameter(kernel: Kernel) -> Self {
        match kernel {
            Kernel::RationalQuadratic(_) => Self::Exponent,
            Kernel::Polynomial => Self::Offset,
            Kernel::Periodic => Self::Period,
            _ => Self::NoParameter,
        }
    }
}

/// What a number must be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Range {
    /// Finite.
    Finite,
    /// Positive, finite and no subnormal.
    Normal,
    /// Positive, with a square that is finite and no subnormal.
    NormalSquare,
    /// An exponent: positive, and with 2αl² finite and no subnormal.
    NormalProduct,
    /// 1, for a length scale that the kernel does not have.
    One,
    /// What the kernel fixes.
    Fixed,
}

impl Range {
    /// The range in words.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::Finite => "finite",
            Self::Normal => "positive, finite and no subnormal",
            Self::NormalSquare => "positive, with a square that is finite and no subnormal",
            Self::NormalProduct => {
                "positive, and 2*exponent*(length scale)^2 finite and no subnormal"
            }
            Self::One => "1",
            Self::Fixed => "what the kernel fixes",
        }
    }

    /// The range of a length scale.
    pub(super) const fn of_length_scale(kernel: Kernel) -> Self {
        match kernel.fixed_length_scale() {
            Some(_) => Self::One,
            // The kernel sees only the square, which would hide a sign.
            None => Self::NormalSquare,
        }
    }

    /// The range of the parameter besides the length scale.
    pub(super) const fn of_parameter(kernel: Kernel) -> Self {
        match (kernel, kernel.fixed_parameter()) {
            (_, Some(_)) => Self::Fixed,
            (Kernel::RationalQuadratic(Exponent::Free), None) => Self::NormalProduct,
            (_, None) => Self::Normal,
        }
    }
}
