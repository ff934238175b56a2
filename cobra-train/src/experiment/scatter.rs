//! The supplement's figure of confidence against ADD.

use super::Experiment;
use super::bench::Bench;
use super::error::ExperimentError;
use super::estimates::Protocol;
use super::findings::Findings;
use super::judged::{Judged, judge_all};
use super::paper;
use super::table::Table;
use crate::evaluate::rank_correlation;
use crate::plot::{Axis, Colour, Item, Look, Mark, Page, Panel};

/// What is plotted: its name, its colour, its value.
type Kind = (&'static str, Colour, fn(&Judged) -> f64);

const KINDS: [Kind; 2] = [
    ("COBRA", Colour::Teal, |j| j.confidence),
    ("the exact distance to the mesh", Colour::Ink, |j| j.oracle),
];

const PRINTED: Look = Look::marks(Colour::Vermilion, Mark::Plus);

pub(super) fn run(bench: &Bench<'_>) -> Result<Findings, ExperimentError> {
    let shown = bench.data.shown();
    let (rows, seconds) = bench.of_subjects(Experiment::Scatter, &[shown], |subject| {
        judge_all(bench, subject, &Protocol::CORRELATION)
    })?;
    let judged: Vec<Judged> = rows.into_iter().flat_map(|(_, judged)| judged).collect();
    let mut numbers = Table::new(
        "",
        &[
            "outlier share",
            "outlier noise px",
            "ADD",
            "confidence",
            "exact distance",
            "inlier share",
            "reprojection error px",
        ],
    );
    for j in &judged {
        numbers.push(vec![
            format!("{:.1}", j.outliers),
            j.outlier_noise.to_string(),
            format!("{:.5}", j.add),
            format!("{:.4}", j.confidence),
            format!("{:.4}", j.oracle),
            format!("{:.4}", j.inliers),
            format!("{:.3}", j.reprojection),
        ]);
    }
    let add: Vec<f64> = judged.iter().map(|j| j.add).collect();
    let rho = |value: fn(&Judged) -> f64| {
        let values: Vec<f64> = judged.iter().map(value).collect();
        rank_correlation(&values, &add).unwrap_or(f64::NAN)
    };
    let mut table = Table::new("", &["scored by", "estimates", "Spearman's ρ with ADD"]);
    let mut panels = Vec::new();
    for (name, colour, value) in KINDS {
        let rho = rho(value);
        table.push(vec![
            name.to_owned(),
            judged.len().to_string(),
            format!("{rho:.3}"),
        ]);
        panels.push(Panel {
            heading: format!("{name}: ρ = {rho:.3}"),
            across: Axis::around(
                "ADD, radii",
                add.iter().copied().chain(paper::SHOWN.map(|(add, _)| add)),
            ),
            up: Axis::linear("confidence", &[0.0, 0.2, 0.4, 0.6, 0.8, 1.0], 0.02),
            room: 70,
            items: vec![
                Item::Series(
                    Look::marks(colour, Mark::Dot),
                    judged.iter().map(|j| (j.add, value(j))).collect(),
                ),
                Item::Series(PRINTED, paper::SHOWN.to_vec()),
            ],
        });
    }
    let figure = Page {
        title: "Confidence against ADD",
        subtitle: &format!("{}: {} simulated estimates", shown.name, judged.len()),
        legend: &[(PRINTED, "the paper's twelve pictures".to_owned())],
        columns: 2,
        panel: (500, 400),
    }
    .svg(&panels)?;
    Ok(Findings {
        experiment: Experiment::Scatter,
        title: "Confidence against ADD",
        protocol: format!(
            "The estimates of `{}` of [Table 2](correlation.md), one by one.",
            shown.name
        ),
        numbers,
        tables: vec![table],
        remarks: vec![
            "The paper's twelve pictures, of other objects under a σ that it does not print for them, fall from a \
             confidence of 0.8 to 0.1 as ADD rises from 0.002 to 0.157."
                .to_owned(),
        ],
        figure,
        seconds,
    })
}
