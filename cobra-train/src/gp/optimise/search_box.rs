//! The hyperparameters a search may reach, and the vectors that an optimiser moves.
//!
//! Owns the box and the order of the variables, which is the gradient's. The box keeps the search
//! where the data can say something: a sphere, for one, has no finite best length scale. Does not
//! own where a search starts.

use crate::gp::gram::Hyperparameters;
use cobra_infer::kernel::Kernel;

const LENGTH_SCALE_LOG: (f64, f64) = (-5.0, 3.0);
const SIGNAL_VARIANCE_LOG: (f64, f64) = (-14.0, 6.0);
const NOISE_VARIANCE_LOG_MOST: f64 = -2.0;

/// Where the hyperparameters of a kernel are looked for.
#[derive(Clone, Debug, PartialEq)]
pub struct SearchBox {
    kernel: Kernel,
    noise_floor: f64,
    /// Logarithms of what the kernel leaves free, in the gradient's order.
    pub(super) lower: Vec<f64>,
    pub(super) upper: Vec<f64>,
}

/// Where hyperparameters of `kernel` are looked for when the noise variance is at least
/// `noise_floor` (unit sphere).
#[must_use]
pub fn search_box(kernel: Kernel, noise_floor: f64) -> SearchBox {
    let mut ranges = vec![
        SIGNAL_VARIANCE_LOG,
        (
            noise_floor.ln(),
            NOISE_VARIANCE_LOG_MOST.max(noise_floor.ln()),
        ),
    ];
    if kernel.fixed_length_scale().is_none() {
        ranges.insert(0, LENGTH_SCALE_LOG);
    }
    if kernel.fixed_parameter().is_none() {
        ranges.push(match kernel {
            Kernel::Periodic => (-2.0, 5.0),
            Kernel::Polynomial => (-7.0, 5.0),
            _ => (-4.0, 3.0),
        });
    }
    let (lower, upper) = ranges.into_iter().unzip();
    SearchBox {
        kernel,
        noise_floor,
        lower,
        upper,
    }
}

impl SearchBox {
    /// The least of each hyperparameter; what the kernel fixes, where it fixes one.
    #[must_use]
    pub fn lower(&self) -> Hyperparameters {
        self.unpack(&self.lower)
    }

    /// The most of each hyperparameter; what the kernel fixes, where it fixes one.
    #[must_use]
    pub fn upper(&self) -> Hyperparameters {
        self.unpack(&self.upper)
    }

    /// Whether the search may end at `h`.
    #[must_use]
    pub fn contains(&self, h: &Hyperparameters) -> bool {
        let values = |h: &Hyperparameters| {
            [
                h.length_scale,
                h.signal_variance,
                h.noise_variance,
                h.parameter,
            ]
        };
        let (lower, upper) = (values(&self.lower()), values(&self.upper()));
        (values(h).iter().zip(lower).zip(upper)).all(|((h, low), high)| (low..=high).contains(h))
    }

    /// The least noise variance.
    pub(super) const fn noise_floor(&self) -> f64 {
        self.noise_floor
    }

    /// Brings logarithms into the box.
    pub(super) fn clamp(&self, logarithms: &mut [f64]) {
        for ((value, low), high) in logarithms.iter_mut().zip(&self.lower).zip(&self.upper) {
            *value = value.clamp(*low, *high);
        }
    }

    /// The logarithms of the free ones of `h`, brought into the box.
    pub(super) fn pack(&self, h: &Hyperparameters) -> Vec<f64> {
        let mut logarithms = vec![h.signal_variance.ln(), h.noise_variance.ln()];
        if self.kernel.fixed_length_scale().is_none() {
            logarithms.insert(0, h.length_scale.ln());
        }
        if self.kernel.fixed_parameter().is_none() {
            logarithms.push(h.parameter.ln());
        }
        self.clamp(&mut logarithms);
        logarithms
    }

    /// Hyperparameters from the logarithms of the free ones.
    pub(super) fn unpack(&self, logarithms: &[f64]) -> Hyperparameters {
        let mut values = logarithms.iter().map(|logarithm| logarithm.exp());
        let mut next = |fixed: Option<f32>| match fixed {
            Some(fixed) => f64::from(fixed),
            None => values.next().unwrap_or(1.0),
        };
        Hyperparameters {
            length_scale: next(self.kernel.fixed_length_scale()),
            signal_variance: next(None),
            // A logarithm and its exponential may miss the floor by a rounding.
            noise_variance: next(None).max(self.noise_floor),
            parameter: next(self.kernel.fixed_parameter()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cobra_infer::kernel::Exponent;

    #[test]
    fn what_a_kernel_fixes_is_fixed_in_its_box() {
        for kernel in Kernel::ALL {
            let found = search_box(kernel, 1e-5);
            let (lower, upper) = (found.lower(), found.upper());
            assert_eq!(
                lower.length_scale == upper.length_scale,
                kernel.fixed_length_scale().is_some()
            );
            assert_eq!(
                lower.parameter == upper.parameter,
                kernel.fixed_parameter().is_some()
            );
            assert!(found.contains(&lower) && found.contains(&upper));
        }
    }

    #[test]
    fn a_step_over_any_edge_is_outside() {
        let found = search_box(Kernel::RationalQuadratic(Exponent::Free), 1e-5);
        let outside: [fn(&mut Hyperparameters); 4] = [
            |h| h.length_scale *= 1.01,
            |h| h.signal_variance *= 1.01,
            |h| h.noise_variance *= 1.01,
            |h| h.parameter *= 1.01,
        ];
        for step in outside {
            let mut h = found.upper();
            step(&mut h);
            assert!(!found.contains(&h), "{h:?}");
        }
    }

    #[test]
    fn the_noise_never_falls_below_its_floor() {
        for floor in [1e-6, 1e-5, 1e-4, 0.3] {
            let found = search_box(Kernel::RadialBasis, floor);
            assert!(found.lower().noise_variance >= floor);
            assert!(found.upper().noise_variance >= floor);
        }
    }
}
