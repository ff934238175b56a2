//! Motions that may be made by any amount: turns about an axis, and slides along a direction.
//!
//! Owns where they are looked for, and how far they are accepted. An amount can only be free where small ones
//! are, so that the directions are those in which refinement has least to say: the eigenvectors of
//! Σ JJᵀ at the true pose (N. Gelfand and L. Guibas, Shape segmentation using local slippage analysis, SGP
//! 2004), of all views together, and of each view, because what decides may be hidden there.

use super::AmbiguityError;
use super::gauge::{Gauge, twist, upwards};
use super::views::{Judge, Look, View, camera};
use crate::bop::symmetry::Axis;
use crate::pose::single_pose;
use cobra_infer::depth::Surface;
use nalgebra::{
    Isometry3, Matrix6, Point3, SymmetricEigen, Translation3, UnitVector3, Vector3, Vector6,
};
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Turns are tried by steps of 5°.
const TURNS: i32 = 72;

/// Slides are tried by steps of this share of the diameter …
const SLIDE: f64 = 0.02;

/// … up to the diameter.
const SLIDES: i32 = 50;

/// Two lines are the same axis when they are at most so far apart in direction, in radians, and no farther
/// apart at the object's middle than a right pose may be wrong.
const SAME_DIRECTION: f64 = 0.17;

/// What may be done by any amount.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Path {
    /// Turning about a line; amounts are radians.
    Turn(Axis),
    /// Sliding along a direction; amounts are lengths in the mesh's unit.
    Slide(UnitVector3<f64>),
}

/// By which amounts a path is accepted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Range {
    /// By any: of turns only.
    Any,
    /// From the one to the other, without a gap.
    Between {
        /// At most 0.
        low: f64,
        /// At least 0.
        high: f64,
    },
}

impl Path {
    /// The motion by an amount.
    #[must_use]
    pub fn at(&self, amount: f64) -> Isometry3<f64> {
        match self {
            Self::Turn(axis) => axis.turn(amount),
            Self::Slide(direction) => Translation3::from(amount * direction.into_inner()).into(),
        }
    }

    /// The amount by which it comes nearest to a motion.
    fn amount(&self, gauge: &Gauge, motion: &Isometry3<f64>) -> f64 {
        match self {
            Self::Turn(axis) => twist(&axis.direction, &Isometry3::identity(), motion),
            Self::Slide(direction) => (motion * gauge.middle - gauge.middle).dot(direction),
        }
    }

    /// One step, and how many there are on each side of none.
    fn steps(&self, gauge: &Gauge) -> (f64, i32) {
        match self {
            Self::Turn(_) => (TAU / f64::from(TURNS), TURNS - 1),
            Self::Slide(_) => (SLIDE * gauge.diameter, SLIDES),
        }
    }

    pub(super) fn is_like(&self, other: &Self, gauge: &Gauge) -> bool {
        let parallel =
            |a: &UnitVector3<f64>, b: &UnitVector3<f64>| a.cross(b).norm() < SAME_DIRECTION;
        match (self, other) {
            (Self::Turn(a), Self::Turn(b)) => {
                let beside = |axis: &Axis| {
                    let away = axis.offset - gauge.middle;
                    away - away.dot(&axis.direction) * axis.direction.into_inner()
                };
                parallel(&a.direction, &b.direction)
                    && (beside(a) - beside(b)).norm() < gauge.limit()
            }
            (Self::Slide(a), Self::Slide(b)) => parallel(a, b),
            _ => false,
        }
    }
}

/// A path that leads to wrong poses which score as well as the true one.
pub(super) struct Family {
    pub(super) path: Path,
    /// Of each view: how far it is accepted, where that leads to wrong poses.
    pub(super) ranges: Vec<Option<Range>>,
    /// The confidences of the wrong poses, summed, and how many there are.
    pub(super) confidences: f64,
    pub(super) count: usize,
}

/// A path in one view.
struct Followed {
    range: Range,
    confidences: Vec<f32>,
}

impl Family {
    /// Whether a motion that was accepted in a view is one of the path, or nearly.
    pub(super) fn explains(&self, gauge: &Gauge, view: usize, motion: &Isometry3<f64>) -> bool {
        let Some(range) = self.ranges.get(view).copied().flatten() else {
            return false;
        };
        let amount = self.path.amount(gauge, motion);
        let amount = match range {
            Range::Any => amount,
            Range::Between { low, high } => amount.clamp(low, high),
        };
        gauge.same(&self.path.at(amount), motion)
    }

    /// The axis, where in every view the object may be turned about it by any angle.
    pub(super) fn whole_axis(&self) -> Option<Axis> {
        match self.path {
            Path::Turn(axis) if self.ranges.iter().all(|r| *r == Some(Range::Any)) => Some(axis),
            _ => None,
        }
    }

    /// From the least amount to the largest over all views.
    pub(super) fn range(&self) -> Range {
        let ranges = self.ranges.iter().flatten();
        ranges.fold(
            Range::Between {
                low: 0.0,
                high: 0.0,
            },
            |sum, range| match (sum, range) {
                (Range::Between { low: a, high: b }, Range::Between { low, high }) => {
                    Range::Between {
                        low: a.min(*low),
                        high: b.max(*high),
                    }
                }
                _ => Range::Any,
            },
        )
    }

    /// The wrong poses' motions within [`Family::range`], step by step.
    pub(super) fn motions(&self, gauge: &Gauge) -> Vec<Isometry3<f64>> {
        let (step, most) = self.path.steps(gauge);
        let (first, last) = match self.range() {
            Range::Any => (1, most),
            Range::Between { low, high } => {
                let count = |amount: f64| (amount / step).round() as i32;
                (count(low), count(high))
            }
        };
        let all = (first..=last).map(|i| self.path.at(f64::from(i) * step));
        all.filter(|motion| gauge.is_wrong(motion)).collect()
    }
}

/// The paths that lead to wrong poses in some view, those of the whole shape first.
pub(super) fn families<S: Surface + Sync>(
    judge: &Judge<'_, S>,
    gauge: &Gauge,
) -> Result<Vec<Family>, AmbiguityError> {
    let of_views: Vec<Matrix6<f64>> = judge
        .views
        .iter()
        .map(|view| products(judge, gauge, view))
        .collect();
    let whole = of_views.iter().fold(Matrix6::zeros(), |sum, m| sum + m);
    let mut families: Vec<Family> = Vec::new();
    for matrix in std::iter::once(&whole).chain(&of_views) {
        for path in softest(matrix, gauge) {
            if families.iter().any(|f| f.path.is_like(&path, gauge)) {
                continue;
            }
            let followed: Vec<Option<Followed>> = judge
                .views
                .par_iter()
                .map(|view| follow(judge, gauge, view, &path))
                .collect::<Result<_, _>>()?;
            let confidences = || followed.iter().flatten().flat_map(|f| &f.confidences);
            if confidences().next().is_none() {
                continue;
            }
            families.push(Family {
                path,
                confidences: confidences().map(|c| f64::from(*c)).sum(),
                count: confidences().count(),
                ranges: followed.into_iter().map(|f| Some(f?.range)).collect(),
            });
        }
    }
    Ok(families)
}

/// Σ JJᵀ/N over what a view shows, J = (n, (P − C) × n/D) as refinement has it.
fn products<S: Surface + Sync>(judge: &Judge<'_, S>, gauge: &Gauge, view: &View) -> Matrix6<f64> {
    let Ok(pose) = single_pose(&view.truth) else {
        return Matrix6::zeros();
    };
    let camera = camera();
    let mut sum = Matrix6::zeros();
    let mut count = 0.0;
    for pixel in view.pixels() {
        let point = camera.back_project_depth(&pose, &pixel.pixel(), pixel.depth);
        let known = point.and_then(|point| Some((point, judge.surface.nearby(&point)?)));
        let Some((point, nearby)) = known else {
            continue;
        };
        let normal = Vector3::from(nearby.normal.map(f64::from));
        let arm = (point.cast::<f64>() - gauge.middle) / gauge.diameter;
        let turn = arm.cross(&normal);
        let j = Vector6::new(normal.x, normal.y, normal.z, turn.x, turn.y, turn.z);
        sum += j * j.transpose();
        count += 1.0;
    }
    if count > 0.0 { sum / count } else { sum }
}

/// The motions along the eigenvectors, the one that changes distances least first.
fn softest(matrix: &Matrix6<f64>, gauge: &Gauge) -> Vec<Path> {
    let eigen = SymmetricEigen::new(*matrix);
    let mut order: Vec<usize> = (0..6).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
    let vector = |index: usize| eigen.eigenvectors.column(index).into_owned();
    order
        .into_iter()
        .filter_map(|index| path(&vector(index), gauge))
        .collect()
}

/// The path that a motion τ + ω × (P − C) begins: a turn about the line through C + ω × τ/ω² along ω, or a
/// slide along τ where that line passes the object by more than its diameter. What a turn shifts along
/// its line is left out.
fn path(vector: &Vector6<f64>, gauge: &Gauge) -> Option<Path> {
    let shift: Vector3<f64> = vector.fixed_rows::<3>(0).into_owned();
    let turn: Vector3<f64> = vector.fixed_rows::<3>(3) / gauge.diameter;
    let away = turn.cross(&shift) / turn.norm_squared();
    if away.norm() < gauge.diameter {
        let direction = upwards(UnitVector3::try_new(turn, 0.0)?);
        let offset: Point3<f64> = gauge.middle + away;
        return Some(Path::Turn(Axis { direction, offset }));
    }
    Some(Path::Slide(upwards(UnitVector3::try_new(shift, 1e-9)?)))
}

/// How far a path is accepted in a view; `None` where all that is accepted is right.
fn follow<S: Surface + Sync>(
    judge: &Judge<'_, S>,
    gauge: &Gauge,
    view: &View,
    path: &Path,
) -> Result<Option<Followed>, AmbiguityError> {
    let (step, most) = path.steps(gauge);
    let mut room = judge.room();
    let mut confidences = Vec::new();
    let mut ends = [0.0, 0.0];
    for (end, sign) in ends.iter_mut().zip([1.0, -1.0]) {
        for index in 1..=most {
            let amount = sign * f64::from(index) * step;
            let motion = path.at(amount);
            let report = judge.report(Look::Full, view, &motion, &mut room)?;
            let accepted = report.filter(|report| report.confidence >= view.least);
            let Some(report) = accepted else { break };
            *end = amount;
            if gauge.is_wrong(&motion) {
                confidences.push(report.confidence);
            }
        }
        if matches!(path, Path::Turn(_)) && *end == f64::from(most) * step {
            let range = Range::Any;
            return Ok(Some(Followed { range, confidences }));
        }
    }
    let [high, low] = ends;
    Ok((!confidences.is_empty()).then_some(Followed {
        range: Range::Between { low, high },
        confidences,
    }))
}
