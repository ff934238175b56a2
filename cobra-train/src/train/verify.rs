//! Where the components of a template may speak.
//!
//! Owns the step from a template to its validity: what is verified is what the controller's own code
//! predicts, in `f32`. The check itself is [`crate::validity`]'s.

use super::TrainError;
use super::assemble::{Frame, ScaledComponent, ScaledValidity};
use super::membership::Patch;
use crate::surface::{BoundingSphere, SurfacePoint};
use crate::validity::{ValidCells, sparsity, verify};
use cobra_infer::gp::UnitDirection;
use cobra_infer::template::Component;
use cobra_infer::validity::{BOX_STEPS, BoxGrid};
use cobra_infer::{Model, Template};
use nalgebra::{Point3, UnitVector3};
use rayon::prelude::*;

/// Where in a cell predictions are looked at, along each side, for the box around them.
const INSIDE: [f32; 4] = [0.01, 0.33, 0.67, 0.99];

/// The validity of each component, none for those that may speak nowhere.
pub(super) fn validities(
    frame: &Frame<'_>,
    scaled: &[ScaledComponent],
    patches: &[Patch],
    training: &[SurfacePoint],
    cell_width: f64,
) -> Result<Vec<Option<ScaledValidity>>, TrainError> {
    let bytes = frame.provisional(scaled)?;
    let template = Template::from_bytes(&bytes)?;
    let grid = BoxGrid::new(template.centre(), template.radius());
    let components: Vec<Component<'_>> = template.components().collect();
    let sparsity = sparsity(training.len());
    Ok(components
        .par_iter()
        .zip(patches)
        .map(|(component, patch)| {
            let own: Vec<SurfacePoint> = patch.own.iter().map(|&i| training[i]).collect();
            let speaker = Speaker {
                component,
                model: template.model(),
                sphere: frame.sphere,
            };
            let centre = patch.cluster.centre();
            let cells = verify(&centre, &own, |u| speaker.mean(u), sparsity, cell_width)?;
            let (low, high) = speaker.around(&centre, &cells, &grid)?;
            Some(ScaledValidity { cells, low, high })
        })
        .collect())
}

/// A component of a template, asked in the unit sphere.
struct Speaker<'a> {
    component: &'a Component<'a>,
    model: Model,
    sphere: &'a BoundingSphere,
}

impl Speaker<'_> {
    fn mean(&self, u: &UnitVector3<f64>) -> f64 {
        let u = UnitDirection::new_unchecked(u.cast::<f32>().into_inner());
        f64::from(self.component.posterior_mean(self.model, &u)) / self.sphere.radius
    }

    /// The box around what it predicts in valid cells, and a step more to every side: the cells are
    /// looked at in a few places only.
    fn around(
        &self,
        centre: &Point3<f64>,
        cells: &ValidCells,
        grid: &BoxGrid,
    ) -> Option<([u8; 3], [u8; 3])> {
        let mut ends: Option<([u8; 3], [u8; 3])> = None;
        for at in INSIDE
            .iter()
            .flat_map(|&row| INSIDE.map(|column| [column, row]))
        {
            for u in cells.directions(at) {
                let point = self.sphere.denormalise(&(centre + u.scale(self.mean(&u))));
                let position = grid.position(point.cast::<f32>().coords.into());
                let (low, high) = ends.get_or_insert((position, position));
                for ((low, high), position) in low.iter_mut().zip(high.iter_mut()).zip(position) {
                    *low = (*low).min(position);
                    *high = (*high).max(position);
                }
            }
        }
        let (low, high) = ends?;
        Some((
            low.map(|low| low.saturating_sub(1)),
            high.map(|high| (high + 1).min(BOX_STEPS - 1)),
        ))
    }
}
