//! The negative log marginal likelihood and its gradient.
//!
//! L(θ) = ½ yᵀK⁻¹y + ½ log det K + (n/2) log 2π with K = v·k(X, X) + η·I (the paper's supplement,
//! Loss function), θ the logarithms of what the kernel leaves free: the length scale l, the signal
//! variance v, the noise variance η, and the kernel's parameter besides. The gradient is
//! ∂L/∂θ = ½ (tr(K⁻¹ ∂K/∂θ) − wᵀ ∂K/∂θ w) with w = K⁻¹y (Rasmussen and Williams, Gaussian Processes
//! for Machine Learning, 2006, Eq. 5.9).

use super::cholesky::{Cholesky, NotPositiveDefinite};
use super::gram::{Coordinates, Hyperparameters, gram};
use cobra_infer::kernel::{Exponent, Kernel, Smoothness, squared_distance};
use faer::Mat;

/// L and its gradient.
#[derive(Clone, Debug, PartialEq)]
pub struct LikelihoodAndGradient {
    /// L(θ).
    pub value: f64,
    /// ∂L/∂ log l where the kernel has a length scale, ∂L/∂ log v, ∂L/∂ log η, and the derivative
    /// by the logarithm of the kernel's parameter where that is free.
    pub gradient: Vec<f64>,
}

/// L(θ) and its gradient for targets `y` at directions `points`.
///
/// # Errors
/// [`NotPositiveDefinite`] where the hyperparameters make K numerically singular.
///
/// # Panics
/// Unless there are as many targets as directions.
pub fn negative_log_marginal_likelihood(
    kernel: Kernel,
    hyperparameters: &Hyperparameters,
    points: &Coordinates,
    y: &[f64],
) -> Result<LikelihoodAndGradient, NotPositiveDefinite> {
    let n = y.len();
    assert_eq!(n, points.len(), "a target a direction");
    let gram = gram(kernel, hyperparameters, points);
    let factor = Cholesky::new(gram.clone())?;
    let w = factor.solve(y);
    let inverse = factor.inverse();
    let fit: f64 = y.iter().zip(&w).map(|(y, w)| y * w).sum();
    let value = 0.5 * fit
        + 0.5 * factor.log_determinant()
        + 0.5 * n as f64 * (2.0 * std::f64::consts::PI).ln();

    let noise = hyperparameters.noise_variance;
    let trace: f64 = (0..n).map(|i| inverse[(i, i)]).sum();
    let norm: f64 = w.iter().map(|w| w * w).sum();
    let by_noise = 0.5 * noise * (trace - norm);
    // v·k(X, X) = K − η·I, so that no further product is needed.
    let by_signal = 0.5 * (n as f64 - fit) - by_noise;
    let by_kernel = Sensitivities {
        gram: &gram,
        inverse: &inverse,
        w: &w,
        points,
        noise,
    }
    .of(kernel, hyperparameters);

    let mut gradient = Vec::with_capacity(4);
    if kernel.fixed_length_scale().is_none() {
        gradient.push(by_kernel.length_scale);
    }
    gradient.extend([by_signal, by_noise]);
    if kernel.fixed_parameter().is_none() {
        gradient.push(by_kernel.parameter);
    }
    Ok(LikelihoodAndGradient { value, gradient })
}

/// Derivatives by the logarithms of a kernel's own hyperparameters, of L or of one entry of K.
#[derive(Clone, Copy, Default)]
struct ByLogarithm {
    length_scale: f64,
    parameter: f64,
}

impl ByLogarithm {
    fn length_scale(length_scale: f64) -> Self {
        Self {
            length_scale,
            parameter: 0.0,
        }
    }
}

/// What the gradient's sums run over: ½ Σᵢⱼ (K⁻¹ − wwᵀ)ᵢⱼ ∂Kᵢⱼ/∂θ.
struct Sensitivities<'a> {
    gram: &'a Mat<f64>,
    inverse: &'a Mat<f64>,
    w: &'a [f64],
    points: &'a Coordinates,
    noise: f64,
}

impl Sensitivities<'_> {
    /// Each arm is the derivative of one entry v·k, given the points and the entry.
    fn of(&self, kernel: Kernel, h: &Hyperparameters) -> ByLogarithm {
        let (l, p) = (h.length_scale, h.parameter);
        let inverse_square = 1.0 / (l * l);
        match kernel {
            Kernel::RationalQuadratic(Exponent::Free) => {
                let scale = 0.5 * inverse_square / p;
                self.sum(move |a, b, vk| {
                    let x = scale * squared_distance(a, b);
                    let share = x / (1.0 + x);
                    ByLogarithm {
                        length_scale: 2.0 * p * vk * share,
                        parameter: p * vk * (share - x.ln_1p()),
                    }
                })
            }
            // The logarithm would take a fifth of all training where nobody asks for it.
            Kernel::RationalQuadratic(_) => {
                let scale = 0.5 * inverse_square / p;
                self.sum(move |a, b, vk| {
                    let x = scale * squared_distance(a, b);
                    ByLogarithm::length_scale(2.0 * p * vk * (x / (1.0 + x)))
                })
            }
            Kernel::RadialBasis => self.sum(move |a, b, vk| {
                ByLogarithm::length_scale(vk * squared_distance(a, b) * inverse_square)
            }),
            Kernel::Matern(Smoothness::Half) => self.sum(move |a, b, vk| {
                ByLogarithm::length_scale(vk * squared_distance(a, b).sqrt() / l)
            }),
            // With z = √3·r/l: k = (1 + z)e⁻ᶻ, ∂k/∂ log l = z²e⁻ᶻ.
            Kernel::Matern(Smoothness::ThreeHalves) => self.sum(move |a, b, vk| {
                let z = (3.0 * squared_distance(a, b)).sqrt() / l;
                ByLogarithm::length_scale(vk * z * z / (1.0 + z))
            }),
            // With z = √5·r/l: k = (1 + z + z²/3)e⁻ᶻ, ∂k/∂ log l = (z²/3)(1 + z)e⁻ᶻ.
            Kernel::Matern(Smoothness::FiveHalves) => self.sum(move |a, b, vk| {
                let z = (5.0 * squared_distance(a, b)).sqrt() / l;
                let third = z * z / 3.0;
                ByLogarithm::length_scale(vk * third * (1.0 + z) / (1.0 + z + third))
            }),
            Kernel::Linear => ByLogarithm::default(),
            // With q = a·b + c: k = q³, ∂k/∂ log c = 3cq².
            Kernel::Polynomial => {
                let v = h.signal_variance;
                self.sum(move |a, b, _| {
                    let q = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + p;
                    ByLogarithm {
                        length_scale: 0.0,
                        parameter: 3.0 * p * v * q * q,
                    }
                })
            }
            // With tᵢ = π(aᵢ − bᵢ)/p: ∂k/∂ log l = 4k Σ sin² tᵢ/l², ∂k/∂ log p = 2k Σ tᵢ sin 2tᵢ/l².
            Kernel::Periodic => {
                let frequency = std::f64::consts::PI / p;
                self.sum(move |a, b, vk| {
                    let t = [0, 1, 2].map(|i| frequency * (a[i] - b[i]));
                    let squares: f64 = t.iter().map(|t| t.sin().powi(2)).sum();
                    let slopes: f64 = t.iter().map(|t| t * (2.0 * t).sin()).sum();
                    ByLogarithm {
                        length_scale: 4.0 * vk * squares * inverse_square,
                        parameter: 2.0 * vk * slopes * inverse_square,
                    }
                })
            }
        }
    }

    fn sum(&self, derivative: impl Fn([f64; 3], [f64; 3], f64) -> ByLogarithm) -> ByLogarithm {
        let mut total = ByLogarithm::default();
        let mut add = |sensitivity: f64, by: ByLogarithm| {
            total.length_scale += sensitivity * by.length_scale;
            total.parameter += sensitivity * by.parameter;
        };
        for j in 0..self.w.len() {
            let point = self.points.at(j);
            let diagonal = self.gram[(j, j)] - self.noise;
            let sensitivity = self.inverse[(j, j)] - self.w[j] * self.w[j];
            add(0.5 * sensitivity, derivative(point, point, diagonal));
            // Off the diagonal, both triangles count.
            let entries = self.gram.col_as_slice(j)[j + 1..]
                .iter()
                .zip(self.points.from(j + 1))
                .zip(&self.inverse.col_as_slice(j)[j + 1..])
                .zip(&self.w[j + 1..]);
            for (((entry, other), inverse), wi) in entries {
                add(inverse - wi * self.w[j], derivative(point, other, *entry));
            }
        }
        total
    }
}
