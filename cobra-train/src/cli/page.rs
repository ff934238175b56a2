//! `cobra report`: a page that says whether a template can be trusted.

mod arguments;

pub(crate) use arguments::ReportArguments;

use super::failure::Failure;
use super::object;
use super::outputs;
use super::template_file;
use super::terminal::{Terminal, command_line};
use cobra_infer::Template;
use cobra_train::digits::grouped;
use cobra_train::evaluate::evaluation_points;
use cobra_train::output::write_whole;
use cobra_train::progress::Progress;
use cobra_train::report::{CURVES, ReportInput, html, read_ambiguity_report, read_curves, report};
use cobra_train::surface::Geometry;
use nalgebra::Point3;
use std::path::{Path, PathBuf};

pub(super) fn run(arguments: &ReportArguments, terminal: &Terminal) -> Result<(), Failure> {
    let bytes = template_file::read(&arguments.template)?;
    let template = Template::from_bytes(&bytes)
        .map_err(|error| Failure::template(&arguments.template, &error))?;
    let output = arguments
        .output
        .clone()
        .unwrap_or_else(|| arguments.template.with_extension("html"));
    let output = outputs::named_file(Some(&output));
    check_outputs(arguments, output)?;

    let calibration = template.depth().and_then(|depth| depth.calibration);
    let curves = match &arguments.curves {
        Some(folder) => read_curves(folder, calibration.as_ref())?,
        None => Vec::new(),
    };
    let diameter = f64::from(template.diameter() * template.unit().millimetres());
    let ambiguities = match &arguments.ambiguity {
        Some(path) => Some(read_ambiguity_report(
            path,
            template.name(),
            diameter,
            calibration.map(|calibration| f64::from(calibration.accept)),
        )?),
        None => None,
    };
    let object = object(arguments, &template, terminal)?;
    terminal.start("measuring the template", 1);
    let data = report(
        &template,
        &bytes,
        ReportInput {
            object: object
                .as_ref()
                .map(|(geometry, points)| (geometry, points.as_slice())),
            curves,
            ambiguities,
            seed: arguments.seed,
            command: command_line(std::env::args_os().skip(1)),
        },
    );
    terminal.finish();
    let data = data?;
    let page = html(&data).map_err(|error| Failure::Io(format!("cannot write JSON: {error}")))?;
    let Some(output) = output else {
        return terminal.print(&page);
    };
    write_whole(output, page.as_bytes())?;
    terminal.say(&format!(
        "{}: {} bytes",
        output.display(),
        grouped(page.len() as u64)
    ));
    Ok(())
}

fn check_outputs(arguments: &ReportArguments, output: Option<&Path>) -> Result<(), Failure> {
    let curves: Vec<PathBuf> = arguments
        .curves
        .iter()
        .flat_map(|folder| CURVES.map(|(name, _)| folder.join(name)))
        .collect();
    let mut inputs = vec![arguments.template.as_path()];
    inputs.extend(arguments.mesh.as_deref());
    inputs.extend(arguments.ambiguity.as_deref());
    inputs.extend(curves.iter().map(PathBuf::as_path));
    let outputs: Vec<&Path> = output.into_iter().collect();
    outputs::check(&inputs, &outputs)
}

/// An object, and points of it that training did not see.
type Object = (Geometry, Vec<Point3<f64>>);

/// The object, which must be the template's.
fn object(
    arguments: &ReportArguments,
    template: &Template<'_>,
    terminal: &Terminal,
) -> Result<Option<Object>, Failure> {
    let Some(path) = &arguments.mesh else {
        return Ok(None);
    };
    let geometry = object::read(path, arguments.unit_sphere, terminal)?.geometry;
    object::check_diameter(template, geometry.diameter(), path)?;
    let points = evaluation_points(&geometry, arguments.points as usize, arguments.seed)
        .map_err(|error| Failure::BadInput(format!("{}: {error}", path.display())))?;
    Ok(Some((geometry, points)))
}
