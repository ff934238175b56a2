//! Whether an object is still tracked, from the confidences of its frames.
//!
//! Owns the smoothing, the hysteresis and what a frame without a confidence means. It neither scores a
//! pose nor decides about one: the decision on a single frame is the scorer's, and a robot that acts on
//! one frame acts on that.
//!
//! Of frame n with confidence c the smoothed confidence is s ← s + g(c − s), g = 1 − e^(−1/τ), with τ the
//! time constant in frames; the first confidence is taken as it is. Tracking is lost
//!
//! - when s stays below the lower threshold for [`TrackerSettings::lost_after`] frames;
//! - at once at a confidence of 0: nothing that was seen lies on the object;
//! - when [`TrackerSettings::stale_after`] frames in a row bring no confidence.
//!
//! and regained, or found in the first place, when s stays at or above the upper threshold for
//! [`TrackerSettings::regained_after`] frames. A loss forgets s: what was seen before it says nothing
//! about what is found next. Between the thresholds nothing changes, so that a confidence which flickers
//! around one of them toggles nothing.
//!
//! # Example
//! ```
//! use cobra_infer::tracking::{Loss, Tracker, TrackerSettings, TrackingState};
//! # fn main() -> Result<(), cobra_infer::tracking::TrackerError> {
//! let mut tracker = Tracker::new(TrackerSettings::with_thresholds(0.25, 0.5))?;
//! let states = [0.875; 3].map(|confidence| tracker.update(Some(confidence)));
//! assert_eq!(states[1], TrackingState::Acquiring);
//! assert_eq!(states[2], TrackingState::Tracking);
//! // A single bad frame does not lose it; on every target these bits.
//! assert_eq!(tracker.update(Some(0.125)), TrackingState::Tracking);
//! assert_eq!(tracker.smoothed().map(f32::to_bits), Some(0x3f29_92f2));
//! // A frame in which nothing lies on the object does.
//! assert_eq!(tracker.update(Some(0.0)), TrackingState::Lost(Loss::NoSupport));
//! # Ok(()) }
//! ```

use crate::math;
use crate::template::Template;
use core::fmt;

/// When tracking is lost and regained.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TrackerSettings {
    /// The smoothed confidence below which tracking may be lost: 0 ≤ `lower` ≤ `upper` ≤ 1.
    pub lower: f32,
    /// The smoothed confidence from which on it may be regained.
    pub upper: f32,
    /// τ, in frames: after so many frames e⁻¹ of a step is left. At least 0, which smooths nothing.
    pub time_constant: f32,
    /// Frames below `lower` that lose it, at least 1.
    pub lost_after: u16,
    /// Frames at or above `upper` that regain it, at least 1.
    pub regained_after: u16,
    /// Frames in a row without a confidence that lose it, at least 1.
    pub stale_after: u16,
}

impl TrackerSettings {
    /// A frame moves the smoothed confidence by 0.28 of its difference: one bad frame out of a good
    /// track cannot take it below a third of the way down, and a step has lost most of itself after a
    /// tenth of a second at 30 frames a second.
    pub const TIME_CONSTANT: f32 = 3.0;

    /// One frame more than a dip of two, which a passing hand or a blurred image makes.
    pub const LOST_AFTER: u16 = 3;

    /// As many as lose it: a wrong pose that fits by chance rarely does so in three views.
    pub const REGAINED_AFTER: u16 = 3;

    /// A third of a second at 30 frames a second: an object that nobody has seen for longer may have
    /// been moved.
    pub const STALE_AFTER: u16 = 10;

    /// These thresholds, and the constants above.
    #[must_use]
    pub const fn with_thresholds(lower: f32, upper: f32) -> Self {
        Self {
            lower,
            upper,
            time_constant: Self::TIME_CONSTANT,
            lost_after: Self::LOST_AFTER,
            regained_after: Self::REGAINED_AFTER,
            stale_after: Self::STALE_AFTER,
        }
    }

    /// [`TrackerSettings::with_thresholds`] with those of the template's calibration: tracking is lost
    /// below what is rejected, and regained from what is accepted on. `None` without a calibration:
    /// there is no threshold that suits every object.
    #[must_use]
    pub fn for_template(template: &Template<'_>) -> Option<Self> {
        let calibration = template.depth()?.calibration?;
        Some(Self::with_thresholds(
            calibration.reject,
            calibration.accept,
        ))
    }
}

/// Why a tracker could not start.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum TrackerError {
    /// Not 0 ≤ lower ≤ upper ≤ 1.
    Thresholds {
        /// The lower one.
        lower: f32,
        /// The upper one.
        upper: f32,
    },
    /// The time constant is not finite, or below 0.
    TimeConstant {
        /// Its value.
        found: f32,
    },
    /// A number of frames is 0.
    Frames,
}

impl fmt::Display for TrackerError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Thresholds { lower, upper } => write!(
                f,
                "the thresholds must be 0 <= lower <= upper <= 1, found lower {lower}, upper {upper}"
            ),
            Self::TimeConstant { found } => write!(
                f,
                "the time constant must be finite and at least 0 frames, found {found}"
            ),
            Self::Frames => f.write_str(
                "lost_after, regained_after and stale_after must be at least 1 frame each",
            ),
        }
    }
}

impl core::error::Error for TrackerError {}

/// Why tracking was lost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Loss {
    /// The smoothed confidence stayed below the lower threshold.
    LowConfidence,
    /// A frame's confidence was 0.
    NoSupport,
    /// Too many frames in a row brought no confidence.
    Stale,
}

/// What is known of the track.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum TrackingState {
    /// Not found yet: not tracked, and never lost.
    Acquiring,
    /// The object is where the poses say.
    Tracking,
    /// It was tracked, and is not any more; why it was lost.
    Lost(Loss),
}

/// Follows the confidences of one object, frame by frame.
///
/// None of its numbers is ever NaN, and the same confidences give the same bits on every target.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Tracker {
    settings: TrackerSettings,
    gain: f32,
    smoothed: Option<f32>,
    state: TrackingState,
    /// Frames that spoke for the other state, one behind the other.
    contrary: u16,
    /// Frames without a confidence, one behind the other.
    missing: u16,
}

impl Tracker {
    /// A tracker that has seen nothing.
    ///
    /// # Errors
    /// [`TrackerError`]: thresholds that are out of order, a time constant that is no duration, a number
    /// of frames that is 0.
    pub fn new(settings: TrackerSettings) -> Result<Self, TrackerError> {
        let TrackerSettings {
            lower,
            upper,
            time_constant,
            lost_after,
            regained_after,
            stale_after,
        } = settings;
        if !(0.0 <= lower && lower <= upper && upper <= 1.0) {
            return Err(TrackerError::Thresholds { lower, upper });
        }
        if !(time_constant >= 0.0 && time_constant.is_finite()) {
            return Err(TrackerError::TimeConstant {
                found: time_constant,
            });
        }
        if lost_after == 0 || regained_after == 0 || stale_after == 0 {
            return Err(TrackerError::Frames);
        }
        Ok(Self {
            settings,
            // Of τ = 0 it is −1/0, whose exponential is 0: the gain is 1. The sign of a 0 is dropped.
            gain: -math::exp_minus_one(-1.0 / math::abs(time_constant)),
            smoothed: None,
            state: TrackingState::Acquiring,
            contrary: 0,
            missing: 0,
        })
    }

    /// Takes in the next frame: its confidence, or `None` where there is no pose or too little was seen of
    /// the object ([`crate::depth::DepthReport::evidence`]). What is no number from 0 to 1 is no evidence
    /// either.
    pub fn update(&mut self, confidence: Option<f32>) -> TrackingState {
        match confidence.filter(|confidence| (0.0..=1.0).contains(confidence)) {
            None => self.miss(),
            Some(0.0) => {
                self.missing = 0;
                self.forget(Loss::NoSupport);
            }
            Some(confidence) => {
                self.missing = 0;
                self.see(confidence);
            }
        }
        self.state
    }

    /// What is known after the last frame.
    #[must_use]
    pub const fn state(&self) -> TrackingState {
        self.state
    }

    /// The smoothed confidence, from 0 to 1; `None` before the first one and after a loss.
    #[must_use]
    pub const fn smoothed(&self) -> Option<f32> {
        self.smoothed
    }

    fn miss(&mut self) {
        self.missing = self.missing.saturating_add(1);
        if self.missing >= self.settings.stale_after {
            self.forget(Loss::Stale);
        }
    }

    fn see(&mut self, confidence: f32) {
        let smoothed = match self.smoothed {
            None => confidence,
            Some(smoothed) => smoothed + self.gain * (confidence - smoothed),
        };
        self.smoothed = Some(smoothed);
        let is_tracking = self.state == TrackingState::Tracking;
        let (is_contrary, enough) = if is_tracking {
            (smoothed < self.settings.lower, self.settings.lost_after)
        } else {
            (
                smoothed >= self.settings.upper,
                self.settings.regained_after,
            )
        };
        if !is_contrary {
            self.contrary = 0;
            return;
        }
        self.contrary = self.contrary.saturating_add(1);
        if self.contrary < enough {
            return;
        }
        if is_tracking {
            self.forget(Loss::LowConfidence);
        } else {
            self.contrary = 0;
            self.state = TrackingState::Tracking;
        }
    }

    /// Starts anew; what was tracked is lost.
    fn forget(&mut self, loss: Loss) {
        if self.state == TrackingState::Tracking {
            self.state = TrackingState::Lost(loss);
        }
        self.smoothed = None;
        self.contrary = 0;
    }
}
