//! Covariance functions over directions.
//!
//! Owns the formulas, once, for the controller's `f32` sums and the trainer's `f64` Gram matrices
//! alike, and which of them a build contains. Does not own the sum over a template's terms
//! ([`crate::gp`]) or hyperparameter gradients (the trainer's).
//!
//! Each kernel is a feature of this crate, so that a controller links only what its templates need:
//! the rational quadratic with a fixed exponent needs four operations and a square root, others an
//! exponential, a sine or a power. The names are always there: a template whose kernel was left out
//! is refused by name.
//!
//! The formulas are those of C. E. Rasmussen and C. K. I. Williams, Gaussian Processes for Machine
//! Learning, 2006, chapter 4; the rational quadratic is also the paper's.

mod inner_product;
mod matern;
mod metric;
mod periodic;
mod radial_basis;
mod rational_quadratic;

pub use inner_product::{Linear, Polynomial};
pub use matern::{MaternFiveHalves, MaternHalf, MaternThreeHalves};
pub use metric::Metric;
pub use periodic::Periodic;
pub use radial_basis::RadialBasis;
pub use rational_quadratic::{RationalQuadraticFree, RationalQuadraticHalf, RationalQuadraticOne};

use crate::math::Real;
use serde::{Deserialize, Serialize};

/// Which covariance function a template was trained with.
///
/// The trainer folds the signal variance into the weights, so no kernel carries one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Kernel {
    /// The paper's rational quadratic, k = (1 + s/(2αl²))^(−α) with s the squared distance.
    RationalQuadratic(Exponent),
    /// The radial basis function, or squared exponential, k = exp(−s/(2l²)).
    RadialBasis,
    /// Matérn's kernels.
    Matern(Smoothness),
    /// The inner product, k = a·b.
    Linear,
    /// The polynomial of degree 3, k = (a·b + c)³.
    Polynomial,
    /// The periodic kernel, k = exp(−2 Σᵢ sin²(π(aᵢ − bᵢ)/p)/l²).
    Periodic,
}

/// The exponent α of the rational quadratic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Exponent {
    /// α = 1: needs only + − × ÷. The default.
    One,
    /// α = ½: needs a square root besides.
    Half,
    /// Any α > 0, learned for each component: needs `powf`.
    Free,
}

/// The smoothness ν of Matérn's kernels: a process is differentiable ⌈ν⌉ − 1 times.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Smoothness {
    /// ν = ½: the exponential kernel.
    Half,
    /// ν = 3/2.
    ThreeHalves,
    /// ν = 5/2.
    FiveHalves,
}

/// What the posterior mean of a template is made of besides numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Model {
    /// In which coordinates directions are compared.
    pub metric: Metric,
    /// The covariance function.
    pub kernel: Kernel,
}

impl Model {
    /// A kernel on unit vectors.
    #[must_use]
    pub const fn chord(kernel: Kernel) -> Self {
        Self {
            metric: Metric::Chord,
            kernel,
        }
    }
}

/// A covariance function of two points in a metric's coordinates.
pub trait Covariance<T: Real>: Copy {
    /// k(a, b).
    fn between(&self, a: [T; 3], b: [T; 3]) -> T;

    /// ∂k(a, b)/∂a.
    fn gradient(&self, a: [T; 3], b: [T; 3]) -> [T; 3];
}

/// factor·(a − b): what the gradient of a kernel of the distance is.
#[inline(always)]
fn along<T: Real>(factor: T, [a0, a1, a2]: [T; 3], [b0, b1, b2]: [T; 3]) -> [T; 3] {
    [factor * (a0 - b0), factor * (a1 - b1), factor * (a2 - b2)]
}

/// What is done with a kernel once its formula and numbers are known: [`Kernel::visit`] chooses the
/// formula outside of the loop, so that the compiler sees a loop over one of them.
pub trait Visitor<T: Real> {
    /// What comes of it.
    type Output;
    /// Takes the kernel.
    fn visit(self, kernel: impl Covariance<T>) -> Self::Output;
}

impl Kernel {
    /// All of them, in the order of their numbers in a template.
    pub const ALL: [Self; 10] = [
        Self::RationalQuadratic(Exponent::One),
        Self::RationalQuadratic(Exponent::Half),
        Self::RationalQuadratic(Exponent::Free),
        Self::RadialBasis,
        Self::Matern(Smoothness::Half),
        Self::Matern(Smoothness::ThreeHalves),
        Self::Matern(Smoothness::FiveHalves),
        Self::Linear,
        Self::Polynomial,
        Self::Periodic,
    ];

    /// Its name in reports and messages.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::RationalQuadratic(Exponent::One) => "rational quadratic, exponent 1",
            Self::RationalQuadratic(Exponent::Half) => "rational quadratic, exponent 0.5",
            Self::RationalQuadratic(Exponent::Free) => "rational quadratic, exponent free",
            Self::RadialBasis => "radial basis function",
            Self::Matern(Smoothness::Half) => "Matern 1/2",
            Self::Matern(Smoothness::ThreeHalves) => "Matern 3/2",
            Self::Matern(Smoothness::FiveHalves) => "Matern 5/2",
            Self::Linear => "linear",
            Self::Polynomial => "polynomial of degree 3",
            Self::Periodic => "periodic",
        }
    }

    /// The feature of this crate that contains it.
    #[must_use]
    pub const fn feature(self) -> &'static str {
        match self {
            Self::RationalQuadratic(Exponent::One | Exponent::Half) => "rational-quadratic",
            Self::RationalQuadratic(Exponent::Free) => "rational-quadratic-free",
            Self::RadialBasis => "radial-basis",
            Self::Matern(_) => "matern",
            Self::Linear => "linear",
            Self::Polynomial => "polynomial",
            Self::Periodic => "periodic",
        }
    }

    /// Whether this build contains it.
    #[must_use]
    pub const fn is_compiled_in(self) -> bool {
        match self {
            Self::RationalQuadratic(Exponent::One | Exponent::Half) => {
                cfg!(feature = "rational-quadratic")
            }
            Self::RationalQuadratic(Exponent::Free) => cfg!(feature = "rational-quadratic-free"),
            Self::RadialBasis => cfg!(feature = "radial-basis"),
            Self::Matern(_) => cfg!(feature = "matern"),
            Self::Linear => cfg!(feature = "linear"),
            Self::Polynomial => cfg!(feature = "polynomial"),
            Self::Periodic => cfg!(feature = "periodic"),
        }
    }

    /// What stands for the length scale of a kernel that has none.
    #[must_use]
    pub const fn fixed_length_scale(self) -> Option<f32> {
        match self {
            Self::Linear | Self::Polynomial => Some(1.0),
            _ => None,
        }
    }

    /// The parameter besides the length scale, where the kernel fixes it or has none (then 1).
    #[must_use]
    pub const fn fixed_parameter(self) -> Option<f32> {
        match self {
            Self::RationalQuadratic(Exponent::Half) => Some(0.5),
            Self::RationalQuadratic(Exponent::Free) | Self::Polynomial | Self::Periodic => None,
            _ => Some(1.0),
        }
    }

    /// What the parameter besides the length scale is called.
    #[must_use]
    pub const fn parameter_name(self) -> Option<&'static str> {
        match self {
            Self::RationalQuadratic(_) => Some("exponent"),
            Self::Polynomial => Some("offset"),
            Self::Periodic => Some("period"),
            _ => None,
        }
    }

    /// Hands the visitor this kernel with a length scale l and the parameter besides it; `None`
    /// where this build does not contain it.
    pub fn visit<T: Real, V: Visitor<T>>(
        self,
        length_scale: T,
        parameter: T,
        visitor: V,
    ) -> Option<V::Output> {
        // A build without a kernel would not use what it is called with.
        let _ = (&length_scale, &parameter, &visitor);
        match self {
            #[cfg(feature = "rational-quadratic")]
            Self::RationalQuadratic(Exponent::One) => {
                Some(visitor.visit(RationalQuadraticOne::new(length_scale)))
            }
            #[cfg(feature = "rational-quadratic")]
            Self::RationalQuadratic(Exponent::Half) => {
                Some(visitor.visit(RationalQuadraticHalf::new(length_scale)))
            }
            #[cfg(feature = "rational-quadratic-free")]
            Self::RationalQuadratic(Exponent::Free) => {
                Some(visitor.visit(RationalQuadraticFree::new(length_scale, parameter)))
            }
            #[cfg(feature = "radial-basis")]
            Self::RadialBasis => Some(visitor.visit(RadialBasis::new(length_scale))),
            #[cfg(feature = "matern")]
            Self::Matern(Smoothness::Half) => Some(visitor.visit(MaternHalf::new(length_scale))),
            #[cfg(feature = "matern")]
            Self::Matern(Smoothness::ThreeHalves) => {
                Some(visitor.visit(MaternThreeHalves::new(length_scale)))
            }
            #[cfg(feature = "matern")]
            Self::Matern(Smoothness::FiveHalves) => {
                Some(visitor.visit(MaternFiveHalves::new(length_scale)))
            }
            #[cfg(feature = "linear")]
            Self::Linear => Some(visitor.visit(Linear)),
            #[cfg(feature = "polynomial")]
            Self::Polynomial => Some(visitor.visit(Polynomial::new(parameter))),
            #[cfg(feature = "periodic")]
            Self::Periodic => Some(visitor.visit(Periodic::new(length_scale, parameter))),
            #[allow(
                unreachable_patterns,
                reason = "builds that leave kernels out reach it"
            )]
            _ => None,
        }
    }
}

impl Exponent {
    /// The value that this choice fixes, if it fixes one.
    #[must_use]
    pub const fn fixed(self) -> Option<f32> {
        Kernel::RationalQuadratic(self).fixed_parameter()
    }
}

/// s = ((a₀−b₀)² + (a₁−b₁)²) + (a₂−b₂)², from the differences: the form 2 − 2a·b of unit vectors
/// cancels where the fit is exact.
#[inline(always)]
pub fn squared_distance<T: Real>([a0, a1, a2]: [T; 3], [b0, b1, b2]: [T; 3]) -> T {
    let (d0, d1, d2) = (a0 - b0, a1 - b1, a2 - b2);
    (d0 * d0 + d1 * d1) + d2 * d2
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec::Vec;

    struct At([f64; 3], [f64; 3]);

    impl Visitor<f64> for At {
        type Output = f64;
        fn visit(self, kernel: impl Covariance<f64>) -> f64 {
            kernel.between(self.0, self.1)
        }
    }

    fn at(kernel: Kernel, l: f64, p: f64, a: [f64; 3], b: [f64; 3]) -> f64 {
        kernel.visit(l, p, At(a, b)).unwrap()
    }

    fn points() -> Vec<[f64; 3]> {
        (0..7)
            .map(f64::from)
            .map(|i| [0.3 * i - 0.9, 0.5 - 0.2 * i, 0.1 * i * i - 1.1])
            .collect()
    }

    #[test]
    fn a_test_build_contains_every_kernel() {
        for kernel in Kernel::ALL {
            assert!(kernel.is_compiled_in(), "{}", kernel.name());
        }
    }

    #[test]
    fn the_fixed_exponents_are_special_cases_of_the_free_one() {
        for b in points() {
            for l in [0.05, 0.3, 1.7] {
                for (exponent, alpha) in [(Exponent::One, 1.0), (Exponent::Half, 0.5)] {
                    let fixed = at(Kernel::RationalQuadratic(exponent), l, 1.0, [0.0; 3], b);
                    let free = Kernel::RationalQuadratic(Exponent::Free);
                    assert!((fixed - at(free, l, alpha, [0.0; 3], b)).abs() < 1e-14);
                }
            }
        }
    }

    #[test]
    fn the_rational_quadratic_tends_to_the_radial_basis_function() {
        for b in points() {
            let free = Kernel::RationalQuadratic(Exponent::Free);
            let limit = at(Kernel::RadialBasis, 0.7, 1.0, [0.1; 3], b);
            assert!((at(free, 0.7, 1e7, [0.1; 3], b) - limit).abs() < 1e-6);
        }
    }

    #[test]
    fn stationary_kernels_are_one_at_zero_distance() {
        for kernel in Kernel::ALL {
            if matches!(kernel, Kernel::Linear | Kernel::Polynomial) {
                continue;
            }
            for a in points() {
                assert_eq!(at(kernel, 0.3, 0.7, a, a), 1.0, "{}", kernel.name());
            }
        }
    }

    #[test]
    fn every_kernel_is_symmetric() {
        for kernel in Kernel::ALL {
            for a in points() {
                for b in points() {
                    let (ab, ba) = (at(kernel, 0.4, 0.9, a, b), at(kernel, 0.4, 0.9, b, a));
                    assert_eq!(ab.to_bits(), ba.to_bits(), "{}", kernel.name());
                }
            }
        }
    }

    #[test]
    fn every_gradient_is_that_of_central_differences() {
        struct Gradient([f64; 3], [f64; 3]);
        impl Visitor<f64> for Gradient {
            type Output = [f64; 3];
            fn visit(self, kernel: impl Covariance<f64>) -> [f64; 3] {
                kernel.gradient(self.0, self.1)
            }
        }
        for kernel in Kernel::ALL {
            for (a, b) in points().into_iter().zip(points().into_iter().skip(1)) {
                let found = kernel.visit(0.6, 1.3, Gradient(a, b)).unwrap();
                for axis in 0..3 {
                    let step = |by: f64| {
                        let mut moved = a;
                        moved[axis] += by;
                        self::at(kernel, 0.6, 1.3, moved, b)
                    };
                    let expected = (step(1e-5) - step(-1e-5)) / 2e-5;
                    assert!((found[axis] - expected).abs() < 1e-7, "{}", kernel.name());
                }
            }
        }
    }

    #[test]
    fn every_kernel_is_positive_semidefinite_on_a_few_points() {
        let points = points();
        for kernel in Kernel::ALL {
            let gram = nalgebra::SMatrix::<f64, 7, 7>::from_fn(|i, j| {
                at(kernel, 0.6, 1.3, points[i], points[j])
            });
            let eigenvalues = gram.symmetric_eigenvalues();
            let least = eigenvalues.min() / eigenvalues.max();
            assert!(least > -1e-12, "{}: {least}", kernel.name());
        }
    }

    #[test]
    #[expect(
        clippy::disallowed_methods,
        reason = "the reference values are computed independently of the crate's own functions"
    )]
    fn formulas_agree_with_the_textbook() {
        let (a, b) = ([0.2, -0.4, 0.8], [-0.1, 0.3, 0.5]);
        let s: f64 = 0.09 + 0.49 + 0.09;
        let (r, l, p) = (s.sqrt(), 0.45, 1.6);
        let dot: f64 = -0.02 - 0.12 + 0.4;
        let (z3, z5) = (3.0_f64.sqrt() * r / l, 5.0_f64.sqrt() * r / l);
        let sines: f64 = [0.3_f64, -0.7, 0.3]
            .map(|d| (core::f64::consts::PI * d / p).sin().powi(2))
            .iter()
            .sum();
        for (kernel, expected) in [
            (Kernel::RadialBasis, (-s / (2.0 * l * l)).exp()),
            (Kernel::Matern(Smoothness::Half), (-r / l).exp()),
            (
                Kernel::Matern(Smoothness::ThreeHalves),
                (1.0 + z3) * (-z3).exp(),
            ),
            (
                Kernel::Matern(Smoothness::FiveHalves),
                (1.0 + z5 + z5 * z5 / 3.0) * (-z5).exp(),
            ),
            (Kernel::Linear, dot),
            (Kernel::Polynomial, (dot + p).powi(3)),
            (Kernel::Periodic, (-2.0 * sines / (l * l)).exp()),
        ] {
            let found = at(kernel, l, p, a, b);
            assert!((found - expected).abs() < 1e-14, "{}", kernel.name());
        }
    }
}
