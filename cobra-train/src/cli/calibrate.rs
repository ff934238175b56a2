//! `cobra calibrate`: thresholds for a false-accept rate, stored in the template.

mod arguments;
mod document;
mod evidence;
mod simulated;

pub(crate) use arguments::{CalibrateArguments, MasksArgument};

use super::failure::Failure;
use super::outputs;
use super::report::JsonTarget;
use super::template_file;
use super::terminal::Terminal;
use cobra_infer::Template;
use cobra_infer::template::{Calibration, DEPTH_CAPACITY, DepthRecord, DepthSource, with_depth};
use cobra_train::calibrate::{
    Aim, CalibrateError, PrecisionRecall, Roc, calibrate, precision_recall_svg, reliability,
    reliability_svg, roc_svg,
};
use cobra_train::output::write_whole;
use document::Found;
use evidence::{Evidence, evidence};
use std::path::{Path, PathBuf};

pub(super) fn run(arguments: &CalibrateArguments, terminal: &Terminal) -> Result<(), Failure> {
    let bytes = template_file::read(&arguments.template)?;
    let template = Template::from_bytes(&bytes)
        .map_err(|error| Failure::template(&arguments.template, &error))?;
    let output = arguments.output.as_ref().unwrap_or(&arguments.template);
    let curves = curves(arguments)?;
    check_outputs(arguments, output, curves.as_ref())?;

    let evidence = evidence(arguments, &template, terminal)?;
    let found = find(arguments, &template, &evidence)?;
    let calibrated = with_thresholds(&bytes, &found)
        .map_err(|error| Failure::BadInput(format!("{}: {error}", output.display())))?;
    if let Some([roc, precision_recall, reliability]) = &curves {
        let thresholds = &found.thresholds;
        for (path, svg) in [
            (roc, roc_svg(&found.roc, thresholds)),
            (
                precision_recall,
                precision_recall_svg(&found.precision_recall, thresholds),
            ),
            (reliability, reliability_svg(&found.bins, thresholds)),
        ] {
            let svg = svg.map_err(|error| Failure::Io(format!("{}: {error}", path.display())))?;
            write_whole(path, svg.as_bytes())?;
        }
    }
    // Last: whoever finds the thresholds in it finds the curves too.
    write_whole(output, &calibrated)?;

    let json = JsonTarget(arguments.json.as_ref());
    json.write(&found.document(), terminal)?;
    if json.replaces_the_table() {
        return Ok(());
    }
    terminal.print(&found.text())?;
    terminal.say(&format!(
        "{}: thresholds stored, {} bytes",
        output.display(),
        calibrated.len()
    ));
    Ok(())
}

/// Where the curves go, if they were asked for.
fn curves(arguments: &CalibrateArguments) -> Result<Option<[PathBuf; 3]>, Failure> {
    let Some(folder) = &arguments.curves else {
        return Ok(None);
    };
    std::fs::create_dir_all(folder)
        .map_err(|error| Failure::Io(format!("cannot make {}: {error}", folder.display())))?;
    let names = ["roc.svg", "precision-recall.svg", "reliability.svg"];
    Ok(Some(names.map(|name| folder.join(name))))
}

/// The template alone may be written over.
fn check_outputs(
    arguments: &CalibrateArguments,
    output: &Path,
    curves: Option<&[PathBuf; 3]>,
) -> Result<(), Failure> {
    let mut outputs = vec![output];
    outputs.extend(outputs::named_file(arguments.json.as_ref()));
    outputs.extend(curves.into_iter().flatten().map(PathBuf::as_path));
    let inputs = arguments.labelled.iter().chain(&arguments.mesh);
    let inputs: Vec<&Path> = inputs.map(PathBuf::as_path).collect();
    outputs::check(&inputs, &outputs)?;
    outputs::check(&[&arguments.template], &outputs[1..])
}

fn find<'a>(
    arguments: &CalibrateArguments,
    template: &Template<'a>,
    evidence: &'a Evidence,
) -> Result<Found<'a>, Failure> {
    let aim = Aim {
        false_accepts: arguments.false_accept,
        rejected_right: arguments.reject_right.unwrap_or(arguments.false_accept),
    };
    let labelled = &evidence.labelled;
    let refuse = |what: &str| {
        let report = arguments.labelled.as_ref().unwrap_or(&arguments.template);
        Failure::BadInput(format!("{}: {what}", report.display()))
    };
    let thresholds = calibrate(labelled, aim)
        .map_err(|error| refuse(&format!("{error}{}", way_out(arguments, &error))))?;
    let (roc, precision_recall) = Roc::new(labelled)
        .zip(PrecisionRecall::new(labelled))
        .ok_or_else(|| refuse("there must be right and wrong estimates"))?;
    let count = |count: usize| u32::try_from(count).unwrap_or(u32::MAX);
    Ok(Found {
        template: template.name(),
        noise_share: template
            .depth()
            .map_or(DepthRecord::NOISE_SHARE, |depth| depth.noise_share),
        aim,
        calibration: Calibration {
            accept: thresholds.accept,
            reject: thresholds.reject,
            minimum_points: arguments.min_points,
            target: aim.false_accepts as f32,
            false_accepts: thresholds.false_accepts.measured(),
            wrong: count(thresholds.false_accepts.total),
            right: count(thresholds.true_accepts.total),
            source: evidence.source,
        },
        thresholds,
        roc,
        precision_recall,
        bins: reliability(labelled),
        evidence,
    })
}

/// What to do about too few estimates.
fn way_out(arguments: &CalibrateArguments, error: &CalibrateError) -> String {
    let CalibrateError::TooFew { found, needed, .. } = error else {
        return String::new();
    };
    match arguments.simulate {
        // Some more, because the shares of right and wrong ones are drawn too.
        Some(count) => {
            let enough = 1.1 * f64::from(count) * *needed as f64 / (*found).max(1) as f64;
            format!("; raise --simulate to about {enough:.0}")
        }
        None => "; give more, ask for a larger share, or --simulate them".to_owned(),
    }
}

/// The template's bytes with the thresholds in them.
fn with_thresholds(bytes: &[u8], found: &Found<'_>) -> Result<Vec<u8>, cobra_infer::EncodeError> {
    let depth = DepthSource {
        noise_share: found.noise_share,
        calibration: Some(found.calibration),
        provenance: &found.evidence.provenance,
    };
    let mut out = vec![0; bytes.len() + DEPTH_CAPACITY];
    let length = with_depth(bytes, &depth, &mut out)?;
    out.truncate(length);
    Ok(out)
}
