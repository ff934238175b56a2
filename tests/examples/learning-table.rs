//! Prints the optimiser table of `docs/LEARNING.md` as markdown, a line as soon as it is measured.
//!
//! `cargo run --release -p cobra-tests --example learning-table -- PATH_TO_MESH`. Takes some
//! eight minutes on two cores, most of them in the last lines.

use cobra_infer::{Assignment, Exponent, Kernel, Metric, Model, Template};
use cobra_train::evaluate::{evaluate, evaluation_points};
use cobra_train::gp::{AdamOptions, NOISE_FLOOR, Optimiser, PAPER_NOISE_FLOOR, PriorMean, Subset};
use cobra_train::progress::Stopwatch;
use cobra_train::surface::{Geometry, read_mesh};
use cobra_train::train::{FITTING, TrainOptions, train};
use nalgebra::Point3;
use std::error::Error;
use std::path::PathBuf;

/// As many as `cobra eval` measures on.
const POINTS: usize = 30_000;

/// The slow ones last.
const OPTIMISERS: [(&str, Optimiser); 2] = [
    ("lbfgs", Optimiser::Lbfgs),
    ("adam", Optimiser::Adam(AdamOptions::paper())),
];
const EXPONENTS: [(&str, Exponent); 2] = [("1", Exponent::One), ("free", Exponent::Free)];
const METRICS: [(&str, Metric); 2] = [("chord", Metric::Chord), ("angles", Metric::Angles)];
const PRIOR_MEANS: [(&str, PriorMean); 2] =
    [("average", PriorMean::Average), ("zero", PriorMean::Zero)];

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args_os().nth(1).map(PathBuf::from);
    let path = path.ok_or("usage: learning-table PATH_TO_MESH")?;
    let mesh = read_mesh(&path)?;
    let object = Geometry::from(mesh);
    let points = evaluation_points(&object, POINTS, 0)?;
    println!(
        "| optimiser | prior mean | metric | exponent | F | chamfer | rms | s | L/n | iterations \
         | early |\n|---|---|---|---|---|---|---|---|---|---|---|"
    );
    for (optimiser_name, optimiser) in OPTIMISERS {
        for (exponent_name, exponent) in EXPONENTS {
            for (metric_name, metric) in METRICS {
                for (prior_mean_name, prior_mean) in PRIOR_MEANS {
                    let mut options = TrainOptions::clustered("table", 16);
                    options.fit.model = Model {
                        metric,
                        kernel: Kernel::RationalQuadratic(exponent),
                    };
                    options.fit.prior_mean = prior_mean;
                    options.fit.optimiser = optimiser;
                    if let Optimiser::Adam(_) = optimiser {
                        options.fit.subset = Subset::All;
                        options.fit.noise_floor = PAPER_NOISE_FLOOR;
                    } else {
                        options.fit.noise_floor = NOISE_FLOOR;
                    }
                    let figures = measure(&object, &options, &points)?;
                    println!(
                        "| {optimiser_name} | {prior_mean_name} | {metric_name} | {exponent_name} \
                         | {figures} |"
                    );
                }
            }
        }
    }
    Ok(())
}

/// The cells that are measured.
fn measure(
    object: &Geometry,
    options: &TrainOptions,
    points: &[Point3<f64>],
) -> Result<String, Box<dyn Error>> {
    let watch = Stopwatch::new(FITTING);
    let trained = train(object, options, &watch)?;
    let found = evaluate(
        &Template::from_bytes(&trained.bytes)?,
        Assignment::Nearest,
        points,
    )?;
    let searches = trained.components.iter().map(|c| c.fitted.learned);
    let mean = |sum: f64| sum / trained.components.len() as f64;
    Ok(format!(
        "{:.2} | {:.4} | {:.2} | {:.1} | {:.3} | {:.0} | {}",
        found.shape.f_score,
        found.shape.chamfer,
        found.residual.rms,
        watch.total().as_secs_f64(),
        mean(searches.clone().map(|l| l.likelihood_per_point).sum()),
        mean(searches.clone().map(|l| l.iterations as f64).sum()),
        searches.filter(|l| l.stop.is_early()).count(),
    ))
}
