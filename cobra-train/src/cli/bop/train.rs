//! `cobra bop train`: a template for every model of a folder.

use super::arguments::BopTrainArguments;
use crate::cli::choices::BudgetArgument;
use crate::cli::failure::Failure;
use crate::cli::report::{plural, table};
use crate::cli::terminal::Terminal;
use cobra_infer::{Template, Unit};
use cobra_train::bop::dataset::Models;
use cobra_train::bop::templates::template_path;
use cobra_train::output::write_whole;
use cobra_train::progress::Progress;
use cobra_train::train::{MAP_BUDGET, MeanForm, TrainOptions, train};
use std::time::Instant;

/// A model whose diameter differs from what `models_info.json` says by more than this share is hardly
/// the one that it speaks of.
const DIAMETER: f64 = 0.01;

/// A model that is smaller than this, in mm, is hardly in mm.
const SMALLEST_DIAMETER: f64 = 3.0;

pub(super) fn run(arguments: &BopTrainArguments, terminal: &Terminal) -> Result<(), Failure> {
    let models = Models::open(&arguments.models)?;
    let mut objects = models.objects()?;
    if objects.is_empty() {
        return Err(Failure::BadInput(format!(
            "{}: expected models obj_000001.ply, ..., found none",
            arguments.models.display()
        )));
    }
    if !arguments.objects.is_empty() {
        objects.clone_from(&arguments.objects);
        objects.sort_unstable();
        objects.dedup();
    }
    std::fs::create_dir_all(&arguments.output)
        .map_err(|error| Failure::Io(format!("{}: {error}", arguments.output.display())))?;
    let mut rows = Vec::new();
    let mut failed = 0;
    for object in objects {
        let started = Instant::now();
        match one(arguments, &models, object, terminal) {
            Ok(mut row) => {
                row.push(format!("{:.1}", started.elapsed().as_secs_f64()));
                rows.push(row);
            }
            Err(Failure::BadInput(message)) => {
                failed += 1;
                terminal.warn(&format!("object {object} left out: {message}"));
            }
            Err(other) => return Err(other),
        }
    }
    terminal.print(&table(
        &[
            "object",
            "components",
            "bytes",
            "diameter (mm)",
            "covered %",
            "s",
        ],
        &[],
        &rows,
    ))?;
    if failed > 0 {
        return Err(Failure::BadInput(format!(
            "{} left out",
            plural(failed, "object")
        )));
    }
    Ok(())
}

fn one(
    arguments: &BopTrainArguments,
    models: &Models,
    object: u32,
    terminal: &Terminal,
) -> Result<Vec<String>, Failure> {
    let geometry = models.geometry(object)?;
    let mut options = TrainOptions::new(format!("obj_{object:06}"));
    options.unit = Unit::Millimetre;
    options.seed = arguments.seed;
    options.mean = arguments.mean.into();
    if options.mean == MeanForm::Map {
        options.budget = Some(MAP_BUDGET);
    }
    match arguments.budget {
        Some(BudgetArgument::Bytes(bytes)) => options.budget = Some(bytes),
        Some(BudgetArgument::None) => options.budget = None,
        None => {}
    }
    terminal.say(&format!("object {object}"));
    let source = models.path(object);
    let trained = train(&geometry, &options, terminal)
        .map_err(|error| Failure::BadInput(format!("{}: {error}", source.display())))?;
    let path = template_path(&arguments.output, object);
    let template =
        Template::from_bytes(&trained.bytes).map_err(|error| Failure::template(&path, &error))?;
    let diameter = f64::from(template.diameter());
    if diameter < SMALLEST_DIAMETER {
        terminal.warn(&format!(
            "{}: the model's diameter is {diameter:.3} mm, as of one in metres: BOP's are in mm",
            source.display()
        ));
    }
    if let Ok(info) = models.info(object)
        && (info.diameter / diameter - 1.0).abs() > DIAMETER
    {
        terminal.warn(&format!(
            "{}: the model's diameter is {diameter:.1} mm, models_info.json says {:.1}",
            source.display(),
            info.diameter
        ));
    }
    write_whole(&path, &trained.bytes)?;
    Ok(vec![
        object.to_string(),
        template.component_count().to_string(),
        trained.bytes.len().to_string(),
        format!("{diameter:.1}"),
        format!("{:.2}", 100.0 * trained.covered),
    ])
}
