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

/// A width that takes fewer bytes, and lets a few more wrong points pass.
pub const COARSE_CELLS: f64 = 0.03;

/// The coarsest grid.
const SMALLEST_SIDE: u8 = 12;

/// How much farther apart points lie than 10,000 of them would; 1 for that many and more.
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

    /// The valid cells, row by row.
    pub fn valid(&self) -> impl Iterator<Item = Cell> {
        let side = self.side;
        (0..side)
            .flat_map(move |row| (0..side).map(move |column| Cell { column, row }))
            .zip(&self.cells)
            .filter(|(_, valid)| **valid)
            .map(|(cell, _)| cell)
    }

    /// The unit vectors at `at`, 0 to 1 along column and row, of all valid cells.
    pub fn directions(&self, at: [f32; 2]) -> impl Iterator<Item = UnitVector3<f64>> {
        self.valid()
            .map(move |cell| unit(self.pole, self.side, cell, at))
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
    // A point at the centre has no direction.
    let directions: Vec<Vector3<f64>> = offsets
        .iter()
        .filter_map(|offset| offset.try_normalize(0.0))
        .collect();
    let pole = pole_of(&directions);
    let side = side_of(&offsets, cell_width);
    let by_direction = NearestPoints::new(&arrays(&directions));
    let positions: Vec<Vector3<f64>> = own.iter().map(|p| p.position.coords).collect();
    let by_position = NearestPoints::new(&arrays(&positions));
    // Two cells and a bit: cells beside own points, across the gaps that sampling leaves.
    let beside = sparsity * 2.3 * (4.0 * std::f64::consts::PI).sqrt() / f64::from(side);
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of side 0.6 at z = 1, as a reference point at the origin sees it.
    fn plane() -> Vec<SurfacePoint> {
        (0..31 * 31)
            .map(|i| SurfacePoint {
                position: Point3::new(
                    0.02 * f64::from(i % 31) - 0.3,
                    0.02 * f64::from(i / 31) - 0.3,
                    1.0,
                ),
                normal: Vector3::z_axis(),
            })
            .collect()
    }

    fn to_the_plane(u: &UnitVector3<f64>) -> f64 {
        1.0 / u.z
    }

    fn verified(mean: impl Fn(&UnitVector3<f64>) -> f64, sparsity: f64) -> Option<ValidCells> {
        verify(&Point3::origin(), &plane(), mean, sparsity, FINE_CELLS)
    }

    #[test]
    fn a_plane_is_verified_where_its_points_are_and_not_beyond() {
        let cells = verified(to_the_plane, 1.0).unwrap();
        assert_eq!(cells.pole, Pole::PlusZ);
        assert!(cells.side.is_multiple_of(4) && cells.side <= LARGEST_SIDE);
        assert_eq!(cells.cells.len(), usize::from(cells.side).pow(2));
        for point in plane() {
            // A cell is as wide as this at the rim.
            let inner = point.position.coords.xy().amax() < 0.28;
            assert!(!inner || cells.contains(&point.position.coords));
        }
        for (x, y, z) in [
            (0.5, 0.0, 1.0),
            (0.0, -0.5, 1.0),
            (1.0, 0.0, 0.0),
            (0.0, 0.0, -1.0),
        ] {
            assert!(!cells.contains(&Vector3::new(x, y, z)), "{x} {y} {z}");
        }
    }

    #[test]
    fn cells_are_not_valid_where_the_prediction_is_wrong() {
        let half = |u: &UnitVector3<f64>| to_the_plane(u) + if u.x < 0.0 { 0.05 } else { 0.0 };
        let cells = verified(half, 1.0).unwrap();
        assert!(cells.contains(&Vector3::new(0.15, 0.1, 1.0)));
        assert!(!cells.contains(&Vector3::new(-0.15, 0.1, 1.0)));
        let whole = verified(to_the_plane, 1.0).unwrap();
        assert!(cells.count() < whole.count());
        assert_eq!(verified(|u| to_the_plane(u) + 0.05, 1.0), None);
        assert_eq!(verified(|u| -to_the_plane(u), 1.0), None);
        assert_eq!(verified(|_| f64::NAN, 1.0), None);
        assert_eq!(
            verify(&Point3::origin(), &[], to_the_plane, 1.0, FINE_CELLS),
            None
        );
    }

    #[test]
    fn the_directions_of_valid_cells_are_in_them() {
        let cells = verified(to_the_plane, 1.0).unwrap();
        for at in [[0.1, 0.1], [0.5, 0.5], [0.9, 0.2]] {
            let directions: Vec<_> = cells.directions(at).collect();
            assert_eq!(directions.len(), cells.count());
            assert!(directions.iter().all(|u| cells.contains(&u.into_inner())));
        }
    }

    #[test]
    fn points_far_apart_are_looked_for_farther_away() {
        assert_eq!(sparsity(10_000), 1.0);
        assert_eq!(sparsity(1_000_000), 1.0);
        assert_eq!(sparsity(2_500), 2.0);
        assert_eq!(sparsity(0), 100.0);
        // Between points that lie 0.1 apart there are gaps unless that is said.
        let few: Vec<SurfacePoint> = plane()
            .into_iter()
            .enumerate()
            .filter(|(i, _)| i % 31 % 5 == 0 && i / 31 % 5 == 0)
            .map(|(_, point)| point)
            .collect();
        let count = |sparsity| {
            let found = verify(&Point3::origin(), &few, to_the_plane, sparsity, FINE_CELLS);
            found.map_or(0, |cells| cells.count())
        };
        assert!(count(3.0) > count(1.0));
        assert!(count(3.0) > 4 * few.len());
    }

    #[test]
    fn coarse_cells_are_fewer() {
        // From so near that the finer grid is not the finest that there is.
        let centre = Point3::new(0.0, 0.0, 0.8);
        let with = |width| verify(&centre, &plane(), |u| 0.2 / u.z, 1.0, width).unwrap();
        let (fine, coarse) = (with(FINE_CELLS), with(COARSE_CELLS));
        assert!(coarse.side < fine.side && coarse.count() < fine.count());
        assert!(coarse.contains(&Vector3::z()));
    }
}
