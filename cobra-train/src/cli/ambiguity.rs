//! `cobra ambiguity`: poses that score as well as the true one although they are far from it.

mod arguments;
mod document;

pub(crate) use arguments::AmbiguityArguments;

use super::failure::Failure;
use super::outputs;
use super::report::JsonTarget;
use super::template_file;
use super::terminal::Terminal;
use cobra_infer::depth::DepthSettings;
use cobra_infer::template::DecodedTerm;
use cobra_infer::{Template, Unit};
use cobra_train::ambiguity::{AmbiguityError, SearchOptions, find_ambiguities};
use cobra_train::bop::dataset::read_model_info;
use cobra_train::bop::symmetry::Symmetries;
use cobra_train::depth::template_surface;
use cobra_train::surface::read_mesh;
use document::Found;
use std::path::Path;

pub(super) fn run(arguments: &AmbiguityArguments, terminal: &Terminal) -> Result<(), Failure> {
    let bytes = template_file::read(&arguments.template)?;
    let template = Template::from_bytes(&bytes)
        .map_err(|error| Failure::template(&arguments.template, &error))?;
    let mut room = vec![DecodedTerm::default(); template.decoded_len()];
    let template = template.decoded(&mut room).unwrap_or(template);
    let mut inputs: Vec<&Path> = vec![&arguments.template, &arguments.mesh];
    inputs.extend(arguments.models_info.as_deref());
    let outputs: Vec<&Path> = outputs::named_file(arguments.json.as_ref())
        .into_iter()
        .collect();
    outputs::check(&inputs, &outputs)?;
    let mesh = read_mesh(&arguments.mesh)?;
    let symmetries = symmetries(arguments, &template)?;

    let settings = DepthSettings::for_template(&template);
    let options = SearchOptions {
        views: arguments.views as usize,
        candidates: arguments.candidates as usize,
        masks: arguments.masks.into(),
        noise: f64::from(arguments.depth_noise) / f64::from(template.unit().millimetres()),
        seed: arguments.seed,
        ..SearchOptions::new(settings)
    };
    let ambiguities = template_surface(&template, &settings)
        .map_err(AmbiguityError::from)
        .and_then(|surface| {
            find_ambiguities(&mesh, surface, symmetries.as_ref(), &options, terminal)
        })
        .map_err(|error| {
            let template = arguments.template.display();
            Failure::BadInput(format!(
                "{template} with {}: {error}",
                arguments.mesh.display()
            ))
        })?;

    let found = Found {
        template: template.name(),
        millimetres: f64::from(template.unit().millimetres()),
        calibrated: settings.thresholds.is_some(),
        options: &options,
        symmetries: symmetries.as_ref(),
        ambiguities: &ambiguities,
    };
    let json = JsonTarget(arguments.json.as_ref());
    json.write(&found.document(), terminal)?;
    if json.replaces_the_table() {
        return Ok(());
    }
    terminal.print(&found.text())
}

/// What a data set states of the object, if it was named.
fn symmetries(
    arguments: &AmbiguityArguments,
    template: &Template<'_>,
) -> Result<Option<Symmetries>, Failure> {
    let Some((path, object)) = arguments.models_info.as_ref().zip(arguments.object) else {
        return Ok(None);
    };
    if template.unit() != Unit::Millimetre {
        return Err(Failure::BadInput(format!(
            "{}: expected lengths in mm as those of {}, found {}",
            arguments.template.display(),
            path.display(),
            template.unit().symbol()
        )));
    }
    Ok(Some(read_model_info(path, object)?.symmetries))
}
