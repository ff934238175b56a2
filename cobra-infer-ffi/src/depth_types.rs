//! The structures and enumerations of checks against depth, and their way to and from `cobra-infer`'s.

use crate::status::CobraStatus;
use crate::types::{CobraDecision, CobraPose, CobraReason, decision};
use cobra_infer::depth::{Cause, Correction, DepthReport, DepthSettings, Noise, Thresholds};
use core::ffi::c_void;

/// Bytes of scratch memory that a check takes for each cell of its depth buffer, which has
/// `side` by `side` of them.
pub const COBRA_DEPTH_CELL_SIZE: usize = 4;

/// Alignment of that memory.
pub const COBRA_DEPTH_ALIGN: usize = 4;

const _: () = {
    use cobra_infer::depth::Cell;
    assert!(size_of::<Cell>() == COBRA_DEPTH_CELL_SIZE);
    assert!(align_of::<Cell>() <= COBRA_DEPTH_ALIGN);
};

/// What the noise of a measurement follows.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CobraNoiseKind {
    /// A share of the object's diameter: `noise_share`.
    Share = 0,
    /// The sensor: noise_constant + noise_linear z + noise_quadratic z^2 at the object's depth z.
    Sensor = 1,
}

/// How a pose is checked against depth. Fill it with `cobra_depth_settings_default` and change what
/// is to be changed: one that is all zeros is refused, because its depth buffer has no cells.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct CobraDepthSettings {
    /// A CobraNoiseKind.
    pub noise_kind: u32,
    /// The share of the diameter, above 0.
    pub noise_share: f32,
    /// Of the sensor's noise, in the template's unit.
    pub noise_constant: f32,
    /// Of the sensor's noise, a share of the depth.
    pub noise_linear: f32,
    /// Of the sensor's noise, in 1/unit.
    pub noise_quadratic: f32,
    /// Whether there are thresholds, 0 or 1; without them no pose is accepted.
    pub has_thresholds: u32,
    /// From this confidence on a pose is accepted.
    pub accept: f32,
    /// Below this it is rejected; not above `accept`.
    pub reject: f32,
    /// With fewer observed pixels, or fewer points of the surface that the depth says something of,
    /// the decision is undecided.
    pub minimum_points: u32,
    /// Cells along a side of the depth buffer, 8 to 256.
    pub side: u16,
    /// How often the pose is refined.
    pub steps: u16,
    /// How many observed pixels a step uses at most, at least 1.
    pub step_pixels: u16,
}

/// A pixel that shows the object, as a mask says, and the depth measured there.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct CobraDepthPixel {
    /// Column, from 0; pixel centres are at integers.
    pub column: u16,
    /// Row, from 0.
    pub row: u16,
    /// The depth along the camera's axis, in the template's unit; 0 where nothing was measured.
    pub depth: f32,
}

/// What was observed.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct CobraDepthObserved {
    /// The object's pixels; NULL for those in which the pose itself says that it is seen.
    pub pixels: *const CobraDepthPixel,
    /// How many there are; 0 with NULL.
    pub pixel_count: usize,
    /// The depth image, `height` rows of `width` words behind each other; 0 where nothing was
    /// measured.
    pub words: *const u16,
    /// Columns, at least 1.
    pub width: u16,
    /// Rows.
    pub height: u16,
    /// What a word is multiplied by to be in the template's unit, above 0.
    pub scale: f32,
    /// Called with `context` at least once every 64 pixels, cells, or places where a point of the surface
    /// may be: where a watchdog can be fed. NULL for nobody.
    pub alive: Option<extern "C" fn(*mut c_void)>,
    /// What `alive` is called with.
    pub context: *mut c_void,
}

/// Why a pose fits as it does: a hint for people, which no decision depends on. New causes are
/// appended.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CobraCause {
    /// The call failed, nothing was checked.
    NotChecked = 0,
    /// Nothing stands out.
    Fits = 1,
    /// The object would lie behind the camera, or around it.
    BehindCamera = 2,
    /// Measured depths are `cause_value` times those that the pose says, a ratio of units.
    Scale = 3,
    /// Another object stands in front of nearly all of it.
    InFront = 4,
    /// The camera sees past most of what would have to hide the background.
    SeenThrough = 5,
    /// It would have to move along the camera's ray by `cause_value`, negative towards the camera.
    AlongRay = 6,
    /// It would have to move across the ray by `cause_value`.
    Sideways = 7,
    /// It would have to turn by `cause_value`, in radians.
    Turned = 8,
    /// What was observed lies on the surface, and the pose does not: refinement finds no way there.
    Elsewhere = 9,
    /// Little of it can be seen behind something else.
    Hidden = 10,
    /// Nothing was measured where it must be seen, or that lies outside of the image.
    Unmeasured = 11,
}

/// The answer of a check against depth. None of its numbers is ever NaN; lengths are in the
/// template's unit.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct CobraDepthReport {
    /// exp(-estimated_error^2/2 noise^2), the least of three likelihoods, from 0 to 1; 0 where it would rest on
    /// fewer than `minimum_points`.
    pub confidence: f32,
    /// The mean likelihood of the observed pixels, put back onto the surface.
    pub forward: f32,
    /// The mean likelihood of the surface that must be visible.
    pub reverse: f32,
    /// How far the pose is estimated to be off.
    pub estimated_error: f32,
    /// How far refinement moves the object's points, on average.
    pub displacement: f32,
    /// The rms distance of the observed pixels from the surface after refinement.
    pub residual: f32,
    /// The standard deviation that distances were compared with.
    pub noise: f32,
    /// Measured depths over those that the pose says; 0 without any.
    pub depth_ratio: f32,
    /// The pose that refinement leads to: a suggestion.
    pub refined: CobraPose,
    /// How many observed pixels had a depth.
    pub pixels: u32,
    /// How many of them nothing of the surface spoke for.
    pub silent: u32,
    /// How many points of the surface must be visible.
    pub visible: u32,
    /// How many of them were evidence, for or against.
    pub judged: u32,
    /// How many were hidden by something nearer.
    pub hidden: u32,
    /// How many lie outside of the image or where nothing was measured.
    pub unmeasured: u32,
    /// How many of the judged ones the camera saw through.
    pub seen_through: u32,
    /// What to do.
    pub decision: CobraDecision,
    /// Why.
    pub reason: CobraReason,
    /// Why the pose fits as it does.
    pub cause: CobraCause,
    /// The cause's number, where it has one, else 0.
    pub cause_value: f32,
    /// How far refinement moves the object's middle away from the camera along its ray.
    pub moved_along_ray: f32,
    /// How far across the ray.
    pub moved_sideways: f32,
    /// By what angle it turns the object, in radians.
    pub turned: f32,
}

impl CobraDepthSettings {
    pub(crate) fn from_rust(settings: &DepthSettings) -> Self {
        let mut all = Self {
            noise_kind: CobraNoiseKind::Share as u32,
            noise_share: 0.0,
            noise_constant: 0.0,
            noise_linear: 0.0,
            noise_quadratic: 0.0,
            has_thresholds: settings.thresholds.is_some().into(),
            accept: 0.0,
            reject: 0.0,
            minimum_points: settings.minimum_points,
            side: settings.side,
            steps: settings.steps,
            step_pixels: settings.step_pixels,
        };
        match settings.noise {
            Noise::Share(share) => all.noise_share = share,
            Noise::Sensor {
                constant,
                linear,
                quadratic,
            } => {
                all.noise_kind = CobraNoiseKind::Sensor as u32;
                all.noise_constant = constant;
                all.noise_linear = linear;
                all.noise_quadratic = quadratic;
            }
        }
        if let Some(thresholds) = settings.thresholds {
            all.accept = thresholds.accept;
            all.reject = thresholds.reject;
        }
        all
    }

    /// Numbers out of their range are left to `cobra-infer`, which refuses them.
    pub(crate) fn to_rust(self) -> Result<DepthSettings, CobraStatus> {
        let noise = match self.noise_kind {
            0 => Noise::Share(self.noise_share),
            1 => Noise::Sensor {
                constant: self.noise_constant,
                linear: self.noise_linear,
                quadratic: self.noise_quadratic,
            },
            _ => return Err(CobraStatus::SettingsNoiseKind),
        };
        let thresholds = match self.has_thresholds {
            0 => None,
            1 => Some(Thresholds {
                accept: self.accept,
                reject: self.reject,
            }),
            _ => return Err(CobraStatus::SettingsHasThresholds),
        };
        Ok(DepthSettings {
            noise,
            thresholds,
            minimum_points: self.minimum_points,
            side: self.side,
            steps: self.steps,
            step_pixels: self.step_pixels,
        })
    }
}

impl CobraDepthReport {
    /// What a failed call leaves.
    pub(crate) const NOT_CHECKED: Self = Self {
        confidence: 0.0,
        forward: 0.0,
        reverse: 0.0,
        estimated_error: 0.0,
        displacement: 0.0,
        residual: 0.0,
        noise: 0.0,
        depth_ratio: 0.0,
        refined: CobraPose {
            rotation: [0.0; 9],
            translation: [0.0; 3],
        },
        pixels: 0,
        silent: 0,
        visible: 0,
        judged: 0,
        hidden: 0,
        unmeasured: 0,
        seen_through: 0,
        decision: CobraDecision::Undecided,
        reason: CobraReason::NotScored,
        cause: CobraCause::NotChecked,
        cause_value: 0.0,
        moved_along_ray: 0.0,
        moved_sideways: 0.0,
        turned: 0.0,
    };

    pub(crate) fn from_rust(report: &DepthReport, correction: &Correction) -> Self {
        let (decision, reason) = decision(report.decision);
        let (cause, cause_value) = cause(report.cause(correction));
        let r = report.refined.rotation().matrix();
        let t = report.refined.translation();
        Self {
            confidence: report.confidence,
            forward: report.forward,
            reverse: report.reverse,
            estimated_error: report.estimated_error,
            displacement: report.displacement,
            residual: report.residual,
            noise: report.noise,
            depth_ratio: report.depth_ratio,
            refined: CobraPose {
                rotation: [
                    r.m11, r.m12, r.m13, r.m21, r.m22, r.m23, r.m31, r.m32, r.m33,
                ],
                translation: [t.x, t.y, t.z],
            },
            pixels: report.pixels,
            silent: report.silent,
            visible: report.visible,
            judged: report.judged,
            hidden: report.hidden,
            unmeasured: report.unmeasured,
            seen_through: report.seen_through,
            decision,
            reason,
            cause,
            cause_value,
            moved_along_ray: correction.along_ray,
            moved_sideways: correction.sideways,
            turned: correction.turn,
        }
    }
}

pub(crate) const fn cause(cause: Cause) -> (CobraCause, f32) {
    use CobraCause as C;
    match cause {
        Cause::Fits => (C::Fits, 0.0),
        Cause::BehindCamera => (C::BehindCamera, 0.0),
        Cause::Scale { factor } => (C::Scale, factor),
        Cause::InFront => (C::InFront, 0.0),
        Cause::SeenThrough => (C::SeenThrough, 0.0),
        Cause::AlongRay { distance } => (C::AlongRay, distance),
        Cause::Sideways { distance } => (C::Sideways, distance),
        Cause::Turned { angle } => (C::Turned, angle),
        Cause::Elsewhere => (C::Elsewhere, 0.0),
        Cause::Hidden => (C::Hidden, 0.0),
        Cause::Unmeasured => (C::Unmeasured, 0.0),
    }
}
