//! A reference point with the shape of the cluster around it.
//!
//! Owns the precision Q_k of Eq. 8 and what is accepted as one. Which cluster a point belongs to is
//! `reference::membership`'s question.

use nalgebra::{Cholesky, Matrix3, Point3};

/// How far a precision may be from its transpose, as a share of its largest entry.
const SYMMETRY: f64 = 1e-9;

/// A reference point C_k and the precision Q_k that distances from it are measured with.
///
/// Frame and unit are the points' own: while a template is trained, the unit sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cluster {
    centre: Point3<f64>,
    precision: Option<Matrix3<f64>>,
}

/// Why a matrix is no precision.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("expected a symmetric positive definite matrix, found {found:?}")]
pub struct NotAPrecision {
    /// The matrix, row by row.
    pub found: [[f64; 3]; 3],
}

impl Cluster {
    /// A cluster with Q = I, as k-means sees clusters.
    #[must_use]
    pub const fn round(centre: Point3<f64>) -> Self {
        Self {
            centre,
            precision: None,
        }
    }

    /// A cluster with a shape; the upper half of `precision` is replaced by the lower one's
    /// transpose, so that rounding leaves no asymmetry.
    ///
    /// # Errors
    /// [`NotAPrecision`]: not finite, not symmetric to 10⁻⁹ of the largest entry, or not positive
    /// definite.
    pub fn shaped(centre: Point3<f64>, precision: Matrix3<f64>) -> Result<Self, NotAPrecision> {
        let mut symmetric = precision;
        symmetric.fill_upper_triangle_with_lower_triangle();
        let skew = (precision - precision.transpose()).amax();
        let usable = precision.iter().all(|entry| entry.is_finite())
            && skew <= SYMMETRY * precision.amax()
            && Cholesky::new(symmetric).is_some();
        if !usable {
            return Err(NotAPrecision {
                found: precision.transpose().into(),
            });
        }
        Ok(Self {
            centre,
            precision: Some(symmetric),
        })
    }

    /// C_k.
    #[must_use]
    pub const fn centre(&self) -> Point3<f64> {
        self.centre
    }

    /// Q_k, in 1/length², exactly symmetric; `None` stands for the identity.
    #[must_use]
    pub const fn precision(&self) -> Option<&Matrix3<f64>> {
        self.precision.as_ref()
    }

    /// (P − C_k)ᵀ Q_k (P − C_k), the exponent of Eq. 8.
    #[must_use]
    pub fn squared_distance(&self, point: &Point3<f64>) -> f64 {
        let offset = point - self.centre;
        match &self.precision {
            None => offset.norm_squared(),
            Some(precision) => offset.dot(&(precision * offset)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_euclidean_without_a_shape_and_stretched_with_one() {
        let point = Point3::new(1.0, 2.0, 4.0);
        let centre = Point3::new(0.0, 0.0, 1.0);
        assert_eq!(Cluster::round(centre).squared_distance(&point), 14.0);
        let precision = Matrix3::new(2.0, 0.5, 0.0, 0.5, 3.0, 0.0, 0.0, 0.0, 1.0);
        let shaped = Cluster::shaped(centre, precision).unwrap();
        assert_eq!(shaped.squared_distance(&point), 2.0 + 2.0 + 12.0 + 9.0);
        let identity = Cluster::shaped(centre, Matrix3::identity()).unwrap();
        assert_eq!(identity.squared_distance(&point), 14.0);
    }

    #[test]
    fn what_is_no_precision_is_refused_with_its_numbers() {
        let refused = |matrix| Cluster::shaped(Point3::origin(), matrix).unwrap_err();
        let flat = Matrix3::from_diagonal(&[1.0, 1.0, 0.0].into());
        let skew = Matrix3::new(1.0, 0.1, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
        for matrix in [flat, skew, -Matrix3::identity(), Matrix3::zeros()] {
            refused(matrix);
        }
        refused(Matrix3::from_diagonal(&[1.0, f64::NAN, 1.0].into()));
        refused(Matrix3::from_diagonal(&[1.0, f64::INFINITY, 1.0].into()));
        let said = refused(skew).to_string();
        assert!(said.contains("[1.0, 0.1, 0.0]"), "{said}");
    }
}
