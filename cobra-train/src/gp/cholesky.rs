//! The Cholesky factorisation of a Gram matrix, in double precision, on one thread.
//!
//! Owns the choice of one thread: components are trained in parallel, and a factorisation that
//! spread over threads would make the last bits depend on their number.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt;
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Mat, MatMut, Par};

/// K = LLᵀ.
#[derive(Clone, Debug)]
pub struct Cholesky {
    lower: Mat<f64>,
}

/// A matrix was not positive definite.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the Gram matrix of {size} points is not positive definite (pivot {pivot})")]
pub struct NotPositiveDefinite {
    /// Rows of the matrix.
    pub size: usize,
    /// The failing pivot, from 0.
    pub pivot: usize,
}

impl Cholesky {
    /// Factorises a symmetric matrix of which only the lower triangle is read.
    ///
    /// # Errors
    /// [`NotPositiveDefinite`] names the failing pivot.
    pub fn new(mut matrix: Mat<f64>) -> Result<Self, NotPositiveDefinite> {
        let size = matrix.nrows();
        let scratch =
            llt::factor::cholesky_in_place_scratch::<f64>(size, Par::Seq, Default::default());
        llt::factor::cholesky_in_place(
            matrix.as_mut(),
            Default::default(),
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
            Default::default(),
        )
        .map_err(|llt::factor::LltError::NonPositivePivot { index }| {
            NotPositiveDefinite { size, pivot: index }
        })?;
        Ok(Self { lower: matrix })
    }

    /// K⁻¹b.
    #[must_use]
    pub fn solve(&self, b: &[f64]) -> Vec<f64> {
        let mut x = b.to_vec();
        let size = self.lower.nrows();
        llt::solve::solve_in_place(
            self.lower.as_ref(),
            MatMut::from_column_major_slice_mut(&mut x, size, 1),
            Par::Seq,
            MemStack::new(&mut []),
        );
        x
    }

    /// bᵀK⁻¹b = ‖L⁻¹b‖²: never negative.
    #[must_use]
    pub fn quadratic_form(&self, b: &[f64]) -> f64 {
        let mut x = b.to_vec();
        let size = self.lower.nrows();
        solve_lower_triangular_in_place(
            self.lower.as_ref(),
            MatMut::from_column_major_slice_mut(&mut x, size, 1),
            Par::Seq,
        );
        x.iter().map(|x| x * x).sum()
    }

    /// log det K.
    #[must_use]
    pub fn log_determinant(&self) -> f64 {
        2.0 * (0..self.lower.nrows())
            .map(|i| self.lower[(i, i)].ln())
            .sum::<f64>()
    }

    /// K⁻¹, of which only the lower triangle is meaningful.
    #[must_use]
    pub fn inverse(&self) -> Mat<f64> {
        let size = self.lower.nrows();
        let mut inverse = Mat::zeros(size, size);
        let scratch = llt::inverse::inverse_scratch::<f64>(size, Par::Seq);
        llt::inverse::inverse(
            inverse.as_mut(),
            self.lower.as_ref(),
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
        );
        inverse
    }
}
