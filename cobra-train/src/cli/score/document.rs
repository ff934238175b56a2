//! What `cobra score` says: as JSON, and as a table.

use crate::cli::report::table;
use cobra_infer::{Assignment, Likelihood, Report, Settings, Sigma, Template, Threshold};
use cobra_train::input::Estimate;
use serde::Serialize;

#[derive(Serialize)]
pub(super) struct Document<'a> {
    schema: u32,
    template: &'a str,
    unit: &'static str,
    likelihood: &'static str,
    assignment: &'static str,
    delta: f32,
    threshold_rule: &'static str,
    /// σ for all components, where `--sigma-hat` gives it.
    sigma: Option<f32>,
    /// σ_m, where σ is the template's.
    noise: Option<f32>,
    poses: Vec<PoseDocument<'a>>,
}

#[derive(Serialize)]
struct PoseDocument<'a> {
    id: &'a str,
    points: u32,
    confidence: f32,
    threshold: f32,
    decision: &'static str,
    reason: &'static str,
    inlier_share: f32,
    weight_sum: f32,
    behind_camera: u32,
    /// How far the file's matrix was from a rotation, where it had to be replaced.
    repaired: Option<f32>,
}

pub(super) fn document<'a>(
    template: &'a Template<'_>,
    settings: &Settings,
    scored: &[(&'a Estimate, Report)],
) -> Document<'a> {
    Document {
        schema: 1,
        template: template.name(),
        unit: template.unit().symbol(),
        likelihood: match settings.likelihood {
            Likelihood::Peak => "peak",
            Likelihood::Density => "density",
        },
        assignment: match settings.assignment {
            Assignment::Nearest => "nearest",
            Assignment::Maximum => "max",
            Assignment::Soft => "soft",
        },
        delta: settings.delta,
        threshold_rule: match settings.threshold {
            Threshold::Paper => "paper",
            Threshold::Mean => "mean",
            Threshold::Worst => "worst",
        },
        sigma: match settings.sigma {
            Sigma::Fixed(sigma) => Some(sigma),
            Sigma::Template { .. } => None,
        },
        noise: match settings.sigma {
            Sigma::Fixed(_) => None,
            Sigma::Template { noise } => Some(noise),
        },
        poses: scored
            .iter()
            .map(|(estimate, report)| PoseDocument {
                id: &estimate.id,
                points: report.points,
                confidence: report.confidence,
                threshold: report.threshold,
                decision: report.decision.name(),
                reason: report.decision.reason(),
                inlier_share: report.inlier_share,
                weight_sum: report.weight_sum,
                behind_camera: report.behind_camera,
                repaired: estimate.repaired,
            })
            .collect(),
    }
}

pub(super) fn text(
    template: &Template<'_>,
    settings: &Settings,
    scored: &[(&Estimate, Report)],
) -> String {
    let rows: Vec<Vec<String>> = scored
        .iter()
        .map(|(estimate, report)| {
            vec![
                estimate.id.clone(),
                report.points.to_string(),
                format!("{:.3}", report.confidence),
                format!("{:.3}", report.threshold),
                format!("{:.0} %", 100.0 * report.inlier_share),
                report.decision.name().to_owned(),
                report.decision.reason().to_owned(),
            ]
        })
        .collect();
    let within = format!("within {:.3} {}", settings.delta, template.unit().symbol());
    let header = [
        "pose",
        "points",
        "confidence",
        "threshold",
        &within,
        "decision",
        "reason",
    ];
    table(&header, &["pose", "decision", "reason"], &rows)
}
