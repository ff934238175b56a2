//! The supplement's figure of thresholds: Eq. 11 over δ, beside the confidences of estimates.

use super::Experiment;
use super::bench::Bench;
use super::correlation::protocol;
use super::error::ExperimentError;
use super::estimates::{Estimate, Protocol, camera};
use super::findings::Findings;
use super::judged::{NOISE, of_estimates, settings};
use super::paper;
use super::table::{Table, mean};
use crate::plot::{Axis, Colour, Item, Look, Mark, Page, Panel};
use crate::pose::single_pose;
use crate::train::LARGEST_TEMPLATE;
use cobra_infer::{Settings, Template, score};
use serde::{Deserialize, Serialize};

/// δ, in radii: from half of σ_m to four of it.
const DELTAS: [f64; 6] = [0.01, 0.02, 0.03, 0.04, 0.06, 0.08];

/// An estimate, and its threshold for each of [`DELTAS`].
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Row {
    add: f64,
    confidence: f64,
    thresholds: [f64; DELTAS.len()],
}

pub(super) fn run(bench: &Bench<'_>) -> Result<Findings, ExperimentError> {
    let shown = bench.shown(Experiment::Delta)?;
    let (rows, seconds) = bench.of_subjects(Experiment::Delta, &[shown], |subject| {
        of_estimates(
            bench,
            subject,
            &Protocol::CORRELATION,
            |template, _, estimate| judge(template, estimate),
        )
    })?;
    let rows: Vec<Row> = rows.into_iter().flat_map(|(_, rows)| rows).collect();

    let mut header = vec!["ADD".to_owned(), "confidence".to_owned()];
    header.extend(DELTAS.iter().map(|delta| format!("threshold at {delta}")));
    let mut numbers = Table {
        caption: String::new(),
        header,
        rows: Vec::new(),
        text: 0,
    };
    for row in &rows {
        let mut cells = vec![format!("{:.5}", row.add), format!("{:.4}", row.confidence)];
        cells.extend(
            row.thresholds
                .iter()
                .map(|threshold| format!("{threshold:.4}")),
        );
        numbers.push(cells);
    }

    let mut table = Table::new(
        "δ and ADD in radii; each estimate has its own threshold, of the components that speak for its \
         points.",
        &[
            "δ",
            "threshold, mean",
            "accepted",
            "of those with ADD ≤ δ",
            "of those with ADD > δ",
            "of those with ADD > 2δ",
        ],
    );
    let mut items = vec![Item::Series(
        Look::marks(Colour::Blue, Mark::Dot),
        rows.iter().map(|row| (row.add, row.confidence)).collect(),
    )];
    for (index, &delta) in DELTAS.iter().enumerate() {
        let threshold = mean(rows.iter().map(|row| row.thresholds[index]));
        let share = |wanted: &dyn Fn(&Row) -> bool| {
            let of: Vec<&Row> = rows.iter().filter(|row| wanted(row)).collect();
            let accepted = of
                .iter()
                .filter(|row| row.confidence >= row.thresholds[index]);
            match (accepted.count(), of.len()) {
                (_, 0) => "–".to_owned(),
                (some, all) => format!("{:.1} %", 100.0 * some as f64 / all as f64),
            }
        };
        table.push(vec![
            delta.to_string(),
            format!("{threshold:.3}"),
            share(&|_| true),
            share(&|row| row.add <= delta),
            share(&|row| row.add > delta),
            share(&|row| row.add > 2.0 * delta),
        ]);
        let look = Look::broken(Colour::Vermilion, Mark::None);
        items.push(Item::Rule(
            look,
            threshold,
            format!("δ = {delta}: {threshold:.3}"),
        ));
    }
    let figure = Page {
        title: "Thresholds of Eq. 11 over δ",
        subtitle: &format!(
            "{}: {} simulated estimates; δ in radii",
            shown.name,
            rows.len()
        ),
        legend: &[],
        columns: 1,
        panel: (900, 460),
    }
    .svg(&[Panel {
        heading: String::new(),
        across: Axis::around("ADD, radii", rows.iter().map(|row| row.add)),
        up: Axis::linear("confidence", &[0.0, 0.2, 0.4, 0.6, 0.8, 1.0], 0.02),
        room: 70,
        items,
    }])?;
    Ok(Findings {
        experiment: Experiment::Delta,
        title: "Thresholds over δ",
        protocol: format!(
            "The estimates of `{}` of Table 2, and Eq. 11 with σ_m = {NOISE} \
             radii, in the form for the likelihood whose peak is 1.",
            shown.name
        ),
        elsewhere: format!("The estimates of Table 2. {}", protocol()),
        numbers,
        tables: vec![table],
        remarks: vec![
            "A larger δ lowers the threshold and lets more pass. Eq. 11 bounds an average over residuals that \
             spread evenly in ±δ: ADD is another length than a residual, and a pose that slides points along the \
             surface keeps its residuals small."
                .to_owned(),
            format!(
                "In this form Eq. 11 never asks for more than ½. The paper states {} for δ = 2 mm on its real images; \
                 with the σ̂ = 1.93 mm of its code Eq. 11 gives 0.387, and 0.585 is what every residual at δ would \
                 give.",
                paper::STATED_THRESHOLD
            ),
        ],
        figure,
        seconds,
    })
}

/// The confidence, and the threshold for each δ.
fn judge(template: &Template<'_>, estimate: &Estimate) -> Result<Row, ExperimentError> {
    let pose = single_pose(&estimate.pose)?;
    let mut row = Row {
        add: estimate.add,
        confidence: 0.0,
        thresholds: [0.0; DELTAS.len()],
    };
    for (threshold, delta) in row.thresholds.iter_mut().zip(DELTAS) {
        let settings = Settings {
            delta: delta as f32,
            ..settings(template)
        };
        let seen = &estimate.correspondences;
        let report = score::<LARGEST_TEMPLATE>(template, &camera(), &pose, &settings, seen)?;
        *threshold = f64::from(report.threshold);
        row.confidence = f64::from(report.confidence);
    }
    Ok(row)
}
