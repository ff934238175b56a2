//! A component where it lies in the file.
//!
//! Owns what scoring reads of a record, field by field and when it is needed: a [`Component`] holds
//! all of them, and putting one together for each point costs more than the search for it.

use super::wire::{self, Record, TermValues};
use super::{Component, Precision, Template, Validity};
use crate::gp::{self, Hyperparameters, Terms, UnitDirection};
use crate::kernel::Model;
use crate::validity::Square;

/// A record, and the terms that it names a range of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stored<'a> {
    record: &'a Record,
    values: TermValues<'a>,
}

impl<'a> Template<'a> {
    /// The components as they lie in the file.
    pub(crate) fn stored(&self) -> impl Iterator<Item = Stored<'a>> + use<'a> {
        let values = self.values;
        self.records
            .iter()
            .map(move |record| Stored::new(record, values))
    }

    /// Component `index` as it lies in the file.
    #[inline]
    pub(crate) fn stored_at(&self, index: usize) -> Option<Stored<'a>> {
        Some(Stored::new(self.records.get(index)?, self.values))
    }
}

impl<'a> Stored<'a> {
    #[inline]
    pub(super) fn new(record: &'a Record, values: TermValues<'a>) -> Self {
        Self { record, values }
    }

    /// C_k.
    #[inline]
    pub(crate) fn centre(&self) -> [f32; 3] {
        wire::centre(self.record)
    }

    /// P − C_k.
    #[inline]
    pub(crate) fn offset(&self, point: [f32; 3]) -> [f32; 3] {
        wire::offset(self.record, point)
    }

    /// σ̂_k.
    pub(crate) fn sigma_hat(&self) -> f32 {
        let [_, _, _, sigma_hat, ..] = *self.record;
        f32::from_le_bytes(sigma_hat)
    }

    /// Where its terms start, in the unit of the encoding, and how many there are.
    pub(super) fn term_range(&self) -> Option<(usize, usize)> {
        let (first, count) = wire::term_range(self.record);
        Some((usize::try_from(first).ok()?, usize::try_from(count).ok()?))
    }

    /// Of a record that was not validated, none.
    #[inline]
    pub(super) fn terms(&self) -> Terms<'a> {
        self.values
            .of(self.record)
            .unwrap_or(Terms::from_quads(&[]))
    }

    #[inline(always)]
    pub(super) fn hyperparameters(&self) -> Hyperparameters {
        let [_, _, _, _, length_scale, parameter, prior_mean, ..] = *self.record;
        Hyperparameters {
            length_scale: f32::from_le_bytes(length_scale),
            parameter: f32::from_le_bytes(parameter),
            prior_mean: f32::from_le_bytes(prior_mean),
        }
    }

    /// [`Component::posterior_mean`] in the direction that lies at `square` on the component's map of
    /// directions, which there is where it has validity.
    #[inline(always)]
    pub(crate) fn posterior_mean(
        &self,
        model: Model,
        u: &UnitDirection,
        square: Option<Square>,
    ) -> f32 {
        if let (Some(map), Some(square)) = (self.values.map(self.record), square) {
            return self.hyperparameters().prior_mean + map.above_prior(square);
        }
        gp::posterior_mean_at(model, &self.hyperparameters(), &self.terms(), u, square)
    }

    /// The gradient of the mean in a direction.
    pub(crate) fn posterior_gradient(&self, model: Model, u: &UnitDirection) -> [f32; 3] {
        gp::posterior_gradient(model, &self.hyperparameters(), &self.terms(), u)
    }

    /// The component's average distance, where that is its prior mean.
    pub(crate) fn prior_mean(&self) -> f32 {
        self.hyperparameters().prior_mean
    }

    /// All of it, with the precision and the validity that belong to it.
    pub(super) fn component(
        &self,
        precision: Option<Precision>,
        validity: Option<Validity<'a>>,
    ) -> Component<'a> {
        Component {
            centre: self.centre(),
            sigma_hat: self.sigma_hat(),
            precision,
            hyperparameters: self.hyperparameters(),
            terms: self.terms(),
            validity,
        }
    }
}
