//! The confidence of a pose (Eq. 10), its threshold ([`crate::bound`]) and the decision.
//!
//! Owns the weighted mean over correspondences: a streaming scorer, so that a watchdog can be fed
//! between points, and a batch call that is the same scorer in a loop and so gives the same bits.

use crate::camera::{Camera, Correspondence};
use crate::error::ScoreError;
use crate::math::{self, CompensatedSum};
use crate::mixture::{Likelihood, Match, Mixture, Settings};
use crate::pose::Pose;
use crate::template::Template;
use crate::trace;

/// What to do with the pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Decision {
    /// The confidence reaches the threshold.
    Accept,
    /// It does not.
    Reject(Rejection),
    /// The input does not allow an answer.
    Undecided(Doubt),
}

/// Why a pose is rejected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Rejection {
    /// The confidence lies below the threshold.
    BelowThreshold,
    /// The confidence is 0, which is never accepted, whatever the threshold.
    NoSupport,
    /// Every point comes to lie behind the camera.
    BehindCamera,
}

/// Why there is no answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Doubt {
    /// Fewer points of positive weight than [`Settings::minimum_points`].
    TooFewPoints,
    /// The weights add up to 0, or are below [`f32::MIN_POSITIVE`] on average: their products with
    /// likelihoods would have too few bits left to decide on.
    NoWeight,
    /// A pixel, point or weight was NaN or infinite, or the weights add up to more than an `f32`
    /// holds.
    NonFiniteInput,
    /// A weight was negative.
    NegativeWeight,
    /// The threshold rounds to 0, because δ is immense against σ: any pose would pass.
    NoThreshold,
    /// Against depth: something nearer hides what would have to be seen.
    Hidden,
    /// Against depth: no thresholds are known.
    NotCalibrated,
    /// Against depth: the confidence lies between the thresholds.
    BetweenThresholds,
}

impl Decision {
    /// `accept`, `reject` or `undecided`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Decision::Accept => "accept",
            Decision::Reject(_) => "reject",
            Decision::Undecided(_) => "undecided",
        }
    }

    /// The reason, as a phrase.
    #[must_use]
    pub const fn reason(self) -> &'static str {
        match self {
            Decision::Accept => "confidence reaches the threshold",
            Decision::Reject(Rejection::BelowThreshold) => "confidence below the threshold",
            Decision::Reject(Rejection::NoSupport) => "no point lies on the surface",
            Decision::Reject(Rejection::BehindCamera) => "every point lies behind the camera",
            Decision::Undecided(Doubt::TooFewPoints) => "too few points",
            Decision::Undecided(Doubt::NoWeight) => "the weights add up to zero or next to nothing",
            Decision::Undecided(Doubt::NonFiniteInput) => "a number in the input is not finite",
            Decision::Undecided(Doubt::NegativeWeight) => "a weight is negative",
            Decision::Undecided(Doubt::NoThreshold) => {
                "the threshold is zero: the tolerance is immense against sigma"
            }
            Decision::Undecided(Doubt::Hidden) => "something in front hides the object",
            Decision::Undecided(Doubt::NotCalibrated) => "no threshold is known: calibrate first",
            Decision::Undecided(Doubt::BetweenThresholds) => "confidence between the thresholds",
        }
    }
}

/// The scorer's answer. None of its numbers is ever NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Report {
    /// The weighted mean likelihood of the valid points, weights normalised to sum 1 (Eq. 10 as
    /// printed with the density and the maximum); 0 where the weights vanish or overflow.
    pub confidence: f32,
    /// The threshold that the settings ask for, Eq. 11 by default, with the same weights.
    pub threshold: f32,
    /// How many correspondences were pushed.
    pub points: u32,
    /// How many of them came to lie behind the camera.
    pub behind_camera: u32,
    /// How many came to lie in front of it, at finite coordinates, where no component speaks for them:
    /// of a template with validity, mostly where nothing of the object is. Their likelihood is 0, and
    /// their contribution to the threshold is the largest of all components'.
    pub uncovered: u32,
    /// The sum of the weights before normalisation.
    pub weight_sum: f32,
    /// The share of the points whose residual is at most δ in magnitude, unweighted.
    pub inlier_share: f32,
    /// What to do, and why.
    pub decision: Decision,
}

/// What one correspondence came to.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PointScore {
    /// Its likelihood; 0 for a point behind the camera or with invalid input.
    pub likelihood: f32,
    /// What the template said of it, if it could say anything.
    pub found: Option<Match>,
}

/// Scores one pose, point by point, against a template of at most `COMPONENTS` components.
#[derive(Clone, Debug)]
pub struct Scorer<'t, const COMPONENTS: usize> {
    mixture: Mixture<'t, COMPONENTS>,
    camera: Camera,
    pose: Pose,
    likelihood: Likelihood,
    delta: f32,
    minimum_points: u32,
    likelihoods: CompensatedSum,
    thresholds: CompensatedSum,
    weights: CompensatedSum,
    points: u32,
    weighty: u32,
    inliers: u32,
    behind_camera: u32,
    uncovered: u32,
    doubt: Option<Doubt>,
}

impl<'t, const COMPONENTS: usize> Scorer<'t, COMPONENTS> {
    /// Starts on a pose.
    ///
    /// # Errors
    /// [`ScoreError::TooManyComponents`], or a setting out of its range.
    pub fn new(
        template: &'t Template<'t>,
        camera: &Camera,
        pose: &Pose,
        settings: &Settings,
    ) -> Result<Self, ScoreError> {
        Mixture::<COMPONENTS>::check(template, settings)?;
        // Filled inside the result: a scorer moved into it would lie on the stack twice.
        let mut result = Ok(Self {
            mixture: Mixture::unprepared(template, settings),
            camera: *camera,
            pose: *pose,
            likelihood: settings.likelihood,
            delta: settings.delta,
            minimum_points: settings.minimum_points,
            likelihoods: CompensatedSum::default(),
            thresholds: CompensatedSum::default(),
            weights: CompensatedSum::default(),
            points: 0,
            weighty: 0,
            inliers: 0,
            behind_camera: 0,
            uncovered: 0,
            doubt: None,
        });
        if let Ok(scorer) = &mut result {
            scorer.mixture.prepare(settings);
        }
        result
    }

    /// Takes one correspondence.
    ///
    /// A correspondence with a number that is not finite, or a negative weight, makes the decision
    /// undecided; it is counted and otherwise left out.
    pub fn push(&mut self, correspondence: &Correspondence) -> PointScore {
        self.points = self.points.saturating_add(1);
        let weight = correspondence.weight;
        let back =
            self.camera
                .back_project(&self.pose, &correspondence.pixel, &correspondence.point);
        // A pixel or a point that is not finite leaves no finite depth: most correspondences are
        // through with one look at it.
        let suspect = !(back.depth.is_finite() && weight.is_finite());
        let fault = if suspect && !correspondence.is_finite() {
            Some(Doubt::NonFiniteInput)
        } else if weight < 0.0 {
            Some(Doubt::NegativeWeight)
        } else {
            None
        };
        if fault.is_some() {
            self.doubt = self.doubt.or(fault);
            return PointScore {
                likelihood: 0.0,
                found: None,
            };
        }
        // An overflow makes the depth NaN: that point is nowhere, not behind the camera.
        let found = if back.depth <= 0.0 {
            self.behind_camera = self.behind_camera.saturating_add(1);
            None
        } else {
            let found = self.mixture.evaluate(&back.point);
            if found.is_none() && back.point.iter().all(|x| x.is_finite()) {
                self.uncovered = self.uncovered.saturating_add(1);
            }
            found
        };
        let likelihood = found.map_or(0.0, |found| found.likelihood);
        if found.is_some_and(|found| math::abs(found.residual()) <= self.delta) {
            self.inliers = self.inliers.saturating_add(1);
        }
        if weight > 0.0 {
            self.weighty = self.weighty.saturating_add(1);
        }
        self.likelihoods.add(weight * likelihood);
        self.thresholds
            .add(weight * self.mixture.threshold(found.as_ref()));
        self.weights.add(weight);
        PointScore { likelihood, found }
    }

    /// The confidence, the threshold and the decision on everything pushed so far.
    #[must_use]
    pub fn finish(&self) -> Report {
        let weight_sum = self.weights.value();
        let confidence = self.likelihoods.value() / weight_sum;
        let threshold = self.thresholds.value() / weight_sum;
        let mut report = Report {
            confidence: match self.likelihood {
                // Two rounded sums may differ by an ulp where every likelihood is 1.
                Likelihood::Peak if confidence > 1.0 => 1.0,
                _ => confidence,
            },
            threshold,
            points: self.points,
            behind_camera: self.behind_camera,
            uncovered: self.uncovered,
            weight_sum,
            inlier_share: match self.points {
                0 => 0.0,
                points => self.inliers as f32 / points as f32,
            },
            decision: Decision::Accept,
        };
        let overflow = !(weight_sum.is_finite() && confidence.is_finite() && threshold.is_finite());
        let no_weight = weight_sum < f32::MIN_POSITIVE * self.points.max(1) as f32;
        let doubt = if self.doubt.is_some() {
            self.doubt
        } else if self.points < self.minimum_points.max(1) {
            Some(Doubt::TooFewPoints)
        } else if no_weight {
            Some(Doubt::NoWeight)
        } else if self.weighty < self.minimum_points {
            Some(Doubt::TooFewPoints)
        } else if overflow {
            Some(Doubt::NonFiniteInput)
        } else {
            None
        };
        if overflow || no_weight {
            report.confidence = 0.0;
            report.threshold = 0.0;
            if weight_sum.is_nan() {
                report.weight_sum = f32::INFINITY;
            }
        }
        report.decision = match doubt {
            Some(doubt) => Decision::Undecided(doubt),
            None if self.behind_camera == self.points => Decision::Reject(Rejection::BehindCamera),
            None if report.confidence <= 0.0 => Decision::Reject(Rejection::NoSupport),
            None if report.threshold <= 0.0 => Decision::Undecided(Doubt::NoThreshold),
            None if report.confidence < report.threshold => {
                Decision::Reject(Rejection::BelowThreshold)
            }
            None => Decision::Accept,
        };
        trace::pose_scored(&report);
        report
    }
}

/// Scores one pose on a slice of correspondences: [`Scorer`] in a loop, the same bits.
///
/// # Errors
/// As [`Scorer::new`].
pub fn score<const COMPONENTS: usize>(
    template: &Template<'_>,
    camera: &Camera,
    pose: &Pose,
    settings: &Settings,
    correspondences: &[Correspondence],
) -> Result<Report, ScoreError> {
    let mut scorer = Scorer::<COMPONENTS>::new(template, camera, pose, settings)?;
    for correspondence in correspondences {
        scorer.push(correspondence);
    }
    Ok(scorer.finish())
}
