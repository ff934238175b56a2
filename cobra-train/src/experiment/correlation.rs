//! Table 2: whether the confidence falls as the error grows.

use super::bench::Bench;
use super::error::ExperimentError;
use super::estimates::{PnpSolver, Protocol};
use super::findings::Findings;
use super::judged::{INLIER, Judged, NOISE, judge_all};
use super::subject::classes;
use super::table::{Table, mean};
use super::{Experiment, paper};
use crate::evaluate::rank_correlation;
use crate::plot::{Axis, Colour, Item, Look, Mark, Page, Panel};
use serde::{Deserialize, Serialize};

/// Spearman's ρ of an object between ADD and each of what could tell it.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Row {
    estimates: usize,
    /// ADD's quantiles at 10, 50 and 90 %.
    add: [f64; 3],
    confidence: Option<f64>,
    oracle: Option<f64>,
    inliers: Option<f64>,
    reprojection: Option<f64>,
    /// The same estimates, their poses found by the least distances in space.
    in_space: Option<f64>,
    oracle_in_space: Option<f64>,
}

/// What a column of ρ is called, its look, and its number.
type Column = (&'static str, Look, fn(&Row) -> f64);

const COLUMNS: [Column; 6] = [
    ("COBRA", Look::marks(Colour::Teal, Mark::Disc), |row| {
        row.confidence.unwrap_or(f64::NAN)
    }),
    (
        "exact distance",
        Look::marks(Colour::Ink, Mark::Ring),
        |row| row.oracle.unwrap_or(f64::NAN),
    ),
    (
        "inlier share",
        Look::marks(Colour::Ochre, Mark::Triangle),
        |row| row.inliers.unwrap_or(f64::NAN),
    ),
    (
        "reprojection error",
        Look::marks(Colour::Violet, Mark::Cross),
        |row| row.reprojection.unwrap_or(f64::NAN),
    ),
    (
        "COBRA, other solver",
        Look::marks(Colour::Teal, Mark::Square),
        |row| row.in_space.unwrap_or(f64::NAN),
    ),
    (
        "exact distance, other solver",
        Look::marks(Colour::Ink, Mark::Plus),
        |row| row.oracle_in_space.unwrap_or(f64::NAN),
    ),
];

pub(super) fn run(bench: &Bench<'_>) -> Result<Findings, ExperimentError> {
    let subjects = bench.data.of_the_paper();
    let (rows, seconds) = bench.of_subjects(Experiment::Correlation, &subjects, |subject| {
        let in_space = Protocol {
            solver: PnpSolver::Space,
            ..Protocol::CORRELATION
        };
        let row = summarise(&judge_all(bench, subject, &Protocol::CORRELATION)?);
        let other = summarise(&judge_all(bench, subject, &in_space)?);
        Ok(Row {
            in_space: other.confidence,
            oracle_in_space: other.oracle,
            ..row
        })
    })?;

    let mut numbers = Table::new(
        "",
        &[
            "class",
            "object",
            "estimates",
            "ADD at 10 %",
            "ADD at 50 %",
            "ADD at 90 %",
            "rho of confidence",
            "rho of exact distance",
            "rho of inlier share",
            "rho of reprojection error",
            "rho of confidence, other solver",
            "rho of exact distance, other solver",
        ],
    );
    for (subject, row) in &rows {
        let mut cells = vec![
            subject.class.clone(),
            subject.name.clone(),
            row.estimates.to_string(),
        ];
        cells.extend(row.add.map(|add| format!("{add:.5}")));
        cells.extend(COLUMNS.map(|(_, _, rho)| format!("{:.4}", rho(row))));
        numbers.push(cells);
    }

    let measured: Vec<_> = rows.iter().map(|(subject, _)| *subject).collect();
    let classes = classes(&measured);
    let mut table = Table::new(
        "Spearman's ρ with ADD, mean over the objects of a class; of the reprojection error, that of its \
         negative.",
        &[
            "class",
            "objects",
            "the paper prints",
            "COBRA",
            "exact distance",
            "difference",
            "inlier share",
            "reprojection error",
            "other solver: COBRA",
            "exact distance",
        ],
    );
    let mut items = Vec::new();
    let mut by_class: Vec<ClassMeans> = Vec::new();
    for (index, class) in classes.iter().enumerate() {
        let of: Vec<&Row> = rows
            .iter()
            .filter(|(subject, _)| subject.class == *class)
            .map(|(_, row)| row)
            .collect();
        let means = COLUMNS.map(|(_, _, rho)| mean(of.iter().map(|row| rho(row))));
        let printed = paper::correlation_of(class);
        let difference = means[0] - means[1];
        by_class.push(((*class).to_owned(), printed, means));
        table.push(vec![
            (*class).to_owned(),
            of.len().to_string(),
            printed.map_or_else(|| "–".to_owned(), |rho| format!("{rho:.2}")),
            format!("{:.3}", means[0]),
            format!("{:.3}", means[1]),
            format!("{difference:+.3}"),
            format!("{:.3}", means[2]),
            format!("{:.3}", means[3]),
            format!("{:.3}", means[4]),
            format!("{:.3}", means[5]),
        ]);
        let place = Axis::place(index, classes.len());
        if let Some(rho) = printed {
            items.push(Item::Series(PRINTED, vec![(rho, place)]));
        }
        for (column, ((_, look, _), rho)) in COLUMNS.iter().zip(means).enumerate() {
            // COBRA and the exact distance would hide each other.
            let aside = if column % 2 == 0 { 0.14 } else { -0.14 };
            items.push(Item::Series(*look, vec![(rho, place + aside)]));
        }
    }

    let measured = rows
        .iter()
        .flat_map(|(_, row)| COLUMNS.map(|(_, _, rho)| rho(row)));
    let printed = classes
        .iter()
        .filter_map(|class| paper::correlation_of(class));
    let all: Vec<f64> = measured.chain(printed).collect();
    let all = all.into_iter();
    let mut legend: Vec<(Look, String)> = COLUMNS
        .iter()
        .map(|(name, look, _)| (*look, (*name).to_owned()))
        .collect();
    legend.push((PRINTED, "the paper's Table 2".to_owned()));
    let figure = Page {
        title: "Confidence against ADD: Spearman's ρ",
        subtitle: "mean over the objects of a class; the farther left the better",
        legend: &legend,
        columns: 1,
        panel: (820, 300),
    }
    .svg(&[Panel {
        heading: String::new(),
        across: Axis::steps("ρ", all, 0.1, (-1.0, 1.0)),
        up: Axis::names("", &classes),
        room: 120,
        items,
    }])?;
    Ok(Findings {
        experiment: Experiment::Correlation,
        title: "Table 2: confidence and error",
        protocol: protocol(),
        elsewhere: String::new(),
        numbers,
        tables: vec![table],
        remarks: remarks(&by_class),
        figure,
        seconds,
    })
}

/// A class: its name, what the paper prints for it, and the means of [`COLUMNS`].
type ClassMeans = (String, Option<f64>, [f64; COLUMNS.len()]);

/// What follows for ρ.
fn remarks(classes: &[ClassMeans]) -> Vec<String> {
    let farthest = |a: usize, b: usize| {
        let apart = classes
            .iter()
            .map(|(.., means)| (means[a] - means[b]).abs());
        apart.fold(0.0, f64::max)
    };
    let ends = |column: usize| {
        let of = || classes.iter().map(|(.., means)| means[column]);
        let (low, high) = (
            of().fold(f64::INFINITY, f64::min),
            of().fold(f64::NEG_INFINITY, f64::max),
        );
        format!("{low:.2} to {high:.2}")
    };
    let named = |wanted: &dyn Fn(&ClassMeans) -> bool| {
        let names: Vec<&str> = classes
            .iter()
            .filter(|class| wanted(class))
            .map(|(name, ..)| name.as_str())
            .collect();
        names.join(", ")
    };
    let mut remarks = Vec::new();
    let same = farthest(0, 1);
    if same.is_finite() {
        remarks.push(format!(
            "The template's ρ and the exact distance's differ by at most {same:.3} in any class{}.",
            if same <= 0.02 {
                ": with poses of this solver a better template would not have a better ρ"
            } else {
                ""
            }
        ));
    }
    let below =
        named(&|(_, printed, means)| printed.is_some_and(|rho| means[0] > rho && means[1] > rho));
    if !below.is_empty() {
        remarks.push(format!(
            "What the paper prints is not reached, neither by the template nor by the exact distance: {below}."
        ));
    }
    let between = classes
        .iter()
        .all(|(_, printed, means)| printed.is_some_and(|rho| means[4] <= rho && rho <= means[0]));
    remarks.push(format!(
        "\"Other solver\": the same points, pixels and noise, but poses of the least distances in space (SQPnP \
         alone), which noise draws to the camera: ρ is {} there, that of the exact distance {}. The paper does \
         not name its solver{}.",
        ends(4),
        ends(5),
        if between {
            "; what it prints lies between the two"
        } else {
            ""
        }
    ));
    let better = named(&|(.., means)| means[3] <= means[0]);
    remarks.push(format!(
        "Inlier share and reprojection error are what an estimator knows of its pose without any template. {} It \
         is what the solver made least; an estimator that does not solve for its poses has none.",
        if better.is_empty() {
            "The reprojection error ranks worse than the template in every class.".to_owned()
        } else {
            format!(
                "The reprojection error ranks as well as the template or better in: {better}."
            )
        }
    ));
    remarks
}

/// What the paper prints.
const PRINTED: Look = Look::marks(Colour::Vermilion, Mark::Stroke);

/// What was simulated, for whoever reads the numbers.
pub(super) fn protocol() -> String {
    let Protocol {
        points,
        turns,
        tilts,
        distances,
        inlier_noise,
        noise,
        ..
    } = Protocol::CORRELATION;
    let listed = |numbers: &[f64]| {
        let numbers: Vec<String> = numbers.iter().map(f64::to_string).collect();
        numbers.join(", ")
    };
    format!(
        "As the supplement describes it: {points} surface points, projected by a camera of f = 600 pixels \
         through every pose of a grid of Euler angles (φ {}°, θ {}°) and distances \
         ({} radii); normal noise of {inlier_noise} pixel on inliers; outliers of a share of 0.1, \
         0.2, 0.3, 0.4 or 0.5, each with normal noise of 12, 24, 36, 48 or 60 pixels, and none: {} estimates \
         an object, whose poses have the least reprojection error (SQPnP, refined by Levenberg-Marquardt). The \
         supplement does not print its grid. ADD is over 2,000 points. Confidence: \
         default template, σ_m = {NOISE} radii; the exact distance is scored with the same σ_m. An inlier's \
         reprojection error is below {INLIER} pixels.",
        listed(turns),
        listed(tilts),
        listed(distances),
        turns.len() * tilts.len() * distances.len() * noise.len(),
    )
}

fn summarise(judged: &[Judged]) -> Row {
    let mut add: Vec<f64> = judged.iter().map(|j| j.add).collect();
    let rho = |value: fn(&Judged) -> f64| {
        let values: Vec<f64> = judged.iter().map(value).collect();
        rank_correlation(&values, &add)
    };
    let [confidence, oracle, inliers, reprojection] = [
        rho(|j| j.confidence),
        rho(|j| j.oracle),
        rho(|j| j.inliers),
        rho(|j| -j.reprojection),
    ];
    add.sort_by(f64::total_cmp);
    let quantile = |percent: usize| add.get(percent * add.len() / 100).copied().unwrap_or(0.0);
    Row {
        in_space: None,
        oracle_in_space: None,
        estimates: judged.len(),
        add: [10, 50, 90].map(quantile),
        confidence,
        oracle,
        inliers,
        reprojection,
    }
}
