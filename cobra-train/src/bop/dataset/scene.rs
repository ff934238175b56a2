//! A scene: images of one camera path, their cameras and true poses, by their ids.

use super::document::{Document, Entry};
use super::image::{read_depth, read_mask, read_photo};
use super::{DatasetError, place_of};
use crate::demo::RgbImage;
use crate::depth_image::DepthImage;
use crate::input::json::{Misfit, exact_numbers};
use crate::input::{ImageCamera, ImageSize, image_camera};
use crate::pixel_mask::PixelMask;
use crate::pose::nearest_pose;
use nalgebra::Isometry3;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// A scene's folder, `000002` for scene 2. Images are read when they are asked for; what is wrong
/// with one does not concern the others.
#[derive(Clone, Debug)]
pub struct Scene {
    folder: PathBuf,
    id: u32,
    cameras: Document,
    truth: Option<Document>,
}

/// One object in an image, at its true pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Annotation {
    /// The object.
    pub obj_id: u32,
    /// Its pose, object to camera, in millimetres; the rotation is the nearest to the file's matrix.
    pub pose: Isometry3<f64>,
}

impl Scene {
    pub(super) fn open(folder: PathBuf, id: u32) -> Result<Self, DatasetError> {
        Ok(Self {
            cameras: Document::read(folder.join("scene_camera.json"))?,
            truth: Document::read_if_there(folder.join("scene_gt.json"))?,
            folder,
            id,
        })
    }

    /// The scene's number.
    #[must_use]
    pub fn id(&self) -> u32 {
        self.id
    }

    /// Where the scene lies.
    #[must_use]
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The images that have a camera, in rising order.
    #[must_use]
    pub fn images(&self) -> Vec<u32> {
        self.cameras.ids()
    }

    /// Whether there is a `scene_gt.json`: of some test images the truth is not published.
    #[must_use]
    pub fn has_truth(&self) -> bool {
        self.truth.is_some()
    }

    /// An image's intrinsics and depth scale, from `scene_camera.json`.
    ///
    /// # Errors
    /// [`DatasetError`] names the file, the image and the key.
    pub fn camera(&self, image: u32) -> Result<ImageCamera, DatasetError> {
        let entry = self.cameras.entry("image", image)?;
        Ok(image_camera(entry.path, entry.key, entry.value)?)
    }

    /// All annotated objects of an image, in the order of `scene_gt.json`, which is that of the
    /// masks' numbers.
    ///
    /// # Errors
    /// [`DatasetError`] names the file, the image and the key.
    pub fn truth(&self, image: u32) -> Result<Vec<Annotation>, DatasetError> {
        let Some(truth) = &self.truth else {
            let missing = std::io::ErrorKind::NotFound.into();
            return Err(DatasetError::io(
                &self.folder.join("scene_gt.json"),
                missing,
            ));
        };
        let Entry { path, key, value } = truth.entry("image", image)?;
        let list = value
            .as_array()
            .ok_or_else(|| DatasetError::form(path, Misfit::new(key, "a list of poses", value)))?;
        let entries = list.iter().enumerate();
        entries
            .map(|(index, entry)| annotation(path, &format!("{key}[{index}]"), entry))
            .collect()
    }

    /// The file of an image's depth.
    #[must_use]
    pub fn depth_path(&self, image: u32) -> PathBuf {
        self.folder.join(format!("depth/{image:06}.png"))
    }

    /// An image's measured depth: its 16-bit values times `depth_scale`, in millimetres.
    ///
    /// # Errors
    /// [`DatasetError`]: no such file, another size than `size`, no 16-bit grey PNG, or no
    /// `depth_scale` in the camera.
    pub fn depth(&self, image: u32, size: ImageSize) -> Result<DepthImage, DatasetError> {
        let entry = self.cameras.entry("image", image)?;
        let scale = self.camera(image)?.depth_scale.ok_or_else(|| {
            let place = place_of(entry.key, "depth_scale");
            let misfit = Misfit::new(place, "a number greater than 0", &Value::Null);
            DatasetError::form(entry.path, misfit)
        })?;
        read_depth(&self.depth_path(image), size, scale)
    }

    /// The photograph of an image: its PNG in `rgb`, else in `gray`; `None` where there is neither.
    ///
    /// # Errors
    /// [`DatasetError`]: another size than `size`, or no PNG.
    pub fn photo(&self, image: u32, size: ImageSize) -> Result<Option<RgbImage>, DatasetError> {
        let paths = ["rgb", "gray"].map(|name| self.folder.join(format!("{name}/{image:06}.png")));
        let path = paths.iter().find(|path| path.exists());
        path.map(|path| read_photo(path, size)).transpose()
    }

    /// The file of the mask of the pixels that show an annotated object, counted as in
    /// [`Scene::truth`].
    #[must_use]
    pub fn visible_mask_path(&self, image: u32, annotation: usize) -> PathBuf {
        self.folder
            .join(format!("mask_visib/{image:06}_{annotation:06}.png"))
    }

    /// The pixels that show an annotated object, counted as in [`Scene::truth`].
    ///
    /// # Errors
    /// [`DatasetError`]: no such file, another size than `size`, or no 8-bit grey PNG.
    pub fn visible_mask(
        &self,
        image: u32,
        annotation: usize,
        size: ImageSize,
    ) -> Result<PixelMask, DatasetError> {
        read_mask(&self.visible_mask_path(image, annotation), size)
    }
}

fn annotation(path: &Path, place: &str, entry: &Value) -> Result<Annotation, DatasetError> {
    let form = |misfit| DatasetError::form(path, misfit);
    let value = entry.get("obj_id").unwrap_or(&Value::Null);
    let id = value.as_u64().and_then(|id| u32::try_from(id).ok());
    let obj_id = id.ok_or_else(|| {
        let misfit = Misfit::new(place_of(place, "obj_id"), "a whole number", value);
        form(misfit)
    })?;
    let r = exact_numbers::<9>(place, entry, "cam_R_m2c", "9 numbers").map_err(form)?;
    let t = exact_numbers::<3>(place, entry, "cam_t_m2c", "3 numbers").map_err(form)?;
    let pose = nearest_pose(r, t).map_err(|source| DatasetError::Pose {
        path: path.to_owned(),
        place: place.to_owned(),
        source,
    })?;
    Ok(Annotation { obj_id, pose })
}
