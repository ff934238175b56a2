//! Templates that several experiments ask for, trained once.

use super::PROTOCOL;
use super::bench::Bench;
use super::error::ExperimentError;
use super::subject::Subject;
use crate::output::write_whole;
use crate::progress::Silent;
use crate::surface::Mesh;
use crate::train::{TrainOptions, train};
use cobra_infer::Template;

/// What templates are called that nobody asks by name.
pub(super) const NAME: &str = "experiment";

/// The object's template under this project's defaults: the one that lies in the bench's folder `templates`,
/// else a new one, which then lies there.
pub(super) fn template(
    bench: &Bench<'_>,
    subject: &Subject,
    mesh: &Mesh,
) -> Result<Vec<u8>, ExperimentError> {
    let folder = bench.out.join("templates");
    let name = subject.key().replace('/', "-");
    let version = env!("CARGO_PKG_VERSION");
    let path = folder.join(format!("{name}-{version}-{PROTOCOL}-{}.cobra", bench.seed));
    let written = |path| {
        bench
            .written
            .lock()
            .is_ok_and(|written| written.contains(path))
    };
    if (!bench.fresh || written(&path))
        && let Ok(bytes) = std::fs::read(&path)
        && Template::from_bytes(&bytes).is_ok()
    {
        return Ok(bytes);
    }
    let options = TrainOptions {
        seed: bench.seed,
        ..TrainOptions::new(NAME)
    };
    let trained = trained(subject, mesh, &options)?;
    std::fs::create_dir_all(&folder).map_err(|source| ExperimentError::Folder {
        path: folder.clone(),
        source,
    })?;
    write_whole(&path, &trained)?;
    if let Ok(mut written) = bench.written.lock() {
        written.insert(path);
    }
    Ok(trained)
}

/// The bytes of a template that is trained anew.
pub(super) fn trained(
    subject: &Subject,
    mesh: &Mesh,
    options: &TrainOptions,
) -> Result<Vec<u8>, ExperimentError> {
    let trained = train(&mesh.clone().into(), options, &Silent);
    let trained = trained.map_err(|source| ExperimentError::Train {
        object: subject.name.clone(),
        source,
    })?;
    Ok(trained.bytes)
}
