//! Which component speaks for a point, and how probable it finds it.
#![expect(
    clippy::disallowed_methods,
    reason = "the reference values are computed independently of the crate's own functions"
)]

use crate::content::{Content, Part, content};
use crate::scene::{COMPONENTS, settings};
use crate::tolerance::{DENSITY, DISTANCE, MAXIMUM_LIKELIHOOD, QUADRATURE, TINY_NOISE};
use cobra_infer::mixture::Match;
use cobra_infer::template::Precision;
use cobra_infer::{
    Assignment, Likelihood, Mixture, ScoreError, Settings, Sigma, Template, Threshold, bound,
};
use nalgebra::Point3;
use proptest::prelude::*;

const TEMPLATE_SIGMA: Sigma = Sigma::Template { noise: 0.0 };

fn evaluate(
    template: &Template<'_>,
    assignment: Assignment,
    likelihood: Likelihood,
    sigma: Sigma,
    point: [f32; 3],
) -> Option<Match> {
    let settings = settings(assignment, likelihood, sigma);
    let mixture = Mixture::<COMPONENTS>::new(template, &settings).unwrap();
    mixture.evaluate(&Point3::from(point))
}

/// The largest contribution of any component, whichever a point would go to.
fn threshold(content: &Content, settings: &Settings) -> f32 {
    let bytes = content.encode();
    let template = Template::from_bytes(&bytes).unwrap();
    let mixture = Mixture::<COMPONENTS>::new(&template, settings).unwrap();
    mixture.threshold(None)
}

fn point() -> impl Strategy<Value = [f32; 3]> {
    [-25.0_f32..25.0, -25.0_f32..25.0, -25.0_f32..25.0]
}

proptest! {
    #![proptest_config(crate::seed::config())]

    #[test]
    fn the_maximum_is_never_below_the_nearest(content in content(), point in point()) {
        let bytes = content.encode();
        let template = Template::from_bytes(&bytes).unwrap();
        for likelihood in [Likelihood::Peak, Likelihood::Density] {
            let [nearest, maximum] = [Assignment::Nearest, Assignment::Maximum].map(|assignment| {
                evaluate(&template, assignment, likelihood, TEMPLATE_SIGMA, point)
                    .map_or(0.0, |found| f64::from(found.likelihood))
            });
            // Below the smallest normal number a relative tolerance means nothing.
            let least = nearest * (1.0 - MAXIMUM_LIKELIHOOD) - f64::from(f32::MIN_POSITIVE);
            prop_assert!(maximum >= least, "{likelihood:?}: {maximum} < {nearest}");
        }
    }

    #[test]
    fn the_nearest_is_the_nearest(content in content(), point in point()) {
        let bytes = content.encode();
        let template = Template::from_bytes(&bytes).unwrap();
        let likelihood = Likelihood::Peak;
        let found = evaluate(&template, Assignment::Nearest, likelihood, TEMPLATE_SIGMA, point);
        let Some(found) = found else { return Ok(()); };
        let reach = |part: &Part| {
            let offset = Point3::from(point) - Point3::from(part.centre);
            match part.precision {
                Some(precision) => precision.form(offset.into()),
                None => offset.norm_squared(),
            }
        };
        let nearest = reach(&content.parts[found.component]);
        for part in &content.parts {
            // The two are rounded differently.
            prop_assert!(nearest <= reach(part) * (1.0 + 2.0 * DISTANCE as f32));
        }
    }

    #[test]
    fn the_density_is_the_peak_over_its_normaliser(
        content in content(),
        point in point(),
        sigma in 0.01_f32..10.0,
    ) {
        let bytes = content.encode();
        let template = Template::from_bytes(&bytes).unwrap();
        for (setting, fixed) in [(TEMPLATE_SIGMA, None), (Sigma::Fixed(sigma), Some(sigma))] {
            let [peak, density] = [Likelihood::Peak, Likelihood::Density].map(|likelihood| {
                evaluate(&template, Assignment::Nearest, likelihood, setting, point)
            });
            let (Some(peak), Some(density)) = (peak, density) else {
                prop_assert_eq!(peak, density);
                continue;
            };
            prop_assert_eq!(peak.component, density.component);
            prop_assert_eq!(peak.residual().to_bits(), density.residual().to_bits());
            // Subnormal numbers have no relative precision.
            if peak.likelihood.min(density.likelihood) < f32::MIN_POSITIVE {
                continue;
            }
            let sigma = f64::from(fixed.unwrap_or(content.parts[peak.component].sigma_hat));
            let normaliser = core::f64::consts::TAU * sigma * sigma;
            let density = f64::from(density.likelihood);
            let squared = f64::from(peak.likelihood).powi(2) / normaliser;
            // Of the square, so that the reference needs no root.
            prop_assert!((density * density / squared - 1.0).abs() <= 2.0 * DENSITY);
        }
    }

    #[test]
    fn the_peak_is_a_gaussian_of_the_residual(content in content(), point in point()) {
        let bytes = content.encode();
        let template = Template::from_bytes(&bytes).unwrap();
        for assignment in [Assignment::Nearest, Assignment::Maximum] {
            let sigma = Sigma::Fixed(0.5);
            let found = evaluate(&template, assignment, Likelihood::Peak, sigma, point);
            if let Some(found) = found {
                let scaled = found.residual() * 2.0;
                let expected = cobra_infer::math::exp(-(0.5 * scaled * scaled));
                prop_assert_eq!(found.likelihood.to_bits(), expected.to_bits());
                prop_assert!((0.0..=1.0).contains(&found.likelihood));
            }
        }
    }

    #[test]
    fn noise_adds_in_quadrature(sigma_hat in 1e-3_f32..1e3, noise in 0.0_f32..1e3) {
        let content = Content::sphere(50.0, sigma_hat);
        // For a residual e the peak's logarithm is −e²/2σ²; the threshold knows σ without one.
        let delta = 0.5 * (sigma_hat + noise);
        let with_noise = Settings {
            sigma: Sigma::Template { noise },
            ..Settings::with_delta(delta)
        };
        let squares = f64::from(sigma_hat).powi(2) + f64::from(noise).powi(2);
        let bytes = content.encode();
        let template = Template::from_bytes(&bytes).unwrap();
        let density = evaluate(
            &template,
            Assignment::Nearest,
            Likelihood::Density,
            with_noise.sigma,
            [50.0, 0.0, 0.0],
        );
        // On the surface the density is 1/(√(2π)σ).
        let density = f64::from(density.unwrap().likelihood);
        let found = 1.0 / (density * density * core::f64::consts::TAU);
        prop_assert!((found / squares - 1.0).abs() <= 2.0 * (QUADRATURE + DENSITY));
        let least = bound::contribution(Likelihood::Peak, Threshold::Paper, sigma_hat, delta);
        prop_assert!(threshold(&content, &with_noise) >= least);
    }

    #[test]
    fn with_one_sigma_the_threshold_is_the_contribution(
        content in content(),
        sigma in 0.01_f32..100.0,
        delta in 0.01_f32..100.0,
    ) {
        for likelihood in [Likelihood::Peak, Likelihood::Density] {
            let settings = Settings {
                likelihood,
                sigma: Sigma::Fixed(sigma),
                ..Settings::with_delta(delta)
            };
            let expected = bound::contribution(likelihood, Threshold::Paper, sigma, delta);
            prop_assert_eq!(threshold(&content, &settings).to_bits(), expected.to_bits());
        }
    }
}

#[test]
fn noise_far_below_one_is_not_lost() {
    // The squares of both vanish in f32.
    let content = Content::sphere(1e-20, 1e-28);
    let bytes = content.encode();
    let template = Template::from_bytes(&bytes).unwrap();
    let noise = 1e-25;
    let settings = Settings {
        sigma: Sigma::Template { noise },
        ..Settings::with_delta(noise)
    };
    let mixture = Mixture::<1>::new(&template, &settings).unwrap();
    let expected = bound::contribution(Likelihood::Peak, Threshold::Paper, noise, noise);
    assert!((mixture.threshold(None) - expected).abs() < TINY_NOISE as f32);
}

#[test]
fn a_point_on_its_reference_point_has_no_match_but_another_component_may_speak() {
    let content = Content::small();
    let bytes = content.encode();
    let template = Template::from_bytes(&bytes).unwrap();
    let on = content.parts[0].centre;
    let ask = |assignment, point| {
        evaluate(
            &template,
            assignment,
            Likelihood::Peak,
            TEMPLATE_SIGMA,
            point,
        )
    };
    assert_eq!(ask(Assignment::Nearest, on), None);
    assert_eq!(ask(Assignment::Maximum, on).unwrap().component, 1);
    // 1e-6 of the radius, 12, is the limit.
    let near = |offset: f32| [on[0], on[1], on[2] + offset];
    assert_eq!(ask(Assignment::Nearest, near(1e-5)), None);
    assert!(ask(Assignment::Nearest, near(1e-4)).is_some());
}

#[test]
fn a_reach_that_is_no_number_never_hides_a_finite_one() {
    let mut content = Content::small();
    let [first, second] = &mut content.parts[..] else {
        panic!("two parts");
    };
    first.centre = [100.0, 0.0, 0.0];
    // ∞ − ∞ for the point below.
    first.precision = Precision::from_factor([3e38, 3e38, 1.0, 0.0, 0.0, 1.0]);
    second.precision = Precision::from_factor([0.1, 0.0, 0.1, 0.0, 0.0, 0.1]);
    let bytes = content.encode();
    let template = Template::from_bytes(&bytes).unwrap();
    for assignment in [Assignment::Nearest, Assignment::Soft] {
        let point = [80.0, 40.0, 0.0];
        let found = evaluate(
            &template,
            assignment,
            Likelihood::Peak,
            TEMPLATE_SIGMA,
            point,
        );
        assert_eq!(
            found.map(|found| found.component),
            Some(1),
            "{assignment:?}"
        );
    }
}

#[test]
fn every_residual_of_at_most_delta_reaches_the_worst_threshold_to_the_last_bit() {
    let mut content = Content::sphere(40.0, 1.0);
    for step in 1..400 {
        content.parts[0].sigma_hat = 0.0137 * step as f32;
        let bytes = content.encode();
        let template = Template::from_bytes(&bytes).unwrap();
        for (delta, out) in [(1e-5, 0.0), (0.5, 0.5), (2.0, 2.0), (3.0, -3.0)] {
            for likelihood in [Likelihood::Peak, Likelihood::Density] {
                let settings = Settings {
                    likelihood,
                    threshold: Threshold::Worst,
                    ..Settings::with_delta(delta)
                };
                let mixture = Mixture::<COMPONENTS>::new(&template, &settings).unwrap();
                let found = mixture
                    .evaluate(&Point3::new(40.0 + out, 0.0, 0.0))
                    .unwrap();
                assert_eq!(found.residual(), out);
                assert!(
                    found.likelihood >= found.threshold,
                    "{settings:?} {found:?}"
                );
            }
        }
    }
}

#[test]
fn a_point_infinitely_far_away_has_no_match() {
    let bytes = Content::small().encode();
    let template = Template::from_bytes(&bytes).unwrap();
    for far in [f32::INFINITY, f32::NAN, f32::MAX, 1e30] {
        for assignment in [Assignment::Nearest, Assignment::Maximum, Assignment::Soft] {
            let point = [0.0, far, 0.0];
            let found = evaluate(
                &template,
                assignment,
                Likelihood::Peak,
                TEMPLATE_SIGMA,
                point,
            );
            assert_eq!(found, None, "{far}");
        }
    }
}

#[test]
fn more_components_than_room_is_refused() {
    let bytes = Content::small().encode();
    let template = Template::from_bytes(&bytes).unwrap();
    let settings = Settings::with_delta(1.0);
    let error = ScoreError::TooManyComponents {
        capacity: 1,
        found: 2,
    };
    assert_eq!(Mixture::<1>::new(&template, &settings).unwrap_err(), error);
    assert!(Mixture::<0>::new(&template, &settings).is_err());
    assert!(Mixture::<2>::new(&template, &settings).is_ok());
}

#[test]
fn settings_out_of_range_are_refused() {
    let bytes = Content::small().encode();
    let template = Template::from_bytes(&bytes).unwrap();
    let refused = |settings| Mixture::<2>::new(&template, &settings).unwrap_err();
    for value in [0.0, -1.0, 1e-40, f32::INFINITY, f32::NAN] {
        let error = refused(Settings::with_delta(value));
        assert!(matches!(error, ScoreError::Delta { .. }), "{value}");
        let sigma = Sigma::Fixed(value);
        let error = refused(Settings {
            sigma,
            ..Settings::with_delta(1.0)
        });
        assert!(matches!(error, ScoreError::Sigma { .. }), "{value}");
    }
    for noise in [-1.0, -1e-40, f32::INFINITY, f32::NAN] {
        let sigma = Sigma::Template { noise };
        let error = refused(Settings {
            sigma,
            ..Settings::with_delta(1.0)
        });
        assert!(matches!(error, ScoreError::Noise { .. }), "{noise}");
    }
}
