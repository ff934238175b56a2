//! The labelled estimates that thresholds are found on, and where they come from.

use super::{CalibrateArguments, simulated};
use crate::cli::failure::Failure;
use crate::cli::report::plural;
use crate::cli::terminal::Terminal;
use cobra_infer::Template;
use cobra_infer::template::{CalibrationSource, PROVENANCE_CAPACITY};
use cobra_train::calibrate::Labelled;
use cobra_train::input::{ReportedEstimate, ScoreReport, read_score_report};
use std::path::Path;

/// What thresholds are found on.
pub(super) struct Evidence {
    pub(super) labelled: Vec<Labelled>,
    pub(super) left_out: LeftOut,
    pub(super) source: CalibrationSource,
    /// Where it comes from, in words that fit into a template.
    pub(super) provenance: String,
}

/// How many estimates say nothing, and why.
#[derive(Clone, Copy, Default)]
pub(super) struct LeftOut {
    pub(super) other_objects: usize,
    pub(super) not_scored: usize,
    pub(super) without_truth: usize,
    pub(super) too_few_pixels: usize,
}

/// The estimates that the arguments ask for.
pub(super) fn evidence(
    arguments: &CalibrateArguments,
    template: &Template<'_>,
    terminal: &Terminal,
) -> Result<Evidence, Failure> {
    match (&arguments.labelled, arguments.simulate) {
        (Some(path), _) => labelled(arguments, template, path, terminal),
        (None, count) => simulated::evidence(arguments, template, count.unwrap_or(0), terminal),
    }
}

/// The object that a template is named after, as `cobra bop train` names them.
fn named_object(name: &str) -> Option<u64> {
    name.strip_prefix("obj_")?.parse().ok()
}

fn labelled(
    arguments: &CalibrateArguments,
    template: &Template<'_>,
    path: &Path,
    terminal: &Terminal,
) -> Result<Evidence, Failure> {
    let report = read_score_report(path)?;
    if let (Some(id), Some(named)) = (arguments.object, named_object(template.name()))
        && id != named
    {
        return Err(Failure::Usage(format!(
            "{} is of object {named}, and --object says {id}",
            arguments.template.display()
        )));
    }
    let (labelled, left_out) = select(&report.estimates, arguments, path)?;
    for (count, why) in [
        (left_out.other_objects, "of another object"),
        (left_out.not_scored, "without a score"),
        (left_out.without_truth, "without truth"),
        (left_out.too_few_pixels, "with too few valid pixels"),
    ] {
        if count > 0 {
            terminal.say(&format!("{} {why} left out", plural(count, "estimate")));
        }
    }
    Ok(Evidence {
        labelled,
        left_out,
        source: CalibrationSource::Labelled,
        provenance: match asked_provenance(arguments)? {
            Some(text) => text,
            None => shortened(provenance(arguments, path, &report)),
        },
    })
}

fn select(
    estimates: &[ReportedEstimate],
    arguments: &CalibrateArguments,
    path: &Path,
) -> Result<(Vec<Labelled>, LeftOut), Failure> {
    let mut left_out = LeftOut::default();
    // The row with the largest least number of pixels that is more than what is asked for.
    let mut stricter: Option<(u64, u32)> = None;
    let mut labelled = Vec::with_capacity(estimates.len());
    for estimate in estimates {
        if arguments
            .object
            .is_some_and(|id| Some(id) != estimate.object)
        {
            left_out.other_objects += 1;
            continue;
        }
        let minimum = estimate.scored.and_then(|scored| scored.minimum_points);
        if let Some(minimum) = minimum.filter(|minimum| *minimum > arguments.min_points)
            && stricter.is_none_or(|(_, least)| least < minimum)
        {
            stricter = Some((estimate.row, minimum));
        }
        match (estimate.right, estimate.scored) {
            (None, _) => left_out.without_truth += 1,
            (_, None) => left_out.not_scored += 1,
            (_, Some(scored)) if scored.valid_pixels < arguments.min_points => {
                left_out.too_few_pixels += 1;
            }
            (Some(right), Some(scored)) => labelled.push(Labelled {
                confidence: scored.confidence,
                right,
            }),
        }
    }
    let of_object = estimates.len() - left_out.other_objects;
    let refuse = |what: &str| Err(Failure::BadInput(format!("{}: {what}", path.display())));
    if let Some((row, minimum)) = stricter {
        return refuse(&format!(
            "row {row} was scored with a least of {minimum} valid pixels, below which a confidence is 0 \
             whatever was seen: expected --min-points {minimum} or more, found {}",
            arguments.min_points
        ));
    }
    match arguments.object {
        _ if estimates.is_empty() => refuse("the report holds no estimate"),
        Some(id) if of_object == 0 => refuse(&format!("no estimate is of object {id}")),
        _ if left_out.without_truth == of_object => refuse(
            "no estimate has a truth to be right or wrong by: score with the dataset's ground truth",
        ),
        _ => Ok((labelled, left_out)),
    }
}

/// The words that the arguments say, if they say some.
pub(super) fn asked_provenance(arguments: &CalibrateArguments) -> Result<Option<String>, Failure> {
    match &arguments.provenance {
        Some(text) if text.len() > PROVENANCE_CAPACITY => Err(Failure::Usage(format!(
            "--provenance has {} bytes, at most {PROVENANCE_CAPACITY} fit into a template",
            text.len()
        ))),
        asked => Ok(asked.clone()),
    }
}

fn provenance(arguments: &CalibrateArguments, path: &Path, report: &ScoreReport) -> String {
    let text = match &report.dataset {
        Some(name) => name.clone(),
        None => {
            let name = path.file_name().unwrap_or_default();
            name.to_string_lossy().into_owned()
        }
    };
    match arguments.object {
        Some(id) => format!("{text}, object {id}"),
        None => text,
    }
}

/// As much of the words as fits into a template.
pub(super) fn shortened(mut text: String) -> String {
    while text.len() > PROVENANCE_CAPACITY {
        text.pop();
    }
    text
}
