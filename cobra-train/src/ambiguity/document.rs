//! What was found, as a document: `cobra ambiguity --json` writes it, `cobra report` reads it.
//!
//! Owns its form, in millimetres and degrees, which `docs/AMBIGUITY.md` describes.

use super::{Path, Range, Screw, What};
use crate::bop::symmetry::Axis;
use nalgebra::{Isometry3, Matrix3, Point3, Translation3, UnitQuaternion, UnitVector3, Vector3};
use serde::{Deserialize, Serialize};

/// The document's version.
pub const SCHEMA: u32 = 1;

/// What was found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AmbiguityDocument {
    /// [`SCHEMA`].
    pub schema: u32,
    /// The object's name.
    pub template: String,
    /// Its diameter.
    pub diameter_mm: f64,
    /// Poses of at least this ADD are wrong.
    pub limit_mm: f64,
    /// How many views were looked at.
    pub views: usize,
    /// How many rotations were tried in each.
    pub candidates: usize,
    /// How far apart neighbouring ones are.
    pub step_degrees: f64,
    /// `simulated` or `silhouette`.
    pub masks: String,
    /// Standard deviation of the depth's noise.
    pub depth_noise_mm: f64,
    /// Seed of all randomness.
    pub seed: u64,
    /// The mean confidence of the true poses.
    pub true_confidence: f64,
    /// The least confidence that was accepted in some view.
    pub accepted_from: f64,
    /// Whether the template's own threshold says what is accepted.
    pub calibrated: bool,
    /// Paths first, then motions; those in most views first.
    pub ambiguities: Vec<AmbiguityEntry>,
    /// `null` where nothing is known of what a data set states.
    pub stated: Option<StatedSymmetries>,
    /// What follows, in sentences.
    pub conclusion: String,
}

/// Wrong poses that score as well as the true one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AmbiguityEntry {
    /// Which they are.
    #[serde(flatten)]
    pub what: MotionDocument,
    /// In how many views.
    pub views: usize,
    /// Their mean confidence.
    pub confidence: f64,
    /// The largest ADD.
    pub add_mm: f64,
    /// The largest ADD-S.
    pub add_s_mm: f64,
    /// The largest MSSD, as if the object had no symmetries.
    pub mssd_mm: f64,
    /// The largest MSSD with the stated symmetries, where there are some.
    pub mssd_with_symmetries_mm: Option<f64>,
    /// Whether a stated symmetry is near; `null` where nothing is known of what is stated.
    pub stated: Option<bool>,
}

/// Motions of the object in its own frame: the pose that scores as well is the true one after them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum MotionDocument {
    /// Turns about a line by any angle, or by those from low to high.
    Turns {
        /// The line's direction.
        axis: [f64; 3],
        /// A point on it.
        offset_mm: [f64; 3],
        /// Whether any angle will do.
        any: bool,
        /// The least.
        low_degrees: Option<f64>,
        /// The largest.
        high_degrees: Option<f64>,
    },
    /// Slides.
    Slides {
        /// Along which direction.
        direction: [f64; 3],
        /// The least.
        low_mm: Option<f64>,
        /// The largest.
        high_mm: Option<f64>,
    },
    /// One motion, as a turn about a line with a shift along it, and as R and t.
    Motion {
        /// The line's direction.
        axis: [f64; 3],
        /// A point on it.
        offset_mm: [f64; 3],
        /// The turn.
        angle_degrees: f64,
        /// The shift.
        along_mm: f64,
        /// R, row-major.
        rotation: [f64; 9],
        /// t.
        translation_mm: [f64; 3],
    },
}

/// What a data set states.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StatedSymmetries {
    /// How many discrete symmetries.
    pub discrete: usize,
    /// How many axes of rotational symmetry.
    pub continuous: usize,
    /// Of the discrete ones and then the axes: whether shape cannot tell them apart.
    pub found: Vec<bool>,
}

impl MotionDocument {
    /// Of motions in a unit of so many millimetres.
    #[must_use]
    pub fn new(what: &What, millimetres: f64) -> Self {
        let lengths = |vector: Vector3<f64>| (millimetres * vector).into();
        match what {
            What::Path {
                path: Path::Turn(axis),
                range,
            } => Self::Turns {
                axis: axis.direction.into_inner().into(),
                offset_mm: lengths(axis.offset.coords),
                any: *range == Range::Any,
                low_degrees: range.ends().map(|[low, _]| low.to_degrees()),
                high_degrees: range.ends().map(|[_, high]| high.to_degrees()),
            },
            What::Path {
                path: Path::Slide(direction),
                range,
            } => Self::Slides {
                direction: direction.into_inner().into(),
                low_mm: range.ends().map(|[low, _]| millimetres * low),
                high_mm: range.ends().map(|[_, high]| millimetres * high),
            },
            What::Motion { motion, screw } => {
                let matrix = motion.rotation.to_rotation_matrix();
                Self::Motion {
                    axis: screw.axis.direction.into_inner().into(),
                    offset_mm: lengths(screw.axis.offset.coords),
                    angle_degrees: screw.angle.to_degrees(),
                    along_mm: millimetres * screw.along,
                    rotation: std::array::from_fn(|i| matrix[(i / 3, i % 3)]),
                    translation_mm: lengths(motion.translation.vector),
                }
            }
        }
    }

    /// The motions, in millimetres.
    #[must_use]
    pub fn what(&self) -> What {
        let unit = |direction: &[f64; 3]| UnitVector3::new_normalize(Vector3::from(*direction));
        let line = |direction: &[f64; 3], offset: &[f64; 3]| Axis {
            direction: unit(direction),
            offset: Point3::from(*offset),
        };
        let range = |ends: [Option<f64>; 2]| match ends {
            [Some(low), Some(high)] => Range::Between { low, high },
            _ => Range::Any,
        };
        match self {
            Self::Turns {
                axis,
                offset_mm,
                low_degrees,
                high_degrees,
                ..
            } => What::Path {
                path: Path::Turn(line(axis, offset_mm)),
                range: range([low_degrees, high_degrees].map(|end| end.map(f64::to_radians))),
            },
            Self::Slides {
                direction,
                low_mm,
                high_mm,
            } => What::Path {
                path: Path::Slide(unit(direction)),
                range: range([*low_mm, *high_mm]),
            },
            Self::Motion {
                axis,
                offset_mm,
                angle_degrees,
                along_mm,
                rotation,
                translation_mm,
            } => What::Motion {
                motion: Isometry3::from_parts(
                    Translation3::from(*translation_mm),
                    UnitQuaternion::from_matrix(&Matrix3::from_row_slice(rotation)),
                ),
                screw: Screw {
                    axis: line(axis, offset_mm),
                    angle: angle_degrees.to_radians(),
                    along: *along_mm,
                },
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn motions_come_back_from_the_document_in_millimetres() {
        let axis = Axis {
            direction: UnitVector3::new_normalize(Vector3::new(1.0, 2.0, -2.0)),
            offset: Point3::new(0.1, 0.2, 0.3),
        };
        let between = Range::Between {
            low: -0.5,
            high: 1.5,
        };
        let motion = Isometry3::new(Vector3::new(0.01, 0.02, 0.03), Vector3::new(0.4, -1.0, 0.2));
        let screw = Screw {
            axis,
            angle: 0.7,
            along: 0.05,
        };
        let all = [
            What::Path {
                path: Path::Turn(axis),
                range: Range::Any,
            },
            What::Path {
                path: Path::Turn(axis),
                range: between,
            },
            What::Path {
                path: Path::Slide(axis.direction),
                range: between,
            },
            What::Motion { motion, screw },
        ];
        for what in all {
            let document = MotionDocument::new(&what, 1000.0);
            let text = serde_json::to_string(&document).unwrap();
            let read: MotionDocument = serde_json::from_str(&text).unwrap();
            assert_eq!(read, document);
            assert_eq!(read.what().words(1.0), what.words(1000.0));
            if let What::Motion { motion: found, .. } = read.what() {
                assert!(found.rotation.angle_to(&motion.rotation) < 1e-9);
                let off = found.translation.vector - 1000.0 * motion.translation.vector;
                assert!(off.norm() < 1e-9);
            }
        }
    }
}
