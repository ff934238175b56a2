//! How far an estimate is from the truth.

use super::frame::Frames;
use crate::bop::dataset::Dataset;
use crate::bop::results::PoseEstimate;
use crate::bop::symmetry::LARGEST_STEP;
use crate::pose::{ModelPoints, add, add_s, mspd, mssd};
use nalgebra::Isometry3;
use std::collections::BTreeMap;

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
    /// Right is what is off by less than this share of the diameter.
    pub const RIGHT: f64 = 0.1;

    /// What the estimate is judged by: ADD-S of symmetric objects, ADD of others.
    #[must_use]
    pub fn error(&self) -> f64 {
        if self.symmetric { self.add_s } else { self.add }
    }

    /// Whether [`Errors::error`] is less than [`Errors::RIGHT`] times the diameter.
    #[must_use]
    pub fn is_right(&self) -> bool {
        self.error() < Self::RIGHT * self.diameter
    }
}

/// What errors are measured on.
struct Measured {
    points: ModelPoints,
    symmetries: Vec<Isometry3<f64>>,
    symmetric: bool,
    diameter: f64,
}

/// The models of all objects of which there are some: those of `models_eval`, or of `models` where a data
/// set has no others.
pub(super) struct Judge {
    objects: BTreeMap<u32, Measured>,
}

impl Judge {
    pub(super) fn new(dataset: &Dataset, objects: impl Iterator<Item = u32>) -> Self {
        let models = dataset
            .models("models_eval")
            .or_else(|_| dataset.models("models"));
        let Ok(models) = models else {
            return Self {
                objects: BTreeMap::new(),
            };
        };
        let measured = |object| {
            let info = models.info(object).ok()?;
            Some(Measured {
                points: ModelPoints::of(&models.geometry(object).ok()?),
                symmetric: !info.symmetries.is_none(),
                symmetries: info.symmetries.transformations(LARGEST_STEP),
                diameter: info.diameter,
            })
        };
        Self {
            objects: objects
                .filter_map(|object| Some((object, measured(object)?)))
                .collect(),
        }
    }

    /// The errors against that annotation of the object in the image that is nearest; `None` where nothing
    /// is known of the image or the object.
    pub(super) fn truth(&self, frames: &Frames<'_>, estimate: &PoseEstimate) -> Option<Truth> {
        let model = self.objects.get(&estimate.obj_id)?;
        let scene = frames.scene(estimate.scene_id).ok()?;
        let camera = scene.camera(estimate.im_id).ok()?.camera;
        let annotations = scene.truth(estimate.im_id).ok()?;
        let pose = estimate.isometry().ok()?;
        let points = model.points.points();
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
        Some(errors.map_or(Truth::Absent, Truth::Present))
    }
}
