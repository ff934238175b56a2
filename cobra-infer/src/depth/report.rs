//! What a check comes to, and what is to be done.

use super::reverse::Evidence;
use super::settings::DepthSettings;
use crate::math::{self, Real};
use crate::pose::Pose;
use crate::score::{Decision, Doubt, Rejection};

/// The answer. None of its numbers is ever NaN; lengths are in the template's unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct DepthReport {
    /// exp(−estimated_error²/2σ²), the least of the three likelihoods, from 0 to 1; 0 where it would rest on
    /// fewer than [`DepthSettings::minimum_points`] pixels or points of the surface.
    pub confidence: f32,
    /// The mean likelihood of the observed pixels, put back onto the surface.
    pub forward: f32,
    /// The mean likelihood of the surface that must be visible.
    pub reverse: f32,
    /// How far the pose is estimated to be off, as ADD is: the largest of the displacement and of the
    /// lengths that the two likelihoods stand for. At most 13.3 σ unless the displacement is larger, and that
    /// where too little is known.
    pub estimated_error: f32,
    /// How far refinement moves the object's points, on average.
    pub displacement: f32,
    /// The rms distance of the observed pixels from the surface after refinement; pixels farther away than a
    /// fifth of the diameter, and those that nothing speaks for, count as so far.
    pub residual: f32,
    /// The standard deviation that distances were compared with, without the template's own.
    pub noise: f32,
    /// The pose that refinement leads to: a suggestion.
    pub refined: Pose,
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
    /// How many of the judged ones the camera saw through, to something more than 3 σ behind them.
    pub seen_through: u32,
    /// What was measured over what the pose says: the ratio of the sums of both depths. Of the pixels of a mask
    /// and the object's middle; without a mask of the visible points that have a depth, hidden ones included. 0
    /// without any.
    pub depth_ratio: f32,
    /// How far behind where the pose puts it the whole visible surface was measured, along the camera's axis;
    /// below 0 in front. 0 where what was measured does not lie at a common distance.
    pub common_offset: f32,
    /// What to do, and why.
    pub decision: Decision,
}

impl DepthReport {
    /// What a [`crate::tracking::Tracker`] takes in of this frame: the confidence, also where a single frame's
    /// answer is undecided between the thresholds; `None` where too little was seen for one, because
    /// something hides the object or the image ends there.
    #[must_use]
    pub fn evidence(&self) -> Option<f32> {
        match self.decision {
            Decision::Undecided(Doubt::Hidden | Doubt::TooFewPoints) => None,
            _ => Some(self.confidence),
        }
    }

    /// On how many pixels or points of the surface it rests, whichever are fewer: what
    /// [`DepthSettings::minimum_points`] is compared with.
    #[must_use]
    pub fn valid_pixels(&self) -> u32 {
        self.pixels.min(self.judged)
    }

    /// Of a pose whose object does not lie in front of the camera.
    pub(super) fn behind_camera(pose: &Pose, noise: f32) -> Self {
        Self {
            confidence: 0.0,
            forward: 0.0,
            reverse: 0.0,
            estimated_error: length(0.0, noise),
            displacement: 0.0,
            residual: 0.0,
            noise,
            refined: *pose,
            pixels: 0,
            silent: 0,
            visible: 0,
            judged: 0,
            hidden: 0,
            unmeasured: 0,
            seen_through: 0,
            depth_ratio: 0.0,
            common_offset: 0.0,
            decision: Decision::Reject(Rejection::BehindCamera),
        }
    }

    pub(super) fn take(&mut self, evidence: &Evidence) {
        self.reverse = evidence.likelihood();
        self.visible = evidence.visible;
        self.judged = evidence.judged;
        self.hidden = evidence.hidden;
        self.unmeasured = evidence.unmeasured;
        self.seen_through = evidence.seen_through;
        self.depth_ratio = evidence.depth_ratio();
        self.common_offset = evidence.common_offset();
    }

    /// Draws the conclusions.
    pub(super) fn conclude(&mut self, settings: &DepthSettings) {
        let scaled = self.displacement / self.noise;
        let displaced = math::exp(-(0.5 * scaled * scaled));
        self.confidence = least(displaced, least(self.forward, self.reverse));
        let lengths = [self.forward, self.reverse].map(|mean| length(mean, self.noise));
        self.estimated_error = lengths.into_iter().fold(self.displacement, largest);
        let few = settings.minimum_points.max(1);
        if self.judged < few || self.pixels < few {
            // What little there is may fit by chance.
            self.confidence = 0.0;
            self.estimated_error = largest(length(0.0, self.noise), self.displacement);
        }
        // Of a mask: what shows the object does not fit, whatever hides where the pose puts it.
        let contradicted = settings.thresholds.is_some_and(|thresholds| {
            self.pixels >= few && least(displaced, self.forward) < thresholds.reject
        });
        self.decision = if self.judged < few && contradicted {
            Decision::Reject(Rejection::BelowThreshold)
        } else if self.judged < few && self.hidden >= few {
            Decision::Undecided(Doubt::Hidden)
        } else if self.judged < few || self.pixels < few {
            Decision::Undecided(Doubt::TooFewPoints)
        } else if self.confidence <= 0.0 {
            Decision::Reject(Rejection::NoSupport)
        } else {
            match settings.thresholds {
                None => Decision::Undecided(Doubt::NotCalibrated),
                Some(thresholds) if self.confidence >= thresholds.accept => Decision::Accept,
                Some(thresholds) if self.confidence < thresholds.reject => {
                    Decision::Reject(Rejection::BelowThreshold)
                }
                Some(_) => Decision::Undecided(Doubt::BetweenThresholds),
            }
        };
    }
}

/// σ√(−2 ln L): how far all points are off that have the mean likelihood L on average.
fn length(mean: f32, sigma: f32) -> f32 {
    let mean = largest(mean, f32::MIN_POSITIVE);
    let exponent = -2.0 * math::ln(mean);
    // Two rounded sums may bring a mean of ones above 1.
    sigma * largest(exponent, 0.0).square_root()
}

fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

fn largest(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}
