//! Why a pose fits as it does, in one line.
//!
//! Owns the reasons and the order in which they are looked for. A reason is a hint for whoever debugs a cell
//! at night; decisions do not depend on it.

use super::report::DepthReport;
use crate::math::{self, Real};
use crate::pose::Pose;
use crate::score::{Decision, Rejection};
use crate::unit::Unit;
use core::fmt;
use nalgebra::Point3;

/// What refinement does to a pose, seen from the camera; lengths in the template's unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Correction {
    /// How far the object's middle moves away from the camera along its ray; negative towards it.
    pub along_ray: f32,
    /// How far it moves across the ray.
    pub sideways: f32,
    /// By what angle the object turns, in radians.
    pub turn: f32,
}

impl Correction {
    /// From one pose to another, of an object with this middle.
    // Inline, so that only who asks for the angle links an arctangent.
    #[inline]
    #[must_use]
    pub fn between(pose: &Pose, refined: &Pose, [x, y, z]: [f32; 3]) -> Self {
        let middle = Point3::new(x, y, z);
        let (from, to) = (pose.to_camera(&middle), refined.to_camera(&middle));
        let ray = [from.x, from.y, from.z];
        let moved = [to.x - from.x, to.y - from.y, to.z - from.z];
        let length = math::dot(ray, ray).square_root();
        let along_ray = finite(math::dot(moved, ray) / length);
        let across = math::dot(moved, moved) - along_ray * along_ray;
        let sine = limited(0.125 * turn_squares(pose, refined));
        Self {
            along_ray,
            sideways: finite(across.square_root()),
            turn: 2.0 * sine.square_root().arctangent((1.0 - sine).square_root()),
        }
    }
}

/// ‖R − R′‖² = 8 sin²(θ/2) in the Frobenius norm, θ being the angle between the two.
pub(super) fn turn_squares(pose: &Pose, refined: &Pose) -> f32 {
    let difference = pose.rotation().matrix() - refined.rotation().matrix();
    let entries = difference.iter();
    entries.fold(0.0, |sum, entry| sum + entry * entry)
}

/// 0 in place of what rounding or the largest numbers make no length of.
fn finite(length: f32) -> f32 {
    if length.is_finite() { length } else { 0.0 }
}

fn limited(share: f32) -> f32 {
    if share < 1.0 { share } else { 1.0 }
}

/// Why.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Cause {
    /// Nothing stands out.
    Fits,
    /// The object would lie behind the camera, or around it.
    BehindCamera,
    /// What was measured is about this many times as far away as the pose says, a ratio of units.
    Scale {
        /// 1000 for a pose in metres and depth in millimetres.
        factor: f32,
    },
    /// Something stands in front of nearly all of it; or the pose puts it far behind what was measured.
    InFront,
    /// The camera sees past most of what would have to hide the background: nothing is there, or something of
    /// another shape.
    SeenThrough,
    /// It would have to move along the camera's ray.
    AlongRay {
        /// How far, negative towards the camera.
        distance: f32,
    },
    /// It would have to move across the ray.
    Sideways {
        /// How far.
        distance: f32,
    },
    /// It would have to turn.
    Turned {
        /// By how much, in radians.
        angle: f32,
    },
    /// What was observed lies on the surface, and the pose does not: refinement finds no way there.
    Elsewhere,
    /// Little of it can be seen behind something else.
    Hidden,
    /// Nothing was measured where it must be seen, or that lies outside of the image.
    Unmeasured,
}

/// Ratios of the units that lengths come in, and which units these may be, the larger one first.
const UNITS: [(f32, [&str; 2]); 4] = [
    (10.0, ["centimetres", "millimetres"]),
    (25.4, ["inches", "millimetres"]),
    (100.0, ["metres", "centimetres"]),
    (1000.0, ["metres", "millimetres"]),
];

/// A ratio is that of two units within this factor: objects are not where they are expected exactly.
const NEAR_UNIT: f32 = 1.35;

/// An error of less than this many σ needs no reason.
const SMALL: f32 = 1.0;

/// A motion of less than this many σ is no reason.
const LEAST_MOTION: f32 = 0.8;

/// A residual after refinement of less than this many σ: the motion explains what was seen.
const EXPLAINED: f32 = 0.7;

/// Of more than this many: it does not.
const UNEXPLAINED: f32 = 1.6;

/// A mask whose pixels have less than this mean likelihood does not show the object at the pose.
const LEAST_FORWARD: f32 = 0.5;

/// With fewer pixels refinement explains nothing.
const FEWEST: u32 = 10;

impl DepthReport {
    /// Why the pose fits as it does; `correction` is that from the pose to [`DepthReport::refined`].
    ///
    /// What is certain is looked for first: a ratio of units; a surface that as a whole lies nearer or farther;
    /// a motion after which the pixels fit; then what hides the object or is missing; then the motion that
    /// explains most. Which reason is given to which error: `docs/OVERLAY.md`.
    #[must_use]
    pub fn cause(&self, correction: &Correction) -> Cause {
        if let Some(factor) = unit_ratio(self.depth_ratio) {
            return Cause::Scale { factor };
        }
        if self.decision == Decision::Reject(Rejection::BehindCamera) {
            return Cause::BehindCamera;
        }
        let sigma = self.noise;
        let fits = self.decision == Decision::Accept || self.estimated_error < SMALL * sigma;
        if !fits && math::abs(self.common_offset) >= LEAST_MOTION * sigma {
            return Cause::AlongRay {
                distance: self.common_offset,
            };
        }
        let moves = self.displacement >= LEAST_MOTION * sigma
            && self.displacement >= 0.5 * self.estimated_error;
        if !fits && moves && self.pixels >= FEWEST && self.residual < EXPLAINED * sigma {
            return self.motion(correction);
        }
        let looked_at = self.hidden.saturating_add(self.judged) as f32;
        let hidden = self.hidden as f32;
        if looked_at == 0.0 {
            return Cause::Unmeasured;
        }
        // More pixels than points of the surface are a mask's: where they do not fit, the object is elsewhere.
        let masked = self.pixels >= FEWEST && self.pixels > self.judged;
        let masked_elsewhere = masked && self.forward < LEAST_FORWARD;
        if hidden >= 0.9 * looked_at {
            return match () {
                () if !masked_elsewhere => Cause::InFront,
                () if moves => self.motion(correction),
                () => Cause::Elsewhere,
            };
        }
        if fits {
            return if hidden > 0.5 * looked_at {
                Cause::Hidden
            } else {
                Cause::Fits
            };
        }
        let through = self.seen_through as f32;
        let judged = self.judged as f32;
        if through > 0.85 * judged {
            Cause::SeenThrough
        } else if moves && self.residual < UNEXPLAINED * sigma {
            self.motion(correction)
        } else if through > 0.5 * judged {
            Cause::SeenThrough
        } else {
            Cause::Elsewhere
        }
    }

    /// The largest part of the motion: along the ray, across it, or what of the displacement the middle does not
    /// share, because the object turns about it.
    fn motion(&self, correction: &Correction) -> Cause {
        let along = correction.along_ray * correction.along_ray;
        let sideways = correction.sideways * correction.sideways;
        let turned = self.displacement * self.displacement - along - sideways;
        if along >= sideways && along >= turned {
            Cause::AlongRay {
                distance: correction.along_ray,
            }
        } else if sideways >= turned {
            Cause::Sideways {
                distance: correction.sideways,
            }
        } else {
            Cause::Turned {
                angle: correction.turn,
            }
        }
    }
}

/// The ratio of units that a ratio of depths is near to, if it is.
fn unit_ratio(ratio: f32) -> Option<f32> {
    let near = |unit: f32| ratio > unit / NEAR_UNIT && ratio < unit * NEAR_UNIT;
    let larger = UNITS.map(|(unit, _)| unit);
    let smaller = larger.map(|unit| 1.0 / unit);
    larger.into_iter().chain(smaller).find(|unit| near(*unit))
}

fn write_scale(f: &mut fmt::Formatter<'_>, factor: f32) -> fmt::Result {
    let inverse = 1.0 / factor;
    for (unit, [larger, smaller]) in UNITS {
        if math::abs(factor - unit) < 0.5 {
            return write!(
                f,
                "wrong scale: depth is about {unit} times what the pose says, as of {larger} taken for \
                 {smaller}"
            );
        }
        if math::abs(inverse - unit) < 0.5 {
            return write!(
                f,
                "wrong scale: depth is about 1/{unit} of what the pose says, as of {smaller} taken for \
                 {larger}"
            );
        }
    }
    write!(
        f,
        "wrong scale: depth is about {factor} times what the pose says"
    )
}

impl Cause {
    /// The line with the unit behind its lengths.
    #[must_use]
    pub const fn in_unit(self, unit: Unit) -> CauseInUnit {
        CauseInUnit { cause: self, unit }
    }

    /// One line, with `unit` behind its lengths.
    fn write(self, f: &mut fmt::Formatter<'_>, unit: &str) -> fmt::Result {
        match self {
            Cause::Fits => f.write_str("what was observed fits the pose"),
            Cause::BehindCamera => f.write_str(
                "the pose puts the object behind or around the camera, as a wrong unit would",
            ),
            Cause::Scale { factor } => write_scale(f, factor),
            Cause::InFront => {
                f.write_str("something stands in front of nearly all of it, or it is too far away")
            }
            Cause::SeenThrough => f.write_str(
                "the camera sees past it: what was measured lies behind where the pose puts it",
            ),
            Cause::AlongRay { distance } if distance < 0.0 => write!(
                f,
                "offset along the ray: too far away by about {:.1}{unit}",
                -distance
            ),
            Cause::AlongRay { distance } => write!(
                f,
                "offset along the ray: too near by about {distance:.1}{unit}"
            ),
            Cause::Sideways { distance } => {
                write!(f, "offset across the ray by about {distance:.1}{unit}")
            }
            Cause::Turned { angle } => write!(
                f,
                "turned by about {:.0} degrees",
                angle * (180.0 / core::f32::consts::PI)
            ),
            Cause::Elsewhere => {
                f.write_str("the shape does not fit, and no small motion makes it fit")
            }
            Cause::Hidden => f.write_str("most of it is hidden behind something else"),
            Cause::Unmeasured => f.write_str(
                "nothing was measured where it must be seen, or that lies outside of the image",
            ),
        }
    }
}

impl fmt::Display for Cause {
    /// One line; lengths in the template's unit, which it does not name.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.write(f, "")
    }
}

/// A reason whose lengths name their unit: [`Cause::in_unit`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CauseInUnit {
    cause: Cause,
    unit: Unit,
}

impl fmt::Display for CauseInUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.cause.write(
            f,
            match self.unit {
                Unit::Millimetre => " mm",
                Unit::Centimetre => " cm",
                Unit::Metre => " m",
                Unit::Inch => " in",
            },
        )
    }
}
