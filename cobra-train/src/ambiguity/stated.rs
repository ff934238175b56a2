//! What a data set states of an object's symmetries, against what was found.

use super::gauge::Gauge;
use super::slide::{Family, Path, Range};
use crate::bop::symmetry::{LARGEST_STEP, Symmetries};
use nalgebra::Isometry3;

/// The symmetries as finitely many motions.
pub(super) struct Stated<'g> {
    gauge: &'g Gauge,
    symmetries: Symmetries,
    all: Vec<Isometry3<f64>>,
}

impl<'g> Stated<'g> {
    pub(super) fn new(gauge: &'g Gauge, symmetries: &Symmetries) -> Self {
        Self {
            gauge,
            symmetries: symmetries.clone(),
            all: symmetries.transformations(LARGEST_STEP),
        }
    }

    /// All of them, the identity first.
    pub(super) fn all(&self) -> &[Isometry3<f64>] {
        &self.all
    }

    /// Whether one of them leads to where a motion's pose is right.
    pub(super) fn excuses(&self, motion: &Isometry3<f64>) -> bool {
        self.all
            .iter()
            .any(|stated| self.gauge.same(stated, motion))
    }

    /// Which of the discrete ones, and then of the axes, were found: the motion, or any angle about the axis.
    pub(super) fn found(&self, families: &[Family], motions: &[Isometry3<f64>]) -> Vec<bool> {
        let gauge = self.gauge;
        let discrete = self.symmetries.discrete.iter().map(|stated| {
            let by_family = |family: &Family| {
                (0..family.ranges.len()).any(|view| family.explains(gauge, view, stated))
            };
            motions.iter().any(|motion| gauge.same(stated, motion))
                || families.iter().any(by_family)
        });
        let continuous = self.symmetries.continuous.iter().map(|axis| {
            families.iter().any(|family| {
                family.path.is_like(&Path::Turn(*axis), gauge) && family.range() == Range::Any
            })
        });
        discrete.chain(continuous).collect()
    }
}
