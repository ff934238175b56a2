//! What is minimised: the negative log marginal likelihood per point over logarithms.

use super::search_box::SearchBox;
use crate::gp::cholesky::NotPositiveDefinite;
use crate::gp::gram::Coordinates;
use crate::gp::likelihood::negative_log_marginal_likelihood;
use cobra_infer::kernel::Kernel;

/// L(θ)/n of targets `y` at directions `points`, at least one.
#[derive(Clone, Debug)]
pub(super) struct Objective<'a> {
    pub(super) kernel: Kernel,
    pub(super) points: &'a Coordinates,
    pub(super) y: &'a [f64],
    pub(super) search_box: SearchBox,
}

impl Objective<'_> {
    /// The value and its gradient by the logarithms.
    pub(super) fn at(&self, logarithms: &[f64]) -> Result<(f64, Vec<f64>), NotPositiveDefinite> {
        let n = self.y.len() as f64;
        let h = self.search_box.unpack(logarithms);
        let found = negative_log_marginal_likelihood(self.kernel, &h, self.points, self.y)?;
        let gradient = found.gradient.iter().map(|g| g / n).collect();
        Ok((found.value / n, gradient))
    }
}
