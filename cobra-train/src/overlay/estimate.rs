//! One estimate as it is drawn.
//!
//! Owns that everything that a picture says of an estimate comes from one check with one set of pixels.

use crate::depth::{ResidualMap, spread};
use crate::depth_image::DepthImage;
use cobra_infer::depth::{
    Cause, Cell, Correction, DepthCheck, DepthError, DepthPixel, DepthReport, DepthSettings,
    Observed, Surface, Thresholds,
};
use cobra_infer::{Camera, Pose, Unit};
use nalgebra::{Point2, Point3};

/// An estimate, what the check says of it, and where the image speaks for or against it.
#[derive(Clone, Debug)]
pub struct OverlayEstimate {
    /// What it is called in the picture.
    pub name: String,
    /// What the check came to.
    pub report: DepthReport,
    /// Why it fits as it does.
    pub cause: Cause,
    /// What the confidence is decided by, where that is known.
    pub thresholds: Option<Thresholds>,
    /// The object's diameter.
    pub diameter: f32,
    /// The unit of all lengths.
    pub unit: Unit,
    /// Whether a mask said which pixels show the object.
    pub masked: bool,
    /// The residuals.
    pub residuals: ResidualMap,
    /// The edges of the object's box, aligned with its frame, in the image; those that lie in front of the
    /// camera whole.
    pub edges: Vec<[Point2<f32>; 2]>,
}

/// What estimates of an image are checked with.
#[derive(Clone, Copy, Debug)]
pub struct Evidence<'a> {
    /// The camera.
    pub camera: &'a Camera,
    /// What it measured.
    pub depth: &'a DepthImage,
    /// The pixels that show the object; without, the estimate's own silhouette counts.
    pub pixels: Option<&'a [DepthPixel]>,
    /// At most so many of them go into the check, spread evenly; all are drawn.
    pub most: usize,
}

impl OverlayEstimate {
    /// Checks a pose of a surface.
    ///
    /// # Errors
    /// [`DepthError`], as [`DepthCheck::new`].
    pub fn of(
        name: String,
        surface: &impl Surface,
        unit: Unit,
        pose: &Pose,
        settings: &DepthSettings,
        evidence: &Evidence<'_>,
    ) -> Result<Self, DepthError> {
        let &Evidence {
            camera,
            depth,
            pixels,
            most,
        } = evidence;
        let check = DepthCheck::new(surface, camera, settings)?;
        let mut cells = vec![Cell::EMPTY; settings.cells()];
        let checked = pixels.map(|pixels| spread(pixels, most));
        let observed = checked
            .as_deref()
            .map_or(Observed::Silhouette, Observed::Pixels);
        let report = check.run(pose, observed, depth, &mut cells, &mut || {})?;
        let correction = Correction::between(pose, &report.refined, surface.centre());
        Ok(Self {
            name,
            report,
            cause: report.cause(&correction),
            thresholds: settings.thresholds,
            diameter: surface.diameter(),
            unit,
            masked: pixels.is_some(),
            residuals: ResidualMap::of(surface, camera, settings, pose, pixels, depth)?,
            edges: edges(surface, camera, pose),
        })
    }

    /// Everything of it in the image or beside it: the box, the surface, the observed pixels.
    pub(super) fn outline(&self) -> Vec<Point2<f32>> {
        let mut points: Vec<_> = self.edges.iter().flatten().copied().collect();
        points.extend(self.residuals.surface.iter().map(|point| point.pixel));
        let observed = self.residuals.pixels.iter();
        points.extend(observed.map(|(pixel, _)| pixel.pixel()));
        points
    }
}

/// How far apart the points lie that the box is put around, as a share of the radius.
const BOX_SPACING: f32 = 0.05;

/// The edges of the box around the surface.
fn edges(surface: &impl Surface, camera: &Camera, pose: &Pose) -> Vec<[Point2<f32>; 2]> {
    let mut bounds: Option<(Point3<f32>, Point3<f32>)> = None;
    surface.sample(BOX_SPACING * surface.radius(), &mut |point| {
        let Some(point) = point else {
            return;
        };
        let (low, high) = bounds.unwrap_or((*point, *point));
        bounds = Some((low.inf(point), high.sup(point)));
    });
    let Some((low, high)) = bounds else {
        return Vec::new();
    };
    let corner = |index: usize| {
        let side = |bit: usize, axis: usize| {
            if index & bit == 0 {
                low[axis]
            } else {
                high[axis]
            }
        };
        camera.project(&pose.to_camera(&Point3::new(side(1, 0), side(2, 1), side(4, 2))))
    };
    let ends = (0..8).flat_map(|from| [1, 2, 4].map(|bit| (from, from | bit)));
    ends.filter(|(from, to)| from != to)
        .filter_map(|(from, to)| Some([corner(from)?, corner(to)?]))
        .collect()
}
