//! Scores the estimates of LineMOD-Occlusion and prints the tables of `docs/DEPTH.md`: how well
//! confidences tell right from wrong poses, what a template loses to the exact mesh, what the estimated
//! error is worth, what thresholds found on some objects do on others, and what thresholds found on
//! simulated estimates do on these (`docs/CALIBRATION.md`).
//!
//! `cargo run --release -p cobra-tests --example lmo-table -- --data DIR --templates DIR [--seed N]
//! [--noise-share X]`; DIR is LM-O in BOP's layout with `estimates/`, the templates are those of `cobra bop
//! train`.

use cobra_infer::depth::{DepthReport, DepthSettings, Surface};
use cobra_infer::template::DepthRecord;
use cobra_train::bop::dataset::Dataset;
use cobra_train::bop::results::{Results, read_results};
use cobra_train::bop::score::{
    Checked, DepthSource, Masks, ScoreOptions, Scored, Summary, Surfaces, score_results,
};
use cobra_train::bop::templates::TemplateFolder;
use cobra_train::calibrate::{Aim, Labelled, Rate, Roc, calibrate};
use cobra_train::depth::MeshSurface;
use cobra_train::evaluate::rank_correlation;
use cobra_train::progress::Silent;
use cobra_train::simulation::{Simulation, simulate};
use cobra_train::surface::Geometry;
use std::error::Error;
use std::path::PathBuf;

const ESTIMATORS: [&str; 3] = ["epos", "gdrnpp", "zebrapose"];
const OBJECTS: [u32; 8] = [1, 5, 6, 8, 9, 10, 11, 12];

/// Thresholds are found on the one half of the objects and tried on the other.
const HALVES: [[u32; 4]; 2] = [[1, 5, 6, 8], [9, 10, 11, 12]];

/// Noise on the simulated depth, in mm.
const NOISE: f64 = 1.5;

const AIM: Aim = Aim {
    false_accepts: 0.01,
    rejected_right: 0.01,
};

/// Estimates that `cobra calibrate --simulate` would be asked for.
const SIMULATED: usize = 4000;

/// Of these errors are ADD-S.
const SYMMETRIC: [u32; 2] = [10, 11];

struct Arguments {
    data: PathBuf,
    templates: PathBuf,
    seed: u64,
    noise_share: f32,
}

/// A number of a report that orders estimates, the larger the better.
type Score = fn(&DepthReport) -> f32;

const CONFIDENCE: Score = |report| report.confidence;
const FORWARD: Score = |report| report.forward;
const REVERSE: Score = |report| report.reverse;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = arguments()?;
    let dataset = Dataset::open(&arguments.data, "test")?;
    let (estimates, ends) = estimates(&arguments)?;
    let templates = TemplateFolder::read(&arguments.templates, OBJECTS);
    let mut templates = templates.with_noise_share(arguments.noise_share);
    let meshes = meshes(&dataset, &arguments)?;

    println!(
        "| pixels | surface | score | AUC | {} | rank correlation |",
        ESTIMATORS.join(" | ")
    );
    println!("|---|---|---|--:|--:|--:|--:|--:|");
    let mut errors = Vec::new();
    let mut thresholds = Vec::new();
    let mut simulated = Vec::new();
    for (name, masks) in [
        ("mask", Masks::Simulated),
        ("silhouette", Masks::Silhouette),
    ] {
        let masked = masks == Masks::Simulated;
        let options = options(masks, arguments.seed);
        let scored =
            templates.with_surfaces(|surfaces| run(&dataset, &estimates, surfaces, &options));
        let exact = run(&dataset, &estimates, &meshes, &options);
        for (surface, scored) in [("template", &scored), ("mesh", &exact)] {
            for (score, of) in [
                ("both ways", CONFIDENCE),
                ("forward", FORWARD),
                ("reverse", REVERSE),
            ] {
                line([name, surface, score], scored, &ends, of);
            }
        }
        errors.push(error_line(name, &scored));
        thresholds.extend(threshold_lines(name, &scored)?);
        simulated.extend(templates.with_surfaces(|surfaces| {
            simulated_lines((name, masked), &scored, surfaces, arguments.seed)
        })?);
    }
    println!(
        "\n| pixels | rank correlation of estimated and true error | estimated over true error, median of wrong poses within 0.5 d |"
    );
    println!("|---|--:|--:|");
    errors.iter().for_each(|line| println!("{line}"));
    println!(
        "\n| pixels | found on objects | accept from | accepted of wrong ones there | of right ones | tried on objects | accepted of wrong ones | of right ones |"
    );
    println!("|---|---|--:|--:|--:|---|--:|--:|");
    thresholds.iter().for_each(|line| println!("{line}"));
    println!(
        "\n| pixels | object | accept from | accepted of wrong ones | of right ones |\n|---|--:|--:|--:|--:|"
    );
    simulated.iter().for_each(|line| println!("{line}"));
    own_scores(&arguments, &dataset, &mut templates)
}

/// The rows of all three estimators behind each other, and where each one's end.
fn estimates(arguments: &Arguments) -> Result<(Results, Vec<usize>), Box<dyn Error>> {
    let mut rows = Vec::new();
    let mut ends = Vec::new();
    for name in ESTIMATORS {
        let file = format!("estimates/{name}_lmo-test.csv");
        rows.extend(read_results(&arguments.data.join(file))?.rows);
        ends.push(rows.len());
    }
    Ok((Results { rows }, ends))
}

fn meshes(
    dataset: &Dataset,
    arguments: &Arguments,
) -> Result<Surfaces<MeshSurface>, Box<dyn Error>> {
    let models = dataset.models("models")?;
    let mut meshes = Surfaces::new();
    for object in OBJECTS {
        let Geometry::Mesh(mesh) = models.geometry(object)? else {
            return Err(format!("{}: no mesh", models.path(object).display()).into());
        };
        let settings = DepthSettings::DEFAULT;
        let noise = arguments.noise_share * mesh.diameter() as f32;
        let surface = MeshSurface::new(&mesh, noise, arguments.seed);
        meshes.insert(object, Ok(Checked { surface, settings }));
    }
    Ok(meshes)
}

fn options(masks: Masks, seed: u64) -> ScoreOptions {
    ScoreOptions {
        masks,
        depth: DepthSource::Simulated { noise: NOISE },
        seed,
        pixels: ScoreOptions::PIXELS,
    }
}

fn run<S: Surface + Sync + Send>(
    dataset: &Dataset,
    results: &Results,
    surfaces: &Surfaces<S>,
    options: &ScoreOptions,
) -> Vec<Scored> {
    score_results(dataset, results, surfaces, options, &Silent)
}

/// What is known of a scored row: whether it is right, and its error as a share of the diameter.
fn known(scored: &[Scored], of: Score) -> impl Iterator<Item = (Labelled, f64)> + '_ {
    scored.iter().filter_map(move |row| {
        let outcome = row.outcome.as_ref().ok()?;
        let truth = row.known_truth()?;
        let errors = truth.errors()?;
        let labelled = Labelled {
            confidence: of(&outcome.report),
            right: truth.is_right(),
        };
        Some((labelled, errors.error() / errors.diameter))
    })
}

fn line(names: [&str; 3], scored: &[Scored], ends: &[usize], of: Score) {
    let area = |rows: &[Scored]| {
        let labelled: Vec<Labelled> = known(rows, of).map(|(labelled, _)| labelled).collect();
        Roc::new(&labelled).map_or(f64::NAN, |roc| roc.area)
    };
    let (scores, errors): (Vec<f64>, Vec<f64>) = known(scored, of)
        .map(|(labelled, error)| (f64::from(labelled.confidence), error))
        .unzip();
    let mut start = 0;
    let each: Vec<String> = ends
        .iter()
        .map(|end| {
            let area = area(&scored[start..*end]);
            start = *end;
            format!("{area:.4}")
        })
        .collect();
    println!(
        "| {} | {:.4} | {} | {:.4} |",
        names.join(" | "),
        area(scored),
        each.join(" | "),
        rank_correlation(&scores, &errors).unwrap_or(f64::NAN)
    );
}

fn error_line(name: &str, scored: &[Scored]) -> String {
    let summary = Summary::of(scored);
    format!(
        "| {name} | {:.4} | {:.2} |",
        summary.error_correlation.unwrap_or(f64::NAN),
        summary.error_ratio.unwrap_or(f64::NAN)
    )
}

fn threshold_lines(name: &str, scored: &[Scored]) -> Result<Vec<String>, Box<dyn Error>> {
    let mut lines = Vec::new();
    for (found_on, tried_on) in [(0, 1), (1, 0)] {
        let found = calibrate(&decided(scored, &HALVES[found_on]), AIM)?;
        let others = decided(scored, &HALVES[tried_on]);
        lines.push(format!(
            "| {name} | {} | {:.3} | {} | {:.1} | {} | {} | {:.1} |",
            listed(&HALVES[found_on]),
            found.accept,
            rate(found.false_accepts),
            found.true_accepts,
            listed(&HALVES[tried_on]),
            rate(Rate::of_accepted(&others, found.accept, false)),
            Rate::of_accepted(&others, found.accept, true),
        ));
    }
    Ok(lines)
}

/// What thresholds that were found on simulated estimates of each object do on `scored`, and of all objects
/// together.
fn simulated_lines<S: Surface + Sync>(
    (name, masked): (&str, bool),
    scored: &[Scored],
    surfaces: &Surfaces<S>,
    seed: u64,
) -> Result<Vec<String>, Box<dyn Error>> {
    let mut lines = Vec::new();
    let mut all = [Rate { count: 0, total: 0 }; 2];
    for (object, checked) in surfaces {
        let checked = checked.as_ref().map_err(ToString::to_string)?;
        let simulation = Simulation {
            estimates: SIMULATED,
            noise: NOISE,
            masked,
            symmetric: SYMMETRIC.contains(object),
            seed,
        };
        let found = simulate(&checked.surface, None, &checked.settings, &simulation)?;
        let judged = found
            .iter()
            .filter(|one| one.valid_pixels >= checked.settings.minimum_points);
        let labelled: Vec<Labelled> = judged.map(|one| one.labelled).collect();
        let accept = calibrate(&labelled, AIM)?.accept;
        let own = decided(scored, &[*object]);
        let rates = [false, true].map(|right| Rate::of_accepted(&own, accept, right));
        for (sum, one) in all.iter_mut().zip(rates) {
            sum.count += one.count;
            sum.total += one.total;
        }
        lines.push(simulated_line(
            name,
            &[&object.to_string(), &format!("{accept:.3}")],
            rates,
        ));
    }
    lines.push(simulated_line(name, &["all", ""], all));
    Ok(lines)
}

fn simulated_line(name: &str, words: &[&str; 2], [wrong, right]: [Rate; 2]) -> String {
    let words = words.join(" | ");
    format!("| {name} | {words} | {} | {right:.1} |", rate(wrong))
}

/// The estimates of these objects that a threshold decides.
fn decided(scored: &[Scored], objects: &[u32]) -> Vec<Labelled> {
    let wanted = |row: &&Scored| {
        row.estimate
            .is_some_and(|one| objects.contains(&one.obj_id))
    };
    let of_objects = scored.iter().filter(wanted);
    of_objects.filter_map(Scored::decided).collect()
}

/// A share with Wilson's interval.
fn rate(rate: Rate) -> String {
    format!("{rate} ({})", rate.interval())
}

fn listed(objects: &[u32]) -> String {
    let words: Vec<String> = objects.iter().map(u32::to_string).collect();
    words.join(", ")
}

/// The estimators' own scores beside ours, MegaPose's too.
fn own_scores(
    arguments: &Arguments,
    dataset: &Dataset,
    templates: &mut TemplateFolder,
) -> Result<(), Box<dyn Error>> {
    println!(
        "\n| file | rows | right | AUC of its own score | of the confidence, mask | silhouette |"
    );
    println!("|---|--:|--:|--:|--:|--:|");
    let files = ESTIMATORS.map(|name| format!("estimates/{name}_lmo-test.csv"));
    for file in files
        .iter()
        .map(String::as_str)
        .chain(["megapose_lmo-test.csv"])
    {
        let results = read_results(&arguments.data.join(file))?;
        let [mask, silhouette] = [Masks::Simulated, Masks::Silhouette].map(|masks| {
            let options = options(masks, arguments.seed);
            let scored =
                templates.with_surfaces(|surfaces| run(dataset, &results, surfaces, &options));
            Summary::of(&scored)
        });
        let number = |area: Option<f64>| area.map_or("-".to_owned(), |area| format!("{area:.4}"));
        println!(
            "| {file} | {} | {} | {} | {} | {} |",
            mask.rows,
            mask.right,
            number(mask.own_area),
            number(mask.area),
            number(silhouette.area)
        );
    }
    Ok(())
}

fn arguments() -> Result<Arguments, Box<dyn Error>> {
    let usage = "lmo-table --data DIR --templates DIR [--seed N] [--noise-share X]";
    let (mut data, mut templates, mut seed) = (None, None, 0);
    let mut noise_share = DepthRecord::NOISE_SHARE;
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let value = words.next().ok_or(usage)?;
        match word.as_str() {
            "--data" => data = Some(value.into()),
            "--templates" => templates = Some(value.into()),
            "--seed" => seed = value.parse()?,
            "--noise-share" => noise_share = value.parse()?,
            _ => return Err(usage.into()),
        }
    }
    Ok(Arguments {
        data: data.ok_or(usage)?,
        templates: templates.ok_or(usage)?,
        seed,
        noise_share,
    })
}
