//! The ablation of the number of reference points.

use super::Experiment;
use super::bench::Bench;
use super::error::ExperimentError;
use super::findings::Findings;
use super::shape::{SIGMA_POINTS, assignment};
use super::subject::{Subject, classes};
use super::table::{Table, mean};
use super::templates::{NAME, trained};
use crate::digits::grouped;
use crate::evaluate::evaluate;
use crate::plot::{Axis, Colour, Item, Look, Mark, Page, Panel};
use crate::random::Purpose;
use crate::surface::RayCaster;
use crate::train::{ReferencePoints, TrainOptions};
use cobra_infer::{Exponent, Kernel, Template};
use serde::{Deserialize, Serialize};

/// How many reference points there are, or at most.
const COUNTS: [usize; 5] = [4, 8, 16, 32, 64];

/// The classes of the paper's figure, and how many objects of each.
const CLASSES: [&str; 3] = ["planes", "chairs", "sofas"];
const MODELS: usize = 3;

const POINTS: usize = 30_000;

/// A way to place reference points.
type Placement = (&'static str, Look, fn(usize) -> TrainOptions);

const PLACEMENTS: [Placement; 3] = [
    (
        "k-means",
        Look::joined(Colour::Ochre, Mark::Triangle),
        |count| clustered(ReferencePoints::KMeans { components: count }),
    ),
    ("EM", Look::joined(Colour::Violet, Mark::Square), |count| {
        clustered(ReferencePoints::Em { components: count })
    }),
    (
        "automatic",
        Look::joined(Colour::Teal, Mark::Disc),
        |count| TrainOptions {
            reference_points: ReferencePoints::Auto { most: count },
            budget: None,
            ..TrainOptions::new(NAME)
        },
    ),
];

fn clustered(reference_points: ReferencePoints) -> TrainOptions {
    let mut options = TrainOptions::clustered(NAME, 1);
    options.fit.model.kernel = Kernel::RationalQuadratic(Exponent::Half);
    options.reference_points = reference_points;
    options
}

#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
struct Measured {
    /// Components in the template.
    components: usize,
    chamfer: f64,
    f_score: f64,
}

/// Of each placement, of each count.
type Row = [[Measured; COUNTS.len()]; PLACEMENTS.len()];

pub(super) fn run(bench: &Bench<'_>) -> Result<Findings, ExperimentError> {
    let subjects = bench.data.of_classes(&CLASSES, MODELS);
    let (rows, seconds) = bench.of_subjects(Experiment::ReferencePoints, &subjects, |subject| {
        measure(bench, subject)
    })?;
    let mut numbers = Table::new(
        "",
        &[
            "class",
            "object",
            "placement",
            "asked for",
            "components",
            "chamfer x1000",
            "F %",
        ],
    );
    for (subject, row) in &rows {
        for ((name, ..), counts) in PLACEMENTS.iter().zip(row) {
            for (count, found) in COUNTS.iter().zip(counts) {
                numbers.push(vec![
                    subject.class.clone(),
                    subject.name.clone(),
                    (*name).to_owned(),
                    count.to_string(),
                    found.components.to_string(),
                    format!("{:.4}", found.chamfer),
                    format!("{:.2}", found.f_score),
                ]);
            }
        }
    }
    let measured: Vec<&Subject> = rows.iter().map(|(subject, _)| *subject).collect();
    let mut header = vec!["class".to_owned(), "placement".to_owned()];
    header.extend(COUNTS.iter().map(|count| format!("{count}")));
    let mut table = Table {
        caption: "d_C × 10³ over the number of reference points, mean over the objects of a class; of the \
                  automatic ones the most, with the mean number that there are."
            .to_owned(),
        header,
        rows: Vec::new(),
        text: 2,
    };
    let mut panels = Vec::new();
    let mut remarks = Vec::new();
    for class in classes(&measured) {
        let mut items = Vec::new();
        let mut lines = Vec::new();
        for (placement, (name, look, _)) in PLACEMENTS.iter().enumerate() {
            let mut cells = vec![class.to_owned(), (*name).to_owned()];
            let mut line = Vec::new();
            for (index, &count) in COUNTS.iter().enumerate() {
                let of: Vec<Measured> = rows
                    .iter()
                    .filter(|(subject, _)| subject.class == class)
                    .map(|(_, row)| row[placement][index])
                    .collect();
                let chamfer = mean(of.iter().map(|found| found.chamfer));
                let components = mean(of.iter().map(|found| found.components as f64));
                line.push((components, chamfer));
                cells.push(if (components - count as f64).abs() < 0.5 {
                    format!("{chamfer:.3}")
                } else {
                    format!("{chamfer:.3} ({components:.0})")
                });
            }
            table.push(cells);
            items.push(Item::Series(*look, line.clone()));
            lines.push((*name, line));
        }
        remarks.extend(remarks_of(class, &lines));
        let chamfers = rows
            .iter()
            .flat_map(|(_, row)| row.iter().flatten().map(|found| found.chamfer));
        panels.push(Panel {
            heading: class.to_owned(),
            across: Axis::logarithmic("reference points", &COUNTS.map(|count| count as f64), 0.04),
            up: Axis::around("d_C × 10³", chamfers),
            room: 76,
            items,
        });
    }
    let legend: Vec<(Look, String)> = PLACEMENTS
        .iter()
        .map(|(name, look, _)| (*look, (*name).to_owned()))
        .collect();
    let figure = Page {
        title: "The number of reference points",
        subtitle: "Chamfer distance, mean over the objects of a class; less is better",
        legend: &legend,
        columns: 3,
        panel: (400, 380),
    }
    .svg(&panels)?;
    Ok(Findings {
        experiment: Experiment::ReferencePoints,
        title: "Reference points",
        protocol: format!(
            "Rational quadratic, α = ½, on the chord, exact; {points} fresh test points; at most {MODELS} objects \
             of a class. k-means' and EM's components speak everywhere, the nearest for a point; automatic ones \
             where they are verified, and what none may speak for is missing in what is compared.",
            points = grouped(POINTS as u64)
        ),
        elsewhere: String::new(),
        numbers,
        tables: vec![table],
        remarks,
        figure,
        seconds,
    })
}

/// Where more reference points do harm, and from how many on the automatic ones are the best.
fn remarks_of(class: &str, lines: &[(&str, Vec<(f64, f64)>)]) -> Vec<String> {
    let mut remarks = Vec::new();
    let [clustered @ .., (_, automatic)] = lines else {
        return remarks;
    };
    for (name, line) in clustered {
        let best = line.iter().min_by(|a, b| a.1.total_cmp(&b.1));
        if let (Some(best), Some(last)) = (best, line.last())
            && last.1 > 1.1 * best.1
        {
            remarks.push(format!(
                "{class}: {name} is best with {:.0} reference points ({:.3}) and worse again with {:.0} ({:.3}): the \
                 cutoff that the paper speaks of.",
                best.0, best.1, last.0, last.1
            ));
        }
    }
    if remarks.is_empty() {
        remarks.push(format!(
            "{class}: up to {} reference points neither k-means nor EM shows the cutoff that the paper speaks of.",
            COUNTS[COUNTS.len() - 1]
        ));
    }
    let least = |index: usize| {
        clustered
            .iter()
            .map(|(_, line)| line[index].1)
            .fold(f64::INFINITY, f64::min)
    };
    let first = (0..COUNTS.len())
        .rev()
        .take_while(|&index| automatic[index].1 < least(index))
        .last();
    if let Some(first) = first {
        let last = COUNTS.len() - 1;
        remarks.push(format!(
            "{class}: automatic placement has the least d_C from {} on, in the end {:.1} times less than the \
             better of the others.",
            COUNTS[first],
            least(last) / automatic[last].1
        ));
    }
    remarks
}

fn measure(bench: &Bench<'_>, subject: &Subject) -> Result<Row, ExperimentError> {
    let mesh = subject.mesh()?;
    let caster = RayCaster::new(&mesh);
    let points = subject.sample(&mesh, &caster, POINTS, bench.seed, Purpose::Evaluation)?;
    let of_count = |options: fn(usize) -> TrainOptions, count: usize| {
        let options = TrainOptions {
            seed: bench.seed,
            test_points: SIGMA_POINTS,
            ..options(count)
        };
        let bytes = trained(subject, &mesh, &options)?;
        let template = Template::from_bytes(&bytes)?;
        let shape = evaluate(&template, assignment(&template), &points)?.shape;
        Ok::<_, ExperimentError>(Measured {
            components: template.component_count(),
            chamfer: shape.chamfer,
            f_score: shape.f_score,
        })
    };
    let mut row = Row::default();
    for (found, (_, _, options)) in row.iter_mut().zip(PLACEMENTS) {
        for (found, count) in found.iter_mut().zip(COUNTS) {
            *found = of_count(options, count)?;
        }
    }
    Ok(row)
}
