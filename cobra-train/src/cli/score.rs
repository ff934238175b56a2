//! `cobra score`: estimated poses against a template.

mod document;

use super::args::ScoreArguments;
use super::choices::assignment;
use super::failure::Failure;
use super::outputs;
use super::report::{JsonTarget, plural};
use super::template_file;
use super::terminal::Terminal;
use cobra_infer::template::DecodedTerm;
use cobra_infer::{
    Assignment, Camera, Correspondence, Decision, Likelihood, Report, Settings, Sigma, Template,
    bound, score,
};
use cobra_train::input::{
    CameraFile, CorrespondenceOptions, Estimate, doubt_point_scale, doubt_pose_scale, read_camera,
    read_correspondences, read_estimates, same_image,
};
use cobra_train::progress::Progress;
use cobra_train::train::LARGEST_TEMPLATE;
use document::{document, text};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// A tolerance of more than this many σ lies beyond what a Gaussian residual reaches: a threshold
/// below what it gives is warned of.
const LARGE_DELTA: f32 = 3.2;

pub(super) fn run(arguments: &ScoreArguments, terminal: &Terminal) -> Result<(), Failure> {
    let bytes = template_file::read(&arguments.template)?;
    let template = Template::from_bytes(&bytes)
        .map_err(|error| Failure::template(&arguments.template, &error))?;
    let mut room = vec![DecodedTerm::default(); template.decoded_len()];
    let template = template.decoded(&mut room).unwrap_or(template);
    let cameras = read_camera(&arguments.camera)?;
    let estimates = read_estimates(&arguments.poses)?;
    let settings = settings(arguments, &template);
    if arguments.sigma_hat.is_some() && arguments.noise > 0.0 {
        terminal.warn("--sigma-hat replaces the whole standard deviation: --noise has no effect");
    }
    if settings.assignment == Assignment::Soft
        && template.component_count() > 1
        && !template.has_precisions()
    {
        terminal.warn(
            "the template has no precisions: the weights of a soft assignment hardly differ over \
             the object, and components that extrapolate dilute every confidence; train with \
             --reference-points em, or use --assignment nearest",
        );
    }
    let jobs = pair(&estimates, &arguments.correspondences, terminal)?;
    if let Some(path) = outputs::named_file(arguments.json.as_ref()) {
        let mut inputs = vec![
            arguments.template.as_path(),
            arguments.camera.as_path(),
            arguments.poses.as_path(),
        ];
        inputs.extend(jobs.iter().map(|(_, file)| file.as_path()));
        outputs::check(&inputs, &[path])?;
    }

    let mut scored = Vec::with_capacity(jobs.len());
    for (estimate, file) in &jobs {
        let correspondences = read_correspondences(
            file,
            CorrespondenceOptions {
                weighting: arguments.weights.into(),
                inliers_only: arguments.inliers_only,
            },
        )?;
        if let Some(deviation) = estimate.repaired {
            terminal.warn(&format!(
                "pose {}: R is no rotation (R^T R differs from the identity by {deviation:.2e}); \
                 scored with the nearest rotation",
                estimate.id
            ));
        }
        if correspondences.is_empty() {
            terminal.warn(&format!("{}: no row counts", file.display()));
        }
        warn_of_scale(&template, estimate, &correspondences, file, terminal);
        let camera = camera_of(&cameras, estimate, &arguments.camera)?;
        let report = judge(&template, camera, estimate, &settings, &correspondences)?;
        scored.push((*estimate, report));
    }

    warn_of_low_thresholds(&template, &settings, &scored, terminal);
    let json = JsonTarget(arguments.json.as_ref());
    json.write(&document(&template, &settings, &scored), terminal)?;
    if !json.replaces_the_table() {
        terminal.print(&text(&template, &settings, &scored))?;
    }
    let count = scored
        .iter()
        .filter(|(_, report)| report.decision != Decision::Accept)
        .count();
    if arguments.fail_on_reject && count > 0 {
        return Err(Failure::NotAccepted { count });
    }
    Ok(())
}

fn camera_of<'c>(
    cameras: &'c CameraFile,
    estimate: &Estimate,
    file: &Path,
) -> Result<&'c Camera, Failure> {
    let found = cameras.for_image(&estimate.image);
    found.map(|found| &found.camera).ok_or_else(|| {
        Failure::BadInput(format!(
            "{}: no camera of image {}, which pose {} is of",
            file.display(),
            estimate.image,
            estimate.id
        ))
    })
}

fn judge(
    template: &Template<'_>,
    camera: &Camera,
    estimate: &Estimate,
    settings: &Settings,
    correspondences: &[Correspondence],
) -> Result<Report, Failure> {
    Ok(score::<LARGEST_TEMPLATE>(
        template,
        camera,
        &estimate.pose,
        settings,
        correspondences,
    )?)
}

/// The settings in the template's unit; the arguments are in millimetres.
fn settings(arguments: &ScoreArguments, template: &Template<'_>) -> Settings {
    let millimetre = 1.0 / template.unit().millimetres();
    let delta = arguments
        .delta
        .unwrap_or(0.01 * template.diameter() / millimetre);
    Settings {
        likelihood: arguments.likelihood.into(),
        assignment: assignment(arguments.assignment, template),
        sigma: match arguments.sigma_hat {
            Some(sigma) => Sigma::Fixed(sigma * millimetre),
            None => Sigma::Template {
                noise: arguments.noise * millimetre,
            },
        },
        threshold: arguments.threshold.into(),
        minimum_points: arguments.min_points,
        ..Settings::for_template(template, delta)
    }
}

/// Finds each pose's correspondences: in a folder every pose has a file; files that are named one
/// by one choose the poses to score.
fn pair<'e>(
    estimates: &'e [Estimate],
    inputs: &[PathBuf],
    terminal: &Terminal,
) -> Result<Vec<(&'e Estimate, PathBuf)>, Failure> {
    if let [folder] = inputs
        && folder.is_dir()
    {
        return estimates
            .iter()
            .map(|estimate| Ok((estimate, in_folder(folder, &estimate.image)?)))
            .collect();
    }
    let mut jobs = Vec::new();
    for file in inputs {
        let metadata = file
            .metadata()
            .map_err(|error| Failure::Io(format!("{}: {error}", file.display())))?;
        if metadata.is_dir() {
            return Err(Failure::Usage(format!(
                "{}: a folder stands alone, files may be several",
                file.display()
            )));
        }
        let image = image_of(file);
        let mut poses: Vec<&Estimate> = estimates
            .iter()
            .filter(|estimate| same_image(&estimate.image, &image))
            .collect();
        if let ([file_is_single], [only], true) = (inputs, estimates, poses.is_empty()) {
            terminal.warn(&format!(
                "{} is taken for pose {}, the only one",
                file_is_single.display(),
                only.id
            ));
            poses.push(only);
        }
        if poses.is_empty() {
            return Err(Failure::BadInput(format!(
                "{}: no pose has the id {image:?} that the file's name says",
                file.display()
            )));
        }
        jobs.extend(poses.into_iter().map(|estimate| (estimate, file.clone())));
    }
    let unused = estimates.len().saturating_sub(jobs.len());
    if unused > 0 {
        terminal.say(&format!(
            "{} without a correspondence file left out",
            plural(unused, "pose")
        ));
    }
    Ok(jobs)
}

/// The names that a pose's correspondences may have in a folder.
fn in_folder(folder: &Path, image: &str) -> Result<PathBuf, Failure> {
    [
        format!("{image}_corr.txt"),
        format!("{image}_corr.csv"),
        format!("{image}.csv"),
        format!("{image}.txt"),
    ]
    .into_iter()
    .map(|name| folder.join(name))
    .find(|path| path.is_file())
    .or_else(|| with_other_zeros(folder, image))
    .ok_or_else(|| {
        Failure::BadInput(format!(
            "{}: no correspondences of pose {image}, expected {image}_corr.txt or {image}.csv",
            folder.display()
        ))
    })
}

/// The file of the same number, first by name: `000061_corr.txt` for pose 61.
fn with_other_zeros(folder: &Path, image: &str) -> Option<PathBuf> {
    let entries = std::fs::read_dir(folder).ok()?;
    entries
        .flatten()
        .map(|entry| entry.path())
        .filter(|path| {
            let extension = path.extension().and_then(OsStr::to_str);
            matches!(extension, Some("csv" | "txt"))
                && same_image(&image_of(path), image)
                && path.is_file()
        })
        .min()
}

fn image_of(file: &Path) -> String {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    stem.strip_suffix("_corr").unwrap_or(&stem).to_owned()
}

fn warn_of_scale(
    template: &Template<'_>,
    estimate: &Estimate,
    correspondences: &[Correspondence],
    file: &Path,
    terminal: &Terminal,
) {
    if let Some(doubt) = doubt_point_scale(template, correspondences) {
        terminal.warn(&format!("{}: {doubt}", file.display()));
    }
    if let Some(doubt) = doubt_pose_scale(template, &estimate.pose) {
        terminal.warn(&format!("translation of pose {}: {doubt}", estimate.id));
    }
}

/// Thresholds fall as δ grows against σ, Eq. 11 with (σ/δ)²: in the end any pose reaches them.
fn warn_of_low_thresholds(
    template: &Template<'_>,
    settings: &Settings,
    scored: &[(&Estimate, Report)],
    terminal: &Terminal,
) {
    let lowest = scored
        .iter()
        .filter(|(_, report)| !matches!(report.decision, Decision::Undecided(_)))
        .map(|(_, report)| report.threshold)
        .fold(f32::INFINITY, f32::min);
    // A density is in 1/length: the largest sigma makes the least that is not warned of.
    let sigma = match (settings.likelihood, settings.sigma) {
        (Likelihood::Peak, _) => 1.0,
        (Likelihood::Density, Sigma::Fixed(sigma)) => sigma,
        (Likelihood::Density, Sigma::Template { noise }) => template
            .components()
            .map(|component| component.sigma_hat.hypot(noise))
            .fold(0.0, f32::max),
    };
    let large = LARGE_DELTA * sigma;
    let low = bound::contribution(settings.likelihood, settings.threshold, sigma, large);
    if lowest < low {
        terminal.warn(&format!(
            "the threshold falls to {lowest:.3}, because the tolerance is far above the residuals' \
             standard deviation: poses may be accepted that nothing supports; add the \
             measurement's own with --noise, or lower --delta"
        ));
    }
}
