//! Which components need not be asked, because what they would say cannot be the most probable.
//!
//! A component that speaks for P with residual e predicts a point at distance |e| from P, and inside its
//! own box. So if its box has no position in common with those of [P − r, P + r], then |e| > r, and it
//! finds P less probable than any whose cost is at most ½(r/σ)², plus the least ln σ for the density, σ
//! being the template's largest. Maximum assignment asks within the first reach, and then, if what it
//! found is not good enough for that, once more within the reach that this leaves; if it found nothing,
//! within a wider one before all are asked.
//!
//! Nothing of it may show in the answer, so the reach is widened by [`SLACK`] for rounding: offset,
//! length, direction and predicted point are each off by at most 8 units of 2⁻²⁴ of |P|, of |C_k| or of
//! the residual, and so is the cost, of which the logarithm, at most 89, is off by 2⁻¹⁸. Conversion to
//! positions rounds nothing that matters: it keeps order.

use super::Likelihood;
use super::slabs::{GROUP, Slabs};
use crate::math::{self, Real};
use crate::template::{Template, Validities, Window};
use crate::validity::BoxGrid;

/// What the reach is widened by, as a share of all lengths that are rounded on the way to it: 2⁻¹⁸.
const SLACK: f32 = 1.0 / 262_144.0;

/// Residuals that the wider look covers, in units of the largest σ: beyond, a likelihood is below 1 %.
const WIDE: f32 = 3.0;

/// Residuals that the first look covers at most, as a share of the radius. Where the measurement's σ is large
/// most points lie far closer to the surface than it, and few components reach as near.
const FIRST: f32 = 0.02;

/// The first look covers no less, in units of the largest σ, and no less than [`WIDE`] where a logarithm is part
/// of the cost: its rounding is to stay far below what [`SLACK`] leaves.
const NARROWEST: f32 = 1e-3;

/// How far around a point components are asked.
#[derive(Clone, Copy, Debug)]
pub(super) struct Look {
    pub(super) reach: f32,
    /// With a cost of no more than this nobody beyond the reach can be more probable.
    pub(super) enough: f32,
}

impl Look {
    /// All are asked.
    pub(super) const EVERYWHERE: Self = Self {
        reach: f32::INFINITY,
        enough: f32::INFINITY,
    };
}

/// What is known of a template beforehand.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    grid: BoxGrid,
    /// The first look: everywhere, where all are asked at once.
    pub(super) first: Look,
    wide: Look,
    radius: f32,
    largest_sigma: f32,
    least_cost: f32,
    /// The largest coordinate of a reference point, in magnitude.
    furthest: f32,
    slabs: Slabs,
}

impl Reach {
    /// Of no component yet.
    pub(super) fn new(template: &Template<'_>) -> Self {
        Self {
            grid: BoxGrid::new(template.centre(), template.radius()),
            first: Look::EVERYWHERE,
            wide: Look::EVERYWHERE,
            radius: template.radius(),
            largest_sigma: 0.0,
            least_cost: f32::INFINITY,
            furthest: 0.0,
            slabs: Slabs::NONE,
        }
    }

    /// Takes a component in: where it lies, its σ, and what its cost is with a residual of 0.
    pub(super) fn take(&mut self, centre: [f32; 3], sigma: f32, least_cost: f32) {
        for coordinate in centre {
            self.furthest = larger(self.furthest, math::abs(coordinate));
        }
        self.largest_sigma = larger(self.largest_sigma, sigma);
        self.least_cost = -larger(-self.least_cost, -least_cost);
    }

    /// All components are taken in, and need not be asked all at once.
    pub(super) fn prune(&mut self, validities: &Validities<'_>, likelihood: Likelihood) {
        self.wide = self.reaching(WIDE);
        let sigmas = FIRST * self.radius / self.largest_sigma;
        let narrow = likelihood == Likelihood::Peak && sigmas > NARROWEST && sigmas < WIDE;
        self.first = if narrow {
            self.reaching(sigmas)
        } else {
            self.wide
        };
        self.slabs.take(validities);
    }

    /// The components of a group, of so many in all, that may meet the window, and perhaps others.
    #[inline]
    pub(super) fn meeting(&self, group: usize, window: Window, count: usize) -> u32 {
        match self.slabs.meeting(group, window) {
            Some(components) => components,
            None => match count.saturating_sub(group * GROUP) {
                some @ 0..GROUP => (1_u32 << some).wrapping_sub(1),
                _ => u32::MAX,
            },
        }
    }

    /// The positions that are no farther than `reach` from a point along each axis.
    #[inline(always)]
    pub(super) fn window(&self, at: [f32; 3], reach: f32) -> Window {
        let [x, y, z] = at;
        let size = (math::abs(x) + math::abs(y)) + math::abs(z);
        let reach = reach + (size + (self.furthest + reach)) * SLACK;
        Window::between(
            self.grid.position([x - reach, y - reach, z - reach]),
            self.grid.position([x + reach, y + reach, z + reach]),
        )
    }

    /// The position of a point alone.
    #[inline]
    pub(super) fn position(&self, point: [f32; 3]) -> Window {
        let position = self.grid.position(point);
        Window::between(position, position)
    }

    fn reaching(&self, sigmas: f32) -> Look {
        Look {
            reach: sigmas * self.largest_sigma,
            enough: self.least_cost + 0.5 * sigmas * sigmas,
        }
    }

    /// The look after one that found no better than `least`: as far as that asks for, which can only improve
    /// it; where nothing was found, wide, and then everywhere.
    // Out of line, a controller takes 40 instructions less for a point, most of which are found at once.
    #[inline(never)]
    pub(super) fn after(&self, look: Look, least: f32) -> Look {
        if least < f32::INFINITY {
            Look {
                // The largest residual that costs no more.
                reach: self.largest_sigma * (2.0 * (least - self.least_cost)).square_root(),
                enough: f32::INFINITY,
            }
        } else if look.reach < self.wide.reach {
            self.wide
        } else {
            Look::EVERYWHERE
        }
    }
}

/// Of two numbers, none of which is NaN.
fn larger(a: f32, b: f32) -> f32 {
    if a < b { b } else { a }
}
