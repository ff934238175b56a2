//! Where a search starts.
//!
//! Owns the starts; the box that they are brought into is `search_box`'s.

use super::search_box::SearchBox;
use cobra_infer::kernel::Kernel;

/// Where a search for hyperparameters starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// What the targets suggest: l = ½, v = their mean square, η = v/1000, the kernel's parameter 1,
    /// or one turn, 2π, as a period.
    Targets,
    /// GPyTorch's, whose raw values are all 0: every hyperparameter softplus(0) = ln 2, η that above
    /// its floor.
    Softplus,
}

impl Start {
    /// The logarithms, in the order and within the edges of `search_box`, for targets `y`, at least
    /// one.
    pub(super) fn logarithms(self, kernel: Kernel, search_box: &SearchBox, y: &[f64]) -> Vec<f64> {
        let ln_2 = std::f64::consts::LN_2;
        let mean_square = (y.iter().map(|y| y * y).sum::<f64>() / y.len() as f64).max(1e-8);
        let (length_scale, signal, noise, parameter) = match self {
            Self::Targets => {
                let parameter = match kernel {
                    // One turn, of coordinates that are angles or differ by at most 2.
                    Kernel::Periodic => std::f64::consts::TAU,
                    _ => 1.0,
                };
                (0.5, mean_square, 1e-3 * mean_square, parameter)
            }
            Self::Softplus => (ln_2, ln_2, search_box.noise_floor() + ln_2, ln_2),
        };
        let mut start = vec![signal.ln(), noise.ln()];
        if kernel.fixed_length_scale().is_none() {
            start.insert(0, length_scale.ln());
        }
        if kernel.fixed_parameter().is_none() {
            start.push(parameter.ln());
        }
        search_box.clamp(&mut start);
        start
    }
}

#[cfg(test)]
mod tests {
    use super::super::search_box;
    use super::*;
    use cobra_infer::kernel::Exponent;

    const FREE: Kernel = Kernel::RationalQuadratic(Exponent::Free);

    #[test]
    fn the_targets_start_is_what_their_mean_square_suggests() {
        let found = Start::Targets.logarithms(FREE, &search_box(FREE, 1e-5), &[0.3, -0.4]);
        let expected = [0.5, 0.125, 1.25e-4, 1.0];
        for (found, expected) in found.iter().zip(expected) {
            assert!((found.exp() - expected).abs() < 1e-12, "{found}");
        }
    }

    #[test]
    fn the_softplus_start_is_ln_2_with_the_noise_at_the_boxes_edge() {
        let search_box = search_box(FREE, 1e-4);
        let found = Start::Softplus.logarithms(FREE, &search_box, &[0.3, -0.4]);
        let ln_2 = 2.0_f64.ln();
        let expected = [ln_2, ln_2, search_box.upper().noise_variance, ln_2];
        for (found, expected) in found.iter().zip(expected) {
            assert!((found.exp() - expected).abs() < 1e-12, "{found}");
        }
    }

    #[test]
    fn every_start_lies_in_the_box_and_has_its_length() {
        for kernel in Kernel::ALL {
            let search_box = search_box(kernel, 1e-4);
            for start in [Start::Targets, Start::Softplus] {
                for y in [[1e-9, 0.0], [1e3, -1e3]] {
                    let found = start.logarithms(kernel, &search_box, &y);
                    assert_eq!(found.len(), search_box.lower.len());
                    assert!(
                        search_box.contains(&search_box.unpack(&found)),
                        "{kernel:?}"
                    );
                }
            }
        }
    }
}
