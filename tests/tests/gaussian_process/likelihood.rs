//! The negative log marginal likelihood and its gradient.

use crate::dense::{free, hyperparameters, independent_gram, models, moved, patch, split};
use cobra_tests::tolerance;
use cobra_train::gp::{Coordinates, negative_log_marginal_likelihood};
use nalgebra::DVector;

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
