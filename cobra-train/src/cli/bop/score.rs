//! `cobra bop score`: a results file with other scores.

use super::arguments::{BopScoreArguments, DepthArgument};
use super::summary;
use crate::cli::failure::Failure;
use crate::cli::outputs;
use crate::cli::report::JsonTarget;
use crate::cli::terminal::Terminal;
use cobra_train::bop::dataset::Dataset;
use cobra_train::bop::results::{Results, read_results};
use cobra_train::bop::score::{
    DepthSource, Masks, ReportDocument, ScoreOptions, Scored, score_results,
};
use cobra_train::bop::templates::TemplateFolder;
use cobra_train::output::write_whole;
use cobra_train::progress::Progress;
use std::collections::BTreeSet;
use std::path::Path;

/// The noise on simulated depth unless somebody says otherwise, in mm.
const DEPTH_NOISE: f32 = 1.5;

pub(super) fn run(arguments: &BopScoreArguments, terminal: &Terminal) -> Result<(), Failure> {
    if arguments.depth == DepthArgument::Sensor && arguments.depth_noise.is_some() {
        return Err(Failure::Usage(
            "--depth-noise goes with --depth simulated: measured depth has its own".to_owned(),
        ));
    }
    let mut written = vec![arguments.output.as_path()];
    written.extend(outputs::named_file(arguments.report.as_ref()));
    outputs::check(&[&arguments.results], &written)?;
    let results = read_results(&arguments.results)?;
    let dataset = Dataset::open(&arguments.dataset, &arguments.split)?;
    let options = options(arguments, &results);
    if let DepthSource::Simulated { noise } = options.depth {
        terminal.say(&format!(
            "depth is simulated: all annotated objects at their true poses, {noise} mm of noise, far \
             elsewhere"
        ));
    }
    let estimates = results
        .rows
        .iter()
        .flat_map(|row| row.estimate.as_ref().ok());
    let objects: BTreeSet<u32> = estimates.map(|estimate| estimate.obj_id).collect();
    let mut templates = TemplateFolder::read(&arguments.templates, objects);
    let scored = templates
        .with_surfaces(|surfaces| score_results(&dataset, &results, surfaces, &options, terminal));
    let failed = tell(&scored, &arguments.results, terminal);

    let confidence = |row: usize| {
        let outcome = scored.get(row)?.outcome.as_ref().ok()?;
        Some(outcome.report.confidence)
    };
    let text = results.rescored(|row, _| confidence(row));
    write_whole(&arguments.output, text.as_bytes())?;
    let json = JsonTarget(arguments.report.as_ref());
    let names = [&arguments.dataset, &arguments.results]
        .map(|path| path.file_name().unwrap_or_default().to_string_lossy());
    let [dataset_name, results_name] = &names;
    json.write(
        &ReportDocument::new(
            [dataset_name, &arguments.split, results_name],
            &options,
            &scored,
        ),
        terminal,
    )?;
    if !json.replaces_the_table() {
        terminal.print(&summary::text(&scored))?;
    }
    if failed > 0 {
        return Err(Failure::BadInput(format!(
            "{}: {failed} of {} rows were not scored",
            arguments.results.display(),
            scored.len()
        )));
    }
    Ok(())
}

fn options(arguments: &BopScoreArguments, results: &Results) -> ScoreOptions {
    ScoreOptions {
        masks: match &arguments.masks {
            Some(words) if words == Path::new("simulated") => Masks::Simulated,
            Some(words) if words == Path::new("silhouette") => Masks::Silhouette,
            Some(folder) => Masks::Folder(folder.clone()),
            None => own_masks(arguments, results).unwrap_or(Masks::Silhouette),
        },
        depth: match arguments.depth {
            DepthArgument::Sensor => DepthSource::Sensor,
            DepthArgument::Simulated => DepthSource::Simulated {
                noise: f64::from(arguments.depth_noise.unwrap_or(DEPTH_NOISE)),
            },
        },
        seed: arguments.seed,
        pixels: arguments.pixels as usize,
    }
}

/// The data set's own masks, if it has some of the first scene of the results.
fn own_masks(arguments: &BopScoreArguments, results: &Results) -> Option<Masks> {
    let first = results
        .rows
        .iter()
        .find_map(|row| row.estimate.as_ref().ok())?;
    let split = arguments.dataset.join(&arguments.split);
    let masks = split
        .join(format!("{:06}", first.scene_id))
        .join("mask_visib");
    masks.is_dir().then_some(Masks::Folder(split))
}

/// Says what was not scored, and why: each row that is wrong itself, and once what several rows share.
/// Returns how many rows there are of both.
fn tell(scored: &[Scored], file: &Path, terminal: &Terminal) -> usize {
    let mut shared: Vec<(String, usize, u64)> = Vec::new();
    let mut failed = 0;
    for row in scored {
        let Err(problem) = &row.outcome else {
            continue;
        };
        failed += 1;
        let text = problem.to_string();
        if !problem.is_shared() {
            terminal.warn(&format!("{}: line {}: {text}", file.display(), row.line));
        } else if let Some(known) = shared.iter_mut().find(|(known, ..)| *known == text) {
            known.1 += 1;
        } else {
            shared.push((text, 1, row.line));
        }
    }
    for (text, count, line) in shared {
        let rows = match count {
            1 => format!("line {line}"),
            _ => format!("{count} rows, the first in line {line}"),
        };
        terminal.warn(&format!("{text} ({} not scored: {rows})", file.display()));
    }
    failed
}
