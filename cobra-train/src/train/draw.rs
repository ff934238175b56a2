//! The points that a template is trained and tested on.
//!
//! Owns which of the ways to draw points is used for which of them, and nothing of how it is done:
//! that is `surface`'s work. All points are in the unit sphere.

use super::{TrainError, TrainOptions};
use crate::random::Purpose;
use crate::reference::Cluster;
use crate::surface::{
    BoundingSphere, Mesh, RayCaster, sample_from_within, sample_poisson, sample_visible,
};
use nalgebra::Point3;

/// How training points are drawn. Test points are always what cameras see: that is what will be
/// scored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SurfaceSampling {
    /// First hits of rays from cameras around the object, as the paper.
    #[default]
    Cameras,
    /// Poisson-disk points: evenly spread on all faces, also on those that no camera sees.
    Poisson,
    /// First hits of evenly spread rays from each reference point; these are placed on points that
    /// cameras see.
    ReferencePoints,
}

/// A surface that points can be drawn on.
pub(super) struct Surface {
    mesh: Mesh,
    caster: RayCaster,
}

pub(super) struct Drawn {
    /// What reference points are placed on.
    pub(super) training: Vec<Point3<f64>>,
    /// What σ̂ is measured on.
    pub(super) test: Vec<Point3<f64>>,
}

impl Surface {
    pub(super) fn new(mesh: &Mesh, sphere: &BoundingSphere) -> Self {
        let mesh = mesh.normalised(sphere);
        Self {
            caster: RayCaster::new(&mesh),
            mesh,
        }
    }

    /// Training and test points, before there are reference points.
    pub(super) fn draw(&self, options: &TrainOptions) -> Result<Drawn, TrainError> {
        let mut training: Vec<Point3<f64>> = sample_visible(
            &self.mesh,
            &self.caster,
            options.points + options.test_points,
            options.seed,
            Purpose::Training,
        )?
        .into_iter()
        .map(|point| point.position)
        .collect();
        let test = training.split_off(options.points);
        if options.sampling == SurfaceSampling::Poisson {
            training = sample_poisson(&self.mesh, options.points, options.seed);
        }
        Ok(Drawn { training, test })
    }

    /// The training points, once there are reference points: `drawn` unless they are to be seen
    /// from these.
    pub(super) fn redraw(
        &self,
        drawn: Vec<Point3<f64>>,
        clusters: &[Cluster],
        options: &TrainOptions,
    ) -> Result<Vec<Point3<f64>>, TrainError> {
        match options.sampling {
            SurfaceSampling::Cameras | SurfaceSampling::Poisson => Ok(drawn),
            SurfaceSampling::ReferencePoints => {
                let centres: Vec<_> = clusters.iter().map(Cluster::centre).collect();
                Ok(sample_from_within(
                    &self.caster,
                    &centres,
                    options.points,
                    options.seed,
                )?)
            }
        }
    }
}
