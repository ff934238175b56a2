//! What a template covers of the surface, and what not.

use crate::evaluate::{
    OwnCloud, ResidualSummary, ShapeMetrics, TAU, TrueSurface, WronglyAccepted, evaluate,
    own_cloud, residuals, wrongly_accepted,
};
use crate::surface::Geometry;
use crate::train::{UncoveredRegion, regions};
use cobra_infer::{Assignment, ScoreError, Template};
use nalgebra::Point3;
use serde::Serialize;

/// Smaller shares are not worth a line.
const SMALLEST_SHARE: f64 = 0.001;

/// What a template covers.
#[derive(Clone, Debug, Serialize)]
pub struct Coverage {
    /// Percent of the surface with a residual of at most τ: of the object's where there is one, else what the
    /// template says that training found.
    pub covered: Option<f64>,
    /// The same as the template says that training found it.
    pub trained: Option<f64>,
    /// τ in millimetres: a hundredth of the bounding sphere's radius.
    pub tau_mm: f64,
    /// What was measured on the object.
    pub own: Option<Own>,
}

/// What was measured on the object.
#[derive(Clone, Debug, Serialize)]
pub struct Own {
    /// Points of its surface.
    pub points: usize,
    /// Chamfer distance, precision, recall, F.
    pub shape: ShapeMetrics,
    /// Magnitudes of the residuals in millimetres.
    pub residual_mm: ResidualSummary,
    /// Points that no component says anything about.
    pub unmatched: usize,
    /// Points off the surface that are taken for points on it.
    pub wrongly_accepted: WronglyAccepted,
    /// The template's own points; `None` for a template without validity.
    pub own_cloud: Option<OwnCloud>,
    /// Where the surface is not covered, the largest places first.
    pub regions: Vec<Region>,
    /// Percent of the surface in smaller places.
    pub scattered: f64,
}

/// A place that is not covered, in the object's frame and the template's unit.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Region {
    /// Its middle.
    pub centre: [f64; 3],
    /// How far it reaches from there.
    pub reach: f64,
    /// Percent of the surface.
    pub percent: f64,
}

impl From<&UncoveredRegion> for Region {
    fn from(region: &UncoveredRegion) -> Self {
        Self {
            centre: region.centre.into(),
            reach: region.reach,
            percent: 100.0 * region.share,
        }
    }
}

impl Coverage {
    /// With it, where there is an object, the percent of its surface that each component speaks for and covers.
    pub(super) fn new(
        template: &Template<'_>,
        assignment: Assignment,
        object: Option<(&Geometry, &[Point3<f64>])>,
        seed: u64,
    ) -> Result<(Self, Option<Vec<f64>>), ScoreError> {
        let millimetres = f64::from(template.unit().millimetres());
        let tau = TAU * f64::from(template.radius());
        let quality = template.quality();
        let trained = quality.map(|quality| 100.0 * f64::from(quality.covered));
        let Some((object, points)) = object else {
            let alone = Self {
                covered: trained,
                trained,
                tau_mm: tau * millimetres,
                own: None,
            };
            return Ok((alone, None));
        };
        let evaluation = evaluate(template, assignment, points)?;
        let percent = |count: usize| 100.0 * count as f64 / points.len().max(1) as f64;
        let mut spoken = vec![0_usize; template.component_count()];
        let covered = |residual: f64| residual.abs() <= tau;
        for point in evaluation
            .predicted
            .iter()
            .filter(|point| covered(point.residual))
        {
            spoken[point.component] += 1;
        }
        let open: Vec<Point3<f64>> = residuals(template, assignment, points)?
            .iter()
            .zip(points)
            .filter(|(found, _)| !found.is_some_and(|found| covered(f64::from(found.residual()))))
            .map(|(_, point)| *point)
            .collect();
        let all = regions(&open, points.len(), f64::from(template.radius()));
        let (large, small): (Vec<&UncoveredRegion>, Vec<&UncoveredRegion>) = all
            .iter()
            .partition(|region| region.share >= SMALLEST_SHARE);
        let surface = TrueSurface::new(object);
        let own = Own {
            points: points.len(),
            shape: evaluation.shape,
            residual_mm: evaluation.residual.scaled(millimetres),
            unmatched: evaluation.unmatched,
            wrongly_accepted: wrongly_accepted(template, assignment, &surface, points, seed)?,
            own_cloud: own_cloud(template, &surface, points),
            regions: large.into_iter().map(Region::from).collect(),
            scattered: 100.0 * small.iter().map(|region| region.share).sum::<f64>(),
        };
        let coverage = Self {
            covered: Some(evaluation.covered),
            trained,
            tau_mm: tau * millimetres,
            own: Some(own),
        };
        Ok((coverage, Some(spoken.into_iter().map(percent).collect())))
    }
}
