//! `cobra bop score`: a results file with other scores.

use super::arguments::BopScoreArguments;
use super::summary;
use crate::cli::failure::Failure;
use crate::cli::outputs;
use crate::cli::report::JsonTarget;
use crate::cli::terminal::Terminal;
use cobra_train::bop::dataset::Dataset;
use cobra_train::bop::results::read_results;
use cobra_train::bop::score::{DepthSource, ReportDocument, ScoreOptions, Scored, score_results};
use cobra_train::bop::templates::TemplateFolder;
use cobra_train::output::write_whole;
use cobra_train::progress::Progress;
use std::collections::BTreeSet;
use std::path::Path;

pub(super) fn run(arguments: &BopScoreArguments, terminal: &Terminal) -> Result<(), Failure> {
    let depth = arguments.sources.depth()?;
    arguments.sources.check_masks()?;
    let mut written = vec![arguments.output.as_path()];
    written.extend(outputs::named_file(arguments.report.as_ref()));
    outputs::check(&[&arguments.results], &written)?;
    let mut read = outputs::read_of(&arguments.dataset, &arguments.split);
    read.push(arguments.templates.clone());
    outputs::check_folders(&read, &written)?;
    template_folder(&arguments.templates)?;
    let results = read_results(&arguments.results)?;
    let dataset = Dataset::open(&arguments.dataset, &arguments.split)?;
    let estimates = results
        .rows
        .iter()
        .filter_map(|row| row.estimate.as_ref().ok());
    let first_scene = estimates.clone().next().map(|estimate| estimate.scene_id);
    let options = ScoreOptions {
        masks: arguments.sources.masks(&dataset, first_scene),
        depth,
        seed: arguments.sources.seed,
        pixels: arguments.pixels as usize,
    };
    if let DepthSource::Simulated { noise } = options.depth {
        terminal.say(&format!(
            "depth is simulated: all annotated objects at their true poses, {noise} mm of noise, far \
             elsewhere"
        ));
    }
    let objects: BTreeSet<u32> = estimates.map(|estimate| estimate.obj_id).collect();
    let mut templates = TemplateFolder::read(&arguments.templates, objects);
    let scored = templates
        .with_surfaces(|surfaces| score_results(&dataset, &results, surfaces, &options, terminal));
    let missing = tell(&scored, &arguments.results, terminal);

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
    missing.failure(&arguments.results, scored.len())
}

/// One line for a folder that is not there, in the place of one for each object.
fn template_folder(folder: &Path) -> Result<(), Failure> {
    match std::fs::metadata(folder) {
        Ok(found) if found.is_dir() => Ok(()),
        Ok(_) => Err(Failure::BadInput(format!(
            "{}: expected a folder of templates, found a file",
            folder.display()
        ))),
        Err(error) => Err(Failure::Io(format!("{}: {error}", folder.display()))),
    }
}

/// How many rows something was not done for.
struct Missing {
    scores: usize,
    truths: usize,
}

impl Missing {
    fn failure(&self, file: &Path, rows: usize) -> Result<(), Failure> {
        let words = match (self.scores, self.truths) {
            (0, 0) => return Ok(()),
            (scores, 0) => format!("{scores} of {rows} rows were not scored"),
            (0, truths) => format!("the truth of {truths} of {rows} rows is not known"),
            (scores, truths) => format!(
                "{scores} of {rows} rows were not scored, the truth of {truths} others is not known"
            ),
        };
        Err(Failure::BadInput(format!("{}: {words}", file.display())))
    }
}

/// Says what was not scored or has no truth, and why: each row that is wrong itself, and once what several rows
/// share. Of a row that was not scored the truth does not matter.
fn tell(scored: &[Scored], file: &Path, terminal: &Terminal) -> Missing {
    let mut shared = Shared::default();
    let mut missing = Missing {
        scores: 0,
        truths: 0,
    };
    for row in scored {
        match (&row.outcome, &row.truth) {
            (Err(problem), _) => {
                missing.scores += 1;
                if problem.is_shared() {
                    shared.add(problem.to_string(), "not scored", row.line);
                } else {
                    let file = file.display();
                    terminal.warn(&format!("{file}: line {}: {problem}", row.line));
                }
            }
            (Ok(_), Err(problem)) => {
                missing.truths += 1;
                shared.add(problem.to_string(), "without truth", row.line);
            }
            (Ok(_), Ok(_)) => {}
        }
    }
    shared.tell(file, terminal);
    missing
}

/// What several rows share, in the order in which it was met.
#[derive(Default)]
struct Shared(Vec<SharedProblem>);

struct SharedProblem {
    text: String,
    consequence: &'static str,
    rows: usize,
    first_line: u64,
}

impl Shared {
    fn add(&mut self, text: String, consequence: &'static str, line: u64) {
        let known = |one: &&mut SharedProblem| one.text == text && one.consequence == consequence;
        match self.0.iter_mut().find(known) {
            Some(known) => known.rows += 1,
            None => self.0.push(SharedProblem {
                text,
                consequence,
                rows: 1,
                first_line: line,
            }),
        }
    }

    fn tell(&self, file: &Path, terminal: &Terminal) {
        let file = file.display();
        for one in &self.0 {
            let rows = match one.rows {
                1 => format!("line {}", one.first_line),
                count => format!("{count} rows, the first in line {}", one.first_line),
            };
            terminal.warn(&format!(
                "{} ({file} {}: {rows})",
                one.text, one.consequence
            ));
        }
    }
}
