//! What is told of what was found: errors, and whether it was stated.

use super::cluster::Cluster;
use super::gauge::Gauge;
use super::slide::Family;
use super::stated::Stated;
use super::{Ambiguity, What};
use crate::bop::symmetry::Symmetries;
use crate::pose::{ModelPoints, add, add_s, mssd};
use crate::surface::Mesh;
use nalgebra::Isometry3;
use rayon::prelude::*;

/// What errors are measured on: all vertices of the mesh.
pub(super) struct Measure<'g> {
    points: ModelPoints,
    stated: Option<Stated<'g>>,
    gauge: &'g Gauge,
}

impl<'g> Measure<'g> {
    pub(super) fn new(mesh: &Mesh, gauge: &'g Gauge, symmetries: Option<&Symmetries>) -> Self {
        Self {
            points: ModelPoints::new(mesh.vertices().to_vec()),
            stated: symmetries.map(|symmetries| Stated::new(gauge, symmetries)),
            gauge,
        }
    }

    /// Whether each stated symmetry was found, as [`Stated::found`].
    pub(super) fn stated_found(&self, families: &[Family], clusters: &[Cluster]) -> Vec<bool> {
        let motions: Vec<Isometry3<f64>> = clusters.iter().map(|c| c.motion).collect();
        let stated = self.stated.as_ref();
        stated.map_or_else(Vec::new, |stated| stated.found(families, &motions))
    }

    pub(super) fn family(&self, family: &Family) -> Ambiguity {
        let what = What::Path {
            path: family.path,
            range: family.range(),
        };
        Ambiguity {
            views: family.ranges.iter().flatten().count(),
            confidence: family.confidences / family.count.max(1) as f64,
            ..self.of(what, &family.motions(self.gauge))
        }
    }

    pub(super) fn cluster(&self, cluster: &Cluster) -> Ambiguity {
        let motion = cluster.motion;
        let what = What::Motion {
            motion,
            screw: self.gauge.screw(&motion),
        };
        Ambiguity {
            views: cluster.confidences.len(),
            confidence: cluster.confidence(),
            ..self.of(what, &[motion])
        }
    }

    fn of(&self, what: What, motions: &[Isometry3<f64>]) -> Ambiguity {
        let none = Isometry3::identity();
        let points = self.points.points();
        let largest = |error: &(dyn Fn(&Isometry3<f64>) -> f64 + Sync)| {
            let errors: Vec<f64> = motions.par_iter().map(error).collect();
            errors.into_iter().fold(0.0, f64::max)
        };
        let stated = self.stated.as_ref();
        Ambiguity {
            what,
            views: 0,
            confidence: 0.0,
            add: largest(&|motion| add(points, &none, motion)),
            add_s: largest(&|motion| add_s(&self.points, &none, motion)),
            mssd: largest(&|motion| mssd(points, &none, motion, &[])),
            mssd_stated: stated
                .map(|stated| largest(&|motion| mssd(points, &none, motion, stated.all()))),
            stated: stated.map(|stated| motions.iter().all(|motion| stated.excuses(motion))),
        }
    }
}
