//! What is drawn of an image whose depth, photograph, camera and poses are files of their own.

use super::super::failure::Failure;
use super::super::template_file;
use super::super::terminal::Terminal;
use super::arguments::FileArguments;
use super::{Seen, Shown, estimate, file_name};
use cobra_infer::template::DecodedTerm;
use cobra_infer::{Template, Unit};
use cobra_train::bop::dataset::{read_depth, read_mask, read_photo, size_of};
use cobra_train::depth::observed;
use cobra_train::input::{Estimate, read_camera, read_estimates};
use cobra_train::overlay::grey_depth;
use cobra_train::progress::Progress;
use std::path::Path;

pub(super) fn read(
    template_path: &Path,
    arguments: &FileArguments,
    terminal: &Terminal,
) -> Result<Shown, Failure> {
    let missing = |option: &str| Failure::Usage(format!("{option} is needed beside a template"));
    let depth_path = arguments
        .depth_image
        .as_deref()
        .ok_or_else(|| missing("--depth-image"))?;
    let camera_path = arguments
        .camera
        .as_deref()
        .ok_or_else(|| missing("--camera"))?;
    let pose_path = arguments.pose.as_deref().ok_or_else(|| missing("--pose"))?;

    let bytes = template_file::read(template_path)?;
    let template =
        Template::from_bytes(&bytes).map_err(|error| Failure::template(template_path, &error))?;
    if template.unit() != Unit::Millimetre {
        return Err(Failure::BadInput(format!(
            "{}: expected lengths in mm, found {}",
            template_path.display(),
            template.unit().symbol()
        )));
    }
    let mut room = vec![DecodedTerm::default(); template.decoded_len()];
    let template = template.decoded(&mut room).unwrap_or(template);
    let cameras = read_camera(camera_path)?;
    let estimates = read_estimates(pose_path)?;
    let dataset = |error| Failure::from(&error);
    let size = size_of(depth_path).map_err(dataset)?;
    let photo = arguments.photo.as_deref();
    let photo = photo
        .map(|path| read_photo(path, size))
        .transpose()
        .map_err(dataset)?;
    let mask = arguments.mask.as_deref();
    let mask = mask
        .map(|path| read_mask(path, size))
        .transpose()
        .map_err(dataset)?;

    let image = image_of(pose_path, &estimates)?;
    let camera = cameras.for_image(image).ok_or_else(|| {
        Failure::BadInput(format!(
            "{}: expected a camera of image {image}, found none",
            camera_path.display()
        ))
    })?;
    let scale = arguments.depth_scale.or(camera.depth_scale).unwrap_or(1.0);
    let depth = read_depth(depth_path, size, scale).map_err(dataset)?;
    let pixels = mask.map(|mask| observed(&mask, &depth));
    let seen = Seen {
        camera: &camera.camera,
        depth: &depth,
        pixels: pixels.as_deref(),
    };
    let mut drawn = Vec::with_capacity(estimates.len());
    for one in &estimates {
        if let Some(deviation) = one.repaired {
            terminal.warn(&format!(
                "pose {}: R is no rotation (R^T R differs from the identity by {deviation:.2e}); \
                 checked with the nearest rotation",
                one.id
            ));
        }
        let name = match estimates.len() {
            1 => template.name().to_owned(),
            _ => format!("pose {}", one.id),
        };
        let checked = estimate(name, &template, &one.pose, &seen);
        drawn.push(
            checked.map_err(|error| {
                Failure::BadInput(format!("{}: {error}", template_path.display()))
            })?,
        );
    }
    Ok(Shown {
        photo: photo.unwrap_or_else(|| grey_depth(&depth)),
        estimates: drawn,
        subtitle: format!("{}   ·   {}", file_name(depth_path), file_name(pose_path)),
        missing: 0,
    })
}

/// The image that all poses are of.
fn image_of<'e>(path: &Path, estimates: &'e [Estimate]) -> Result<&'e str, Failure> {
    // A file without poses is refused when it is read.
    let first = estimates.first().map_or("", |one| one.image.as_str());
    match estimates.iter().find(|one| one.image != first) {
        None => Ok(first),
        Some(other) => Err(Failure::BadInput(format!(
            "{}: expected poses of one image, found those of {first} and {}",
            path.display(),
            other.image
        ))),
    }
}
