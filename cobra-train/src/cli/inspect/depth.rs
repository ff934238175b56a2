//! What `cobra inspect` says of depth mode.

use cobra_infer::template::{Calibration, DepthRecord};
use serde::Serialize;

#[derive(Serialize)]
pub(super) struct DepthDocument {
    /// The measurement's standard deviation as a share of the diameter.
    noise_share: f32,
    /// `null` where no thresholds were calibrated.
    calibration: Option<CalibrationDocument>,
}

#[derive(Serialize)]
struct CalibrationDocument {
    accept: f32,
    reject: f32,
    minimum_points: u32,
    /// The false-accept rate that was aimed at.
    target: f32,
    /// The one that was measured, with its Wilson interval at 95 %.
    false_accepts: FalseAccepts,
    wrong: u32,
    right: u32,
    source: &'static str,
    provenance: String,
}

#[derive(Serialize)]
struct FalseAccepts {
    share: f32,
    low: f32,
    high: f32,
}

impl DepthDocument {
    pub(super) fn new(depth: &DepthRecord<'_>) -> Self {
        let of = |calibration: Calibration| CalibrationDocument {
            accept: calibration.accept,
            reject: calibration.reject,
            minimum_points: calibration.minimum_points,
            target: calibration.target,
            false_accepts: FalseAccepts {
                share: calibration.false_accepts.share,
                low: calibration.false_accepts.low,
                high: calibration.false_accepts.high,
            },
            wrong: calibration.wrong,
            right: calibration.right,
            source: calibration.source.name(),
            provenance: depth.provenance().to_owned(),
        };
        Self {
            noise_share: depth.noise_share,
            calibration: depth.calibration.map(of),
        }
    }

    /// Lines of the table.
    pub(super) fn text(&self) -> String {
        let noise = format!(
            "depth mode  sigma_m {:.2} % of the diameter",
            100.0 * self.noise_share
        );
        let Some(calibration) = &self.calibration else {
            return format!("{noise}; no thresholds\n");
        };
        let FalseAccepts { share, low, high } = calibration.false_accepts;
        let origin = match &calibration.provenance {
            text if text.is_empty() => calibration.source.to_owned(),
            text => format!("{}: {text}", calibration.source),
        };
        format!(
            "{noise}; accepted from {:.4} on, rejected below {:.4}, undecided with fewer than {} pixels\n\
             calibrated  {:.2} % of wrong estimates accepted ({:.2} to {:.2} %, aimed at {:.2} %), on {} \
             wrong and {} right ones ({origin})\n",
            calibration.accept,
            calibration.reject,
            calibration.minimum_points,
            100.0 * share,
            100.0 * low,
            100.0 * high,
            100.0 * calibration.target,
            calibration.wrong,
            calibration.right,
        )
    }
}
