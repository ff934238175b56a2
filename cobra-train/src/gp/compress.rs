//! Compression: the posterior mean of many points by few terms, on a grid of directions and with
//! 16-bit weights.
//!
//! Owns the choice of the directions, over all components at once, and the least squares for their
//! weights. The grid is `cobra-infer`'s ([`cobra_infer::gp::compact`]).
//!
//! Reference for the mean of few directions conditioned on all data: J. Quiñonero-Candela and
//! C. E. Rasmussen, A unifying view of sparse approximate Gaussian process regression, 2005 (the
//! deterministic training conditional).

use super::cholesky::{Cholesky, NotPositiveDefinite};
use super::gram::{Coordinates, Hyperparameters, covariance, covariances};
use cobra_infer::gp::LANES;
use cobra_infer::gp::compact::GRID;
use cobra_infer::{Kernel, Metric};
use faer::Mat;
use nalgebra::{UnitVector3, Vector3};
use rayon::prelude::*;

/// Directions that each component starts with.
const START: usize = 8;

/// Added to the diagonal of the normal equations: large weights do not survive 16 bits.
const RIDGE: f64 = 1e-6;

/// The least share of noise in a signal.
const LEAST_NOISE: f64 = 1e-7;

/// Directions that are added in one round lie at least this far apart on the surface (unit sphere).
const APART: f64 = 0.027;

/// One component to be compressed, in the unit sphere.
#[derive(Clone, Debug)]
pub struct Uncompressed {
    /// The covariance function.
    pub kernel: Kernel,
    /// Its hyperparameters.
    pub hyperparameters: Hyperparameters,
    /// The directions of all points that it is to explain.
    pub directions: Vec<UnitVector3<f64>>,
    /// d − m of each.
    pub targets: Vec<f64>,
    /// m.
    pub prior_mean: f64,
}

/// The terms of a compressed component, in the unit sphere.
#[derive(Clone, Debug, PartialEq)]
pub struct Compressed {
    /// Directions in steps of the grid.
    pub directions: Vec<[i8; 3]>,
    /// Weights in units of `scale`; they multiply the unit-variance kernel.
    pub weights: Vec<i16>,
    /// What the weights are multiplied by.
    pub scale: f64,
}

/// Compresses all components to at most `terms` terms together and `most` each, and at least one.
///
/// Each starts with 8 directions far from one another; then, again and again, directions are added
/// where residuals are largest, whichever component they belong to, and all weights are solved
/// anew: w minimises ‖y − K_uz w‖² + (η/v) wᵀK_zz w + 10⁻⁶‖w‖², over all points u and the chosen
/// directions z as the grid has rounded them. A component with more than 8 terms gets a multiple of 8.
///
/// # Errors
/// [`NotPositiveDefinite`], where hyperparameters leave no finite solution.
pub fn compress(
    components: &[Uncompressed],
    terms: usize,
    most: usize,
) -> Result<Vec<Compressed>, NotPositiveDefinite> {
    let start = START.min(terms / components.len().max(1)).min(most).max(1);
    let mut states: Vec<State<'_>> = components
        .par_iter()
        .map(|component| State::new(component, start))
        .collect::<Result<_, _>>()?;
    loop {
        let total: usize = states.iter().map(|state| state.chosen.len()).sum();
        let room = terms.saturating_sub(total);
        let wanted = (total / 3).max(20).min(room);
        let added = worst(&mut states, wanted, most);
        if added == 0 {
            break;
        }
        solve(&mut states)?;
    }
    whole_rounds(&mut states, terms, most);
    solve(&mut states)?;
    Ok(states.iter().map(State::compressed).collect())
}

/// The weights of those whose directions have changed.
fn solve(states: &mut [State<'_>]) -> Result<(), NotPositiveDefinite> {
    states
        .par_iter_mut()
        .filter(|state| state.stale)
        .try_for_each(State::solve)
}

/// Leaves each component as many directions as fill whole rounds of the accumulators that a sum is
/// interleaved over, because a round in part takes a host longer than a whole one: what is over goes, and
/// those that lose most get a round for it while there is room for one.
fn whole_rounds(states: &mut [State<'_>], terms: usize, most: usize) {
    let mut losses = Vec::new();
    for (index, state) in states.iter_mut().enumerate() {
        let over = state.chosen.len() % LANES;
        if over > 0 && state.chosen.len() > LANES {
            state.keep(state.chosen.len() - over);
            losses.push((over, index));
        }
    }
    losses.sort_by(|a, b| b.0.cmp(&a.0).then(a.1.cmp(&b.1)));
    let total: usize = states.iter().map(|state| state.chosen.len()).sum();
    let rounds = terms.saturating_sub(total) / LANES;
    for (_, index) in losses.into_iter().take(rounds) {
        let state = &mut states[index];
        let whole = state.chosen.len() + LANES;
        if whole <= most {
            state.fill(whole);
        }
    }
}

/// Adds the directions of the largest residuals, to components that have fewer than `most`; returns how
/// many.
fn worst(states: &mut [State<'_>], wanted: usize, most: usize) -> usize {
    let mut candidates: Vec<(f64, usize, usize)> = states
        .iter()
        .enumerate()
        .flat_map(|(component, state)| {
            let residuals = state.residuals.iter().enumerate();
            residuals.map(move |(point, residual)| (residual.abs(), component, point))
        })
        .collect();
    candidates.sort_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut fresh = vec![Vec::new(); states.len()];
    let mut added = 0;
    for (_, component, point) in candidates {
        if added == wanted {
            break;
        }
        let state = &mut states[component];
        if state.chosen.len() < most && state.offer(point, &mut fresh[component]) {
            added += 1;
        }
    }
    added
}

/// A component while directions are chosen.
struct State<'a> {
    component: &'a Uncompressed,
    points: Coordinates,
    chosen: Vec<[i8; 3]>,
    /// k(u, z) of all points for each chosen direction.
    columns: Vec<Vec<f64>>,
    weights: Vec<f64>,
    residuals: Vec<f64>,
    /// Whether directions were chosen since the weights were solved.
    stale: bool,
}

impl<'a> State<'a> {
    fn new(component: &'a Uncompressed, start: usize) -> Result<Self, NotPositiveDefinite> {
        let mut state = Self {
            component,
            points: Coordinates::new(Metric::Chord, &component.directions),
            chosen: Vec::new(),
            columns: Vec::new(),
            weights: Vec::new(),
            residuals: component.targets.clone(),
            stale: true,
        };
        for point in far_apart(&component.directions, start) {
            state.choose(rounded(&component.directions[point]));
        }
        state.solve()?;
        Ok(state)
    }

    /// The kernel without its variance, which the weights take in.
    fn unit(&self) -> Hyperparameters {
        Hyperparameters {
            signal_variance: 1.0,
            ..self.component.hyperparameters
        }
    }

    /// Takes the direction of a point unless it is taken, or beside one that this round has taken.
    fn offer(&mut self, point: usize, fresh: &mut Vec<Vector3<f64>>) -> bool {
        let u = self.component.directions[point].into_inner();
        let distance = (self.component.targets[point] + self.component.prior_mean).max(0.1);
        let apart = APART / distance;
        if fresh
            .iter()
            .any(|other| (other - u).norm_squared() < apart * apart)
        {
            return false;
        }
        let grid = rounded(&self.component.directions[point]);
        if self.chosen.contains(&grid) {
            return false;
        }
        fresh.push(u);
        self.choose(grid);
        true
    }

    fn choose(&mut self, grid: [i8; 3]) {
        if !self.chosen.contains(&grid) {
            let z = unrounded(grid);
            let column = covariances(self.component.kernel, &self.unit(), &self.points, z);
            self.columns.push(column);
            self.chosen.push(grid);
            self.stale = true;
        }
    }

    /// Only the first directions.
    fn keep(&mut self, count: usize) {
        self.chosen.truncate(count);
        self.columns.truncate(count);
        self.stale = true;
    }

    /// Adds the directions of its own largest residuals until there are so many.
    fn fill(&mut self, count: usize) {
        let mut points: Vec<usize> = (0..self.residuals.len()).collect();
        points.sort_by(|&a, &b| {
            let (a_size, b_size) = (self.residuals[a].abs(), self.residuals[b].abs());
            b_size.total_cmp(&a_size).then(a.cmp(&b))
        });
        let mut fresh = Vec::new();
        for point in points {
            if self.chosen.len() == count {
                break;
            }
            self.offer(point, &mut fresh);
        }
    }

    /// The weights by the normal equations, and what they leave.
    fn solve(&mut self) -> Result<(), NotPositiveDefinite> {
        let h = &self.component.hyperparameters;
        let noise = h.noise_variance.max(LEAST_NOISE) / h.signal_variance;
        let (unit, count) = (self.unit(), self.chosen.len());
        let mut normal = Mat::zeros(count, count);
        for j in 0..count {
            for i in j..count {
                let (a, b) = (unrounded(self.chosen[i]), unrounded(self.chosen[j]));
                let prior = covariance(self.component.kernel, &unit, a, b);
                normal[(i, j)] = dot(&self.columns[i], &self.columns[j]) + noise * prior;
            }
            normal[(j, j)] += RIDGE + 1e-8 * noise;
        }
        let right: Vec<f64> = self
            .columns
            .iter()
            .map(|column| dot(column, &self.component.targets))
            .collect();
        self.weights = Cholesky::new(normal)?.solve(&right);
        self.residuals.clone_from(&self.component.targets);
        for (column, weight) in self.columns.iter().zip(&self.weights) {
            for (residual, k) in self.residuals.iter_mut().zip(column) {
                *residual -= weight * k;
            }
        }
        self.stale = false;
        Ok(())
    }

    fn compressed(&self) -> Compressed {
        let largest = self.weights.iter().fold(0.0_f64, |m, w| m.max(w.abs()));
        // A surface that is the prior mean has no weights, and a scale must be positive.
        let scale = (largest / f64::from(i16::MAX)).max(1e-12);
        Compressed {
            directions: self.chosen.clone(),
            weights: self
                .weights
                .iter()
                .map(|weight| (weight / scale).round() as i16)
                .collect(),
            scale,
        }
    }
}

/// Eight partial sums: one would wait for each addition.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (a_rounds, a_rest) = a.as_chunks::<8>();
    let (b_rounds, b_rest) = b.as_chunks::<8>();
    for (a, b) in a_rounds.iter().zip(b_rounds) {
        for ((sum, a), b) in sums.iter_mut().zip(a).zip(b) {
            *sum += a * b;
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f64>() + rest
}

/// The nearest direction of the grid.
fn rounded(u: &UnitVector3<f64>) -> [i8; 3] {
    let grid = f64::from(GRID);
    [u.x, u.y, u.z].map(|coordinate| (coordinate * grid).round() as i8)
}

fn unrounded(grid: [i8; 3]) -> [f64; 3] {
    grid.map(|coordinate| f64::from(coordinate) / f64::from(GRID))
}

/// Points whose directions lie far from one another, the first being the first.
fn far_apart(directions: &[UnitVector3<f64>], count: usize) -> Vec<usize> {
    let mut chosen = Vec::new();
    let mut squared = vec![f64::INFINITY; directions.len()];
    while chosen.len() < count.min(directions.len()) {
        let mut next = 0;
        for (index, distance) in squared.iter().enumerate() {
            if *distance > squared[next] {
                next = index;
            }
        }
        if squared[next] <= 0.0 {
            break;
        }
        chosen.push(next);
        for (distance, u) in squared.iter_mut().zip(directions) {
            let to_next = (u.into_inner() - directions[next].into_inner()).norm_squared();
            *distance = distance.min(to_next);
        }
    }
    chosen
}

#[cfg(test)]
mod tests;
