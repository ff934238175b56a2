//! In which coordinates directions are compared.

use crate::math::Real;
use serde::{Deserialize, Serialize};

/// What is taken for the distance between two directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Metric {
    /// ‖u − u′‖ of the unit vectors, the alternative that the paper names where it introduces the
    /// rational quadratic: it has no seam and no pole, and needs no arctangent.
    Chord,
    /// ‖(φ, θ) − (φ′, θ′)‖ of the spherical coordinates, in radians, as the paper prints it: φ from
    /// the z axis, in [0, π], and θ about it from the x axis, in [−π, π] as the authors' code has
    /// it. It tears the sphere open along θ = ±π and stretches it towards the poles.
    Angles,
}

impl Metric {
    /// Both of them, in the order of their numbers in a template.
    pub const ALL: [Self; 2] = [Self::Chord, Self::Angles];

    /// Its name in reports and messages.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Chord => "chord",
            Self::Angles => "angles",
        }
    }

    /// The feature of this crate that contains it, where one is needed.
    #[must_use]
    pub const fn feature(self) -> Option<&'static str> {
        match self {
            Self::Chord => None,
            Self::Angles => Some("angles"),
        }
    }

    /// Whether this build contains it.
    #[must_use]
    pub const fn is_compiled_in(self) -> bool {
        match self {
            Self::Chord => true,
            Self::Angles => cfg!(feature = "angles"),
        }
    }

    /// The coordinates of a unit vector: itself, or (φ, θ, 0). `None` where this build does not
    /// contain the metric.
    ///
    /// φ = atan2(√(x² + y²), z), which unlike the arccosine of z is exact near the poles and never
    /// NaN; θ = atan2(y, x).
    #[must_use]
    #[inline]
    pub fn coordinates<T: Real>(self, unit_vector: [T; 3]) -> Option<[T; 3]> {
        match self {
            Self::Chord => Some(unit_vector),
            #[cfg(feature = "angles")]
            Self::Angles => {
                let [x, y, z] = unit_vector;
                let from_axis = (x * x + y * y).square_root();
                Some([from_axis.arctangent(z), y.arctangent(x), T::ZERO])
            }
            #[cfg(not(feature = "angles"))]
            Self::Angles => None,
        }
    }
}

impl Metric {
    /// The gradient over the unit vector of what has the gradient `over` in these coordinates; without
    /// meaning across the sphere. Not finite at the poles of the angles, nor where this build does not
    /// contain the metric.
    #[must_use]
    #[inline]
    pub(crate) fn pull_back(self, [x, y, z]: [f32; 3], over: [f32; 3]) -> [f32; 3] {
        match self {
            Self::Chord => over,
            #[cfg(feature = "angles")]
            Self::Angles => {
                let [phi, theta, _] = over;
                let square = x * x + y * y;
                let from_axis = square.square_root();
                let outward = phi * z / from_axis;
                let around = theta / square;
                [
                    outward * x - around * y,
                    outward * y + around * x,
                    -(phi * from_axis),
                ]
            }
            #[cfg(not(feature = "angles"))]
            Self::Angles => {
                let _ = (x, y, z, over);
                [f32::NAN; 3]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Metric;
    use core::f64::consts::{FRAC_PI_2, PI};

    #[test]
    fn angles_are_those_of_spherical_coordinates() {
        for (u, expected) in [
            ([1.0, 0.0, 0.0], [FRAC_PI_2, 0.0, 0.0]),
            ([0.0, 1.0, 0.0], [FRAC_PI_2, FRAC_PI_2, 0.0]),
            ([-1.0, 0.0, 0.0], [FRAC_PI_2, PI, 0.0]),
            ([0.0, -1.0, 0.0], [FRAC_PI_2, -FRAC_PI_2, 0.0]),
            ([0.0, 0.0, 1.0], [0.0, 0.0, 0.0]),
            ([0.0, 0.0, -1.0], [PI, 0.0, 0.0]),
        ] {
            assert_eq!(Metric::Angles.coordinates::<f64>(u), Some(expected));
        }
    }
}
