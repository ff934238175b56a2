//! The mixture of Eqs. 6 to 8: right against the formula in `f64`, and within the bounds that a
//! mixture has.
#![expect(
    clippy::disallowed_methods,
    reason = "the reference values are computed independently of the crate's own functions"
)]

use crate::content::{Content, content};
use crate::scene::COMPONENTS;
use crate::tolerance::SOFT;
use cobra_infer::mixture::Match;
use cobra_infer::template::Precision;
use cobra_infer::{Assignment, Likelihood, Mixture, Settings, Sigma, Template, UnitDirection};
use nalgebra::{Point3, Vector3};
use proptest::prelude::*;

const NOISE: f32 = 1.5;

fn evaluate(
    content: &Content,
    assignment: Assignment,
    likelihood: Likelihood,
    point: [f32; 3],
) -> Option<Match> {
    let bytes = content.encode();
    let template = Template::from_bytes(&bytes).unwrap();
    let settings = Settings {
        assignment,
        likelihood,
        sigma: Sigma::Template { noise: NOISE },
        ..Settings::with_delta(2.0)
    };
    Mixture::<COMPONENTS>::new(&template, &settings)
        .unwrap()
        .evaluate(&Point3::from(point))
}

fn point() -> impl Strategy<Value = [f32; 3]> {
    [-9.0_f32..9.0, -9.0_f32..9.0, -9.0_f32..9.0]
}

/// Σ_k π_k q̂_k in `f64`, the posterior means being the template's.
fn mixed(content: &Content, likelihood: Likelihood, point: [f32; 3]) -> f64 {
    let bytes = content.encode();
    let template = Template::from_bytes(&bytes).unwrap();
    let mut weighted = Vec::new();
    for component in template.components() {
        let offset = Point3::from(point) - Point3::from(component.centre);
        let exponent = match component.precision {
            Some(precision) => {
                let [xx, yx, yy, zx, zy, zz] = precision.factor().map(f64::from);
                let lower = nalgebra::Matrix3::new(xx, 0., 0., yx, yy, 0., zx, zy, zz);
                (lower.transpose() * offset.cast::<f64>()).norm_squared()
            }
            None => offset.cast::<f64>().norm_squared() / f64::from(template.radius()).powi(2),
        };
        let u = UnitDirection::new_normalize(offset);
        let predicted = component.posterior_mean(template.model(), &u);
        let residual = offset.cast::<f64>().norm() - f64::from(predicted);
        let sigma = f64::from(component.sigma_hat).hypot(f64::from(NOISE));
        let peak = (-0.5 * (residual / sigma).powi(2)).exp();
        let scale = match likelihood {
            Likelihood::Peak => 1.0,
            Likelihood::Density => 1.0 / ((2.0 * core::f64::consts::PI).sqrt() * sigma),
        };
        weighted.push((exponent, peak * scale));
    }
    let least = weighted
        .iter()
        .map(|(e, _)| *e)
        .fold(f64::INFINITY, f64::min);
    let total: f64 = weighted.iter().map(|(e, _)| (least - e).exp()).sum();
    let sum: f64 = weighted.iter().map(|(e, q)| (least - e).exp() * q).sum();
    sum / total
}

proptest! {
    #![proptest_config(crate::seed::config())]

    #[test]
    fn the_mixture_is_that_of_the_formula(content in content(), point in point()) {
        for likelihood in [Likelihood::Peak, Likelihood::Density] {
            let found = evaluate(&content, Assignment::Soft, likelihood, point);
            let found = found.map_or(0.0, |found| f64::from(found.likelihood));
            let expected = mixed(&content, likelihood, point);
            let error = (found - expected).abs();
            prop_assert!(error <= SOFT, "{likelihood:?}: {found} for {expected}");
        }
    }

    #[test]
    fn a_mixture_never_exceeds_the_maximum(content in content(), point in point()) {
        for likelihood in [Likelihood::Peak, Likelihood::Density] {
            let [soft, maximum] = [Assignment::Soft, Assignment::Maximum].map(|assignment| {
                evaluate(&content, assignment, likelihood, point)
                    .map_or(0.0, |found| f64::from(found.likelihood))
            });
            prop_assert!(soft <= maximum + SOFT, "{likelihood:?}: {soft} > {maximum}");
        }
    }

    #[test]
    fn of_one_component_the_mixture_is_that_component(content in content(), point in point()) {
        let mut content = content;
        content.parts.truncate(1);
        for likelihood in [Likelihood::Peak, Likelihood::Density] {
            prop_assert_eq!(
                evaluate(&content, Assignment::Soft, likelihood, point),
                evaluate(&content, Assignment::Nearest, likelihood, point)
            );
        }
    }

    #[test]
    fn sharp_precisions_leave_the_nearest_component_alone(
        content in content(),
        point in point(),
    ) {
        let mut content = content;
        for part in &mut content.parts {
            part.precision = Precision::from_factor([1e3, 0.0, 1e3, 0.0, 0.0, 1e3]);
        }
        let mut reaches: Vec<f32> = content
            .parts
            .iter()
            .map(|part| (Point3::from(point) - Point3::from(part.centre)).norm_squared())
            .collect();
        reaches.sort_by(f32::total_cmp);
        // Two that are equally near share the point.
        prop_assume!(reaches.len() < 2 || 1e6 * (reaches[1] - reaches[0]) > 200.0);
        prop_assert_eq!(
            evaluate(&content, Assignment::Soft, Likelihood::Peak, point),
            evaluate(&content, Assignment::Nearest, Likelihood::Peak, point)
        );
    }
}

#[test]
fn thresholds_are_mixed_as_likelihoods_are() {
    let mut content = Content::small();
    content.parts[0].sigma_hat = 0.5;
    content.parts[1].sigma_hat = 2.0;
    // Halfway between the reference points, both weigh the same.
    let found = evaluate(
        &content,
        Assignment::Soft,
        Likelihood::Peak,
        [0.0, 0.5, 4.0],
    )
    .unwrap();
    let contribution = |sigma_hat: f32| {
        let sigma = sigma_hat.hypot(NOISE);
        let x = 0.5 * (2.0 / sigma).powi(2);
        (1.0 - (-x).exp()) / (2.0 * x)
    };
    let expected = 0.5 * (contribution(0.5) + contribution(2.0));
    assert!((found.threshold - expected).abs() < 1e-6, "{found:?}");
}

#[test]
fn a_point_on_a_reference_point_is_left_to_the_others() {
    let content = Content::small();
    let on = content.parts[0].centre;
    let found = evaluate(&content, Assignment::Soft, Likelihood::Peak, on).unwrap();
    assert_eq!(found.component, 1);
    let far = Vector3::from(on) * 1e25;
    assert_eq!(
        evaluate(&content, Assignment::Soft, Likelihood::Peak, far.into()),
        None
    );
}
