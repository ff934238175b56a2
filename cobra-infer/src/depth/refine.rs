//! How far the pose would move if it followed the observed depth: Gauss-Newton on the distances to the
//! surface.
//!
//! Owns one step and the normal equations. A step moves the observed points, seen in the object's frame, by
//! τ + ω × (P − C), C the middle of the object, so that the distances e, weighted by
//! w = 1/(1 + (e/c)²), shrink: (Σ w JJᵀ + 10⁻³N·I) x = −Σ w J e with J = (n, (P − C) × n/D), x = (τ, ω·D), n the
//! normal, D the diameter and N the number of points.

use super::surface::{Nearby, Surface};
use crate::math::{self, Real};
use crate::pose::Pose;
use nalgebra::{Matrix6, Point3, Vector6};

/// What a distance counts for at most in the residual, as a share of the diameter.
const LARGEST_SHARE: f32 = 0.2;

/// c, as a share of the diameter: what is farther away pulls less.
const ROBUST_SHARE: f32 = 0.05;

/// Keeps a step small where the points do not say which way to go: on a plane, a sphere, an axis.
const DAMPING: f32 = 1e-3;

/// Rows of the lower triangle of a 6 × 6 matrix, behind each other.
const TRIANGLE: usize = 21;

/// The lower triangle of Σ w JJᵀ row by row, Σ w J e, and what else is summed over the points.
#[derive(Clone, Debug)]
pub(super) struct Equations {
    products: [f32; TRIANGLE],
    right: [f32; 6],
    known: u32,
    silent: u32,
    squares: f32,
    likelihoods: f32,
    centre: [f32; 3],
    inverse_diameter: f32,
    inverse_robust: f32,
    largest: f32,
}

impl Equations {
    /// Of no point yet.
    pub(super) fn new(surface: &impl Surface) -> Self {
        let diameter = surface.diameter();
        Self {
            products: [0.0; TRIANGLE],
            right: [0.0; 6],
            known: 0,
            silent: 0,
            squares: 0.0,
            likelihoods: 0.0,
            centre: surface.centre(),
            inverse_diameter: 1.0 / diameter,
            inverse_robust: 1.0 / (ROBUST_SHARE * diameter),
            largest: LARGEST_SHARE * diameter,
        }
    }

    /// Takes a point in, and what the surface says of it; `None` for one that it says nothing of.
    pub(super) fn add(&mut self, known: Option<(Point3<f32>, Nearby)>) {
        let Some((point, nearby)) = known else {
            self.silent = self.silent.saturating_add(1);
            self.squares += self.largest * self.largest;
            return;
        };
        self.known = self.known.saturating_add(1);
        self.likelihoods += nearby.likelihood;
        let e = nearby.distance;
        let clipped = if math::abs(e) < self.largest {
            e
        } else {
            self.largest
        };
        self.squares += clipped * clipped;
        let scaled = e * self.inverse_robust;
        let weight = 1.0 / (1.0 + scaled * scaled);
        let [cx, cy, cz] = self.centre;
        let [nx, ny, nz] = nearby.normal;
        let s = self.inverse_diameter;
        let (x, y, z) = ((point.x - cx) * s, (point.y - cy) * s, (point.z - cz) * s);
        let j = [
            nx,
            ny,
            nz,
            y * nz - z * ny,
            z * nx - x * nz,
            x * ny - y * nx,
        ];
        let mut products = self.products.iter_mut();
        for (row, a) in j.iter().enumerate() {
            let weighted = weight * a;
            for (product, b) in products.by_ref().take(row + 1).zip(&j) {
                *product += weighted * b;
            }
        }
        for (right, a) in self.right.iter_mut().zip(j) {
            *right += weight * a * e;
        }
    }

    /// How many points there are.
    pub(super) fn count(&self) -> u32 {
        self.known.saturating_add(self.silent)
    }

    /// Of how many the surface says nothing.
    pub(super) fn silent(&self) -> u32 {
        self.silent
    }

    /// The mean likelihood of the points; 0 without any.
    pub(super) fn likelihood(&self) -> f32 {
        self.likelihoods / self.count().max(1) as f32
    }

    /// The root of the mean square of the distances; what is not known counts as [`LARGEST_SHARE`].
    pub(super) fn residual(&self) -> f32 {
        (self.squares / self.count().max(1) as f32).square_root()
    }

    /// The pose after the step; `None` where the equations have no solution.
    #[inline(never)]
    pub(super) fn step(&self, pose: &Pose) -> Option<Pose> {
        let mut matrix = Matrix6::<f32>::zeros();
        let mut products = self.products.iter();
        let damping = DAMPING * self.known as f32;
        for row in 0..6 {
            for column in 0..=row {
                let product = *products.next()?;
                let entry = if row == column {
                    product + damping
                } else {
                    product
                };
                *matrix.get_mut((row, column))? = entry;
                *matrix.get_mut((column, row))? = entry;
            }
        }
        let right = Vector6::from(self.right.map(|entry| -entry));
        let [tx, ty, tz, ox, oy, oz] = matrix.cholesky()?.solve(&right).into();
        let turn = [ox, oy, oz].map(|entry| entry * self.inverse_diameter);
        pose.moved_back(self.centre, [tx, ty, tz], turn)
    }
}
