//! A folder of templates: `obj_000001.cobra`, …, as `cobra bop train` writes them.

use super::objects::{listed, objects_in};
use super::score::{Checked, Surfaces};
use crate::depth::template_surface;
use crate::train::LARGEST_TEMPLATE;
use cobra_infer::depth::{DepthError, DepthSettings, Noise, TemplateSurface};
use cobra_infer::template::DecodedTerm;
use cobra_infer::{Template, TemplateError, Unit};
use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::Arc;

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
    /// There is no template of an object.
    #[error(
        "{}: expected obj_{object:06}.cobra for poses of object {object}, found templates of {known}",
        folder.display()
    )]
    UnknownObject {
        /// The templates' folder.
        folder: PathBuf,
        /// The object.
        object: u32,
        /// The objects that have one.
        known: String,
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
    /// It cannot be checked against depth.
    #[error("{}: {source}", path.display())]
    Depth {
        /// The file.
        path: PathBuf,
        /// Why not.
        source: DepthError,
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
    path: PathBuf,
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
            Err(source) if source.kind() == ErrorKind::NotFound && folder.is_dir() => {
                return Err(TemplateFileError::UnknownObject {
                    folder: folder.to_owned(),
                    object,
                    known: listed(&objects_in(folder, "cobra").unwrap_or_default()),
                });
            }
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
        Ok(Self { path, bytes, room })
    }

    /// The template, decoded where that makes it faster.
    ///
    /// # Panics
    /// Never: the bytes were checked when they were read.
    pub fn template(&mut self) -> Template<'_> {
        self.with_path().1
    }

    fn with_path(&mut self) -> (&Path, Template<'_>) {
        let template = Template::from_bytes(&self.bytes).expect("checked when it was read");
        let decoded = template.decoded(&mut self.room);
        (&self.path, decoded.unwrap_or(template))
    }
}

/// The templates of some objects.
#[derive(Debug)]
pub struct TemplateFolder {
    files: BTreeMap<u32, Result<TemplateFile, Arc<TemplateFileError>>>,
    noise_share: Option<f32>,
}

impl TemplateFolder {
    /// Reads the templates of these objects; what is wrong with one does not concern the others.
    #[must_use]
    pub fn read(folder: &Path, objects: impl IntoIterator<Item = u32>) -> Self {
        let read = |object| (object, TemplateFile::read(folder, object).map_err(Arc::new));
        Self {
            files: objects.into_iter().map(read).collect(),
            noise_share: None,
        }
    }

    /// The same with this share of each object's diameter for σ_m, in the place of what the templates record.
    /// Thresholds that a template has were found with its own.
    #[must_use]
    pub fn with_noise_share(mut self, share: f32) -> Self {
        self.noise_share = Some(share);
        self
    }

    /// Hands over the templates as surfaces, each with the noise and the thresholds that it records.
    pub fn with_surfaces<R>(
        &mut self,
        act: impl FnOnce(&Surfaces<TemplateSurface<'_, LARGEST_TEMPLATE>>) -> R,
    ) -> R {
        let noise_share = self.noise_share;
        let files = self.files.iter_mut();
        let templates: Vec<_> = files
            .map(|(object, file)| (*object, file.as_mut().map(TemplateFile::with_path)))
            .collect();
        let surfaces = templates
            .iter()
            .map(|(object, template)| {
                let surface = match template {
                    Ok((path, template)) => surface(path, template, noise_share).map_err(Arc::new),
                    Err(error) => Err(Arc::clone(error)),
                };
                (*object, surface)
            })
            .collect();
        act(&surfaces)
    }
}

fn surface<'t>(
    path: &Path,
    template: &'t Template<'t>,
    noise_share: Option<f32>,
) -> Result<Checked<TemplateSurface<'t, LARGEST_TEMPLATE>>, TemplateFileError> {
    let mut settings = DepthSettings::for_template(template);
    if let Some(share) = noise_share {
        settings.noise = Noise::Share(share);
    }
    let surface =
        template_surface(template, &settings).map_err(|source| TemplateFileError::Depth {
            path: path.to_owned(),
            source,
        })?;
    Ok(Checked { surface, settings })
}
