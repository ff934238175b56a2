//! The negative log marginal likelihood and its gradient.
//!
//! L(θ) = ½ yᵀK⁻¹y + ½ log det K + (n/2) log 2π with K = v·k(S) + η·I (the paper's supplement,
//! Loss function), θ the logarithms of the length scale l, the signal variance v, the noise
//! variance η and, where the kernel leaves it free, the exponent α. The gradient is
//! ∂L/∂θ = ½ (tr(K⁻¹ ∂K/∂θ) − wᵀ ∂K/∂θ w) with w = K⁻¹y (Rasmussen and Williams, Gaussian Processes
//! for Machine Learning, 2006, Eq. 5.9).

use super::cholesky::{Cholesky, NotPositiveDefinite};
use cobra_infer::kernel::{
    Covariance, Exponent, Kernel, RationalQuadraticFree, RationalQuadraticHalf,
    RationalQuadraticOne,
};
use faer::Mat;
use nalgebra::UnitVector3;

/// What is learned: all positive, in units of the chord (`length_scale`) and of the unit sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hyperparameters {
    /// l.
    pub length_scale: f64,
    /// v.
    pub signal_variance: f64,
    /// η.
    pub noise_variance: f64,
    /// α; what the kernel fixes, where it fixes one.
    pub exponent: f64,
}

/// L and its gradient.
#[derive(Clone, Debug, PartialEq)]
pub struct LikelihoodAndGradient {
    /// L(θ).
    pub value: f64,
    /// ∂L/∂ log l, ∂L/∂ log v, ∂L/∂ log η, and ∂L/∂ log α when α is free.
    pub gradient: Vec<f64>,
}

/// The covariance function at squared distance `s`, with unit variance.
#[must_use]
pub fn covariance(kernel: Kernel, hyperparameters: &Hyperparameters, s: f64) -> f64 {
    let l = hyperparameters.length_scale;
    let Kernel::RationalQuadratic(exponent) = kernel;
    match exponent {
        Exponent::One => RationalQuadraticOne::new(l).at(s),
        Exponent::Half => RationalQuadraticHalf::new(l).at(s),
        Exponent::Free => RationalQuadraticFree::new(l, hyperparameters.exponent).at(s),
    }
}

/// The squared chords between all directions: ‖uᵢ − uⱼ‖².
#[must_use]
pub fn squared_distances(directions: &[UnitVector3<f64>]) -> Mat<f64> {
    let n = directions.len();
    Mat::from_fn(n, n, |i, j| {
        (directions[i].into_inner() - directions[j].into_inner()).norm_squared()
    })
}

/// v·k(S) + η·I, the lower triangle only.
#[must_use]
pub fn gram(kernel: Kernel, hyperparameters: &Hyperparameters, squared: &Mat<f64>) -> Mat<f64> {
    let l = hyperparameters.length_scale;
    let Kernel::RationalQuadratic(exponent) = kernel;
    match exponent {
        Exponent::One => gram_of(RationalQuadraticOne::new(l), hyperparameters, squared),
        Exponent::Half => gram_of(RationalQuadraticHalf::new(l), hyperparameters, squared),
        Exponent::Free => {
            let kernel = RationalQuadraticFree::new(l, hyperparameters.exponent);
            gram_of(kernel, hyperparameters, squared)
        }
    }
}

fn gram_of(
    kernel: impl Covariance<f64>,
    hyperparameters: &Hyperparameters,
    squared: &Mat<f64>,
) -> Mat<f64> {
    let n = squared.nrows();
    let mut gram = Mat::zeros(n, n);
    for j in 0..n {
        gram[(j, j)] = hyperparameters.signal_variance + hyperparameters.noise_variance;
        let below = &mut gram.col_as_slice_mut(j)[j + 1..];
        for (entry, s) in below.iter_mut().zip(&squared.col_as_slice(j)[j + 1..]) {
            *entry = hyperparameters.signal_variance * kernel.at(*s);
        }
    }
    gram
}

/// L(θ) and its gradient for targets `y` at directions with squared distances `squared`.
///
/// # Errors
/// [`NotPositiveDefinite`] where the hyperparameters make K numerically singular.
pub fn negative_log_marginal_likelihood(
    kernel: Kernel,
    hyperparameters: &Hyperparameters,
    squared: &Mat<f64>,
    y: &[f64],
) -> Result<LikelihoodAndGradient, NotPositiveDefinite> {
    let n = y.len();
    let gram = gram(kernel, hyperparameters, squared);
    let factor = Cholesky::new(gram.clone())?;
    let w = factor.solve(y);
    let inverse = factor.inverse();
    let fit: f64 = y.iter().zip(&w).map(|(y, w)| y * w).sum();
    let value = 0.5 * fit
        + 0.5 * factor.log_determinant()
        + 0.5 * n as f64 * (2.0 * std::f64::consts::PI).ln();

    let v = hyperparameters.signal_variance;
    let noise = hyperparameters.noise_variance;
    let free = kernel == Kernel::RationalQuadratic(Exponent::Free);
    let (l, alpha) = (hyperparameters.length_scale, hyperparameters.exponent);
    let two_alpha_l_squared = 2.0 * alpha * l * l;
    let (mut length_scale, mut exponent) = (0.0, 0.0);
    for j in 0..n {
        // The diagonal of ∂K/∂l and ∂K/∂α is 0; off it, both triangles count.
        let entries = gram.col_as_slice(j)[j + 1..]
            .iter()
            .zip(&squared.col_as_slice(j)[j + 1..])
            .zip(&inverse.col_as_slice(j)[j + 1..])
            .zip(&w[j + 1..]);
        for (((entry, s), inverse), wi) in entries {
            let k = entry / v;
            let x = s / two_alpha_l_squared;
            let share = x / (1.0 + x);
            let sensitivity = inverse - wi * w[j];
            length_scale += sensitivity * (2.0 * alpha * k * share);
            // The logarithm would take a fifth of all training where nobody asks for it.
            if free {
                exponent += sensitivity * (alpha * k * (share - x.ln_1p()));
            }
        }
    }
    let trace: f64 = (0..n).map(|i| inverse[(i, i)]).sum();
    let norm: f64 = w.iter().map(|w| w * w).sum();
    let by_noise = 0.5 * noise * (trace - norm);
    // v·k(S) = K − η·I, so that no further product is needed.
    let by_signal = 0.5 * (n as f64 - fit) - by_noise;
    let mut gradient = vec![v * length_scale, by_signal, by_noise];
    if free {
        gradient.push(v * exponent);
    }
    Ok(LikelihoodAndGradient { value, gradient })
}
