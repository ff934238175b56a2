//! What is settled about outputs before any work is done.

use super::failure::Failure;
use cobra_train::output::check_writable;
use std::path::{Path, PathBuf};

/// Refuses an output that is also an input or another output, and one that cannot be written.
pub(super) fn check(inputs: &[&Path], outputs: &[&Path]) -> Result<(), Failure> {
    for (index, output) in outputs.iter().enumerate() {
        let others = inputs.iter().chain(&outputs[..index]);
        for (other, role) in others.zip(roles(inputs.len())) {
            if same_file(other, output) {
                return Err(Failure::Usage(format!(
                    "{} is both {role} and an output",
                    output.display()
                )));
            }
        }
        check_writable(output)?;
    }
    Ok(())
}

/// What is read of a data set: not all of its folder, where results may lie too.
pub(super) fn read_of(dataset: &Path, split: &str) -> Vec<PathBuf> {
    let read = [split, "models", "models_eval", "camera.json"];
    read.map(|name| dataset.join(name)).to_vec()
}

/// Refuses an output that would replace what lies in a folder that is read.
pub(super) fn check_folders(folders: &[PathBuf], outputs: &[&Path]) -> Result<(), Failure> {
    for output in outputs {
        let Ok(file) = output.canonicalize() else {
            continue;
        };
        let read = |folder: &&PathBuf| {
            let folder = folder.canonicalize();
            file.is_file() && folder.is_ok_and(|folder| file.starts_with(folder))
        };
        if let Some(folder) = folders.iter().find(read) {
            return Err(Failure::Usage(format!(
                "{} would be replaced, and lies in {}, which is an input",
                output.display(),
                folder.display()
            )));
        }
    }
    Ok(())
}

/// The file that an option names, if it names one rather than standard output.
pub(super) fn named_file(option: Option<&PathBuf>) -> Option<&Path> {
    option
        .map(PathBuf::as_path)
        .filter(|path| *path != Path::new("-"))
}

fn roles(inputs: usize) -> impl Iterator<Item = &'static str> {
    std::iter::repeat_n("an input", inputs).chain(std::iter::repeat("another output"))
}

/// The same file, by whatever name.
fn same_file(a: &Path, b: &Path) -> bool {
    let resolved = |path: &Path| {
        path.canonicalize()
            .or_else(|_| std::path::absolute(path))
            .unwrap_or_else(|_| path.to_owned())
    };
    resolved(a) == resolved(b)
}
