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
    let opened = Opened::new(path)?;
    if opened.found == opened.expected {
        opened.finish(path)
    } else {
        Err(opened.wrong_length(path))
    }
}

/// The bytes of the template that a file starts with, and how many bytes lie behind it, which are
/// not read: flash goes on behind a template, and so does what was read out of it.
pub(crate) fn read_first(path: &Path) -> Result<(Vec<u8>, usize), Failure> {
    let opened = Opened::new(path)?;
    match opened.found.checked_sub(opened.expected) {
        Some(behind) => Ok((opened.finish(path)?, behind)),
        None => Err(opened.wrong_length(path)),
    }
}

/// A file of which the header is read.
struct Opened {
    file: File,
    header: Vec<u8>,
    /// Bytes that the header says.
    expected: usize,
    /// Bytes that the system says.
    found: usize,
}

impl Opened {
    fn new(path: &Path) -> Result<Self, Failure> {
        let io = |error| io(path, &error);
        // Before it is opened: opening a pipe waits for whoever writes to it.
        let metadata = path.metadata().map_err(io)?;
        if !metadata.is_file() {
            return Err(Failure::Io(format!(
                "{}: not a regular file",
                path.display()
            )));
        }
        let mut file = File::open(path).map_err(io)?;
        let mut header = Vec::new();
        (&mut file)
            .take(HEADER_LENGTH as u64)
            .read_to_end(&mut header)
            .map_err(io)?;
        Ok(Self {
            expected: peek_len(&header).map_err(|error| Failure::template(path, &error))?,
            found: usize::try_from(metadata.len()).unwrap_or(usize::MAX),
            file,
            header,
        })
    }

    /// As many bytes as the header says.
    fn finish(self, path: &Path) -> Result<Vec<u8>, Failure> {
        let rest = self.expected.saturating_sub(self.header.len());
        let mut bytes = self.header;
        self.file
            .take(rest as u64)
            .read_to_end(&mut bytes)
            .map_err(|error| io(path, &error))?;
        Ok(bytes)
    }

    fn wrong_length(&self, path: &Path) -> Failure {
        let (expected, found) = (self.expected, self.found);
        Failure::template(path, &TemplateError::Length { expected, found })
    }
}

fn io(path: &Path, error: &std::io::Error) -> Failure {
    Failure::Io(format!("{}: {error}", path.display()))
}
