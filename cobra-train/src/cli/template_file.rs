//! Reading template files.

use super::failure::Failure;
use cobra_infer::TemplateError;
use cobra_infer::template::{HEADER_LENGTH, peek_len};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// The bytes of a template file, read only when its header and its size agree, so that a large
/// file that is no template is never loaded.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, Failure> {
    let io = |error: std::io::Error| Failure::Io(format!("{}: {error}", path.display()));
    // Before it is opened: opening a pipe waits for whoever writes to it.
    let metadata = path.metadata().map_err(io)?;
    if !metadata.is_file() {
        return Err(Failure::Io(format!(
            "{}: not a regular file",
            path.display()
        )));
    }
    let mut file = File::open(path).map_err(io)?;
    let mut bytes = Vec::new();
    (&mut file)
        .take(HEADER_LENGTH as u64)
        .read_to_end(&mut bytes)
        .map_err(io)?;
    let expected = peek_len(&bytes).map_err(|error| Failure::template(path, &error))?;
    let found = usize::try_from(metadata.len()).unwrap_or(usize::MAX);
    if found != expected {
        return Err(Failure::template(
            path,
            &TemplateError::Length { expected, found },
        ));
    }
    file.read_to_end(&mut bytes).map_err(io)?;
    Ok(bytes)
}
