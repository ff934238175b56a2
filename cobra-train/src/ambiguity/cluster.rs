//! Single motions: what is left of the accepted candidates, as few motions as they are.
//!
//! Owns which candidates are one and the same motion, and in which views that motion is accepted. Motions
//! are the same when the pose that one leads to is right where the other's is the truth; about axes that
//! allow any angle, after the turn that brings them nearest to each other.

use super::AmbiguityError;
use super::gauge::{Gauge, twist};
use super::settle::{Settled, settle};
use super::slide::Family;
use super::views::{Judge, Look, Room};
use crate::bop::symmetry::Axis;
use cobra_infer::depth::Surface;
use nalgebra::Isometry3;
use rayon::prelude::*;

/// A candidate that came to rest at a wrong pose.
#[derive(Clone, Copy, Debug)]
pub(super) struct Accepted {
    pub(super) view: usize,
    pub(super) settled: Settled,
}

/// A motion, and where it is accepted.
pub(super) struct Cluster {
    /// The mean of where it comes to rest.
    pub(super) motion: Isometry3<f64>,
    /// The confidence in each view in which it is accepted.
    pub(super) confidences: Vec<f32>,
}

/// Axes about which every view allows any angle.
pub(super) struct Freedom<'g> {
    gauge: &'g Gauge,
    axes: Vec<Axis>,
}

impl<'g> Freedom<'g> {
    pub(super) fn new(gauge: &'g Gauge, families: &[Family]) -> Self {
        Self {
            gauge,
            axes: families.iter().filter_map(Family::whole_axis).collect(),
        }
    }

    /// `motion` after the turn about the axis that brings it nearest to `other`; about two axes of different
    /// directions any rotation can be had.
    fn brought(&self, motion: &Isometry3<f64>, other: &Isometry3<f64>) -> Isometry3<f64> {
        match self.axes[..] {
            [] => *motion,
            [axis] => motion * axis.turn(twist(&axis.direction, motion, other)),
            [axis, ..] => {
                let centre = axis.offset;
                let to_other = motion.rotation.inverse() * other.rotation;
                motion * Isometry3::rotation_wrt_point(to_other, centre)
            }
        }
    }

    fn same(&self, a: &Isometry3<f64>, b: &Isometry3<f64>) -> bool {
        self.gauge.same(&self.brought(a, b), b)
    }

    /// Whether the motion is none but for a turn that is free.
    fn is_none(&self, motion: &Isometry3<f64>) -> bool {
        self.same(motion, &Isometry3::identity())
    }
}

/// The motions among candidates, those in most views first, then those of the highest confidence.
pub(super) fn clusters<S: Surface + Sync>(
    judge: &Judge<'_, S>,
    freedom: &Freedom<'_>,
    mut accepted: Vec<Accepted>,
) -> Result<Vec<Cluster>, AmbiguityError> {
    accepted.retain(|candidate| !freedom.is_none(&candidate.settled.motion));
    // Stable, so that of equals the one of the first view and candidate leads.
    accepted.sort_by(|a, b| b.settled.confidence.total_cmp(&a.settled.confidence));
    let mut groups: Vec<Group> = Vec::new();
    for candidate in &accepted {
        let motion = &candidate.settled.motion;
        match groups.iter_mut().find(|g| freedom.same(motion, &g.leader)) {
            Some(group) => group.views[candidate.view] = true,
            None => {
                let mut views = vec![false; judge.views.len()];
                views[candidate.view] = true;
                groups.push(Group {
                    leader: *motion,
                    views,
                });
            }
        }
    }
    groups.sort_by_key(|group| std::cmp::Reverse(group.views.iter().filter(|v| **v).count()));
    let mut clusters: Vec<Cluster> = Vec::new();
    for group in groups {
        let known = clusters
            .iter()
            .any(|c| freedom.same(&group.leader, &c.motion));
        if known {
            continue;
        }
        let Some(cluster) = confirm(judge, freedom, &group.leader)? else {
            continue;
        };
        let again = clusters
            .iter()
            .any(|c| freedom.same(&cluster.motion, &c.motion));
        if !again && !freedom.is_none(&cluster.motion) {
            clusters.push(cluster);
        }
    }
    clusters.sort_by(|a, b| {
        let views = b.confidences.len().cmp(&a.confidences.len());
        views.then(b.confidence().total_cmp(&a.confidence()))
    });
    Ok(clusters)
}

struct Group {
    leader: Isometry3<f64>,
    /// In which views the search came upon it.
    views: Vec<bool>,
}

impl Cluster {
    /// The mean over the views in which it is accepted.
    pub(super) fn confidence(&self) -> f64 {
        let sum: f64 = self.confidences.iter().map(|c| f64::from(*c)).sum();
        sum / self.confidences.len().max(1) as f64
    }
}

/// Tries a motion in all views: the search may have missed it in some.
fn confirm<S: Surface + Sync>(
    judge: &Judge<'_, S>,
    freedom: &Freedom<'_>,
    leader: &Isometry3<f64>,
) -> Result<Option<Cluster>, AmbiguityError> {
    let gauge = freedom.gauge;
    let tried: Vec<Option<Settled>> = judge
        .views
        .par_iter()
        .map_init(
            || judge.room(),
            |room: &mut Room, view| settle(judge, gauge, Look::Full, view, leader, room),
        )
        .collect::<Result<_, _>>()?;
    let stayed: Vec<Settled> = tried
        .into_iter()
        .flatten()
        .filter(|settled| {
            freedom.same(&settled.motion, leader) && !freedom.is_none(&settled.motion)
        })
        .collect();
    let brought: Vec<Isometry3<f64>> = stayed
        .iter()
        .map(|settled| freedom.brought(&settled.motion, leader))
        .collect();
    if brought.is_empty() {
        return Ok(None);
    }
    Ok(gauge.mean(&brought).map(|motion| Cluster {
        motion,
        confidences: stayed.iter().map(|settled| settled.confidence).collect(),
    }))
}
