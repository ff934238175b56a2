//! `cobra overlay`: estimates over the image that they are of, as a picture.

mod arguments;
mod bop;
mod files;

pub(crate) use arguments::OverlayArguments;

use super::failure::Failure;
use super::outputs;
use super::report::table;
use super::terminal::Terminal;
use cobra_infer::Pose;
use cobra_infer::depth::DepthPixel;
use cobra_infer::depth::{DepthError, DepthSettings, TemplateSurface};
use cobra_infer::{Camera, Template};
use cobra_train::bop::score::ScoreOptions;
use cobra_train::demo::{RgbImage, encode_png};
use cobra_train::depth_image::DepthImage;
use cobra_train::output::write_whole;
use cobra_train::overlay::{Evidence, Overlay, OverlayEstimate, draw};
use cobra_train::progress::Progress;
use cobra_train::train::LARGEST_TEMPLATE;
use nalgebra::Point3;
use std::path::{Path, PathBuf};

/// What there is to draw.
struct Shown {
    photo: RgbImage,
    estimates: Vec<OverlayEstimate>,
    subtitle: String,
    /// How many estimates were asked for and could not be drawn; it was said why.
    missing: usize,
}

pub(super) fn run(arguments: &OverlayArguments, terminal: &Terminal) -> Result<(), Failure> {
    let mut written = vec![arguments.output.as_path()];
    written.extend(arguments.residuals.as_deref());
    outputs::check(&inputs(arguments), &written)?;
    outputs::check_folders(&folders(arguments), &written)?;
    let shown = match (&arguments.bop.dataset, &arguments.template) {
        (Some(dataset), _) => bop::read(dataset, &arguments.bop, terminal)?,
        (None, Some(template)) => files::read(template, &arguments.files, terminal)?,
        // One of both is required.
        (None, None) => return Err(Failure::Usage("nothing to draw".to_owned())),
    };
    if let Some(path) = &arguments.residuals {
        let [estimate] = shown.estimates.as_slice() else {
            return Err(Failure::Usage(format!(
                "--residuals are of one estimate, found {}: choose one with --row or --object",
                shown.estimates.len()
            )));
        };
        write_whole(path, estimate.residuals.csv().as_bytes())?;
    }
    let picture = draw(&Overlay {
        photo: &shown.photo,
        estimates: &shown.estimates,
        subtitle: &shown.subtitle,
        limit: arguments.limit,
    })
    .and_then(|image| encode_png(&image))
    .map_err(|error| Failure::Io(error.to_string()))?;
    write_whole(&arguments.output, &picture)?;
    terminal.print(&text(&shown.estimates))?;
    match shown.missing {
        0 => Ok(()),
        missing => Err(Failure::BadInput(format!(
            "{missing} of {} estimates could not be drawn",
            missing + shown.estimates.len()
        ))),
    }
}

/// The files that are read, as far as the arguments name them.
fn inputs(arguments: &OverlayArguments) -> Vec<&Path> {
    let files = &arguments.files;
    let named = [
        &arguments.template,
        &arguments.bop.results,
        &files.depth_image,
        &files.photo,
        &files.camera,
        &files.pose,
        &files.mask,
    ];
    named.into_iter().filter_map(Option::as_deref).collect()
}

/// And the folders.
fn folders(arguments: &OverlayArguments) -> Vec<PathBuf> {
    let bop = &arguments.bop;
    let dataset = bop.dataset.iter();
    let read = dataset.flat_map(|dataset| outputs::read_of(dataset, &bop.split));
    read.chain(bop.templates.clone()).collect()
}

/// What is known of an image.
struct Seen<'a> {
    camera: &'a Camera,
    depth: &'a DepthImage,
    pixels: Option<&'a [DepthPixel]>,
}

/// Checks a pose with what the template knows, as `cobra bop score` does.
fn estimate(
    name: String,
    template: &Template<'_>,
    pose: &Pose,
    seen: &Seen<'_>,
) -> Result<OverlayEstimate, DepthError> {
    let settings = DepthSettings::for_template(template);
    let middle = pose.to_camera(&Point3::from(template.centre()));
    let noise = settings.noise.at(template.diameter(), middle.z)?;
    let surface = TemplateSurface::<LARGEST_TEMPLATE>::new(template, noise)?;
    let evidence = Evidence {
        camera: seen.camera,
        depth: seen.depth,
        pixels: seen.pixels,
        most: ScoreOptions::PIXELS,
    };
    OverlayEstimate::of(name, &surface, template.unit(), pose, &settings, &evidence)
}

fn text(estimates: &[OverlayEstimate]) -> String {
    let rows: Vec<Vec<String>> = estimates
        .iter()
        .map(|estimate| {
            vec![
                estimate.name.clone(),
                format!("{:.3}", estimate.report.confidence),
                format!("{:.1}", estimate.report.estimated_error),
                estimate.report.decision.name().to_owned(),
                estimate.cause.in_unit(estimate.unit).to_string(),
            ]
        })
        .collect();
    let unit = estimates.first().map_or("mm", |one| one.unit.symbol());
    let error = format!("error ({unit})");
    let header = ["estimate", "confidence", &error, "decision", "why"];
    table(&header, &["estimate", "decision", "why"], &rows)
}

/// The name of a file without its folders.
fn file_name(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    name.to_string_lossy().into_owned()
}

/// Tells of an estimate that is not drawn.
fn skip(terminal: &Terminal, why: &str, missing: &mut usize) {
    terminal.warn(why);
    *missing += 1;
}
