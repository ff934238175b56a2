//! What is drawn of an image of a BOP data set.
//!
//! Owns which estimates are meant. What belongs to an image, and which pixels show what, is
//! [`cobra_train::bop::score`]'s.

use super::super::failure::Failure;
use super::super::terminal::Terminal;
use super::arguments::BopArguments;
use super::{Seen, Shown, estimate, file_name, skip};
use cobra_infer::Pose;
use cobra_train::bop::dataset::{Dataset, DatasetError, Scene};
use cobra_train::bop::results::{Results, read_results};
use cobra_train::bop::score::{DepthSource, Frames, Masks, ScoreOptions};
use cobra_train::bop::templates::TemplateFile;
use cobra_train::overlay::{OverlayEstimate, grey_depth};
use cobra_train::pose::single_pose;
use nalgebra::Point3;
use std::path::Path;

/// A pose that is to be drawn, and where it comes from.
struct Wanted {
    object: u32,
    name: String,
    /// What a complaint begins with.
    place: String,
    pose: Result<Pose, String>,
}

pub(super) fn read(
    folder: &Path,
    arguments: &BopArguments,
    terminal: &Terminal,
) -> Result<Shown, Failure> {
    let depth = arguments.sources.depth()?;
    arguments.sources.check_masks()?;
    let dataset = Dataset::open(folder, &arguments.split)?;
    let results = match &arguments.results {
        Some(path) => Some((path.as_path(), read_results(path)?)),
        None => None,
    };
    let (scene_id, image) = image_of(arguments, results.as_ref())?;
    let scene = dataset.scene(scene_id)?;
    let wanted = wanted(arguments, results.as_ref(), &scene, image)?;
    let options = ScoreOptions {
        masks: arguments.sources.masks(&dataset, Some(scene_id)),
        depth,
        seed: arguments.sources.seed,
        pixels: ScoreOptions::PIXELS,
    };
    let subtitle = subtitle(arguments, &options, scene_id, image);
    let frames = Frames::new(&dataset, std::iter::once(scene_id), &options);
    let frame = frames
        .open(scene_id, image)
        .map_err(|error| Failure::from(&*error))?;
    let size = frame.depth().size();
    let photo = scene.photo(image, size)?;
    let photo = photo.unwrap_or_else(|| grey_depth(frame.depth()));

    // Required with the data set.
    let templates = arguments.templates.as_deref().unwrap_or(Path::new("."));
    let draw = |wanted: &Wanted| -> Result<OverlayEstimate, String> {
        let pose = wanted.pose.clone()?;
        let mut file =
            TemplateFile::read(templates, wanted.object).map_err(|error| error.to_string())?;
        let template = file.template();
        let middle = pose.to_camera(&Point3::from(template.centre()));
        let expected = frame.camera().project(&middle);
        let pixels = frame
            .pixels(wanted.object, expected, usize::MAX)
            .map_err(|error: DatasetError| error.to_string())?;
        let seen = Seen {
            camera: frame.camera(),
            depth: frame.depth(),
            pixels: pixels.as_deref(),
        };
        estimate(wanted.name.clone(), &template, &pose, &seen).map_err(|error| error.to_string())
    };
    let mut shown = Shown {
        photo,
        estimates: Vec::new(),
        subtitle,
        missing: 0,
    };
    for one in &wanted {
        match draw(one) {
            Ok(estimate) => shown.estimates.push(estimate),
            // Alone, it is why the command fails.
            Err(why) if wanted.len() == 1 => {
                return Err(Failure::BadInput(format!("{}: {why}", one.place)));
            }
            Err(why) => skip(
                terminal,
                &format!("{}: {why}", one.place),
                &mut shown.missing,
            ),
        }
    }
    if shown.estimates.is_empty() {
        return Err(Failure::BadInput(format!(
            "none of {} estimates could be drawn",
            wanted.len()
        )));
    }
    Ok(shown)
}

/// The image that is asked for, by its numbers or by a row of it.
fn image_of(
    arguments: &BopArguments,
    results: Option<&(&Path, Results)>,
) -> Result<(u32, u32), Failure> {
    let asked = arguments.scene.zip(arguments.image);
    let Some((path, results, line)) =
        results.and_then(|(path, results)| Some((path, results, arguments.row?)))
    else {
        return asked.ok_or_else(|| {
            Failure::Usage("which image: --scene and --image, or --row of the results".to_owned())
        });
    };
    let Some(row) = results.rows.iter().find(|row| row.line == line) else {
        let found = match (results.rows.first(), results.rows.last()) {
            (Some(first), Some(last)) => format!("rows on lines {} to {}", first.line, last.line),
            _ => "no rows".to_owned(),
        };
        return Err(Failure::BadInput(format!(
            "{}: expected a row on line {line}, found {found}",
            path.display()
        )));
    };
    let estimate = match &row.estimate {
        Ok(estimate) => estimate,
        Err(error) => {
            return Err(Failure::BadInput(format!(
                "{}: line {line}: {error}",
                path.display()
            )));
        }
    };
    let of_row = (estimate.scene_id, estimate.im_id);
    match asked {
        Some(asked) if asked != of_row => Err(Failure::BadInput(format!(
            "{}: line {line}: expected an estimate of scene {} and image {}, found one of scene {} \
             and image {}",
            path.display(),
            asked.0,
            asked.1,
            of_row.0,
            of_row.1
        ))),
        _ => Ok(of_row),
    }
}

/// The poses that are asked for; at least one.
fn wanted(
    arguments: &BopArguments,
    results: Option<&(&Path, Results)>,
    scene: &Scene,
    image: u32,
) -> Result<Vec<Wanted>, Failure> {
    let of_object = |object: u32| arguments.object.is_none_or(|asked| asked == object);
    let (found, place): (Vec<Wanted>, String) = match results {
        Some((path, results)) => {
            let rows = results.rows.iter().filter_map(|row| {
                let estimate = row.estimate.as_ref().ok()?;
                let here = (estimate.scene_id, estimate.im_id) == (scene.id(), image)
                    && arguments.row.is_none_or(|line| line == row.line)
                    && of_object(estimate.obj_id);
                here.then(|| Wanted {
                    object: estimate.obj_id,
                    name: format!("object {}", estimate.obj_id),
                    place: format!("{}: line {}", path.display(), row.line),
                    pose: estimate.pose().map_err(|error| error.to_string()),
                })
            });
            (rows.collect(), path.display().to_string())
        }
        None if arguments.truth => {
            let annotations = scene.truth(image)?;
            let path = scene.folder().join("scene_gt.json");
            let poses = annotations.iter().filter(|one| of_object(one.obj_id));
            let poses = poses.map(|one| Wanted {
                object: one.obj_id,
                name: format!("object {}, true pose", one.obj_id),
                place: format!("{}: {image}", path.display()),
                pose: single_pose(&one.pose).map_err(|error| error.to_string()),
            });
            (poses.collect(), path.display().to_string())
        }
        None => {
            return Err(Failure::Usage(
                "which poses: --results FILE.csv or --truth".to_owned(),
            ));
        }
    };
    if found.is_empty() {
        let of = arguments
            .object
            .map_or_else(String::new, |object| format!("object {object} in "));
        return Err(Failure::BadInput(format!(
            "{place}: expected a pose of {of}image {image} of scene {}, found none",
            scene.id()
        )));
    }
    Ok(found)
}

fn subtitle(arguments: &BopArguments, options: &ScoreOptions, scene: u32, image: u32) -> String {
    let mut words = vec![format!("Scene {scene}, image {image}")];
    if let Some(path) = &arguments.results {
        let row = arguments
            .row
            .map_or_else(String::new, |line| format!(", line {line}"));
        words.push(format!("{}{row}", file_name(path)));
    }
    words.push(match options.depth {
        DepthSource::Sensor => "depth of the sensor".to_owned(),
        DepthSource::Simulated { noise } => {
            format!("simulated depth of the annotated objects, noise {noise} mm")
        }
    });
    words.push(
        match &options.masks {
            Masks::Folder(_) => "masks of the visible pixels",
            Masks::Simulated => "masks of a rendering of the true poses",
            Masks::Silhouette => "no masks",
        }
        .to_owned(),
    );
    words.join("   ·   ")
}
