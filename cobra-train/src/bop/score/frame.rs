//! What an image gives to score its estimates with: camera, depth, and which pixels show what.

use super::{DepthSource, Masks, ScoreOptions};
use crate::bop::dataset::{Annotation, Dataset, DatasetError, Models, Scene, mask_in};
use crate::bop::render::{DepthNoise, PlacedModel, RenderModel, SimulatedFrame, render};
use crate::depth_image::DepthImage;
use crate::input::ImageSize;
use crate::pixel_mask::PixelMask;
use crate::surface::Geometry;
use cobra_infer::Camera;
use cobra_infer::depth::DepthPixel;
use nalgebra::Point2;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex};

/// The scenes that results are of, and the models that are rendered.
pub struct Frames<'d> {
    dataset: &'d Dataset,
    options: ScoreOptions,
    scenes: BTreeMap<u32, Result<Scene, Arc<DatasetError>>>,
    models: Result<Models, Arc<DatasetError>>,
    /// Prepared when they are first seen.
    rendered: Mutex<BTreeMap<u32, Prepared>>,
}

type Prepared = Result<Arc<RenderModel>, Arc<DatasetError>>;

/// An image: its camera, its depth, and which pixels show what.
pub struct Frame {
    camera: Camera,
    size: ImageSize,
    annotations: Vec<Annotation>,
    /// The sensor's, where it counts.
    measured: Option<DepthImage>,
    /// All annotated objects, where their depth or the pixels that show them count.
    rendering: Option<SimulatedFrame>,
    masks: MaskSource,
}

enum MaskSource {
    Folder {
        folder: PathBuf,
        scene: u32,
        image: u32,
    },
    Rendering,
    None,
}

impl<'d> Frames<'d> {
    /// Opens the scenes; what is wrong with one is told when it is asked for.
    #[must_use]
    pub fn new(
        dataset: &'d Dataset,
        scenes: impl Iterator<Item = u32>,
        options: &ScoreOptions,
    ) -> Self {
        let mut opened = BTreeMap::new();
        for id in scenes {
            opened
                .entry(id)
                .or_insert_with(|| dataset.scene(id).map_err(Arc::new));
        }
        Self {
            dataset,
            options: options.clone(),
            scenes: opened,
            models: dataset.models("models").map_err(Arc::new),
            rendered: Mutex::default(),
        }
    }

    pub(super) fn scene(&self, id: u32) -> Result<&Scene, Arc<DatasetError>> {
        match self.scenes.get(&id) {
            Some(Ok(scene)) => Ok(scene),
            Some(Err(error)) => Err(Arc::clone(error)),
            // All scenes of the results were opened.
            None => unreachable!("scene {id} was not among the results' scenes"),
        }
    }

    /// Whether the truth of a scene is published.
    pub(super) fn have_truth(&self) -> bool {
        let mut opened = self.scenes.values().flatten();
        opened.any(Scene::has_truth)
    }

    /// Everything of an image that scoring needs.
    ///
    /// # Errors
    /// [`DatasetError`]: what is wrong with the image, its scene, or the models that are rendered.
    ///
    /// # Panics
    /// If the scene was not among those that were opened.
    pub fn open(&self, scene_id: u32, image: u32) -> Result<Frame, Arc<DatasetError>> {
        let scene = self.scene(scene_id)?;
        let camera = scene.camera(image)?.camera;
        let size = self.dataset.image_size(scene, image)?;
        let simulated_depth = matches!(self.options.depth, DepthSource::Simulated { .. });
        let rendered = simulated_depth || self.options.masks == Masks::Simulated;
        let counted = rendered || self.options.masks != Masks::Silhouette;
        let annotations = if counted {
            scene.truth(image)?
        } else {
            Vec::new()
        };
        let mut rendering = None;
        if rendered {
            rendering = Some(self.render(&camera, size, &annotations)?);
        }
        let mut measured = None;
        match self.options.depth {
            DepthSource::Sensor => measured = Some(scene.depth(image, size)?),
            DepthSource::Simulated { noise } => {
                let noise = DepthNoise {
                    standard_deviation: noise,
                    seed: self.options.seed,
                    scene: scene_id,
                    image,
                };
                rendering = rendering.map(|frame| frame.with_noise(&noise));
            }
        }
        let masks = match &self.options.masks {
            Masks::Folder(folder) => MaskSource::Folder {
                folder: folder.clone(),
                scene: scene_id,
                image,
            },
            Masks::Simulated => MaskSource::Rendering,
            Masks::Silhouette => MaskSource::None,
        };
        Ok(Frame {
            camera,
            size,
            annotations,
            measured,
            rendering,
            masks,
        })
    }

    fn render(
        &self,
        camera: &Camera,
        size: ImageSize,
        annotations: &[Annotation],
    ) -> Result<SimulatedFrame, Arc<DatasetError>> {
        let models = annotations
            .iter()
            .map(|annotation| self.model(annotation.obj_id))
            .collect::<Result<Vec<_>, _>>()?;
        let placed: Vec<PlacedModel<'_>> = models
            .iter()
            .zip(annotations)
            .map(|(model, annotation)| PlacedModel {
                model,
                pose: annotation.pose,
            })
            .collect();
        Ok(render(camera, size, &placed))
    }

    /// An object's model, prepared once.
    fn model(&self, object: u32) -> Prepared {
        let models = self.models.as_ref().map_err(Arc::clone)?;
        let mut rendered = self
            .rendered
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner);
        rendered
            .entry(object)
            .or_insert_with(|| match models.geometry(object) {
                Ok(Geometry::Mesh(mesh)) => Ok(Arc::new(RenderModel::new(&mesh))),
                Ok(Geometry::Cloud(_)) => Err(Arc::new(DatasetError::NoFaces {
                    path: models.path(object),
                })),
                Err(error) => Err(Arc::new(error)),
            })
            .clone()
    }
}

impl Frame {
    /// The camera that took it.
    #[must_use]
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The depth that counts: measured or simulated, as the options say.
    ///
    /// # Panics
    /// Never: one of both is there.
    #[must_use]
    pub fn depth(&self) -> &DepthImage {
        let rendered = self.rendering.as_ref().map(SimulatedFrame::depth);
        // One of both is there: `open` reads or renders.
        self.measured.as_ref().or(rendered).expect("depth")
    }

    /// At most `most` of the pixels that show an object, spread evenly; of several of its kind, the one
    /// whose pixels lie around where it is expected. `None` where no mask says.
    ///
    /// # Errors
    /// [`DatasetError`]: what is wrong with a mask.
    pub fn pixels(
        &self,
        object: u32,
        expected: Option<Point2<f32>>,
        most: usize,
    ) -> Result<Option<Vec<DepthPixel>>, DatasetError> {
        let mut nearest: Option<(f32, PixelMask)> = None;
        for (index, annotation) in self.annotations.iter().enumerate() {
            if annotation.obj_id != object {
                continue;
            }
            let Some(mask) = self.mask(index)? else {
                return Ok(None);
            };
            let away = distance(&mask, expected);
            if nearest.as_ref().is_none_or(|(least, _)| away < *least) {
                nearest = Some((away, mask));
            }
        }
        let Some((_, mask)) = nearest else {
            return Ok(None);
        };
        Ok(Some(self.depth().pixels_in(&mask, most)))
    }

    fn mask(&self, annotation: usize) -> Result<Option<PixelMask>, DatasetError> {
        match (&self.masks, &self.rendering) {
            (
                MaskSource::Folder {
                    folder,
                    scene,
                    image,
                },
                _,
            ) => mask_in(folder, *scene, *image, annotation, self.size).map(Some),
            (MaskSource::Rendering, Some(frame)) => Ok(Some(frame.visible(annotation))),
            _ => Ok(None),
        }
    }
}

/// How far the middle of a mask is from where an object is expected, in pixels.
fn distance(mask: &PixelMask, expected: Option<Point2<f32>>) -> f32 {
    let (mut sum, mut count) = (Point2::new(0.0_f32, 0.0), 0.0_f32);
    for (column, row) in mask.pixels() {
        sum.x += column as f32;
        sum.y += row as f32;
        count += 1.0;
    }
    match expected {
        Some(expected) if count > 0.0 => (sum / count - expected).norm(),
        _ => f32::MAX,
    }
}
