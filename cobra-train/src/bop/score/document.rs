//! The report of scored estimates, for programs: every number of every estimate.
//!
//! Owns the keys, which `docs/BOP.md` lists. [`crate::input::read_score_report`] reads what calibration
//! needs of them.

use super::{DepthSource, Masks, Outcome, ScoreOptions, Scored, Truth};
use cobra_infer::Unit;
use serde::Serialize;

/// The report of a results file.
#[derive(Debug, Serialize)]
pub struct ReportDocument<'a> {
    dataset: DatasetDocument<'a>,
    estimates: Vec<EstimateDocument>,
}

#[derive(Debug, Serialize)]
struct DatasetDocument<'a> {
    name: &'a str,
    split: &'a str,
    results: &'a str,
    masks: &'static str,
    depth: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    depth_noise_mm: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    seed: Option<u64>,
    pixels: usize,
}

#[derive(Debug, Serialize)]
struct EstimateDocument {
    row: u64,
    scene_id: Option<u32>,
    im_id: Option<u32>,
    obj_id: Option<u32>,
    own_score: Option<f64>,
    confidence: Option<f32>,
    valid_pixels: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    problem: Option<String>,
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    score: Option<ScoreDocument>,
    #[serde(skip_serializing_if = "Option::is_none")]
    truth: Option<TruthDocument>,
    #[serde(skip_serializing_if = "Option::is_none")]
    truth_problem: Option<String>,
}

#[derive(Debug, Serialize)]
struct ScoreDocument {
    decision: &'static str,
    reason: &'static str,
    cause: String,
    masks: &'static str,
    minimum_points: u32,
    forward: f32,
    reverse: f32,
    estimated_error_mm: f32,
    displacement_mm: f32,
    residual_mm: f32,
    noise_mm: f32,
    along_ray_mm: f32,
    sideways_mm: f32,
    turn_degrees: f32,
    refined_r: [f32; 9],
    refined_t_mm: [f32; 3],
    pixels: u32,
    silent: u32,
    visible: u32,
    judged: u32,
    hidden: u32,
    unmeasured: u32,
    seen_through: u32,
}

#[derive(Debug, Serialize)]
struct TruthDocument {
    right: bool,
    in_image: bool,
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    errors: Option<ErrorDocument>,
}

#[derive(Debug, Serialize)]
struct ErrorDocument {
    error_mm: f64,
    diameter_mm: f64,
    symmetric: bool,
    add_mm: f64,
    add_s_mm: f64,
    mssd_mm: f64,
    mssd_without_symmetries_mm: f64,
    mspd_px: f64,
    mspd_without_symmetries_px: f64,
}

impl<'a> ReportDocument<'a> {
    /// Of the rows of a results file with this name, of a data set and a split.
    #[must_use]
    pub fn new(
        [dataset, split, results]: [&'a str; 3],
        options: &ScoreOptions,
        scored: &[Scored],
    ) -> Self {
        let simulated = match options.depth {
            DepthSource::Sensor => None,
            DepthSource::Simulated { noise } => Some(noise),
        };
        Self {
            dataset: DatasetDocument {
                name: dataset,
                split,
                results,
                masks: match options.masks {
                    Masks::Folder(_) => "files",
                    Masks::Simulated => "simulated",
                    Masks::Silhouette => "silhouette",
                },
                depth: simulated.map_or("sensor", |_| "simulated"),
                depth_noise_mm: simulated,
                seed: simulated.map(|_| options.seed),
                pixels: options.pixels,
            },
            estimates: scored.iter().map(estimate).collect(),
        }
    }
}

fn estimate(scored: &Scored) -> EstimateDocument {
    let outcome = scored.outcome.as_ref().ok();
    let ids = scored.estimate.as_ref();
    EstimateDocument {
        row: scored.line,
        scene_id: ids.map(|estimate| estimate.scene_id),
        im_id: ids.map(|estimate| estimate.im_id),
        obj_id: ids.map(|estimate| estimate.obj_id),
        own_score: ids.map(|estimate| estimate.score),
        confidence: outcome.map(|outcome| outcome.report.confidence),
        valid_pixels: outcome.map_or(0, Outcome::valid_pixels),
        problem: scored.outcome.as_ref().err().map(ToString::to_string),
        score: outcome.map(score),
        truth: scored.known_truth().map(truth),
        truth_problem: scored.truth.as_ref().err().map(ToString::to_string),
    }
}

fn score(outcome: &Outcome) -> ScoreDocument {
    let report = &outcome.report;
    let r = report.refined.rotation().matrix();
    ScoreDocument {
        decision: report.decision.name(),
        reason: report.decision.reason(),
        cause: outcome.cause.in_unit(Unit::Millimetre).to_string(),
        masks: if outcome.masked { "mask" } else { "silhouette" },
        minimum_points: outcome.minimum_points,
        forward: report.forward,
        reverse: report.reverse,
        estimated_error_mm: report.estimated_error,
        displacement_mm: report.displacement,
        residual_mm: report.residual,
        noise_mm: report.noise,
        along_ray_mm: outcome.correction.along_ray,
        sideways_mm: outcome.correction.sideways,
        turn_degrees: outcome.correction.turn.to_degrees(),
        refined_r: [
            r.m11, r.m12, r.m13, r.m21, r.m22, r.m23, r.m31, r.m32, r.m33,
        ],
        refined_t_mm: (*report.refined.translation()).into(),
        pixels: report.pixels,
        silent: report.silent,
        visible: report.visible,
        judged: report.judged,
        hidden: report.hidden,
        unmeasured: report.unmeasured,
        seen_through: report.seen_through,
    }
}

fn truth(truth: &Truth) -> TruthDocument {
    TruthDocument {
        right: truth.is_right(),
        in_image: truth.errors().is_some(),
        errors: truth.errors().map(|errors| ErrorDocument {
            error_mm: errors.error(),
            diameter_mm: errors.diameter,
            symmetric: errors.symmetric,
            add_mm: errors.add,
            add_s_mm: errors.add_s,
            mssd_mm: errors.mssd,
            mssd_without_symmetries_mm: errors.mssd_without,
            mspd_px: errors.mspd,
            mspd_without_symmetries_px: errors.mspd_without,
        }),
    }
}
