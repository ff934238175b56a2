//! The structures and enumerations of the interface, and their way to and from `cobra-infer`'s.
//!
//! C hands an enumeration over as whatever integer it holds, and a Rust `enum` of another value is
//! undefined behaviour: what comes from C is a `u32` here, and checked.

use crate::layout::COBRA_NAME_SIZE;
use crate::status::CobraStatus;
use cobra_infer::nalgebra::{Point2, Point3};
use cobra_infer::{
    Assignment, Camera, Correspondence, Decision, Doubt, Likelihood, Pose, Rejection, Report,
    Settings, Sigma, Threshold, Unit,
};
use core::ffi::c_char;

/// In `CobraTemplateDetail`, a number that the status does not have.
pub const COBRA_NOT_APPLICABLE: u32 = 0xffff_ffff;

/// The intrinsics of a pinhole camera.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct CobraCamera {
    /// The matrix K = (fx s cx; 0 fy cy; 0 0 1), row by row, in pixels.
    pub matrix: [f32; 9],
}

/// The object's pose in the camera's frame: a point P of the object is seen at RP + t. The camera
/// looks along +Z, x to the right and y down (OpenCV, BOP).
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct CobraPose {
    /// R, row by row.
    pub rotation: [f32; 9],
    /// t, in the template's unit.
    pub translation: [f32; 3],
}

/// One observed pixel and the point on the object that the estimator assigns to it.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct CobraCorrespondence {
    /// The pixel's column, pixel centres at integers.
    pub u: f32,
    /// The pixel's row.
    pub v: f32,
    /// The point in the object's frame and the template's unit.
    pub x: f32,
    /// See `x`.
    pub y: f32,
    /// See `x`.
    pub z: f32,
    /// The weight, at least 0; 1 for every point is the plain average.
    pub weight: f32,
}

/// How points are scored. Fill it with `cobra_settings_default` and change what is to be changed:
/// one that is all zeros is refused, because its tolerance is 0.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct CobraSettings {
    /// The tolerance above 0, in the template's unit.
    pub delta: f32,
    /// A CobraSigmaKind: what `sigma` is.
    pub sigma_kind: u32,
    /// The measurement's standard deviation, or the fixed one, in the template's unit.
    pub sigma: f32,
    /// A CobraLikelihood.
    pub likelihood: u32,
    /// A CobraAssignment.
    pub assignment: u32,
    /// A CobraThreshold.
    pub threshold: u32,
    /// With fewer points of positive weight than this the decision is undecided.
    pub minimum_points: u32,
}

/// Which standard deviation a residual has.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CobraSigmaKind {
    /// The template's own, combined with the measurement's in `sigma`, which may be 0.
    Template = 0,
    /// The one in `sigma`, for every component.
    Fixed = 1,
}

/// Which likelihood a residual has.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CobraLikelihood {
    /// Between 0 and 1: 1 for a residual of 0.
    Peak = 0,
    /// The Gaussian density, in 1/length.
    Density = 1,
}

/// Which component speaks for a point.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CobraAssignment {
    /// The nearest.
    Nearest = 0,
    /// The one that finds the point most probable.
    Maximum = 1,
    /// All of them, mixed.
    Soft = 2,
}

/// What the threshold promises of a pose within the tolerance.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CobraThreshold {
    /// The paper's: a lower bound of the average confidence of such poses.
    Paper = 0,
    /// That average itself.
    Mean = 1,
    /// Every pose with all residuals within the tolerance passes.
    Worst = 2,
}

/// The unit of a template's lengths.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CobraUnit {
    /// 1 mm.
    Millimetre = 0,
    /// 10 mm.
    Centimetre = 1,
    /// 1,000 mm.
    Metre = 2,
    /// 25.4 mm.
    Inch = 3,
}

/// What to do with the pose. 0 is no answer, so that a report of zeros accepts nothing.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CobraDecision {
    /// The input does not allow an answer.
    Undecided = 0,
    /// The confidence does not reach the threshold.
    Reject = 1,
    /// The confidence reaches the threshold.
    Accept = 2,
}

/// Why. New reasons are appended.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CobraReason {
    /// Undecided: the call failed, nothing was scored.
    NotScored = 0,
    /// Accept: the confidence reaches the threshold.
    ReachesThreshold = 1,
    /// Reject: the confidence lies below the threshold.
    BelowThreshold = 2,
    /// Reject: no point lies on the surface.
    NoSupport = 3,
    /// Reject: every point lies behind the camera.
    BehindCamera = 4,
    /// Undecided: fewer points of positive weight than `minimum_points`.
    TooFewPoints = 5,
    /// Undecided: the weights add up to zero or next to nothing.
    NoWeight = 6,
    /// Undecided: a number in the input is not finite.
    NonFiniteInput = 7,
    /// Undecided: a weight is negative.
    NegativeWeight = 8,
    /// Undecided: the threshold is zero, the tolerance is immense against sigma.
    NoThreshold = 9,
    /// Undecided: something in front hides the object.
    Hidden = 10,
    /// Undecided: no threshold is known, calibrate first.
    NotCalibrated = 11,
    /// Undecided: the confidence lies between the thresholds.
    BetweenThresholds = 12,
}

/// The scorer's answer. None of its numbers is ever NaN.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CobraReport {
    /// The weighted mean likelihood of the points.
    pub confidence: f32,
    /// The threshold for it.
    pub threshold: f32,
    /// The sum of the weights.
    pub weight_sum: f32,
    /// The share of the points whose residual is at most the tolerance.
    pub inlier_share: f32,
    /// How many correspondences were pushed.
    pub points: u32,
    /// How many of them came to lie behind the camera.
    pub behind_camera: u32,
    /// What to do.
    pub decision: CobraDecision,
    /// Why.
    pub reason: CobraReason,
    /// How many came to lie where no component speaks for them.
    pub uncovered: u32,
}

/// What a template says of itself.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct CobraTemplateInfo {
    /// The unit of every length.
    pub unit: CobraUnit,
    /// How many millimetres that is.
    pub millimetres_per_unit: f32,
    /// The centre of the object's bounding sphere, in the object's frame.
    pub centre: [f32; 3],
    /// The radius of that sphere.
    pub radius: f32,
    /// The largest distance between two points of the object.
    pub diameter: f32,
    /// How many components there are; `cobra_max_components` says how many a scorer takes.
    pub components: u32,
    /// How many terms all components have together.
    pub terms: u32,
    /// The most kernel evaluations that one point needs with the nearest component.
    pub cost_nearest: u32,
    /// How many it needs with the maximum, and at most with the mixture.
    pub cost_maximum: u32,
    /// The object's name, UTF-8, ends with a zero.
    pub name: [c_char; COBRA_NAME_SIZE],
}

/// Where and by how much a template is wrong: `COBRA_NOT_APPLICABLE`, and 0 for `value`, where the
/// status has no such number.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct CobraTemplateDetail {
    /// What is wrong.
    pub status: CobraStatus,
    /// The section's tag, as the template format numbers sections.
    pub section: u32,
    /// Which component, from 0.
    pub component: u32,
    /// Which of its terms, from 0.
    pub term: u32,
    /// The number that was expected.
    pub expected: u32,
    /// The number that was found.
    pub found: u32,
    /// The number that was found, where it is no integer.
    pub value: f32,
}

impl CobraCamera {
    pub(crate) fn checked(&self) -> Result<Camera, CobraStatus> {
        Ok(Camera::from_matrix(self.matrix)?)
    }
}

impl CobraPose {
    pub(crate) fn checked(&self) -> Result<Pose, CobraStatus> {
        Ok(Pose::from_row_major(self.rotation, self.translation)?)
    }
}

impl CobraCorrespondence {
    pub(crate) fn to_rust(self) -> Correspondence {
        Correspondence {
            pixel: Point2::new(self.u, self.v),
            point: Point3::new(self.x, self.y, self.z),
            weight: self.weight,
        }
    }
}

impl CobraSettings {
    pub(crate) fn from_rust(settings: &Settings) -> Self {
        let (sigma_kind, sigma) = match settings.sigma {
            Sigma::Template { noise } => (CobraSigmaKind::Template, noise),
            Sigma::Fixed(sigma) => (CobraSigmaKind::Fixed, sigma),
        };
        let likelihood = match settings.likelihood {
            Likelihood::Peak => CobraLikelihood::Peak,
            Likelihood::Density => CobraLikelihood::Density,
        };
        let assignment = match settings.assignment {
            Assignment::Nearest => CobraAssignment::Nearest,
            Assignment::Maximum => CobraAssignment::Maximum,
            Assignment::Soft => CobraAssignment::Soft,
        };
        let threshold = match settings.threshold {
            Threshold::Paper => CobraThreshold::Paper,
            Threshold::Mean => CobraThreshold::Mean,
            Threshold::Worst => CobraThreshold::Worst,
        };
        Self {
            delta: settings.delta,
            sigma_kind: sigma_kind as u32,
            sigma,
            likelihood: likelihood as u32,
            assignment: assignment as u32,
            threshold: threshold as u32,
            minimum_points: settings.minimum_points,
        }
    }

    /// Numbers out of their range are left to `cobra-infer`, which refuses them.
    pub(crate) fn to_rust(self) -> Result<Settings, CobraStatus> {
        let sigma = match self.sigma_kind {
            0 => Sigma::Template { noise: self.sigma },
            1 => Sigma::Fixed(self.sigma),
            _ => return Err(CobraStatus::SettingsSigmaKind),
        };
        let likelihood = match self.likelihood {
            0 => Likelihood::Peak,
            1 => Likelihood::Density,
            _ => return Err(CobraStatus::SettingsLikelihood),
        };
        let assignment = match self.assignment {
            0 => Assignment::Nearest,
            1 => Assignment::Maximum,
            2 => Assignment::Soft,
            _ => return Err(CobraStatus::SettingsAssignment),
        };
        let threshold = match self.threshold {
            0 => Threshold::Paper,
            1 => Threshold::Mean,
            2 => Threshold::Worst,
            _ => return Err(CobraStatus::SettingsThreshold),
        };
        Ok(Settings {
            likelihood,
            assignment,
            sigma,
            threshold,
            delta: self.delta,
            minimum_points: self.minimum_points,
        })
    }
}

impl From<Unit> for CobraUnit {
    fn from(unit: Unit) -> Self {
        match unit {
            Unit::Millimetre => Self::Millimetre,
            Unit::Centimetre => Self::Centimetre,
            Unit::Metre => Self::Metre,
            Unit::Inch => Self::Inch,
        }
    }
}

impl CobraReport {
    /// What a failed call leaves.
    pub(crate) const NOT_SCORED: Self = Self {
        confidence: 0.0,
        threshold: 0.0,
        weight_sum: 0.0,
        inlier_share: 0.0,
        points: 0,
        behind_camera: 0,
        decision: CobraDecision::Undecided,
        reason: CobraReason::NotScored,
        uncovered: 0,
    };

    pub(crate) fn from_rust(report: &Report) -> Self {
        let (decision, reason) = decision(report.decision);
        Self {
            confidence: report.confidence,
            threshold: report.threshold,
            weight_sum: report.weight_sum,
            inlier_share: report.inlier_share,
            points: report.points,
            behind_camera: report.behind_camera,
            decision,
            reason,
            uncovered: report.uncovered,
        }
    }
}

pub(crate) fn decision(decision: Decision) -> (CobraDecision, CobraReason) {
    use CobraDecision as D;
    use CobraReason as R;
    match decision {
        Decision::Accept => (D::Accept, R::ReachesThreshold),
        Decision::Reject(Rejection::BelowThreshold) => (D::Reject, R::BelowThreshold),
        Decision::Reject(Rejection::NoSupport) => (D::Reject, R::NoSupport),
        Decision::Reject(Rejection::BehindCamera) => (D::Reject, R::BehindCamera),
        Decision::Undecided(Doubt::TooFewPoints) => (D::Undecided, R::TooFewPoints),
        Decision::Undecided(Doubt::NoWeight) => (D::Undecided, R::NoWeight),
        Decision::Undecided(Doubt::NonFiniteInput) => (D::Undecided, R::NonFiniteInput),
        Decision::Undecided(Doubt::NegativeWeight) => (D::Undecided, R::NegativeWeight),
        Decision::Undecided(Doubt::NoThreshold) => (D::Undecided, R::NoThreshold),
        Decision::Undecided(Doubt::Hidden) => (D::Undecided, R::Hidden),
        Decision::Undecided(Doubt::NotCalibrated) => (D::Undecided, R::NotCalibrated),
        Decision::Undecided(Doubt::BetweenThresholds) => (D::Undecided, R::BetweenThresholds),
    }
}
