//! The unit of length that a template's numbers are in.

use serde::{Deserialize, Serialize};

/// The unit of every length in a template: mesh files carry none, so the trainer is told.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Unit {
    /// 1 mm, the unit of BOP datasets.
    Millimetre,
    /// 10 mm.
    Centimetre,
    /// 1,000 mm, the unit of ROS.
    Metre,
    /// 25.4 mm.
    Inch,
}

impl Unit {
    /// Every unit, in wire order.
    pub const ALL: [Unit; 4] = [Unit::Millimetre, Unit::Centimetre, Unit::Metre, Unit::Inch];

    /// How many millimetres one of this unit is.
    #[must_use]
    pub const fn millimetres(self) -> f32 {
        match self {
            Unit::Millimetre => 1.0,
            Unit::Centimetre => 10.0,
            Unit::Metre => 1000.0,
            Unit::Inch => 25.4,
        }
    }

    /// The usual symbol: `mm`, `cm`, `m`, `in`.
    #[must_use]
    pub const fn symbol(self) -> &'static str {
        match self {
            Unit::Millimetre => "mm",
            Unit::Centimetre => "cm",
            Unit::Metre => "m",
            Unit::Inch => "in",
        }
    }
}
