//! Why a pose fits as it does, in one line.
//!
//! Owns the reasons and the order in which they are looked for. A reason is a hint for whoever debugs a cell
//! at night; decisions do not depend on it.

use super::report::DepthReport;
use crate::math::{self, Real};
use crate::pose::Pose;
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
    #[must_use]
    pub fn between(pose: &Pose, refined: &Pose, [x, y, z]: [f32; 3]) -> Self {
        let middle = Point3::new(x, y, z);
        let (from, to) = (pose.to_camera(&middle), refined.to_camera(&middle));
        let ray = [from.x, from.y, from.z];
        let moved = [to.x - from.x, to.y - from.y, to.z - from.z];
        let length = math::dot(ray, ray).square_root();
        let along_ray = if length > 0.0 {
            math::dot(moved, ray) / length
        } else {
            0.0
        };
        let across = math::dot(moved, moved) - along_ray * along_ray;
        // ‖R − R′‖² = 8 sin²(θ/2) in the Frobenius norm.
        let difference = pose.rotation().matrix() - refined.rotation().matrix();
        let squares = difference
            .iter()
            .fold(0.0, |sum, entry| sum + entry * entry);
        let sine = limited(0.125 * squares);
        Self {
            along_ray,
            sideways: if across > 0.0 {
                across.square_root()
            } else {
                0.0
            },
            turn: 2.0 * sine.square_root().arctangent((1.0 - sine).square_root()),
        }
    }
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
    /// Another object stands in front of nearly all of it.
    InFront,
    /// The camera sees past most of what would have to hide the background.
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
}

/// Ratios of the units that lengths come in.
const UNITS: [f32; 4] = [10.0, 25.4, 100.0, 1000.0];

/// A ratio is that of two units within this factor: objects are not where they are expected exactly.
const NEAR_UNIT: f32 = 1.35;

/// An error of less than this many σ needs no reason.
const SMALL: f32 = 1.0;

impl DepthReport {
    /// Why the pose fits as it does; `correction` is that from the pose to [`DepthReport::refined`].
    #[must_use]
    pub fn cause(&self, correction: &Correction) -> Cause {
        if let Some(factor) = unit_ratio(self.depth_ratio) {
            return Cause::Scale { factor };
        }
        if self.visible == 0 {
            return Cause::BehindCamera;
        }
        let looked_at = self.hidden.saturating_add(self.judged) as f32;
        let hidden = self.hidden as f32;
        if looked_at > 0.0 && hidden >= 0.9 * looked_at {
            return Cause::InFront;
        }
        if self.estimated_error < SMALL * self.noise {
            return if hidden > 0.5 * looked_at {
                Cause::Hidden
            } else {
                Cause::Fits
            };
        }
        if self.seen_through as f32 > 0.5 * self.judged as f32 {
            return Cause::SeenThrough;
        }
        if self.displacement < 0.5 * self.estimated_error {
            return Cause::Elsewhere;
        }
        let along = math::abs(correction.along_ray);
        if along > 0.7 * self.displacement {
            Cause::AlongRay {
                distance: correction.along_ray,
            }
        } else if correction.sideways > 0.7 * self.displacement {
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
    let larger = UNITS.into_iter().find(|unit| near(*unit));
    larger.or_else(|| {
        let inverse = UNITS.map(|unit| 1.0 / unit);
        inverse.into_iter().find(|unit| near(*unit))
    })
}

impl fmt::Display for Cause {
    /// One line; lengths in the template's unit.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Cause::Fits => f.write_str("what was observed fits the pose"),
            Cause::BehindCamera => f.write_str(
                "the pose puts the object behind or around the camera, as a wrong unit would",
            ),
            Cause::Scale { factor } if factor > 1.0 => write!(
                f,
                "wrong scale: depth is about {factor} times what the pose says, as of metres \
                 taken for millimetres"
            ),
            Cause::Scale { factor } => write!(
                f,
                "wrong scale: depth is about 1/{} of what the pose says, as of millimetres taken \
                 for metres",
                1.0 / factor
            ),
            Cause::InFront => f.write_str("another object stands in front of it"),
            Cause::SeenThrough => {
                f.write_str("the camera sees past it: nothing is where the pose puts it")
            }
            Cause::AlongRay { distance } if distance < 0.0 => write!(
                f,
                "offset along the ray: too far away by about {:.1}",
                -distance
            ),
            Cause::AlongRay { distance } => {
                write!(f, "offset along the ray: too near by about {distance:.1}")
            }
            Cause::Sideways { distance } => {
                write!(f, "offset across the ray by about {distance:.1}")
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
        }
    }
}
