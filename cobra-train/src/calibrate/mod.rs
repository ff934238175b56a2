//! Thresholds on the confidence that come with a false-accept rate.
//!
//! Owns what labelled confidences say: the thresholds for a target, the rates at them with their
//! intervals, and the curves that show what another threshold would do. Where the labels come from,
//! files or simulation, is not its business, and neither is how the confidences were made.
//!
//! What the rates promise, and what not: `docs/CALIBRATION.md`.

mod plot;
mod precision_recall;
mod rate;
mod reliability;
mod roc;
mod sweep;
mod thresholds;

pub use plot::{PlotError, precision_recall_svg, reliability_svg, roc_svg};
pub use precision_recall::{PrecisionRecall, PrecisionRecallPoint};
pub use rate::{Interval, Rate, percent};
pub use reliability::{Bin, reliability};
pub use roc::{Roc, RocPoint, area_under_roc};
pub use thresholds::{Aim, Thresholds, calibrate};

use sweep::sweep;

/// The confidence of an estimate of which somebody knows whether it is right, or as an `f64` another score of
/// its.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Labelled<C = f32> {
    /// Its confidence, from 0 to 1; the larger a score, the better.
    pub confidence: C,
    /// Whether it is right.
    pub right: bool,
}

/// Why labelled confidences give no thresholds.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CalibrateError {
    /// A share that was aimed at is none that can be measured.
    #[error("the {what} must be above 0 and below 1, found {found}")]
    Aim {
        /// Which share.
        what: &'static str,
        /// Its value.
        found: f64,
    },
    /// A confidence is not from 0 to 1.
    #[error("estimate {index}: the confidence must be from 0 to 1, found {found}")]
    Confidence {
        /// Which estimate, from 0.
        index: usize,
        /// Its value.
        found: f32,
    },
    /// So few estimates of a kind that even none at all on the wrong side of the threshold would not
    /// show the share that is aimed at.
    #[error(
        "{found} {kind} estimates show a share of at best {} % (the upper bound of the 95 % interval of \
         none in {found}): for {} % there must be at least {needed}", percent_above(*provable), percent(*aim)
    )]
    TooFew {
        /// `wrong` or `right`.
        kind: &'static str,
        /// How many there are.
        found: usize,
        /// The least share that so many can show.
        provable: f64,
        /// The share that was aimed at.
        aim: f64,
        /// How many it takes.
        needed: usize,
    },
    /// All confidences are the same: no threshold tells any two estimates apart.
    #[error(
        "all {count} estimates have the confidence {confidence}: no threshold tells them apart"
    )]
    AllEqual {
        /// That confidence.
        confidence: f32,
        /// How many estimates.
        count: usize,
    },
    /// More wrong estimates than may be accepted have the confidence 1.
    #[error(
        "{count} wrong estimates have the confidence 1, and {allowed} may be accepted: no threshold \
         leaves the others out"
    )]
    NoThreshold {
        /// How many.
        count: usize,
        /// How many may be accepted.
        allowed: usize,
    },
    /// The threshold that keeps to the target accepts no right estimate.
    #[error(
        "a threshold that accepts at most {allowed} of {wrong} wrong estimates is {accept} and accepts \
         none of the right ones"
    )]
    AcceptsNothing {
        /// The threshold.
        accept: f32,
        /// How many wrong ones may be accepted.
        allowed: usize,
        /// How many wrong ones there are.
        wrong: usize,
    },
}

/// Hundredths of a percent that are not less than a share: what can be shown must not seem less than it is.
fn percent_above(share: f64) -> f64 {
    (share * 1e4).ceil() / 1e2
}
