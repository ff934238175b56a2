//! The posterior mean: the fit's, and the controller's.

use crate::dense::{independent_covariance, independent_gram, models, patch, split};
use cobra_infer::{Model, Template, UnitDirection};
use cobra_tests::tolerance;
use cobra_train::gp::{FitOptions, FittedGp, PriorMean, Subset, fit};
use cobra_train::progress::Silent;
use cobra_train::random::{Purpose, stream};
use cobra_train::train::{ReferencePoints, TrainOptions, train};
use nalgebra::{DVector, Point3, UnitVector3, Vector3};

#[test]
fn the_fitted_mean_agrees_with_a_dense_solve() {
    let points = patch(150);
    let (u, d) = split(&points);
    for model in models() {
        for prior_mean in [PriorMean::Zero, PriorMean::Average] {
            let options = FitOptions {
                model,
                prior_mean,
                subset: Subset::Points(60),
                ..FitOptions::new(model.kernel)
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
fn the_controllers_mean_is_the_hosts_to_a_hundredth_of_sigma_hat() {
    let mesh = cobra_train::demo::mechanical_part();
    let sphere = mesh.bounding_sphere();
    // Given ones: that k-means compares placements is not what is tested.
    let centres = [-0.4, 0.0, 0.4].map(|x| sphere.centre + Vector3::x() * (x * sphere.radius));
    for model in models() {
        let mut options = TrainOptions::clustered("part", 3);
        options.points = 450;
        options.test_points = 1000;
        options.reference_points = ReferencePoints::Given(centres.to_vec());
        options.fit.model = model;
        let trained = train(&mesh.clone().into(), &options, &Silent).unwrap();
        let template = Template::from_bytes(&trained.bytes).unwrap();
        let radius = sphere.radius;
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
