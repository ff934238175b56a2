//! Adam against L-BFGS-B, and how many points hyperparameters are learned on.

use super::Experiment;
use super::bench::{Bench, Order};
use super::error::ExperimentError;
use super::findings::Findings;
use super::shape::{COMPONENTS, SIGMA_POINTS};
use super::subject::Subject;
use super::table::{Table, mean};
use super::templates::NAME;
use crate::evaluate::evaluate;
use crate::gp::{
    AdamOptions, Coordinates, FittedGp, NOISE_FLOOR, Optimiser, Subset,
    negative_log_marginal_likelihood,
};
use crate::plot::{Axis, Colour, Item, Look, Mark, Page, Panel};
use crate::progress::Stopwatch;
use crate::random::Purpose;
use crate::surface::RayCaster;
use crate::train::{FITTING, TrainOptions, train};
use cobra_infer::{Assignment, Exponent, Kernel, Template};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

const POINTS: usize = 30_000;

const ADAM: Optimiser = Optimiser::Adam(AdamOptions::paper());

/// What is compared: an optimiser, and how many points of a component it sees.
const SETTINGS: [(Optimiser, Subset); 9] = [
    (Optimiser::Lbfgs, Subset::Points(50)),
    (Optimiser::Lbfgs, Subset::Points(100)),
    (Optimiser::Lbfgs, Subset::Points(200)),
    (Optimiser::Lbfgs, Subset::Points(300)),
    (Optimiser::Lbfgs, Subset::All),
    (ADAM, Subset::Points(100)),
    (ADAM, Subset::Points(200)),
    (ADAM, Subset::Points(300)),
    (ADAM, Subset::All),
];

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Row {
    /// The mean of L/n over components, on all of their points whatever was learned on.
    likelihood: Option<f64>,
    chamfer: f64,
    f_score: f64,
    seconds: f64,
    iterations: f64,
}

pub(super) fn run(bench: &Bench<'_>) -> Result<Findings, ExperimentError> {
    let shown = bench.shown(Experiment::Learning)?;
    let journal = bench.journal(Experiment::Learning)?;
    let rows = bench.rows(
        &journal,
        "learning",
        &SETTINGS,
        Order::Single,
        |setting| format!("{} {}", shown.key(), name(setting)),
        |setting| measure(bench, shown, setting),
    )?;
    let mut numbers = Table::new(
        "",
        &[
            "optimiser",
            "points of a component",
            "L/n on all points",
            "F %",
            "chamfer x1000",
            "seconds",
            "iterations",
        ],
    );
    let (mut by_likelihood, mut by_f) = (Vec::new(), Vec::new());
    for (index, row) in &rows {
        let (optimiser, subset) = SETTINGS[*index];
        numbers.push(vec![
            optimiser_name(&optimiser).to_owned(),
            subset_name(subset),
            row.likelihood
                .map_or_else(|| "–".to_owned(), |l| format!("{l:.4}")),
            format!("{:.2}", row.f_score),
            format!("{:.4}", row.chamfer),
            format!("{:.2}", row.seconds),
            format!("{:.0}", row.iterations),
        ]);
        let look = if optimiser == ADAM { PAPERS } else { OURS };
        for (items, value) in [
            (&mut by_likelihood, row.likelihood.unwrap_or(f64::NAN)),
            (&mut by_f, row.f_score),
        ] {
            let at = (row.seconds, value);
            items.push(Item::Series(look, vec![at]));
            items.push(Item::Words(at, subset_name(subset)));
        }
    }
    let times = || rows.iter().map(|(_, row)| row.seconds);
    let likelihoods = rows.iter().filter_map(|(_, row)| row.likelihood);
    let scores = rows.iter().map(|(_, row)| row.f_score);
    let panel = |heading: &str, up, items| Panel {
        heading: heading.to_owned(),
        across: Axis::around("seconds of learning and fitting", times()),
        up,
        room: 76,
        items,
    };
    let figure = Page {
        title: "Adam against L-BFGS-B",
        subtitle: &format!(
            "{}, {COMPONENTS} k-means components; beside the marks: points of a component that it learns on",
            shown.name
        ),
        legend: &[
            (OURS, "L-BFGS-B".to_owned()),
            (PAPERS, "Adam".to_owned()),
        ],
        columns: 2,
        panel: (500, 380),
    }
    .svg(&[
        panel("Likelihood", Axis::steps("L/n on all points (less is better)", likelihoods, 0.1, (-20.0, 20.0)), by_likelihood),
        panel("F-score", Axis::steps("F, % (more is better)", scores, 0.5, (0.0, 100.0)), by_f),
    ])?;
    let mut table = numbers.clone();
    table.caption =
        "L/n is the negative log marginal likelihood per point, of all points of a component \
                     whatever was learned on, mean over components."
            .to_owned();
    Ok(Findings {
        experiment: Experiment::Learning,
        title: "Learning",
        protocol: format!(
            "`{}`, {COMPONENTS} k-means components, the same for all; rational quadratic, α = ½, on the chord, \
             average prior mean, noise variance at least 1e-5 for both optimisers. L-BFGS-B: at most 60 \
             iterations. Adam: rate 0.1, times 0.1 after 10 iterations without improvement, 250 iterations, from \
             L-BFGS-B's start. \
             Weights are always those of all points. Seconds are of all components on this machine's cores.",
            shown.name
        ),
        elsewhere: String::new(),
        numbers,
        tables: vec![table],
        remarks: remarks(&rows),
        figure,
        seconds: journal.seconds(),
    })
}

const OURS: Look = Look::marks(Colour::Teal, Mark::Disc);
const PAPERS: Look = Look::marks(Colour::Vermilion, Mark::Triangle);

/// What the two reach on all points, and what a subset loses.
fn remarks(rows: &[(usize, Row)]) -> Vec<String> {
    let of = |optimiser: Optimiser, subset: Subset| {
        let wanted = (optimiser, subset);
        let found = rows.iter().find(|(index, _)| SETTINGS[*index] == wanted);
        found.map(|(_, row)| row)
    };
    let all = [Optimiser::Lbfgs, ADAM].map(|optimiser| of(optimiser, Subset::All));
    let mut remarks = Vec::new();
    if let [Some(lbfgs), Some(adam)] = all
        && let [Some(ours), Some(its)] = [lbfgs, adam].map(|row| row.likelihood)
    {
        remarks.push(format!(
            "On all points of a component L-BFGS-B reaches an L/n of {ours:.3} in {:.1} s, Adam {its:.3} in {:.1} s, \
             {:.1} times the time; F {:.2} and {:.2}. The paper had better results with Adam than with L-BFGS: {}.",
            lbfgs.seconds,
            adam.seconds,
            adam.seconds / lbfgs.seconds,
            lbfgs.f_score,
            adam.f_score,
            match (adam.f_score > lbfgs.f_score, its < ours) {
                (true, true) => "so it is here",
                (true, false) => "here its F is higher, though not by a better likelihood",
                (false, true) => "here its likelihood is better, its F is not",
                (false, false) => "not so here",
            }
        ));
    }
    for (name, optimiser, count) in [
        ("L-BFGS-B, this project's default", Optimiser::Lbfgs, 300),
        ("Adam, as for Table 1", ADAM, super::shape::ADAM_POINTS),
    ] {
        let few = of(optimiser, Subset::Points(count));
        if let (Some(few), Some(all)) = (few, of(optimiser, Subset::All)) {
            remarks.push(format!(
                "{name}: {count} points of a component instead of all change F by {:+.2}.",
                few.f_score - all.f_score
            ));
        }
    }
    remarks
}

fn optimiser_name(optimiser: &Optimiser) -> &'static str {
    match optimiser {
        Optimiser::Lbfgs => "L-BFGS-B",
        Optimiser::Adam(_) => "Adam",
    }
}

fn subset_name(subset: Subset) -> String {
    match subset {
        Subset::Points(count) => count.to_string(),
        Subset::All => "all".to_owned(),
    }
}

fn name((optimiser, subset): &(Optimiser, Subset)) -> String {
    format!("{} {}", optimiser_name(optimiser), subset_name(*subset))
}

fn measure(
    bench: &Bench<'_>,
    subject: &Subject,
    (optimiser, subset): &(Optimiser, Subset),
) -> Result<Row, ExperimentError> {
    let mesh = subject.mesh()?;
    let caster = RayCaster::new(&mesh);
    let points = subject.sample(&mesh, &caster, POINTS, bench.seed, Purpose::Evaluation)?;
    let mut options = TrainOptions::clustered(NAME, COMPONENTS);
    options.seed = bench.seed;
    options.test_points = SIGMA_POINTS;
    options.fit.model.kernel = Kernel::RationalQuadratic(Exponent::Half);
    options.fit.optimiser = *optimiser;
    options.fit.subset = *subset;
    options.fit.noise_floor = NOISE_FLOOR;
    let watch = Stopwatch::new(FITTING);
    let trained =
        train(&mesh.clone().into(), &options, &watch).map_err(|source| ExperimentError::Train {
            object: subject.name.clone(),
            source,
        })?;
    let shape = evaluate(
        &Template::from_bytes(&trained.bytes)?,
        Assignment::Nearest,
        &points,
    )?
    .shape;
    // Of all components or of none: means over different ones would not compare.
    let likelihoods: Option<Vec<f64>> = trained
        .components
        .par_iter()
        .map(|component| likelihood(&component.fitted))
        .collect();
    let iterations = trained
        .components
        .iter()
        .map(|c| c.fitted.learned.iterations as f64);
    Ok(Row {
        likelihood: likelihoods.map(mean),
        chamfer: shape.chamfer,
        f_score: shape.f_score,
        seconds: watch.total().as_secs_f64(),
        iterations: mean(iterations),
    })
}

/// L/n of all points of a component.
fn likelihood(fitted: &FittedGp) -> Option<f64> {
    let points = Coordinates::new(fitted.model.metric, &fitted.directions);
    let found = negative_log_marginal_likelihood(
        fitted.model.kernel,
        &fitted.learned.hyperparameters,
        &points,
        &fitted.targets,
    );
    Some(found.ok()?.value / fitted.targets.len() as f64)
}
