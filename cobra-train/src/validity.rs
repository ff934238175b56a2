//! The directions in which a component is verified: where what it predicts lies beside its own points.
//!
//! Owns the check of each cell of the grid of directions; the grid is `cobra-infer`'s
//! ([`cobra_infer::validity`]). Everything here is in the unit sphere.

use crate::surface::{NearestPoints, SurfacePoint};
use cobra_infer::validity::{Cell, LARGEST_SIDE, Pole, cell, direction};
use nalgebra::{Point3, UnitVector3, Vector3};

/// How far a predicted point may lie from a point of the component's own, with [`DENSE`] points on
/// the object: between two neighbours.
const ALONG: f64 = 0.035;

/// How far a predicted point may lie from the plane of that point.
const ACROSS: f64 = 0.012;

/// How many of the nearest own points are looked at.
const WITNESSES: usize = 3;

/// The number of training points that [`ALONG`] is meant for.
const DENSE: f64 = 10_000.0;

/// The wanted width of a cell where the surface is: twice the paper's τ.
pub const FINE_CELLS: f64 = 0.02;

/// A width that takes half as many bytes, and lets a few more wrong points pass.
pub const COARSE_CELLS: f64 = 0.03;

/// The coarsest grid.
const SMALLEST_SIDE: u8 = 12;

/// How much farther apart points lie than [`DENSE`] of them would; 1 for that many and more.
#[must_use]
pub fn sparsity(points: usize) -> f64 {
    (DENSE / points.max(1) as f64).sqrt().max(1.0)
}

/// The cells of the grid of directions in which a component may speak.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ValidCells {
    /// The grid's orientation.
    pub pole: Pole,
    /// Its cells along a side, a multiple of 4.
    pub side: u8,
    /// Row by row, whether the component may speak.
    pub cells: Vec<bool>,
}

impl ValidCells {
    /// Whether the component may speak of a point at `offset` from its reference point.
    #[must_use]
    pub fn contains(&self, offset: &Vector3<f64>) -> bool {
        let Cell { column, row } = cell(self.pole, self.side, offset.cast::<f32>().into());
        self.cells[usize::from(row) * usize::from(self.side) + usize::from(column)]
    }

    /// How many cells are valid.
    #[must_use]
    pub fn count(&self) -> usize {
        self.cells.iter().filter(|valid| **valid).count()
    }

    /// The unit vectors at `at`, 0 to 1 along column and row, of all valid cells.
    pub fn directions(&self, at: [f32; 2]) -> impl Iterator<Item = UnitVector3<f64>> {
        let side = self.side;
        (0..side)
            .flat_map(move |row| (0..side).map(move |column| Cell { column, row }))
            .zip(&self.cells)
            .filter(|(_, valid)| **valid)
            .map(move |(cell, _)| unit(self.pole, side, cell, at))
    }
}

fn unit(pole: Pole, side: u8, cell: Cell, at: [f32; 2]) -> UnitVector3<f64> {
    UnitVector3::new_normalize(Vector3::from(direction(pole, side, cell, at)).cast())
}

/// Verifies a component around `centre` against its `own` points: a cell is valid where the point
/// that `mean` predicts in the direction of its middle lies within 0.035 of one of the three nearest
/// own points and within 0.012 of that point's plane, both times `sparsity` along the surface.
///
/// Only cells beside directions of own points are looked at. The grid's middle is the half axis
/// nearest to the own points' mean direction, its cells about `cell_width` wide at their median
/// distance, as far as [`LARGEST_SIDE`] allows.
/// `None` where no cell is valid.
#[must_use]
pub fn verify(
    centre: &Point3<f64>,
    own: &[SurfacePoint],
    mean: impl Fn(&UnitVector3<f64>) -> f64,
    sparsity: f64,
    cell_width: f64,
) -> Option<ValidCells> {
    let offsets: Vec<Vector3<f64>> = own.iter().map(|p| p.position - centre).collect();
    let directions: Vec<Vector3<f64>> = offsets.iter().map(|o| o.normalize()).collect();
    let pole = pole_of(&directions);
    let side = side_of(&offsets, cell_width);
    let by_direction = NearestPoints::new(&arrays(&directions));
    let positions: Vec<Vector3<f64>> = own.iter().map(|p| p.position.coords).collect();
    let by_position = NearestPoints::new(&arrays(&positions));
    // Two cells and a bit: cells beside own points, across the gaps that sampling leaves.
    let beside = 2.3 * (4.0 * std::f64::consts::PI).sqrt() / f64::from(side);
    let cells: Vec<bool> = (0..side)
        .flat_map(|row| (0..side).map(move |column| Cell { column, row }))
        .map(|cell| {
            let u = unit(pole, side, cell, [0.5, 0.5]);
            if by_direction.distance(&u.into_inner().into()) > beside {
                return false;
            }
            let predicted = mean(&u);
            let point = centre + u.into_inner() * predicted;
            predicted > 0.0
                && by_position.nearest(&point.into(), WITNESSES).any(|near| {
                    let witness = &own[near.index];
                    let across = witness.normal.dot(&(point - witness.position)).abs();
                    near.distance < ALONG * sparsity && across < ACROSS
                })
        })
        .collect();
    cells
        .contains(&true)
        .then_some(ValidCells { pole, side, cells })
}

fn arrays(vectors: &[Vector3<f64>]) -> Vec<[f64; 3]> {
    vectors.iter().map(|v| (*v).into()).collect()
}

/// The half axis nearest to the mean direction, the first of equals.
fn pole_of(directions: &[Vector3<f64>]) -> Pole {
    let mean: Vector3<f64> = directions.iter().sum();
    let [x, y, z] = mean.into();
    let along = [z, x, y, -z, -x, -y];
    let mut best = 0;
    for (index, value) in along.iter().enumerate() {
        if *value > along[best] {
            best = index;
        }
    }
    Pole::ALL[best]
}

/// Cells are square roots of 4π/side² wide, seen from the reference point.
fn side_of(offsets: &[Vector3<f64>], cell_width: f64) -> u8 {
    let mut distances: Vec<f64> = offsets.iter().map(|o| o.norm()).collect();
    distances.sort_by(f64::total_cmp);
    let median = distances.get(distances.len() / 2).copied().unwrap_or(0.0);
    let wanted = median * (4.0 * std::f64::consts::PI).sqrt() / cell_width;
    let blocks = (wanted / 4.0).round().clamp(0.0, 255.0) as u8;
    (blocks.saturating_mul(4)).clamp(SMALLEST_SIDE, LARGEST_SIDE)
}
