//! How far an estimate is from the truth.

use super::frame::Frames;
use crate::bop::dataset::{Dataset, DatasetError, ModelInfo, Models};
use crate::bop::results::PoseEstimate;
use crate::bop::symmetry::{LARGEST_STEP, Symmetries};
use crate::pose::{ModelPoints, RIGHT, add, add_s, mspd, mssd};
use nalgebra::Isometry3;
use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::PathBuf;
use std::sync::Arc;

/// What the truth says of an estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Truth {
    /// The image does not show the object: the estimate is wrong, by no distance.
    Absent,
    /// It does.
    Present(Errors),
}

/// The errors of an estimate, in mm unless said otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// ADD.
    pub add: f64,
    /// ADD-S.
    pub add_s: f64,
    /// MSSD with the data set's symmetries.
    pub mssd: f64,
    /// MSSD as if the object had none.
    pub mssd_without: f64,
    /// MSPD with the data set's symmetries, in pixels.
    pub mspd: f64,
    /// MSPD as if the object had none, in pixels.
    pub mspd_without: f64,
    /// The object's diameter.
    pub diameter: f64,
    /// Whether the data set states a symmetry of the object.
    pub symmetric: bool,
}

impl Truth {
    /// The errors, where the object is there.
    #[must_use]
    pub fn errors(&self) -> Option<&Errors> {
        match self {
            Self::Absent => None,
            Self::Present(errors) => Some(errors),
        }
    }

    /// Whether the object is there and [`Errors::is_right`].
    #[must_use]
    pub fn is_right(&self) -> bool {
        self.errors().is_some_and(Errors::is_right)
    }
}

impl Errors {
    /// What the estimate is judged by: ADD-S of symmetric objects, ADD of others.
    #[must_use]
    pub fn error(&self) -> f64 {
        if self.symmetric { self.add_s } else { self.add }
    }

    /// Whether [`Errors::error`] is less than [`RIGHT`] times the diameter.
    #[must_use]
    pub fn is_right(&self) -> bool {
        self.error() < RIGHT * self.diameter
    }
}

/// What errors are measured on.
struct Measured {
    points: ModelPoints,
    symmetries: Vec<Isometry3<f64>>,
    symmetric: bool,
    diameter: f64,
}

/// What the truth is measured on: the models of `models_eval`, or of `models` where a data set has no others.
pub(super) struct Judge {
    objects: BTreeMap<u32, Result<Measured, Arc<DatasetError>>>,
    missing_info: Option<PathBuf>,
}

impl Judge {
    /// What is wrong with one object's model is told when its truth is asked for.
    pub(super) fn new(dataset: &Dataset, objects: impl Iterator<Item = u32>) -> Self {
        let models = match dataset.models("models_eval") {
            Err(DatasetError::Io { source, .. }) if source.kind() == ErrorKind::NotFound => {
                dataset.models("models")
            }
            models => models,
        };
        let models = models.map_err(Arc::new);
        let measured = |object| match &models {
            Ok(models) => measured(models, object).map_err(Arc::new),
            Err(error) => Err(Arc::clone(error)),
        };
        Self {
            objects: objects.map(|object| (object, measured(object))).collect(),
            missing_info: match &models {
                Ok(models) if !models.has_info() => Some(models.info_path()),
                _ => None,
            },
        }
    }

    /// The `models_info.json` that is not there: errors are then those of objects without symmetries.
    pub(super) fn missing_info(&self) -> Option<PathBuf> {
        self.missing_info.clone()
    }

    /// The errors against that annotation of the object in the image that is nearest; `None` where the truth
    /// is not published, and where the score tells why there is none: of an estimate that is no pose, and of an
    /// image without a camera.
    ///
    /// # Errors
    /// [`DatasetError`]: what is wrong with the object's model, or with the image's true poses.
    pub(super) fn truth(
        &self,
        frames: &Frames<'_>,
        estimate: &PoseEstimate,
    ) -> Result<Option<Truth>, Arc<DatasetError>> {
        let Ok(scene) = frames.scene(estimate.scene_id) else {
            return Ok(None);
        };
        let (Ok(camera), Ok(pose)) = (scene.camera(estimate.im_id), estimate.isometry()) else {
            return Ok(None);
        };
        if !scene.has_truth() {
            return Ok(None);
        }
        let annotations = scene.truth(estimate.im_id)?;
        let model = match self.objects.get(&estimate.obj_id) {
            Some(Ok(model)) => model,
            Some(Err(error)) => return Err(Arc::clone(error)),
            None => return Ok(None),
        };
        let (camera, points) = (camera.camera, model.points.points());
        let errors = annotations
            .iter()
            .filter(|annotation| annotation.obj_id == estimate.obj_id)
            .map(|annotation| {
                let truth = &annotation.pose;
                Errors {
                    add: add(points, truth, &pose),
                    add_s: add_s(&model.points, truth, &pose),
                    mssd: mssd(points, truth, &pose, &model.symmetries),
                    mssd_without: mssd(points, truth, &pose, &[]),
                    mspd: mspd(points, &camera, truth, &pose, &model.symmetries),
                    mspd_without: mspd(points, &camera, truth, &pose, &[]),
                    diameter: model.diameter,
                    symmetric: model.symmetric,
                }
            })
            .min_by(|a, b| a.error().total_cmp(&b.error()));
        Ok(Some(errors.map_or(Truth::Absent, Truth::Present)))
    }
}

/// An object's model with its diameter and symmetries; without a `models_info.json` with its own diameter and
/// without symmetries.
fn measured(models: &Models, object: u32) -> Result<Measured, DatasetError> {
    let geometry = models.geometry(object)?;
    let info = if models.has_info() {
        models.info(object)?
    } else {
        ModelInfo {
            diameter: geometry.diameter(),
            symmetries: Symmetries::default(),
        }
    };
    Ok(Measured {
        points: ModelPoints::of(&geometry),
        symmetric: !info.symmetries.is_none(),
        symmetries: info.symmetries.transformations(LARGEST_STEP),
        diameter: info.diameter,
    })
}
