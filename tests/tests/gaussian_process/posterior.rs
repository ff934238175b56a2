//! The predictive mean and variance (Eqs. 4 and 5).

use crate::dense::{
    hyperparameters, independent_covariance, independent_gram, models, patch, split,
};
use cobra_infer::{Exponent, Kernel, Metric, Model, Smoothness};
use cobra_tests::tolerance;
use cobra_train::gp::{FitOptions, Hyperparameters, Posterior, Subset, fit};
use cobra_train::random::{Purpose, stream};
use nalgebra::{DVector, Point3, UnitVector3};

/// The deviation of a distance that is not known at all, squared.
fn prior(model: Model, h: &Hyperparameters, u: &UnitVector3<f64>) -> f64 {
    independent_covariance(model, h, u, u)
}

#[test]
fn the_variance_and_the_mean_agree_with_a_dense_solve() {
    let (u, y) = split(&patch(120));
    for model in models() {
        let h = hyperparameters(model.kernel);
        let posterior = Posterior::new(model, &h, 0.2, &u, &y).unwrap();
        let lu = independent_gram(model, &h, &u).lu();
        let solution = lu.solve(&DVector::from_vec(y.clone())).unwrap();
        for query in split(&patch(150)).0.iter().skip(110) {
            let row: DVector<f64> = DVector::from_iterator(
                u.len(),
                u.iter()
                    .map(|u| independent_covariance(model, &h, query, u)),
            );
            let prior = prior(model, &h, query);
            let variance = prior - row.dot(&lu.solve(&row).unwrap());
            let mean = 0.2 + row.dot(&solution);
            let found = posterior.predict(query);
            let error = (found.variance - variance).abs() / prior.max(h.signal_variance);
            assert!(error < tolerance::DENSE_VARIANCE, "{model:?}: {error:e}");
            assert!(
                (found.mean - mean).abs() < tolerance::DENSE_MEAN,
                "{model:?}"
            );
            let observed = posterior.observation_variance(&found);
            assert_eq!(observed, found.variance + h.noise_variance, "{model:?}");
        }
    }
}

#[test]
fn the_posterior_of_a_fit_has_the_means_of_its_weights() {
    let points = patch(100);
    for model in models() {
        let options = FitOptions {
            model,
            subset: Subset::Points(40),
            ..FitOptions::new(model.kernel)
        };
        let mut rng = stream(1, Purpose::HyperparameterSubset, 0);
        let fitted = fit(&Point3::origin(), &points, &options, &mut rng).unwrap();
        let posterior = Posterior::of(&fitted).unwrap();
        let h = &fitted.learned.hyperparameters;
        for query in split(&patch(110)).0.iter().skip(90) {
            let terms = fitted.directions.iter().zip(&fitted.weights);
            let sum: f64 = terms
                .map(|(u, w)| w * independent_covariance(model, h, query, u) / h.signal_variance)
                .sum();
            let error = (posterior.predict(query).mean - fitted.prior_mean - sum).abs();
            assert!(error < tolerance::DENSE_MEAN, "{model:?}: {error:e}");
        }
    }
}

#[test]
fn a_training_point_of_tiny_noise_is_known_and_no_variance_is_negative() {
    let (u, y) = split(&patch(60));
    for model in models() {
        let h = Hyperparameters {
            noise_variance: 1e-9,
            ..hyperparameters(model.kernel)
        };
        let posterior = Posterior::new(model, &h, 0.0, &u, &y).unwrap();
        for query in &u {
            let variance = posterior.predict(query).variance;
            // What one noisy measurement alone leaves of any prior variance.
            assert!(
                (0.0..=1.001 * h.noise_variance).contains(&variance),
                "{model:?}: {variance:e}"
            );
        }
        for query in &split(&patch(500)).0 {
            assert!(posterior.predict(query).variance >= 0.0, "{model:?}");
        }
    }
}

#[test]
fn far_from_all_points_nothing_is_known_of_a_distance() {
    // Only kernels that forget: the others know every direction from some. The length scales put the
    // covariance with each of the 60 points below 1e-8: exponential tails forget at once, those of
    // the rational quadratics as (l/r)^2α, with α = ½ as slowly as l/r, r being about 1.
    let forgetful = [
        (Kernel::RadialBasis, 0.02),
        (Kernel::Matern(Smoothness::Half), 0.02),
        (Kernel::Matern(Smoothness::ThreeHalves), 0.02),
        (Kernel::Matern(Smoothness::FiveHalves), 0.02),
        (Kernel::RationalQuadratic(Exponent::Half), 1e-9),
        (Kernel::RationalQuadratic(Exponent::One), 1e-5),
        // α = 0.7.
        (Kernel::RationalQuadratic(Exponent::Free), 1e-7),
    ];
    let (u, y) = split(&patch(60));
    let opposite = UnitVector3::new_normalize(nalgebra::Vector3::new(0.1, -0.2, -1.0));
    for (kernel, length_scale) in forgetful {
        for metric in Metric::ALL {
            let model = Model { metric, kernel };
            let h = Hyperparameters {
                length_scale,
                ..hyperparameters(kernel)
            };
            let posterior = Posterior::new(model, &h, 0.7, &u, &y).unwrap();
            let found = posterior.predict(&opposite);
            assert!(
                (found.variance / h.signal_variance - 1.0).abs() < 1e-6,
                "{model:?}: {found:?}"
            );
            assert!((found.mean - 0.7).abs() < 1e-6, "{model:?}: {found:?}");
        }
    }
}
