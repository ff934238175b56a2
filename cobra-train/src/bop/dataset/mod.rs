//! A BOP data set's folder: scenes, true poses, images, models.
//!
//! Owns names and keys. Nothing is kept that was not asked for, and nothing of an image but its
//! entries in the scene's JSON files: caches are the caller's.

mod document;
mod error;
mod image;
mod models;
mod scene;
#[cfg(test)]
mod tests;

pub use error::DatasetError;
pub use image::{mask_in, read_depth, read_mask, read_photo, size_of};
pub use models::{ModelInfo, Models, read_model_info};
pub use scene::{Annotation, Scene};

use crate::input::{CameraFile, ImageSize, read_camera};
use std::path::{Path, PathBuf};

/// A data set and one of its splits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Dataset {
    root: PathBuf,
    split: PathBuf,
}

impl Dataset {
    /// The data set in the folder `root`, and its split of this name, `test` for instance.
    ///
    /// # Errors
    /// [`DatasetError::Io`] if there is no such split.
    pub fn open(root: &Path, split: &str) -> Result<Self, DatasetError> {
        let split = root.join(split);
        std::fs::read_dir(&split).map_err(|source| DatasetError::io(&split, source))?;
        Ok(Self {
            root: root.to_owned(),
            split,
        })
    }

    /// The split's folder, in which the scenes lie.
    #[must_use]
    pub fn split(&self) -> &Path {
        &self.split
    }

    /// The scene of this number.
    ///
    /// # Errors
    /// [`DatasetError`]: it has no `scene_camera.json`, or its JSON files are no JSON objects.
    pub fn scene(&self, id: u32) -> Result<Scene, DatasetError> {
        Scene::open(self.split.join(format!("{id:06}")), id)
    }

    /// Whether a scene has masks of its own: a folder `mask_visib`.
    #[must_use]
    pub fn has_masks(&self, scene: u32) -> bool {
        self.split.join(format!("{scene:06}/mask_visib")).is_dir()
    }

    /// The models of this folder, `models` or `models_eval` for instance.
    ///
    /// # Errors
    /// As [`Models::open`].
    pub fn models(&self, folder: &str) -> Result<Models, DatasetError> {
        Models::open(&self.root.join(folder))
    }

    /// The size of an image: that of `camera.json` in the data set's folder if it states one, else
    /// that of the image's own file among `depth`, `rgb`, `gray` and `mask_visib`.
    ///
    /// # Errors
    /// [`DatasetError`]: one of these files cannot be read, or there is none.
    pub fn image_size(&self, scene: &Scene, image: u32) -> Result<ImageSize, DatasetError> {
        let camera = self.root.join("camera.json");
        if camera.exists()
            && let CameraFile::One(one) = read_camera(&camera)?
            && let Some(size) = one.size
        {
            return Ok(size);
        }
        let name = format!("{image:06}.png");
        let files = [
            scene.depth_path(image),
            scene.folder().join("rgb").join(&name),
            scene.folder().join("gray").join(&name),
            scene.visible_mask_path(image, 0),
        ];
        match files.iter().find(|path| path.exists()) {
            Some(path) => image::size_of(path),
            None => Err(DatasetError::UnknownSize {
                camera,
                scene: scene.folder().to_owned(),
                image,
            }),
        }
    }
}

/// A key below a place in a document.
fn place_of(above: &str, key: &str) -> String {
    format!("{above}.{key}")
}
