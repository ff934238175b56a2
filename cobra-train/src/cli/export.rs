//! `cobra export`: a template as a file, as Rust or as C.

use super::args::ExportArguments;
use super::choices::ExportFormat;
use super::failure::Failure;
use super::outputs;
use super::report::plural;
use super::template_file;
use super::terminal::Terminal;
use cobra_infer::{Template, TemplateError};
use cobra_train::export::{Identifier, c_header, rust_source};
use cobra_train::output::write_whole;

pub(super) fn run(arguments: &ExportArguments, terminal: &Terminal) -> Result<(), Failure> {
    let path = &arguments.template;
    if arguments.format == ExportFormat::Bin && arguments.name.is_some() {
        return Err(Failure::Usage(
            "--name is for rust and c: in a file of its own a template has the object's name"
                .to_owned(),
        ));
    }
    let (bytes, behind) = template_file::read_first(path)?;
    let refused = |error: TemplateError| Failure::template(path, &error);
    let template = Template::from_bytes(&bytes).map_err(refused)?;
    let output = outputs::named_file(arguments.output.as_ref());
    match output {
        Some(output) => outputs::check(&[path], &[output])?,
        None if arguments.format == ExportFormat::Bin && terminal.is_shown() => {
            return Err(Failure::Usage(
                "bin is no text for a terminal: name a file with -o, or write to a pipe".to_owned(),
            ));
        }
        None => {}
    }
    let name = arguments
        .name
        .clone()
        .unwrap_or_else(|| Identifier::of_object(template.name()));
    let (content, called) = match arguments.format {
        ExportFormat::Bin => (bytes.clone(), None),
        ExportFormat::Rust => (
            rust_source(&bytes, &name).map_err(refused)?.into_bytes(),
            Some(name.capitals()),
        ),
        ExportFormat::C => (
            c_header(&bytes, &name).map_err(refused)?.into_bytes(),
            Some(name.to_string()),
        ),
    };
    if behind > 0 {
        terminal.say(&format!(
            "note: {}: the template has {} bytes, {behind} behind it are left out",
            path.display(),
            bytes.len()
        ));
    }
    let Some(output) = output else {
        return terminal.write(&content);
    };
    write_whole(output, &content)?;
    let called = called.map_or_else(String::new, |called| format!("{called}, "));
    terminal.say(&format!(
        "{}: {called}{}",
        output.display(),
        plural(bytes.len(), "byte")
    ));
    Ok(())
}
