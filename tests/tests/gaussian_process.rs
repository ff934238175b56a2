//! The Gaussian process against an independent dense solve: nalgebra's LU decomposition in double
//! precision, with the covariance written out here.

use cobra_infer::{Kernel, Metric, Model, Smoothness, Template, UnitDirection};
use cobra_tests::tolerance;
use cobra_train::gp::{
    Coordinates, FitOptions, FittedGp, Hyperparameters, NOISE_FLOOR, PriorMean, StopReason, fit,
    learn, negative_log_marginal_likelihood,
};
use cobra_train::progress::Silent;
use cobra_train::random::{Purpose, stream};
use cobra_train::train::{ReferencePoints, TrainOptions, train};
use nalgebra::{DMatrix, DVector, Point3, UnitVector3, Vector3};
use rand::RngExt;

fn models() -> impl Iterator<Item = Model> {
    Metric::ALL
        .into_iter()
        .flat_map(|metric| Kernel::ALL.map(|kernel| Model { metric, kernel }))
}

/// How many hyperparameters a kernel leaves free.
fn free(kernel: Kernel) -> usize {
    let own = [kernel.fixed_length_scale(), kernel.fixed_parameter()];
    2 + own.iter().filter(|fixed| fixed.is_none()).count()
}

/// Points on a lumpy patch around the origin.
fn patch(count: usize) -> Vec<Point3<f64>> {
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

fn split(points: &[Point3<f64>]) -> (Vec<UnitVector3<f64>>, Vec<f64>) {
    points
        .iter()
        .map(|p| (UnitVector3::new_normalize(p.coords), p.coords.norm()))
        .unzip()
}

fn independent_gram(model: Model, h: &Hyperparameters, u: &[UnitVector3<f64>]) -> DMatrix<f64> {
    DMatrix::from_fn(u.len(), u.len(), |i, j| {
        let noise = if i == j { h.noise_variance } else { 0.0 };
        noise + independent_covariance(model, h, &u[i], &u[j])
    })
}

fn independent_coordinates(metric: Metric, u: &UnitVector3<f64>) -> Vector3<f64> {
    match metric {
        Metric::Chord => u.into_inner(),
        Metric::Angles => Vector3::new(u.z.acos(), u.y.atan2(u.x), 0.0),
    }
}

fn independent_covariance(
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

fn hyperparameters(kernel: Kernel) -> Hyperparameters {
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

#[test]
fn the_marginal_likelihood_agrees_with_a_dense_solve() {
    let (u, y) = split(&patch(150));
    for model in models() {
        let h = hyperparameters(model.kernel);
        let points = Coordinates::new(model.metric, &u);
        let found = negative_log_marginal_likelihood(model.kernel, &h, &points, &y).unwrap();
        let lu = independent_gram(model, &h, &u).lu();
        let targets = DVector::from_vec(y.clone());
        let log_determinant: f64 = lu.u().diagonal().iter().map(|d| d.abs().ln()).sum();
        let expected = 0.5 * targets.dot(&lu.solve(&targets).unwrap())
            + 0.5 * log_determinant
            + 0.5 * y.len() as f64 * (2.0 * std::f64::consts::PI).ln();
        let error = (found.value - expected).abs() / expected.abs();
        assert!(error < tolerance::DENSE_LIKELIHOOD, "{model:?}: {error:e}");
    }
}

/// One hyperparameter multiplied by a factor, in the gradient's order.
fn moved(kernel: Kernel, h: &Hyperparameters, index: usize, factor: f64) -> Hyperparameters {
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

#[test]
fn the_gradient_agrees_with_central_differences() {
    let (u, y) = split(&patch(80));
    for model in models() {
        let kernel = model.kernel;
        let points = Coordinates::new(model.metric, &u);
        let h = hyperparameters(kernel);
        let at = |index: usize, step: f64| {
            let moved = moved(kernel, &h, index, step.exp());
            negative_log_marginal_likelihood(kernel, &moved, &points, &y)
                .unwrap()
                .value
        };
        let gradient = negative_log_marginal_likelihood(kernel, &h, &points, &y)
            .unwrap()
            .gradient;
        assert_eq!(gradient.len(), free(kernel));
        let largest = gradient.iter().fold(0.0_f64, |most, g| most.max(g.abs()));
        for (index, analytic) in gradient.iter().enumerate() {
            let step = 1e-5;
            let numeric = (at(index, step) - at(index, -step)) / (2.0 * step);
            let error = (analytic - numeric).abs() / largest;
            assert!(
                error < tolerance::FINITE_DIFFERENCE,
                "{model:?}, entry {index}: {analytic} against {numeric}"
            );
        }
    }
}

#[test]
fn the_fitted_mean_agrees_with_a_dense_solve() {
    let points = patch(250);
    let (u, d) = split(&points);
    for model in models() {
        for prior_mean in [PriorMean::Zero, PriorMean::Average] {
            let options = FitOptions {
                model,
                prior_mean,
                subset: 100,
            };
            let mut rng = stream(1, Purpose::HyperparameterSubset, 0);
            let fitted = fit(&Point3::origin(), &points, &options, &mut rng).unwrap();
            let h = &fitted.learned.hyperparameters;
            let m = match prior_mean {
                PriorMean::Zero => 0.0,
                PriorMean::Average => d.iter().sum::<f64>() / d.len() as f64,
            };
            let targets = DVector::from_iterator(d.len(), d.iter().map(|d| d - m));
            let gram = independent_gram(model, h, &u);
            let solution = gram.lu().solve(&targets).unwrap();
            for query in split(&patch(20)).0 {
                let rows = u
                    .iter()
                    .map(|u| independent_covariance(model, h, &query, u));
                let expected: f64 = m + rows.zip(solution.iter()).map(|(k, w)| w * k).sum::<f64>();
                let found = host_mean(model, &fitted, &query);
                let error = (found - expected).abs();
                assert!(error < tolerance::DENSE_MEAN, "{model:?}: {error:e}");
            }
        }
    }
}

/// The mean that a fitted process predicts, with the covariance written out here.
fn host_mean(model: Model, fitted: &FittedGp, query: &UnitVector3<f64>) -> f64 {
    let h = &fitted.learned.hyperparameters;
    let terms = fitted.directions.iter().zip(&fitted.weights);
    let sum: f64 = terms
        .map(|(u, w)| w * independent_covariance(model, h, query, u) / h.signal_variance)
        .sum();
    fitted.prior_mean + sum
}

#[test]
fn learning_ends_where_no_small_step_is_better() {
    let (u, y) = split(&patch(120));
    for model in models() {
        let kernel = model.kernel;
        let points = Coordinates::new(model.metric, &u);
        let learned = learn(kernel, &points, &y).unwrap();
        assert_eq!(learned.stop, StopReason::Converged, "{model:?}");
        let best = learned.likelihood_per_point;
        for factor in [0.95, 1.05] {
            for index in 0..free(kernel) {
                let mut moved = moved(kernel, &learned.hyperparameters, index, factor);
                moved.noise_variance = moved.noise_variance.max(NOISE_FLOOR);
                let there = negative_log_marginal_likelihood(kernel, &moved, &points, &y)
                    .unwrap()
                    .value
                    / y.len() as f64;
                assert!(
                    there >= best - tolerance::LEARNED,
                    "{model:?}, entry {index} times {factor}: {there} below {best}"
                );
            }
        }
    }
}

#[test]
fn the_controllers_mean_is_the_hosts_to_a_hundredth_of_sigma_hat() {
    let mesh = cobra_train::demo::mechanical_part();
    for model in models() {
        let mut options = TrainOptions::new("part");
        options.points = 600;
        options.test_points = 1500;
        options.reference_points = ReferencePoints::KMeans { components: 3 };
        options.fit.model = model;
        let trained = train(&mesh.clone().into(), &options, &Silent).unwrap();
        let template = Template::from_bytes(&trained.bytes).unwrap();
        let radius = mesh.bounding_sphere().radius;
        for (component, trained) in template.components().zip(&trained.components) {
            let fitted = &trained.fitted;
            for query in fitted.directions.iter().step_by(7) {
                let host = host_mean(model, fitted, query);
                let direction = UnitDirection::new_unchecked(query.cast::<f32>().into_inner());
                let controller = component.posterior_mean(template.model(), &direction);
                let error =
                    (f64::from(controller) - radius * host).abs() / f64::from(component.sigma_hat);
                assert!(
                    error < tolerance::SINGLE_PRECISION_MEAN,
                    "{model:?}: {error}"
                );
            }
        }
    }
}
