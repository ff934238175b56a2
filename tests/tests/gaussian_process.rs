//! The Gaussian process against an independent dense solve: nalgebra's LU decomposition in double
//! precision, with the covariance written out here.

use cobra_infer::{Exponent, Kernel, Template, UnitDirection};
use cobra_tests::tolerance;
use cobra_train::gp::{
    FitOptions, Hyperparameters, NOISE_FLOOR, PriorMean, StopReason, fit, learn,
    negative_log_marginal_likelihood, squared_distances,
};
use cobra_train::progress::Silent;
use cobra_train::random::{Purpose, stream};
use cobra_train::train::{ReferencePoints, TrainOptions, train};
use nalgebra::{DMatrix, DVector, Point3, UnitVector3, Vector3};
use rand::RngExt;

const EXPONENTS: [Exponent; 3] = [Exponent::One, Exponent::Half, Exponent::Free];

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

fn independent_gram(h: &Hyperparameters, u: &[UnitVector3<f64>]) -> DMatrix<f64> {
    DMatrix::from_fn(u.len(), u.len(), |i, j| {
        let noise = if i == j { h.noise_variance } else { 0.0 };
        noise + independent_covariance(h, &u[i], &u[j])
    })
}

fn independent_covariance(h: &Hyperparameters, a: &UnitVector3<f64>, b: &UnitVector3<f64>) -> f64 {
    let squared = (a.into_inner() - b.into_inner()).norm_squared();
    let base = 1.0 + squared / (2.0 * h.exponent * h.length_scale.powi(2));
    h.signal_variance * base.powf(-h.exponent)
}

fn hyperparameters(exponent: Exponent) -> Hyperparameters {
    Hyperparameters {
        length_scale: 0.4,
        signal_variance: 0.03,
        noise_variance: 2e-4,
        exponent: exponent.fixed().map_or(0.7, f64::from),
    }
}

#[test]
fn the_marginal_likelihood_agrees_with_a_dense_solve() {
    let (u, y) = split(&patch(150));
    for exponent in EXPONENTS {
        let h = hyperparameters(exponent);
        let found = negative_log_marginal_likelihood(
            Kernel::RationalQuadratic(exponent),
            &h,
            &squared_distances(&u),
            &y,
        )
        .unwrap();
        let lu = independent_gram(&h, &u).lu();
        let targets = DVector::from_vec(y.clone());
        let log_determinant: f64 = lu.u().diagonal().iter().map(|d| d.abs().ln()).sum();
        let expected = 0.5 * targets.dot(&lu.solve(&targets).unwrap())
            + 0.5 * log_determinant
            + 0.5 * y.len() as f64 * (2.0 * std::f64::consts::PI).ln();
        let error = (found.value - expected).abs() / expected.abs();
        assert!(
            error < tolerance::DENSE_LIKELIHOOD,
            "{exponent:?}: {error:e}"
        );
    }
}

#[test]
fn the_gradient_agrees_with_central_differences() {
    let (u, y) = split(&patch(80));
    let squared = squared_distances(&u);
    for exponent in EXPONENTS {
        let kernel = Kernel::RationalQuadratic(exponent);
        let h = hyperparameters(exponent);
        let at = |index: usize, step: f64| {
            let mut moved = h;
            let value = match index {
                0 => &mut moved.length_scale,
                1 => &mut moved.signal_variance,
                2 => &mut moved.noise_variance,
                _ => &mut moved.exponent,
            };
            *value *= step.exp();
            negative_log_marginal_likelihood(kernel, &moved, &squared, &y)
                .unwrap()
                .value
        };
        let gradient = negative_log_marginal_likelihood(kernel, &h, &squared, &y)
            .unwrap()
            .gradient;
        assert_eq!(
            gradient.len(),
            if exponent == Exponent::Free { 4 } else { 3 }
        );
        let largest = gradient.iter().fold(0.0_f64, |most, g| most.max(g.abs()));
        for (index, analytic) in gradient.iter().enumerate() {
            let step = 1e-5;
            let numeric = (at(index, step) - at(index, -step)) / (2.0 * step);
            let error = (analytic - numeric).abs() / largest;
            assert!(
                error < tolerance::FINITE_DIFFERENCE,
                "{exponent:?}, entry {index}: {analytic} against {numeric}"
            );
        }
    }
}

#[test]
fn the_fitted_mean_agrees_with_a_dense_solve() {
    let points = patch(250);
    let (u, d) = split(&points);
    for exponent in EXPONENTS {
        for prior_mean in [PriorMean::Zero, PriorMean::Average] {
            let options = FitOptions {
                kernel: Kernel::RationalQuadratic(exponent),
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
            let solution = independent_gram(h, &u).lu().solve(&targets).unwrap();
            for query in split(&patch(20)).0 {
                let expected: f64 = m + u
                    .iter()
                    .zip(solution.iter())
                    .map(|(u, w)| w * independent_covariance(h, &query, u))
                    .sum::<f64>();
                let found: f64 = fitted.prior_mean
                    + fitted
                        .directions
                        .iter()
                        .zip(&fitted.weights)
                        .map(|(u, w)| w * independent_covariance(h, &query, u) / h.signal_variance)
                        .sum::<f64>();
                let error = (found - expected).abs();
                assert!(error < tolerance::DENSE_MEAN, "{exponent:?}: {error:e}");
            }
        }
    }
}

#[test]
fn learning_ends_where_no_small_step_is_better() {
    let (u, y) = split(&patch(120));
    let squared = squared_distances(&u);
    for exponent in EXPONENTS {
        let kernel = Kernel::RationalQuadratic(exponent);
        let learned = learn(kernel, &squared, &y).unwrap();
        assert_eq!(learned.stop, StopReason::Converged);
        let best = learned.likelihood_per_point;
        for factor in [0.95, 1.05] {
            let count = if exponent == Exponent::Free { 4 } else { 3 };
            for index in 0..count {
                let mut moved = learned.hyperparameters;
                match index {
                    0 => moved.length_scale *= factor,
                    1 => moved.signal_variance *= factor,
                    2 => moved.noise_variance = (factor * moved.noise_variance).max(NOISE_FLOOR),
                    _ => moved.exponent *= factor,
                }
                let there = negative_log_marginal_likelihood(kernel, &moved, &squared, &y)
                    .unwrap()
                    .value
                    / y.len() as f64;
                assert!(
                    there >= best - tolerance::LEARNED,
                    "{exponent:?}: {there} below {best}"
                );
            }
        }
    }
}

#[test]
fn the_controllers_mean_is_the_hosts_to_a_hundredth_of_sigma_hat() {
    let mesh = cobra_train::demo::mechanical_part();
    for exponent in EXPONENTS {
        let mut options = TrainOptions::new("part");
        options.points = 2000;
        options.test_points = 4000;
        options.reference_points = ReferencePoints::KMeans { components: 6 };
        options.fit.kernel = Kernel::RationalQuadratic(exponent);
        let trained = train(&mesh, &options, &Silent).unwrap();
        let template = Template::from_bytes(&trained.bytes).unwrap();
        let radius = mesh.bounding_sphere().radius;
        for (component, trained) in template.components().zip(&trained.components) {
            let fitted = &trained.fitted;
            let h = &fitted.learned.hyperparameters;
            for query in fitted.directions.iter().step_by(7) {
                let host: f64 = fitted.prior_mean
                    + fitted
                        .directions
                        .iter()
                        .zip(&fitted.weights)
                        .map(|(u, w)| w * independent_covariance(h, query, u) / h.signal_variance)
                        .sum::<f64>();
                let direction = UnitDirection::new_unchecked(query.cast::<f32>().into_inner());
                let controller = component.posterior_mean(template.kernel(), &direction);
                let error =
                    (f64::from(controller) - radius * host).abs() / f64::from(component.sigma_hat);
                assert!(
                    error < tolerance::SINGLE_PRECISION_MEAN,
                    "{exponent:?}: {error}"
                );
            }
        }
    }
}
