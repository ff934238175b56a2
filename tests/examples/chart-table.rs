//! Trains templates with the command's defaults, some seeds each, and prints the tables of
//! `docs/CHARTS.md`: how well they reproduce the objects, how much they wrongly accept, and what is
//! left uncovered where.
//!
//! `cargo run --release -p cobra-tests --example chart-table -- [--seeds N] [--budget BYTES|none]...
//! [--exponent 1|0.5] FILE|FOLDER...`; a row an object and budget, the mean over the seeds.

use cobra_infer::{Exponent, Kernel, Settings, Template};
use cobra_tests::data::files_below;
use cobra_train::evaluate::{
    TrueSurface, evaluate, evaluation_points, own_cloud, wrongly_accepted,
};
use cobra_train::progress::Silent;
use cobra_train::surface::{Geometry, read_geometry};
use cobra_train::train::{BUDGET, TrainOptions, train};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::Instant;

const FORMATS: [&str; 6] = ["glb", "obj", "off", "ply", "stl", "xyz"];

/// Points that a template is measured on.
const POINTS: usize = 30_000;

/// A coverage that is shown with where the rest lies.
const COVERED: f64 = 99.0;

struct Arguments {
    seeds: u64,
    budgets: Vec<Option<usize>>,
    exponent: Exponent,
    files: Vec<PathBuf>,
}

/// Of one template, or means over several.
#[derive(Clone, Copy, Default)]
struct Figures {
    components: f64,
    bytes: f64,
    f_score: f64,
    covered: f64,
    wrongly_accepted: f64,
    self_f_score: f64,
    deviation_rms: f64,
    seconds: f64,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = arguments()?;
    for budget in &arguments.budgets {
        let name = budget.map_or("exact".to_owned(), |bytes| format!("{bytes} bytes"));
        println!("\n{name}, {} seeds\n", arguments.seeds);
        println!(
            "| object | K | bytes | F % | covered % | wrongly accepted % | self F % | deviation, rms σ̂ | s |"
        );
        println!("|---|--:|--:|--:|--:|--:|--:|--:|--:|");
        let mut all = Vec::new();
        let mut open = Vec::new();
        for path in &arguments.files {
            let object = path.file_stem().unwrap_or_default().to_string_lossy();
            match row(path, *budget, &arguments, &mut open) {
                Ok(figures) => {
                    println!("| `{object}` {}", text(&figures));
                    all.push(figures);
                }
                Err(error) => println!("| `{object}` | refused: {error} | | | | | | | |"),
            }
        }
        println!("| **mean** {}", text(&mean(&all)));
        let least = all.iter().map(|f| f.f_score).fold(f64::INFINITY, f64::min);
        let well = all.iter().filter(|f| f.covered >= COVERED).count();
        println!(
            "\nLeast F {least:.2}; {well} of {} objects covered to {COVERED} %.",
            all.len()
        );
        for line in open {
            println!("{line}");
        }
    }
    Ok(())
}

fn row(
    path: &Path,
    budget: Option<usize>,
    arguments: &Arguments,
    open: &mut Vec<String>,
) -> Result<Figures, Box<dyn Error>> {
    let object = read_geometry(path)?.geometry;
    let mut found = Vec::new();
    for seed in 0..arguments.seeds {
        let (figures, regions) = measure(&object, budget, arguments.exponent, seed)?;
        if figures.covered < COVERED {
            let name = path.file_stem().unwrap_or_default().to_string_lossy();
            open.push(format!("- `{name}`, seed {seed}: {regions}"));
        }
        found.push(figures);
    }
    Ok(mean(&found))
}

fn measure(
    object: &Geometry,
    budget: Option<usize>,
    exponent: Exponent,
    seed: u64,
) -> Result<(Figures, String), Box<dyn Error>> {
    let mut options = TrainOptions::new("object");
    options.fit.model.kernel = Kernel::RationalQuadratic(exponent);
    options.budget = budget;
    options.seed = seed;
    let start = Instant::now();
    let trained = train(object, &options, &Silent)?;
    let seconds = start.elapsed().as_secs_f64();
    let template = Template::from_bytes(&trained.bytes)?;
    let points = evaluation_points(object, POINTS, seed)?;
    let assignment = Settings::for_template(&template, 1.0).assignment;
    let evaluation = evaluate(&template, assignment, &points)?;
    let surface = TrueSurface::new(object);
    let wrongly = wrongly_accepted(&template, assignment, &surface, &points, seed)?;
    let own = own_cloud(&template, &surface, &points).ok_or("components speak everywhere")?;
    let regions: Vec<String> = trained
        .uncovered
        .iter()
        .take(3)
        .map(|region| {
            let [x, y, z]: [f64; 3] = region.centre.into();
            format!(
                "{:.1} % within {:.2} of ({x:.2}, {y:.2}, {z:.2})",
                100.0 * region.share,
                region.reach
            )
        })
        .collect();
    let figures = Figures {
        components: template.component_count() as f64,
        bytes: trained.bytes.len() as f64,
        f_score: evaluation.shape.f_score,
        covered: evaluation.covered,
        wrongly_accepted: wrongly.percent,
        self_f_score: own.self_f_score,
        deviation_rms: trained.deviation.map_or(0.0, |deviation| deviation.rms),
        seconds,
    };
    Ok((figures, regions.join(", ")))
}

fn mean(all: &[Figures]) -> Figures {
    let of = |pick: fn(&Figures) -> f64| all.iter().map(pick).sum::<f64>() / all.len() as f64;
    Figures {
        components: of(|f| f.components),
        bytes: of(|f| f.bytes),
        f_score: of(|f| f.f_score),
        covered: of(|f| f.covered),
        wrongly_accepted: of(|f| f.wrongly_accepted),
        self_f_score: of(|f| f.self_f_score),
        deviation_rms: of(|f| f.deviation_rms),
        seconds: of(|f| f.seconds),
    }
}

fn text(figures: &Figures) -> String {
    format!(
        "| {:.0} | {:.0} | {:.2} | {:.2} | {:.2} | {:.2} | {:.2} | {:.1} |",
        figures.components,
        figures.bytes,
        figures.f_score,
        figures.covered,
        figures.wrongly_accepted,
        figures.self_f_score,
        figures.deviation_rms,
        figures.seconds
    )
}

fn arguments() -> Result<Arguments, Box<dyn Error>> {
    let mut found = Arguments {
        seeds: 1,
        budgets: Vec::new(),
        exponent: Exponent::Half,
        files: Vec::new(),
    };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("{word} needs a value"));
        match word.as_str() {
            "--seeds" => found.seeds = value()?.parse()?,
            "--budget" => {
                let budget = value()?;
                found.budgets.push(match budget.as_str() {
                    "none" => None,
                    bytes => Some(bytes.parse()?),
                });
            }
            "--exponent" => {
                found.exponent = if value()? == "1" {
                    Exponent::One
                } else {
                    Exponent::Half
                };
            }
            path if Path::new(path).is_dir() => {
                found.files.extend(files_below(Path::new(path), &FORMATS));
            }
            path => found.files.push(PathBuf::from(path)),
        }
    }
    if found.budgets.is_empty() {
        found.budgets.push(Some(BUDGET));
    }
    Ok(found)
}
