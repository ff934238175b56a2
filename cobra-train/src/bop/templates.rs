//! A folder of templates: `obj_000001.cobra`, …, as `cobra bop train` writes them.

use cobra_infer::template::DecodedTerm;
use cobra_infer::{Template, TemplateError, Unit};
use std::path::{Path, PathBuf};

/// Why an object has no template that its estimates can be scored with.
#[derive(Debug, thiserror::Error)]
pub enum TemplateFileError {
    /// The file could not be read.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// It is no template.
    #[error("{}: {source}", path.display())]
    Template {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: TemplateError,
    },
    /// Its lengths are not in the unit of BOP's files.
    #[error("{}: expected lengths in mm, found {}", path.display(), found.symbol())]
    Unit {
        /// The file.
        path: PathBuf,
        /// The template's unit.
        found: Unit,
    },
}

/// The file of an object's template.
#[must_use]
pub fn template_path(folder: &Path, object: u32) -> PathBuf {
    folder.join(format!("obj_{object:06}.cobra"))
}

/// A template's bytes, and room for what makes it fast on a host.
#[derive(Debug)]
pub struct TemplateFile {
    bytes: Vec<u8>,
    room: Vec<DecodedTerm>,
}

impl TemplateFile {
    /// Reads the template of an object, and checks it.
    ///
    /// # Errors
    /// [`TemplateFileError`] names the file.
    pub fn read(folder: &Path, object: u32) -> Result<Self, TemplateFileError> {
        let path = template_path(folder, object);
        let bytes = match std::fs::read(&path) {
            Ok(bytes) => bytes,
            Err(source) => return Err(TemplateFileError::Io { path, source }),
        };
        let template = match Template::from_bytes(&bytes) {
            Ok(template) => template,
            Err(source) => return Err(TemplateFileError::Template { path, source }),
        };
        if template.unit() != Unit::Millimetre {
            let found = template.unit();
            return Err(TemplateFileError::Unit { path, found });
        }
        let room = vec![DecodedTerm::default(); template.decoded_len()];
        Ok(Self { bytes, room })
    }

    /// The template, decoded where that makes it faster.
    ///
    /// # Panics
    /// Never: the bytes were checked.
    pub fn template(&mut self) -> Template<'_> {
        let template = Template::from_bytes(&self.bytes).expect("checked when it was read");
        template.decoded(&mut self.room).unwrap_or(template)
    }
}
