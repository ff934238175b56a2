//! The numbers in a template: every one that scoring relies on is checked on load.

use crate::content::Content;
use crate::sections::{OBJECT, TERMS, set_record_word, set_term_word, with_body};
use cobra_infer::{Exponent, Kernel, Metric, Model, Template, TemplateError};

const NOT_FINITE: [f32; 3] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
/// Finite, but neither they nor their inverses are usable where something is divided by.
const NOT_POSITIVE: [f32; 4] = [0.0, -0.0, -1.0, 1e-40];

/// Words of a record, by the format's document.
const SIGMA_HAT: usize = 3;
const LENGTH_SCALE: usize = 4;
const PARAMETER: usize = 5;
const PRIOR_MEAN: usize = 6;
const FIRST_TERM: usize = 7;
const TERM_COUNT: usize = 8;

fn refused(bytes: &[u8]) -> TemplateError {
    Template::from_bytes(bytes).unwrap_err()
}

fn refuses_number(bytes: &[u8], word: usize, value: f32, expected_field: &str) {
    for index in 0..2 {
        let error = refused(&set_record_word(bytes, index, word, value.to_le_bytes()));
        let TemplateError::ComponentNumber {
            component,
            number,
            found,
            ..
        } = error
        else {
            panic!("{error:?}");
        };
        assert_eq!((component, number.name()), (index, expected_field));
        assert_eq!(found.to_bits(), value.to_bits());
        assert!(error.to_string().contains(expected_field), "{error}");
    }
}

#[test]
fn a_bounding_sphere_or_diameter_that_is_none_is_refused() {
    let bytes = Content::small().encode();
    let fields = ["centre x", "centre y", "centre z", "radius", "diameter"];
    for (index, name) in fields.into_iter().enumerate() {
        let unfit: &[f32] = if index < 3 { &[] } else { &NOT_POSITIVE };
        for value in NOT_FINITE.iter().chain(unfit) {
            // The name with its length and the unit lead the numbers.
            let at = 1 + "nut".len() + 1 + 4 * index;
            let damaged = with_body(&bytes, OBJECT, |body| {
                body[at..at + 4].copy_from_slice(&value.to_le_bytes());
            });
            let error = refused(&damaged);
            assert!(
                matches!(error, TemplateError::ObjectNumber { number, .. } if number.name() == name),
                "{name} {value}: {error}"
            );
        }
    }
}

#[test]
fn a_reference_point_that_is_not_finite_is_refused() {
    let bytes = Content::small().encode();
    for word in 0..3 {
        for value in NOT_FINITE {
            refuses_number(&bytes, word, value, "the centre");
        }
    }
}

#[test]
fn a_sigma_hat_or_length_scale_that_is_not_positive_is_refused() {
    let bytes = Content::small().encode();
    for value in NOT_FINITE.into_iter().chain(NOT_POSITIVE) {
        refuses_number(&bytes, SIGMA_HAT, value, "sigma-hat");
        refuses_number(&bytes, LENGTH_SCALE, value, "the length scale");
    }
}

#[test]
fn a_length_scale_whose_square_vanishes_or_overflows_is_refused() {
    let bytes = Content::small().encode();
    for value in [1e-20, 1e20, f32::MAX] {
        refuses_number(&bytes, LENGTH_SCALE, value, "the length scale");
    }
}

#[test]
fn an_exponent_that_contradicts_the_kernel_is_refused() {
    let mut content = Content::small();
    for (exponent, fixed) in [(Exponent::One, 1.0_f32), (Exponent::Half, 0.5)] {
        content.model.kernel = Kernel::RationalQuadratic(exponent);
        for part in &mut content.parts {
            part.hyperparameters.parameter = fixed;
        }
        let bytes = content.encode();
        let neighbour = f32::from_bits(fixed.to_bits() + 1);
        for value in [1.5 - fixed, neighbour, -fixed, 0.0, f32::NAN] {
            refuses_number(&bytes, PARAMETER, value, "the exponent");
        }
    }
}

#[test]
fn a_free_exponent_must_be_positive_and_divide() {
    let mut content = Content::small();
    content.model.kernel = Kernel::RationalQuadratic(Exponent::Free);
    let bytes = content.encode();
    // The kernel divides by twice the exponent, which the last makes infinite.
    for value in NOT_FINITE.into_iter().chain(NOT_POSITIVE).chain([f32::MAX]) {
        refuses_number(&bytes, PARAMETER, value, "the exponent");
    }
}

#[test]
fn an_offset_and_a_period_must_be_positive() {
    let mut content = Content::small();
    for (kernel, name) in [
        (Kernel::Polynomial, "the offset"),
        (Kernel::Periodic, "the period"),
    ] {
        content.model.kernel = kernel;
        for part in &mut content.parts {
            part.hyperparameters.length_scale = 1.0;
        }
        let bytes = content.encode();
        for value in NOT_FINITE.into_iter().chain(NOT_POSITIVE) {
            refuses_number(&bytes, PARAMETER, value, name);
        }
    }
}

#[test]
fn a_number_that_a_kernel_has_not_is_1() {
    let mut content = Content::small();
    for kernel in Kernel::ALL {
        content.model.kernel = kernel;
        for part in &mut content.parts {
            part.hyperparameters.parameter = kernel.fixed_parameter().unwrap_or(0.75);
            part.hyperparameters.length_scale = kernel.fixed_length_scale().unwrap_or(0.75);
        }
        let bytes = content.encode();
        if kernel.parameter_name().is_none() {
            refuses_number(&bytes, PARAMETER, 0.75, "the parameter");
        }
        if kernel.fixed_length_scale().is_some() {
            refuses_number(&bytes, LENGTH_SCALE, 0.75, "the length scale");
        }
    }
}

#[test]
fn angles_outside_their_ranges_are_refused_by_their_place() {
    let mut content = Content::small();
    content.model = Model {
        metric: Metric::Angles,
        ..content.model
    };
    let bytes = content.encode();
    // Component 1 has two terms from word 12 on: phi, phi, theta, theta, 0, 0, weights.
    let expected = TemplateError::Angles {
        component: 1,
        term: 0,
    };
    for (word, values) in [
        (12, &[-0.1, 3.15, f32::NAN][..]),
        (14, &[-3.15, 3.15, f32::INFINITY]),
        (16, &[1e-30, -1.0, f32::NAN]),
    ] {
        for value in values {
            assert_eq!(refused(&set_term_word(&bytes, word, *value)), expected);
        }
    }
    for (word, value) in [(12, core::f32::consts::PI), (14, -core::f32::consts::PI)] {
        assert!(Template::from_bytes(&set_term_word(&bytes, word, value)).is_ok());
    }
}

#[test]
fn a_prior_mean_that_is_not_finite_is_refused() {
    let bytes = Content::small().encode();
    for value in NOT_FINITE {
        refuses_number(&bytes, PRIOR_MEAN, value, "the prior mean");
    }
}

#[test]
fn a_weight_that_is_not_finite_is_refused_by_its_place() {
    let bytes = Content::small().encode();
    // 3 terms: x, y, z, weights; then 2 terms.
    for (word, component, term) in [(9, 0, 0), (11, 0, 2), (12 + 6, 1, 0), (12 + 7, 1, 1)] {
        for value in NOT_FINITE {
            assert_eq!(
                refused(&set_term_word(&bytes, word, value)),
                TemplateError::Weight { component, term }
            );
        }
    }
}

#[test]
fn a_direction_that_is_no_unit_vector_is_refused_by_its_place() {
    let bytes = Content::small().encode();
    // Component 1's directions are (1, 0, 0) and (0, -1, 0); its x run starts at word 12.
    for value in [0.0, 0.99999, 1.00001, 2.0, f32::NAN, f32::INFINITY, 1e20] {
        let error = refused(&set_term_word(&bytes, 12, value));
        assert!(
            matches!(
                error,
                TemplateError::Direction {
                    component: 1,
                    term: 0,
                    ..
                }
            ),
            "{value}: {error}"
        );
    }
    assert!(Template::from_bytes(&set_term_word(&bytes, 12, 0.999_999)).is_ok());
    assert!(Template::from_bytes(&set_term_word(&bytes, 12, -1.0)).is_ok());
}

#[test]
fn a_component_without_terms_is_refused() {
    let bytes = Content::small().encode();
    for component in 0..2 {
        let none = set_record_word(&bytes, component, TERM_COUNT, [0; 4]);
        assert_eq!(refused(&none), TemplateError::NoTerms { component });
    }
}

#[test]
fn term_ranges_that_overlap_or_leave_a_gap_are_refused() {
    let bytes = Content::small().encode();
    for (component, first) in [(0, 1), (0, u32::MAX), (1, 0), (1, 2), (1, 4), (1, u32::MAX)] {
        let moved = set_record_word(&bytes, component, FIRST_TERM, first.to_le_bytes());
        assert_eq!(refused(&moved), TemplateError::TermRange { component });
    }
}

#[test]
fn term_ranges_past_the_end_are_refused() {
    let bytes = Content::small().encode();
    for count in [3, 4, 1 << 30, u32::MAX - 3, u32::MAX] {
        let longer = set_record_word(&bytes, 1, TERM_COUNT, u32::to_le_bytes(count));
        assert_eq!(
            refused(&longer),
            TemplateError::TermRange { component: 1 },
            "{count}"
        );
    }
}

#[test]
fn terms_that_belong_to_no_component_are_refused() {
    let bytes = Content::small().encode();
    let unused = with_body(&bytes, TERMS, |body| {
        body[1] += 16;
        body.extend([0; 16]);
    });
    let expected = TemplateError::UnusedTerms {
        expected: 5,
        found: 6,
    };
    assert_eq!(refused(&unused), expected);
    let shorter = set_record_word(&bytes, 1, TERM_COUNT, 1_u32.to_le_bytes());
    let expected = TemplateError::UnusedTerms {
        expected: 4,
        found: 5,
    };
    assert_eq!(refused(&shorter), expected);
}
