//! What `cobra calibrate` says: as JSON, and as a table.

use super::evidence::Evidence;
use crate::cli::report::table;
use cobra_infer::template::Calibration;
use cobra_train::calibrate::{Aim, Bin, PrecisionRecall, Rate, Roc, Thresholds, percent};
use serde::Serialize;

#[derive(Serialize)]
pub(super) struct Document<'a> {
    schema: u32,
    template: &'a str,
    accept: f32,
    reject: f32,
    minimum_points: u32,
    noise_share: f32,
    source: &'static str,
    provenance: &'a str,
    target: Target,
    wrong: Kind,
    right: Kind,
    area_under_roc: f64,
    average_precision: f64,
    left_out: LeftOut,
    reliability: Vec<BinDocument>,
}

#[derive(Serialize)]
struct Target {
    false_accepts: f64,
    rejected_right: f64,
}

/// What becomes of the wrong or of the right estimates.
#[derive(Serialize)]
struct Kind {
    total: usize,
    accepted: Share,
    rejected: Share,
}

/// A share with its Wilson interval at 95 %.
#[derive(Serialize)]
struct Share {
    count: usize,
    share: f64,
    low: f64,
    high: f64,
}

#[derive(Serialize)]
struct LeftOut {
    other_objects: usize,
    not_scored: usize,
    without_truth: usize,
    too_few_pixels: usize,
}

#[derive(Serialize)]
struct BinDocument {
    low: f64,
    high: f64,
    confidence: f64,
    right: Share,
    total: usize,
}

impl From<Rate> for Share {
    fn from(rate: Rate) -> Self {
        let interval = rate.interval();
        Self {
            count: rate.count,
            share: rate.share(),
            low: interval.low,
            high: interval.high,
        }
    }
}

/// What was found.
pub(super) struct Found<'a> {
    pub(super) template: &'a str,
    pub(super) noise_share: f32,
    pub(super) aim: Aim,
    pub(super) calibration: Calibration,
    pub(super) thresholds: Thresholds,
    pub(super) roc: Roc,
    pub(super) precision_recall: PrecisionRecall,
    pub(super) bins: Vec<Bin>,
    pub(super) evidence: &'a Evidence,
}

impl Found<'_> {
    pub(super) fn document(&self) -> Document<'_> {
        let Thresholds {
            false_accepts,
            true_accepts,
            rejected_wrong,
            rejected_right,
            ..
        } = self.thresholds;
        let kind = |accepted: Rate, rejected: Rate| Kind {
            total: accepted.total,
            accepted: accepted.into(),
            rejected: rejected.into(),
        };
        let left_out = &self.evidence.left_out;
        Document {
            schema: 1,
            template: self.template,
            accept: self.thresholds.accept,
            reject: self.thresholds.reject,
            minimum_points: self.calibration.minimum_points,
            noise_share: self.noise_share,
            source: self.evidence.source.name(),
            provenance: &self.evidence.provenance,
            target: Target {
                false_accepts: self.aim.false_accepts,
                rejected_right: self.aim.rejected_right,
            },
            wrong: kind(false_accepts, rejected_wrong),
            right: kind(true_accepts, rejected_right),
            area_under_roc: self.roc.area,
            average_precision: self.precision_recall.average_precision,
            left_out: LeftOut {
                other_objects: left_out.other_objects,
                not_scored: left_out.not_scored,
                without_truth: left_out.without_truth,
                too_few_pixels: left_out.too_few_pixels,
            },
            reliability: self
                .bins
                .iter()
                .map(|bin| BinDocument {
                    low: bin.low,
                    high: bin.high,
                    confidence: bin.confidence,
                    right: bin.right.into(),
                    total: bin.right.total,
                })
                .collect(),
        }
    }

    pub(super) fn text(&self) -> String {
        let thresholds = &self.thresholds;
        let row = |kind: &str, accepted: Rate, rejected: Rate| {
            let undecided = Rate {
                count: accepted.total - accepted.count - rejected.count,
                total: accepted.total,
            };
            vec![
                kind.to_owned(),
                accepted.total.to_string(),
                accepted.to_string(),
                accepted.interval().to_string(),
                undecided.to_string(),
                rejected.to_string(),
                rejected.interval().to_string(),
            ]
        };
        let rows = [
            row("wrong", thresholds.false_accepts, thresholds.rejected_wrong),
            row("right", thresholds.true_accepts, thresholds.rejected_right),
        ];
        let header = [
            "estimates",
            "count",
            "accepted",
            "interval",
            "undecided",
            "rejected",
            "its interval",
        ];
        let minimum = self.calibration.minimum_points;
        format!(
            "accept      confidence of at least {:.4}, for at most {} % of the wrong estimates\n\
             reject      confidence below {:.4}, for at most {} % of the right ones\n\
             undecided   between them, or with fewer than {minimum} valid pixels\n\
             area        {:.4} under the roc; average precision {:.4}\n\n{}\n\nintervals: Wilson's at 95 %",
            thresholds.accept,
            percent(self.aim.false_accepts),
            thresholds.reject,
            percent(self.aim.rejected_right),
            self.roc.area,
            self.precision_recall.average_precision,
            table(&header, &["estimates"], &rows)
        )
    }
}
