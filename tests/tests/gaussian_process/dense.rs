//! The covariance functions written out once more, and what the tests ask them about.

use cobra_infer::{Kernel, Metric, Model, Smoothness};
use cobra_train::gp::Hyperparameters;
use cobra_train::random::{Purpose, stream};
use nalgebra::{DMatrix, Point3, UnitVector3, Vector3};
use rand::RngExt;

pub(crate) fn models() -> impl Iterator<Item = Model> {
    Metric::ALL
        .into_iter()
        .flat_map(|metric| Kernel::ALL.map(|kernel| Model { metric, kernel }))
}

/// How many hyperparameters a kernel leaves free.
pub(crate) fn free(kernel: Kernel) -> usize {
    let own = [kernel.fixed_length_scale(), kernel.fixed_parameter()];
    2 + own.iter().filter(|fixed| fixed.is_none()).count()
}

/// Points on a lumpy patch around the origin.
pub(crate) fn patch(count: usize) -> Vec<Point3<f64>> {
    let mut rng = stream(7, Purpose::Demonstration, 0);
    (0..count)
        .map(|_| {
            let u = UnitVector3::new_normalize(Vector3::<f64>::new(
                rng.random_range(-1.0..1.0),
                rng.random_range(-1.0..1.0),
                rng.random_range(0.2..1.0),
            ));
            let d = 0.5 + 0.1 * (5.0 * u.x).sin() + 0.05 * (7.0 * u.y).cos();
            Point3::from(u.into_inner() * d)
        })
        .collect()
}

pub(crate) fn split(points: &[Point3<f64>]) -> (Vec<UnitVector3<f64>>, Vec<f64>) {
    points
        .iter()
        .map(|p| (UnitVector3::new_normalize(p.coords), p.coords.norm()))
        .unzip()
}

pub(crate) fn independent_gram(
    model: Model,
    h: &Hyperparameters,
    u: &[UnitVector3<f64>],
) -> DMatrix<f64> {
    DMatrix::from_fn(u.len(), u.len(), |i, j| {
        let noise = if i == j { h.noise_variance } else { 0.0 };
        noise + independent_covariance(model, h, &u[i], &u[j])
    })
}

pub(crate) fn independent_coordinates(metric: Metric, u: &UnitVector3<f64>) -> Vector3<f64> {
    match metric {
        Metric::Chord => u.into_inner(),
        Metric::Angles => Vector3::new(u.z.acos(), u.y.atan2(u.x), 0.0),
    }
}

pub(crate) fn independent_covariance(
    model: Model,
    h: &Hyperparameters,
    a: &UnitVector3<f64>,
    b: &UnitVector3<f64>,
) -> f64 {
    let [a, b] = [a, b].map(|u| independent_coordinates(model.metric, u));
    let (r, l, p) = ((a - b).norm(), h.length_scale, h.parameter);
    let k = match model.kernel {
        Kernel::RationalQuadratic(_) => (1.0 + r * r / (2.0 * p * l * l)).powf(-p),
        Kernel::RadialBasis => (-0.5 * (r / l).powi(2)).exp(),
        Kernel::Matern(smoothness) => {
            let z = match smoothness {
                Smoothness::Half => 1.0,
                Smoothness::ThreeHalves => 3.0,
                Smoothness::FiveHalves => 5.0,
            };
            let z = f64::sqrt(z) * r / l;
            let polynomial = match smoothness {
                Smoothness::Half => 1.0,
                Smoothness::ThreeHalves => 1.0 + z,
                Smoothness::FiveHalves => 1.0 + z + z * z / 3.0,
            };
            polynomial * (-z).exp()
        }
        Kernel::Linear => a.dot(&b),
        Kernel::Polynomial => (a.dot(&b) + p).powi(3),
        Kernel::Periodic => {
            let sines = (a - b).map(|d| (std::f64::consts::PI * d / p).sin());
            (-2.0 * sines.norm_squared() / (l * l)).exp()
        }
    };
    h.signal_variance * k
}

pub(crate) fn hyperparameters(kernel: Kernel) -> Hyperparameters {
    let fixed = |value: Option<f32>, free| value.map_or(free, f64::from);
    Hyperparameters {
        length_scale: fixed(kernel.fixed_length_scale(), 0.4),
        signal_variance: 0.03,
        noise_variance: 2e-4,
        parameter: match kernel {
            // Shorter, and the likelihood bends too fast for finite differences.
            Kernel::Periodic => 2.5,
            _ => fixed(kernel.fixed_parameter(), 0.7),
        },
    }
}

/// One hyperparameter multiplied by a factor, in the gradient's order.
pub(crate) fn moved(
    kernel: Kernel,
    h: &Hyperparameters,
    index: usize,
    factor: f64,
) -> Hyperparameters {
    let mut moved = *h;
    let mut free = vec![&mut moved.signal_variance, &mut moved.noise_variance];
    if kernel.fixed_length_scale().is_none() {
        free.insert(0, &mut moved.length_scale);
    }
    if kernel.fixed_parameter().is_none() {
        free.push(&mut moved.parameter);
    }
    *free[index] *= factor;
    moved
}
