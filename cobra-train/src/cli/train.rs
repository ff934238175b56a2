//! `cobra train`: a mesh becomes a template file.

mod document;

use super::args::TrainArguments;
use super::choices::{BudgetArgument, KernelArgument};
use super::coverage;
use super::covered;
use super::failure::Failure;
use super::learning;
use super::object::{self, Object};
use super::outputs;
use super::report::{JsonTarget, plural};
use super::terminal::Terminal;
use cobra_infer::template::NAME_CAPACITY;
use cobra_infer::{Exponent, Metric, Model, Template, Unit};
use cobra_train::coverage::{Coverage, coverage as measure};
use cobra_train::evaluate::evaluation_points;
use cobra_train::export::elements;
use cobra_train::output::write_whole;
use cobra_train::progress::Progress;
use cobra_train::reference::read_reference_points;
use cobra_train::surface::Geometry;
use cobra_train::train::{
    BUDGET, MAP_BUDGET, MOST_CHARTS, MeanForm, Overlap, ReferencePoints, TrainOptions, Trained,
    Validity, train,
};
use document::document;
use std::path::Path;

/// Components unless the user says otherwise.
const COMPONENTS: u32 = 16;

/// What `--reference-points` and the JSON call the ways of clustering.
const AUTO: &str = "auto";
const KMEANS: &str = "kmeans";
const EM: &str = "em";

/// Objects smaller or larger than this are more likely in another unit, in millimetres.
const PLAUSIBLE_DIAMETER: std::ops::RangeInclusive<f64> = 2.0..=20_000.0;

pub(super) fn run(arguments: &TrainArguments, terminal: &Terminal) -> Result<(), Failure> {
    let mut inputs = vec![arguments.mesh.as_path()];
    inputs.extend(centres_file(arguments));
    let mut written = vec![arguments.output.as_path()];
    written.extend(outputs::named_file(arguments.json.as_ref()));
    outputs::check(&inputs, &written)?;
    let mut options = options(arguments)?;
    let object = object::read(&arguments.mesh, arguments.unit_sphere, terminal)?;
    options.unit = object.unit(arguments.unit, terminal);
    describe(&object, options.unit, terminal);
    learning::warn_of_patience(&options, terminal);
    let trained = train(&object.geometry, &options, terminal)
        .map_err(|error| Failure::BadInput(format!("{}: {error}", arguments.mesh.display())))?;
    if let Geometry::Cloud(_) = object.geometry {
        terminal.say(&format!(
            "cloud split: {} for training, {} to measure sigma-hat",
            plural(trained.points, "point"),
            trained.test_points
        ));
    }
    write_whole(&arguments.output, &trained.bytes)?;
    let template = Template::from_bytes(&trained.bytes)
        .map_err(|error| Failure::template(&arguments.output, &error))?;
    let limit = options.fit.optimiser.iteration_limit();
    learning::tell(&trained.components, limit, terminal);
    let coverage = if arguments.coverage {
        let found = calibrate(&object.geometry, &trained, options.seed, terminal);
        Some(found.map_err(|why| {
            Failure::BadInput(format!("{}: coverage: {why}", arguments.mesh.display()))
        })?)
    } else {
        None
    };
    let json = JsonTarget(arguments.json.as_ref());
    let mut document = document(&template, &trained, &options, object.moved_from.as_ref());
    document.coverage = coverage.as_ref();
    json.write(&document, terminal)?;
    if json.replaces_the_table() {
        return Ok(());
    }
    terminal.print(&format!(
        "{}: {}, {} {}, {} bytes",
        arguments.output.display(),
        plural(template.component_count(), "component"),
        template.term_count(),
        elements(&template),
        trained.bytes.len()
    ))?;
    terminal.print(&covered::text(&trained, &template))?;
    if let Some(coverage) = &coverage {
        let unit = template.unit().symbol();
        let points = match object.geometry {
            Geometry::Mesh(_) => "points drawn anew",
            Geometry::Cloud(_) => "points that training left out, as for sigma-hat",
        };
        terminal.print(&format!("\n{}", coverage::text(coverage, points, unit)))?;
    }
    Ok(())
}

fn calibrate(
    object: &Geometry,
    trained: &Trained,
    seed: u64,
    terminal: &Terminal,
) -> Result<Coverage, String> {
    terminal.start("measuring coverage", 1);
    let points = evaluation_points(object, coverage::POINTS, seed).map_err(|e| e.to_string())?;
    let found = measure(trained, &points).map_err(|e| e.to_string())?;
    terminal.step();
    terminal.finish();
    Ok(found)
}

fn options(arguments: &TrainArguments) -> Result<TrainOptions, Failure> {
    let stem = arguments.mesh.file_stem().unwrap_or_default();
    let name = match &arguments.name {
        Some(name) if name.len() > NAME_CAPACITY => {
            return Err(Failure::Usage(format!(
                "--name has {} bytes, at most {NAME_CAPACITY} fit",
                name.len()
            )));
        }
        Some(name) => name.clone(),
        None => shortened(&stem.to_string_lossy()),
    };
    let mut options = TrainOptions::new(name);
    options.points = arguments.points as usize;
    options.test_points = arguments.test_points as usize;
    options.sampling = arguments.sampling.into();
    options.reference_points = reference_points(arguments)?;
    options.overlap = arguments.overlap;
    options.validity = arguments.validity.into();
    options.fit.model = model(arguments)?;
    options.mean = arguments.mean.into();
    if options.mean == MeanForm::Map && options.validity != Validity::Verified {
        return Err(Failure::Usage(
            "--mean map goes with --validity verified alone: a map holds where it was verified"
                .to_owned(),
        ));
    }
    options.budget = budget(arguments)?;
    learning::choose(arguments, &mut options.fit);
    options.seed = arguments.seed;
    Ok(options)
}

fn model(arguments: &TrainArguments) -> Result<Model, Failure> {
    if arguments.exponent.is_some() && arguments.kernel != KernelArgument::Rq {
        return Err(Failure::Usage(
            "--exponent is the rational quadratic's: it goes with --kernel rq alone".to_owned(),
        ));
    }
    let exponent = arguments.exponent.map_or(Exponent::Half, Exponent::from);
    Ok(Model {
        metric: arguments.metric.into(),
        kernel: arguments.kernel.with_exponent(exponent),
    })
}

fn budget(arguments: &TrainArguments) -> Result<Option<usize>, Failure> {
    if MeanForm::from(arguments.mean) == MeanForm::Map {
        return Ok(match arguments.budget {
            Some(BudgetArgument::Bytes(bytes)) => Some(bytes),
            Some(BudgetArgument::None) => None,
            None => Some(MAP_BUDGET),
        });
    }
    let angles = Metric::from(arguments.metric) == Metric::Angles;
    match arguments.budget {
        Some(BudgetArgument::Bytes(_)) if angles => Err(Failure::Usage(
            "--budget goes with --metric chord alone: angles are not compressed".to_owned(),
        )),
        Some(BudgetArgument::Bytes(bytes)) => Ok(Some(bytes)),
        None if !angles => Ok(Some(BUDGET)),
        _ => Ok(None),
    }
}

fn reference_points(arguments: &TrainArguments) -> Result<ReferencePoints, Failure> {
    let auto = arguments.reference_points == Path::new(AUTO);
    if !auto && arguments.max_components.is_some() {
        return Err(Failure::Usage(
            "--max-components goes with --reference-points auto; the others have --components"
                .to_owned(),
        ));
    }
    if auto {
        if arguments.components.is_some() {
            return Err(Failure::Usage(
                "--components goes with --reference-points kmeans or em; auto finds the number and \
                 has --max-components"
                    .to_owned(),
            ));
        }
        if arguments.overlap != Overlap::None {
            return Err(Failure::Usage(
                "--overlap goes with --reference-points kmeans, em or a file".to_owned(),
            ));
        }
        let most = arguments
            .max_components
            .map_or(MOST_CHARTS, |most| most as usize);
        return Ok(ReferencePoints::Auto { most });
    }
    let components = arguments.components.unwrap_or(COMPONENTS) as usize;
    let Some(file) = centres_file(arguments) else {
        return Ok(if arguments.reference_points == Path::new(EM) {
            ReferencePoints::Em { components }
        } else {
            ReferencePoints::KMeans { components }
        });
    };
    let points = read_reference_points(file)?;
    match arguments.components {
        Some(components) if components as usize != points.len() => Err(Failure::Usage(format!(
            "--components {components}, but {} has {}",
            file.display(),
            plural(points.len(), "reference point")
        ))),
        _ => Ok(ReferencePoints::Given(points)),
    }
}

/// The file that `--reference-points` names, unless it names a way of clustering.
fn centres_file(arguments: &TrainArguments) -> Option<&Path> {
    let path = arguments.reference_points.as_path();
    Some(path).filter(|path| {
        ![AUTO, KMEANS, EM]
            .iter()
            .any(|name| *path == Path::new(name))
    })
}

fn describe(object: &Object, unit: Unit, terminal: &Terminal) {
    let diameter = object.geometry.diameter();
    let (what, left_out) = match &object.geometry {
        Geometry::Mesh(mesh) => (
            format!("mesh: {}", plural(mesh.triangles().len(), "triangle")),
            (mesh.dropped_triangles(), "triangle", "without area"),
        ),
        Geometry::Cloud(cloud) => (
            format!("cloud: {}", plural(cloud.points().len(), "point")),
            (cloud.dropped_duplicates(), "point", "that repeats another"),
        ),
    };
    terminal.say(&format!("{what}, diameter {diameter:.4} {}", unit.symbol()));
    let (count, noun, reason) = left_out;
    if count > 0 {
        terminal.detail(&format!("{} {reason} left out", plural(count, noun)));
    }
    let millimetres = diameter * f64::from(unit.millimetres());
    if object.moved_from.is_none() && !PLAUSIBLE_DIAMETER.contains(&millimetres) {
        terminal.warn(&format!(
            "an object {millimetres:.4} mm across: is --unit {} the mesh's unit?",
            unit.symbol()
        ));
    }
}

/// At most [`NAME_CAPACITY`] bytes of a name, cut between characters.
fn shortened(name: &str) -> String {
    let mut end = name.len().min(NAME_CAPACITY);
    while !name.is_char_boundary(end) {
        end -= 1;
    }
    name[..end].to_owned()
}
