//! Baking: a mean over directions as a cubic B-spline of so many nodes of a byte each.
//!
//! Owns the least squares for the nodes and their rounding. What the nodes mean on the controller is
//! `cobra-infer`'s ([`cobra_infer::gp::map`]).
//!
//! Nodes are fitted, not sampled: the mean need not be known where the component is not valid, the
//! error is spread evenly, and interpolation of the same samples (Catmull-Rom) takes 1.3 times the bytes
//! for it. Rounding is part of the fit: each node in turn goes to the whole number that suits its
//! neighbours as they are now, which leaves less than rounding each by itself.

use super::banded::Banded;

/// Nodes along a side that one place depends on.
const SUPPORT: usize = 4;

/// Weight of the squared second differences of nodes, as a share of what a node weighs in the
/// residuals: it decides where no sample does. With ten times as much or a hundredth of it more of the
/// screwdriver is off by more than τ.
const SMOOTHNESS: f64 = 1e-4;

/// Rounds of rounding.
const ROUNDS: usize = 4;

/// The mean in one direction.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Where the direction lies on the octahedral map.
    pub square: [f64; 2],
    /// The mean.
    pub distance: f64,
}

/// The map of a component, in the unit of the samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Baked {
    /// Nodes in a row, and rows.
    pub size: [u8; 2],
    /// Nodes in a unit of the square.
    pub spacing: f64,
    /// The place of the middle of the square, in nodes.
    pub origin: [f64; 2],
    /// What is added to the sum.
    pub prior_mean: f64,
    /// What the sum over the nodes is multiplied by.
    pub scale: f64,
    /// Row by row.
    pub nodes: Vec<i8>,
}

/// Fits a map to the samples, so coarse that the geometric mean of the rectangle's sides that they
/// fill has `cells` cells.
///
/// `None` where there is no sample, or more than 255 nodes in a row or a column.
#[must_use]
pub fn bake(samples: &[Sample], cells: f64) -> Option<Baked> {
    let ends = |axis: usize| {
        let places = samples.iter().map(move |sample| sample.square[axis]);
        let low = places.clone().fold(f64::INFINITY, f64::min);
        (low, places.fold(f64::NEG_INFINITY, f64::max).max(low))
    };
    let sides = [ends(0), ends(1)];
    let [wide, high] = sides.map(|(low, high)| (high - low).max(1e-3));
    let spacing = cells / (wide * high).sqrt();
    if !spacing.is_finite() || samples.is_empty() {
        return None;
    }
    let mut size = [0; 2];
    let mut origin = [0.0; 2];
    for ((size, origin), (low, high)) in size.iter_mut().zip(&mut origin).zip(sides) {
        // A margin, so that rounding leads out of no cell.
        let cells = ((high - low) * spacing + 0.02).ceil().max(1.0);
        *size = u8::try_from(cells as usize + SUPPORT - 1).ok()?;
        *origin = 0.5 * (cells - (high + low) * spacing);
    }
    let mut map = Baked {
        size,
        spacing,
        origin,
        prior_mean: 0.0,
        scale: 0.0,
        nodes: Vec::new(),
    };
    let equations = Equations::new(&map, samples);
    let nodes = equations.matrix.solve(&equations.right)?;
    map.round(&nodes, &equations);
    Some(map)
}

impl Baked {
    /// The mean that the map gives.
    #[must_use]
    pub fn mean(&self, square: [f64; 2]) -> f64 {
        let sum: f64 = self
            .support(square)
            .map(|(node, weight)| weight * f64::from(self.nodes[node]))
            .sum();
        self.prior_mean + self.scale * sum
    }

    /// The sum of the squared differences from samples.
    #[must_use]
    pub fn squared_error(&self, samples: &[Sample]) -> f64 {
        let squares = samples.iter().map(|sample| {
            let error = self.mean(sample.square) - sample.distance;
            error * error
        });
        squares.sum()
    }

    /// The nodes that a place depends on, and their weights, which add up to 36.
    fn support(&self, square: [f64; 2]) -> impl Iterator<Item = (usize, f64)> {
        let along = |axis: usize| {
            let at = square[axis] * self.spacing + self.origin[axis];
            let most = usize::from(self.size[axis]) - SUPPORT;
            let first = (at.max(0.0) as usize).min(most);
            (first, weights(at - first as f64))
        };
        let ((column, across), (row, down)) = (along(0), along(1));
        let columns = usize::from(self.size[0]);
        (0..SUPPORT * SUPPORT).map(move |k| {
            let (i, j) = (k % SUPPORT, k / SUPPORT);
            ((row + j) * columns + column + i, across[i] * down[j])
        })
    }

    /// Takes in nodes as whole numbers.
    fn round(&mut self, nodes: &[f64], equations: &Equations) {
        let used = nodes.iter().zip(&equations.used).filter(|(_, used)| **used);
        let used = used.map(|(node, _)| *node);
        let low = used.clone().fold(f64::INFINITY, f64::min);
        let high = used.fold(f64::NEG_INFINITY, f64::max);
        let middle = 0.5 * (low + high);
        // A sphere has no range, and a scale must be positive.
        let step = ((high - low) / 254.0).max(1e-12);
        let clamped = |steps: f64| steps.round().clamp(-127.0, 127.0);
        let mut steps: Vec<f64> = nodes
            .iter()
            .map(|node| clamped((node - middle) / step))
            .collect();
        let matrix = &equations.matrix;
        for _ in 0..ROUNDS {
            for node in 0..steps.len() {
                let beside = matrix.beside(node);
                let pull: f64 = beside
                    .map(|other| matrix.at(node, other) * (middle + step * steps[other]))
                    .sum();
                let shift = (equations.right[node] - pull) / matrix.at(node, node);
                steps[node] = clamped(steps[node] + shift / step);
            }
        }
        self.nodes = steps.iter().map(|steps| *steps as i8).collect();
        self.prior_mean = 36.0 * middle;
        self.scale = step;
    }
}

/// Of a cubic B-spline, times 6.
fn weights(t: f64) -> [f64; SUPPORT] {
    let r = 1.0 - t;
    let inner = |t: f64| (3.0 * t - 6.0) * t * t + 4.0;
    [r * r * r, inner(t), inner(r), t * t * t]
}

/// The normal equations of nodes times 1/36, so that weights are those of the controller.
struct Equations {
    matrix: Banded,
    right: Vec<f64>,
    /// Whether some sample depends on a node.
    used: Vec<bool>,
}

impl Equations {
    fn new(map: &Baked, samples: &[Sample]) -> Self {
        let [columns, rows] = map.size.map(usize::from);
        let count = columns * rows;
        let mut matrix = Banded::new(count, (SUPPORT - 1) * (columns + 1));
        let mut right = vec![0.0; count];
        let mut used = vec![false; count];
        for sample in samples {
            let support: Vec<(usize, f64)> = map.support(sample.square).collect();
            for (node, weight) in &support {
                right[*node] += weight * sample.distance;
                used[*node] = true;
                for (other, by) in &support {
                    matrix.add(*node, *other, weight * by);
                }
            }
        }
        let weight: f64 = (0..count).map(|node| matrix.at(node, node)).sum();
        let known = used.iter().filter(|used| **used).count();
        let smooth = SMOOTHNESS * weight / known as f64;
        let mut bend = |nodes: [usize; 3]| {
            for (node, a) in nodes.iter().zip([1.0, -2.0, 1.0]) {
                for (other, b) in nodes.iter().zip([1.0, -2.0, 1.0]) {
                    matrix.add(*node, *other, smooth * a * b);
                }
            }
        };
        for node in 0..count {
            let (column, row) = (node % columns, node / columns);
            if (1..columns - 1).contains(&column) {
                bend([node - 1, node, node + 1]);
            }
            if (1..rows - 1).contains(&row) {
                bend([node - columns, node, node + columns]);
            }
        }
        for node in 0..count {
            matrix.add(node, node, 1e-6 * smooth);
        }
        Self {
            matrix,
            right,
            used,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples(mean: impl Fn(f64, f64) -> f64) -> Vec<Sample> {
        (0..900)
            .map(|k| {
                let (p, q) = (f64::from(k % 30) / 29.0, f64::from(k / 30) / 29.0);
                let square = [0.8 * p - 0.2, 0.5 * q - 0.6];
                let distance = mean(square[0], square[1]);
                Sample { square, distance }
            })
            .collect()
    }

    #[test]
    fn a_smooth_mean_is_met_to_the_rounding_of_its_nodes() {
        let samples = samples(|p, q| 0.4 + 0.1 * (3.0 * p).sin() * (2.0 * q).cos());
        let map = bake(&samples, 8.0).unwrap();
        assert!(map.size[0] > map.size[1]);
        let rms = (map.squared_error(&samples) / samples.len() as f64).sqrt();
        // A range of about 0.17 in 254 steps.
        assert!(rms < 4e-4, "{rms}");
    }

    #[test]
    fn finer_maps_meet_what_coarse_ones_cannot() {
        let samples = samples(|p, q| 0.4 + 0.1 * (12.0 * p).sin() * (9.0 * q).cos());
        let error = |cells| bake(&samples, cells).unwrap().squared_error(&samples);
        assert!(error(8.0) < 0.25 * error(3.0));
    }

    #[test]
    fn a_sphere_is_met_and_no_sample_is_no_map() {
        let samples = samples(|_, _| 0.7);
        let map = bake(&samples, 2.0).unwrap();
        assert!(map.scale > 0.0);
        assert!((map.mean([0.1, -0.3]) - 0.7).abs() < 1e-6);
        assert_eq!(bake(&[], 2.0), None);
    }

    #[test]
    fn one_direction_is_enough_for_a_map() {
        let one = [Sample {
            square: [0.3, 0.3],
            distance: 0.5,
        }];
        let map = bake(&one, 2.0).unwrap();
        assert!((map.mean([0.3, 0.3]) - 0.5).abs() < 1e-3);
    }
}
