//! The normal of the surface that a component describes, and points on it.
//!
//! Owns what follows from the gradient of the mean: F(P) = ‖P − C‖ − μ(u) is 0 on the surface and has the
//! gradient ∇F = u − (I − uuᵀ)∇μ(u)/‖P − C‖, at least 1 long; F/‖∇F‖ is the distance along the normal, as
//! far as the surface is flat.

use super::{Match, Mixture};
use crate::gp;
use crate::math::{self, Real};
use crate::template::Stored;
use crate::validity::{self, Cell};
use nalgebra::Point3;

/// ∇F at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Slope {
    /// ∇F/‖∇F‖.
    pub(crate) normal: [f32; 3],
    /// ‖∇F‖.
    pub(crate) length: f32,
}

impl<const COMPONENTS: usize> Mixture<'_, COMPONENTS> {
    /// ∇F of the component that spoke for a point; `None` where the gradient is not finite.
    pub(crate) fn slope(&self, point: &Point3<f32>, found: &Match) -> Option<Slope> {
        let component = self.template.stored_at(found.component)?;
        let offset = component.offset([point.x, point.y, point.z]);
        let (u, distance) = gp::direction_and_length(offset, self.smallest_distance)?;
        let [gx, gy, gz] = component.posterior_gradient(self.template.model(), &u);
        let along = math::dot([gx, gy, gz], [u.x, u.y, u.z]);
        let inverse = 1.0 / distance;
        let x = u.x - (gx - along * u.x) * inverse;
        let y = u.y - (gy - along * u.y) * inverse;
        let z = u.z - (gz - along * u.z) * inverse;
        let length = math::dot([x, y, z], [x, y, z]).square_root();
        (length.is_finite() && length > 0.0).then(|| Slope {
            normal: [x / length, y / length, z / length],
            length,
        })
    }

    /// exp(−distance²/2σ²) with the σ of the component that spoke.
    pub(crate) fn peak(&self, found: &Match, distance: f32) -> f32 {
        self.prepared.get(found.component).map_or(0.0, |prepared| {
            let scaled = distance * prepared.inverse_sigma;
            math::exp(-(0.5 * scaled * scaled))
        })
    }

    /// Points that the components predict where they may speak, about `spacing` apart: on the grid of each
    /// component's directions every so many cells, or several of a cell; `None` for a cell, or a point, where
    /// it may not speak. Nothing without validity.
    pub(crate) fn sample(&self, spacing: f32, take: &mut impl FnMut(Option<&Point3<f32>>)) {
        for (index, component) in self.template.stored().enumerate() {
            let validity = self.template.validities().and_then(|all| all.get(index));
            let Some(validity) = validity else {
                return;
            };
            // Along the middle of an octahedral face a cell is 2√(3/2)/side wide, seen from the centre.
            let width = 2.45 / f32::from(validity.side()) * self.usual_distance(component);
            let (every, within) = steps(spacing / width);
            let share = 1.0 / f32::from(within);
            let side = validity.side();
            let mut row = every / 2;
            while row < side {
                let mut column = every / 2;
                while column < side {
                    let cell = Cell { column, row };
                    if !validity.contains(cell) {
                        take(None);
                    } else {
                        for inside in 0..within * within {
                            let at = [inside % within, inside / within]
                                .map(|step| (f32::from(step) + 0.5) * share);
                            let u = validity::direction(validity.pole(), side, cell, at);
                            self.predicted_at(index, u, take);
                        }
                    }
                    column = column.saturating_add(every);
                }
                row = row.saturating_add(every);
            }
        }
    }

    /// About how far the surface is from a component's reference point: the prior mean, if it says that.
    fn usual_distance(&self, component: Stored<'_>) -> f32 {
        let prior = math::abs(component.prior_mean());
        if prior > 0.0 {
            prior
        } else {
            self.template.radius()
        }
    }

    /// The point that a component predicts in a direction, if it may.
    #[inline]
    fn predicted_at(
        &self,
        index: usize,
        [x, y, z]: [f32; 3],
        take: &mut impl FnMut(Option<&Point3<f32>>),
    ) {
        let found = || {
            let component = self.template.stored_at(index)?;
            let validity = self.template.validities()?.get(index)?;
            let u = nalgebra::Unit::new_unchecked(nalgebra::Vector3::new(x, y, z));
            let square = validity::square(validity.pole(), [x, y, z]);
            let mean = component.posterior_mean(self.template.model(), &u, Some(square));
            let place = self.place(component, &u, mean);
            let [cx, cy, cz] = component.centre();
            let point = Point3::new(cx + mean * x, cy + mean * y, cz + mean * z);
            (mean.is_finite() && validity.meets(place)).then_some(point)
        };
        take(found().as_ref());
    }
}

/// Every how many cells a point is taken, or how many along each side of a cell.
fn steps(cells: f32) -> (u8, u8) {
    // Rust's conversion rounds down, clamps, and takes NaN for 0.
    if cells >= 1.0 {
        ((cells as u8).clamp(1, validity::LARGEST_SIDE), 1)
    } else {
        (1, ((1.0 / cells + 0.999) as u8).clamp(1, 4))
    }
}
