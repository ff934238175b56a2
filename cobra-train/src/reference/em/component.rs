//! One Gaussian of a mixture.
//!
//! Owns its density and the cluster that comes of it; what it is fitted to is `em::steps`' work.

use crate::reference::Cluster;
use nalgebra::{Matrix3, Point3, SymmetricEigen};
use std::f64::consts::PI;

/// One weighted Gaussian; the weight is its share of the points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Component {
    pub(super) mean: Point3<f64>,
    /// S with SᵀS = Q = ½ Σ⁻¹.
    root: Matrix3<f64>,
    /// ln of the weight over √det 2πΣ.
    log_scale: f64,
}

impl Component {
    /// With the eigenvalues of `covariance` raised to `floor`.
    pub(super) fn new(
        mean: Point3<f64>,
        covariance: Matrix3<f64>,
        weight: f64,
        floor: f64,
    ) -> Self {
        let eigen = SymmetricEigen::new(covariance);
        let values = eigen.eigenvalues.map(|value| value.max(floor));
        let axes = eigen.eigenvectors;
        let log_determinant: f64 = values.iter().map(|value| libm::log(2.0 * PI * value)).sum();
        Self {
            mean,
            root: Matrix3::from_diagonal(&values.map(|value| (0.5 / value).sqrt()))
                * axes.transpose(),
            log_scale: libm::log(weight) - 0.5 * log_determinant,
        }
    }

    /// ln of the weighted density.
    pub(super) fn log_density(&self, point: &Point3<f64>) -> f64 {
        self.log_scale - (self.root * (point - self.mean)).norm_squared()
    }

    pub(super) fn cluster(&self) -> Cluster {
        Cluster::shaped(self.mean, self.root.tr_mul(&self.root))
            .expect("eigenvalues between the floor and the points' own spread")
    }
}
