//! The supplement's surface of confidence over outlier share and outlier noise.

use super::Experiment;
use super::bench::Bench;
use super::correlation::protocol;
use super::error::ExperimentError;
use super::estimates::Protocol;
use super::findings::Findings;
use super::judged::{Judged, judge_all};
use super::table::{Table, mean};
use crate::plot::{Axis, Item, Page, Panel};

const SHARES: [f64; 7] = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6];
const SIZES: [f64; 6] = [10.0, 20.0, 30.0, 40.0, 50.0, 60.0];

const NOISE: [(f64, f64); 42] = {
    let mut noise = [(0.0, 0.0); 42];
    let mut index = 0;
    while index < 42 {
        noise[index] = (SHARES[index / 6], SIZES[index % 6]);
        index += 1;
    }
    noise
};

const PROTOCOL: Protocol = Protocol {
    noise: &NOISE,
    distances: &[4.5],
    repetitions: 3,
    ..Protocol::CORRELATION
};

pub(super) fn run(bench: &Bench<'_>) -> Result<Findings, ExperimentError> {
    let shown = bench.shown(Experiment::Noise)?;
    let (rows, seconds) = bench.of_subjects(Experiment::Noise, &[shown], |subject| {
        judge_all(bench, subject, &PROTOCOL)
    })?;
    let judged: Vec<&Judged> = rows.iter().flat_map(|(_, judged)| judged).collect();
    let cell = |share: f64, size: f64, value: fn(&Judged) -> f64| {
        let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
        let of = judged
            .iter()
            .filter(|j| near(j.outliers, share) && near(j.outlier_noise, size));
        mean(of.map(|j| value(j)))
    };

    let mut numbers = Table::new(
        "",
        &["outlier share", "outlier noise px", "confidence", "ADD"],
    );
    let mut header = vec!["outlier share".to_owned()];
    header.extend(SIZES.iter().map(|size| format!("{size} px")));
    let mut table = Table {
        caption: "Mean confidence over outlier share (down) and outlier noise (across).".to_owned(),
        header,
        rows: Vec::new(),
        text: 1,
    };
    let (mut confidences, mut errors) = (Vec::new(), Vec::new());
    let mut rises: Vec<String> = Vec::new();
    let largest = cell(SHARES[6], SIZES[5], |j| j.add);
    for (row, &share) in SHARES.iter().enumerate() {
        let mut cells = vec![format!("{share}")];
        for (column, &size) in SIZES.iter().enumerate() {
            let confidence = cell(share, size, |j| j.confidence);
            let add = cell(share, size, |j| j.add);
            numbers.push(vec![
                share.to_string(),
                size.to_string(),
                format!("{confidence:.4}"),
                format!("{add:.5}"),
            ]);
            cells.push(format!("{confidence:.2}"));
            let corners = [
                (column as f64, row as f64),
                (column as f64 + 1.0, row as f64 + 1.0),
            ];
            confidences.push(Item::Cell(corners, confidence, format!("{confidence:.2}")));
            errors.push(Item::Cell(corners, add / largest, format!("{add:.3}")));
            let beside = [
                (row.checked_sub(1), Some(column)),
                (Some(row), column.checked_sub(1)),
            ];
            for (row, column) in beside {
                let (Some(row), Some(column)) = (row, column) else {
                    continue;
                };
                let before = cell(SHARES[row], SIZES[column], |j| j.confidence);
                // Without outliers their noise is nobody's.
                if confidence > before && share > 0.0 {
                    rises.push(format!("{share} at {size} px"));
                }
            }
        }
        table.push(cells);
    }
    let trend = if rises.is_empty() {
        "The confidence falls with every step of the outlier share, and of the outlier noise where there are \
         outliers, as the paper says."
            .to_owned()
    } else {
        rises.dedup();
        format!(
            "The confidence falls with most steps of the outlier share, and of the outlier noise where there are \
             outliers; it rises in {} of {} cells: {}.",
            rises.len(),
            (SHARES.len() - 1) * SIZES.len(),
            rises.join(", ")
        )
    };

    let panel = |heading: &str, items| Panel {
        heading: heading.to_owned(),
        across: Axis::bins("outlier noise, px", &SIZES),
        up: Axis::bins("outlier share", &SHARES),
        room: 70,
        items,
    };
    let figure = Page {
        title: "Confidence over outlier share and outlier noise",
        subtitle: &format!(
            "{}: means over {} estimates a cell",
            shown.name,
            judged.len() / 42
        ),
        legend: &[],
        columns: 2,
        panel: (500, 400),
    }
    .svg(&[
        panel("Confidence", confidences),
        panel("ADD, radii", errors),
    ])?;
    Ok(Findings {
        experiment: Experiment::Noise,
        title: "Confidence over noise",
        protocol: format!(
            "Simulated estimates of `{}`, {} for each outlier share and outlier noise, at a distance of 4.5 radii; else \
             as those of Table 2.",
            shown.name,
            judged.len() / 42
        ),
        elsewhere: format!("The estimates of Table 2. {}", protocol()),
        numbers,
        tables: vec![table],
        remarks: vec![trend],
        figure,
        seconds,
    })
}
