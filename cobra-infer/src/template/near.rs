//! How near a template's components are to a point.
//!
//! Owns (P − C_k)ᵀQ_k(P − C_k) over the records, of which only the reference point is read: the
//! search for the nearest component is most of what a point costs besides its Gaussian process.

use super::wire;
use super::{Precision, Template};
use crate::math;

impl Template<'_> {
    /// The component of the least (P − C_k)ᵀQ_k(P − C_k), the first of equals; without precisions,
    /// of the least ‖P − C_k‖². Of those that are valid in the point's direction. `None` where none of
    /// these is a finite number.
    pub(crate) fn nearest(&self, point: [f32; 3]) -> Option<usize> {
        if self.has_validity() {
            let mut best = None;
            let mut least = f32::INFINITY;
            for index in 0..self.records.len() {
                let measure = self.measure(index, point);
                if measure < least && self.is_valid_towards(index, point) {
                    (best, least) = (Some(index), measure);
                }
            }
            return best;
        }
        let records = self.records.iter();
        match self.precisions {
            None => least(records.map(|record| {
                let offset = wire::offset(record, point);
                math::dot(offset, offset)
            })),
            Some(factors) => least(records.zip(factors).map(|(record, factor)| {
                Precision::from_record(factor).form(wire::offset(record, point))
            })),
        }
    }

    /// What [`Template::nearest`] compares.
    fn measure(&self, index: usize, point: [f32; 3]) -> f32 {
        let Some(record) = self.records.get(index) else {
            return f32::INFINITY;
        };
        let offset = wire::offset(record, point);
        match self.precisions.and_then(|factors| factors.get(index)) {
            Some(factor) => Precision::from_record(factor).form(offset),
            None => math::dot(offset, offset),
        }
    }

    /// Whether the cell of P − C_k is valid; without validity it always is.
    pub(crate) fn is_valid_towards(&self, index: usize, point: [f32; 3]) -> bool {
        let Some(validities) = self.validities() else {
            return true;
        };
        let validity = validities.get(index).zip(self.records.get(index));
        validity.is_some_and(|(validity, record)| {
            validity.contains_direction(wire::offset(record, point))
        })
    }

    /// The exponent of Eq. 8 of component `index`, (P − C_k)ᵀQ_k(P − C_k); without precisions
    /// ‖(P − C_k)/radius‖², each coordinate multiplied by 1/radius first. Infinite where there is no
    /// such component.
    pub(crate) fn exponent(&self, index: usize, point: [f32; 3]) -> f32 {
        let Some(record) = self.records.get(index) else {
            return f32::INFINITY;
        };
        let offset = wire::offset(record, point);
        match self.precisions.and_then(|factors| factors.get(index)) {
            Some(factor) => Precision::from_record(factor).form(offset),
            None => {
                let inverse_radius = 1.0 / self.radius;
                let scaled = offset.map(|coordinate| coordinate * inverse_radius);
                math::dot(scaled, scaled)
            }
        }
    }
}

/// The index of the least finite number, the first of equals.
fn least(numbers: impl Iterator<Item = f32>) -> Option<usize> {
    let mut best = None;
    let mut least = f32::INFINITY;
    for (index, number) in numbers.enumerate() {
        if number < least {
            least = number;
            best = Some(index);
        }
    }
    best
}
