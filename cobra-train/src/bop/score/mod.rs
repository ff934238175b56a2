//! Estimates of a results file against the data set's depth.
//!
//! Owns which pixels, which depth and which truth belong to an estimate, and that what is wrong with one
//! row or one image does not concern the others. The check itself is [`cobra_infer::depth`]'s.

mod document;
mod frame;
mod problem;
mod summary;
#[cfg(test)]
mod tests;
mod truth;

pub use document::ReportDocument;
pub use frame::{Frame, Frames};
pub use problem::Problem;
pub use summary::Summary;
pub use truth::{Errors, Truth};

use super::dataset::{Dataset, DatasetError};
use super::results::{PoseEstimate, Results};
use super::templates::TemplateFileError;
use crate::calibrate::Labelled;
use crate::depth::valid_pixels;
use crate::progress::Progress;
use cobra_infer::depth::{
    Cause, Cell, Correction, DepthCheck, DepthReport, DepthSettings, Observed, Surface,
};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use truth::Judge;

/// Which pixels show the object that an estimate is of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Masks {
    /// Those that masks in a folder say: `SSSSSS/mask_visib/IIIIII_GGGGGG.png` below it, or without
    /// `mask_visib`, of scene, image and annotation as BOP counts them. The data set's own lie below the
    /// split.
    Folder(PathBuf),
    /// Those in which the object is seen in the rendering of all objects at their true poses.
    Simulated,
    /// Those in which the estimate itself says that it is seen.
    Silhouette,
}

/// Where depth comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DepthSource {
    /// The data set's depth images.
    Sensor,
    /// A rendering of all annotated objects at their true poses, far where no object is.
    Simulated {
        /// Standard deviation of the noise along the camera's axis, in mm.
        noise: f64,
    },
}

/// How results are scored.
#[derive(Clone, Debug)]
pub struct ScoreOptions {
    /// Which pixels.
    pub masks: Masks,
    /// Which depth.
    pub depth: DepthSource,
    /// Of the noise.
    pub seed: u64,
    /// How many of a mask's pixels are used at most, spread evenly.
    pub pixels: usize,
}

impl ScoreOptions {
    /// Pixels of a mask that are used unless the caller says otherwise.
    pub const PIXELS: usize = 500;
}

/// What came of a row.
#[derive(Clone, Debug)]
pub struct Scored {
    /// Its index among [`Results::rows`].
    pub row: usize,
    /// The line of the file.
    pub line: u64,
    /// What it says, if it is an estimate.
    pub estimate: Option<PoseEstimate>,
    /// The score, or why there is none.
    pub outcome: Result<Outcome, Problem>,
    /// How far the estimate is from the truth; `None` where that is not published or the row is no pose, and
    /// otherwise why it is not known.
    pub truth: Result<Option<Truth>, Arc<DatasetError>>,
}

impl Scored {
    /// How far the estimate is from the truth, where that is known.
    #[must_use]
    pub fn known_truth(&self) -> Option<&Truth> {
        self.truth.as_ref().ok()?.as_ref()
    }

    /// Its confidence and whether it is right, where that is known and a threshold decides: with fewer than
    /// [`Outcome::minimum_points`] the answer is undecided, whatever the threshold.
    #[must_use]
    pub fn decided(&self) -> Option<Labelled> {
        let outcome = self.outcome.as_ref().ok()?;
        let enough = outcome.valid_pixels() >= outcome.minimum_points;
        let right = self.known_truth()?.is_right();
        enough.then_some(Labelled {
            confidence: outcome.report.confidence,
            right,
        })
    }
}

/// A score.
#[derive(Clone, Copy, Debug)]
pub struct Outcome {
    /// What the check came to.
    pub report: DepthReport,
    /// What refinement does to the pose.
    pub correction: Correction,
    /// Why it fits as it does.
    pub cause: Cause,
    /// With fewer valid pixels the confidence would be 0, [`DepthSettings::minimum_points`].
    pub minimum_points: u32,
    /// Whether a mask said which pixels show the object, rather than the estimate's own silhouette.
    pub masked: bool,
}

impl Outcome {
    /// [`valid_pixels`] of the report.
    #[must_use]
    pub fn valid_pixels(&self) -> u32 {
        valid_pixels(&self.report)
    }
}

/// What an object's estimates are checked against, and how.
#[derive(Clone, Debug)]
pub struct Checked<S> {
    /// Its surface, with the noise that likelihoods are made with.
    pub surface: S,
    /// All other settings.
    pub settings: DepthSettings,
}

/// The surface of each object, or why there is none.
pub type Surfaces<S> = BTreeMap<u32, Result<Checked<S>, Arc<TemplateFileError>>>;

/// Scores all rows, those of an image together; in the order of the file, whatever the number of threads.
///
/// An image's object without a mask, because it is not annotated there, is scored by the estimate's
/// silhouette.
#[must_use]
pub fn score_results<S: Surface + Sync + Send>(
    dataset: &Dataset,
    results: &Results,
    surfaces: &Surfaces<S>,
    options: &ScoreOptions,
    progress: &dyn Progress,
) -> Vec<Scored> {
    let mut images: BTreeMap<(u32, u32), Vec<(usize, PoseEstimate)>> = BTreeMap::new();
    let mut scored = Vec::with_capacity(results.rows.len());
    for (row, content) in results.rows.iter().enumerate() {
        match &content.estimate {
            Ok(estimate) => images
                .entry((estimate.scene_id, estimate.im_id))
                .or_default()
                .push((row, *estimate)),
            Err(error) => scored.push(Scored {
                row,
                line: content.line,
                estimate: None,
                outcome: Err(Problem::Row(error.clone())),
                truth: Ok(None),
            }),
        }
    }
    let frames = Frames::new(dataset, images.keys().map(|(scene, _)| *scene), options);
    let judge = Judge::new(dataset, surfaces.keys().copied());
    if let Some(info) = judge.missing_info().filter(|_| frames.have_truth()) {
        progress.warn(&format!(
            "{}: expected diameters and symmetries of the objects, found no such file: diameters are the \
             models' own, and errors those of objects without symmetries",
            info.display()
        ));
    }
    progress.start("scoring images", images.len() as u64);
    let judged: Vec<Vec<Scored>> = images
        .into_par_iter()
        .map(|((scene, image), estimates)| {
            let frame = frames.open(scene, image).map_err(Problem::Image);
            let of_image = estimates.into_iter().map(|(row, estimate)| Scored {
                row,
                line: results.rows[row].line,
                estimate: Some(estimate),
                outcome: frame
                    .as_ref()
                    .map_err(Problem::clone)
                    .and_then(|frame| score_one(frame, &estimate, surfaces, options)),
                truth: judge.truth(&frames, &estimate),
            });
            let of_image = of_image.collect();
            progress.step();
            of_image
        })
        .collect();
    progress.finish();
    scored.extend(judged.into_iter().flatten());
    scored.sort_by_key(|scored| scored.row);
    scored
}

fn score_one<S: Surface>(
    frame: &Frame,
    estimate: &PoseEstimate,
    surfaces: &Surfaces<S>,
    options: &ScoreOptions,
) -> Result<Outcome, Problem> {
    let Checked { surface, settings } = match surfaces.get(&estimate.obj_id) {
        Some(Ok(checked)) => checked,
        Some(Err(error)) => return Err(Problem::Template(Arc::clone(error))),
        None => {
            return Err(Problem::NoTemplate {
                object: estimate.obj_id,
            });
        }
    };
    let pose = estimate.pose().map_err(Problem::Pose)?;
    let middle = pose.to_camera(&surface.centre().into());
    let expected = frame.camera().project(&middle);
    let pixels = frame
        .pixels(estimate.obj_id, expected, options.pixels)
        .map_err(|error| Problem::Image(Arc::new(error)))?;
    let observed = match &pixels {
        Some(pixels) => Observed::Pixels(pixels),
        None => Observed::Silhouette,
    };
    let check = DepthCheck::new(surface, frame.camera(), settings);
    let mut cells = vec![Cell::EMPTY; settings.cells()];
    let report = check
        .and_then(|check| check.run(&pose, observed, frame.depth(), &mut cells, &mut || {}))
        .map_err(Problem::Check)?;
    let correction = Correction::between(&pose, &report.refined, surface.centre());
    Ok(Outcome {
        report,
        correction,
        cause: report.cause(&correction),
        minimum_points: settings.minimum_points,
        masked: pixels.is_some(),
    })
}
