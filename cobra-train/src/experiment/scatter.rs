//! The supplement's figure of confidence against ADD.

use super::Experiment;
use super::bench::Bench;
use super::correlation::protocol;
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
    let shown = bench.shown(Experiment::Scatter)?;
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
        protocol: format!("The estimates of `{}` of Table 2, one by one.", shown.name),
        elsewhere: format!("The estimates of Table 2. {}", protocol()),
        numbers,
        tables: vec![table],
        remarks: vec![pictures(&judged)],
        figure,
        seconds,
    })
}

/// What the paper's pictures say beside these estimates.
fn pictures(judged: &[Judged]) -> String {
    let least = judged
        .iter()
        .map(|j| j.confidence)
        .fold(f64::INFINITY, f64::min);
    let below: Vec<(f64, f64)> = paper::SHOWN
        .into_iter()
        .filter(|(_, confidence)| *confidence < least)
        .collect();
    let from = |value: fn(&(f64, f64)) -> f64| {
        let of = || below.iter().map(value);
        (
            of().fold(f64::INFINITY, f64::min),
            of().fold(f64::NEG_INFINITY, f64::max),
        )
    };
    let apart = if below.is_empty() {
        String::new()
    } else {
        let ((low, high), (near, far)) = (from(|shown| shown.1), from(|shown| shown.0));
        format!(
            ": {} of them, of ADD {near} to {far}, have {low:.2} to {high:.2}, less than any of these estimates, \
             whose least is {least:.2}",
            below.len()
        )
    };
    format!(
        "The paper's twelve pictures are of other objects, under a σ that it does not print for them{apart}."
    )
}
