//! The precisions section: optional, whole, one factor a component, each of them positive definite.

use crate::content::Content;
use crate::sections::{REQUIRED, Raw, join, split};
use cobra_infer::template::{PRECISION_LENGTH, Precision};
use cobra_infer::{EncodeError, Section, Template, TemplateError};

const PRECISIONS: u16 = 5;

fn precise() -> Content {
    let mut content = Content::small();
    for part in &mut content.parts {
        part.precision = Precision::from_factor([0.5, 0.1, 0.25, -0.2, 0.0, 0.125]);
    }
    content
}

fn refused(sections: &[Raw]) -> TemplateError {
    Template::from_bytes(&join(sections)).unwrap_err()
}

#[test]
fn a_template_says_whether_it_has_precisions() {
    for (content, expected) in [(precise(), true), (Content::small(), false)] {
        let bytes = content.encode();
        let template = Template::from_bytes(&bytes).unwrap();
        assert_eq!(template.has_precisions(), expected);
        for (component, part) in template.components().zip(&content.parts) {
            assert_eq!(component.precision, part.precision);
        }
    }
}

#[test]
fn a_reader_that_does_not_know_the_section_refuses_it() {
    let section = split(&precise().encode()).pop().unwrap();
    assert_eq!((section.tag, section.flags), (PRECISIONS, REQUIRED));
}

#[test]
fn precisions_of_some_components_only_are_not_written() {
    let mut content = precise();
    content.parts[1].precision = None;
    assert_eq!(content.try_encode(), Err(EncodeError::Precisions));
}

#[test]
fn a_factor_too_few_or_too_many_is_refused() {
    for found in [0, 1, 3] {
        let mut sections = split(&precise().encode());
        let body = &mut sections.last_mut().unwrap().body;
        // The stride and the array's length are one byte each.
        body.resize(2 + found * PRECISION_LENGTH, 0);
        body[1] = (found * PRECISION_LENGTH) as u8;
        let expected = TemplateError::PrecisionCount { expected: 2, found };
        assert_eq!(refused(&sections), expected);
    }
}

#[test]
fn a_factor_that_is_cut_or_of_another_stride_is_refused() {
    let mut cut = split(&precise().encode());
    let body = &mut cut.last_mut().unwrap().body;
    body.pop();
    body[1] -= 1;
    let expected = TemplateError::ArrayLength {
        section: Section::Precisions,
        element: PRECISION_LENGTH,
        found: 2 * PRECISION_LENGTH - 1,
    };
    assert_eq!(refused(&cut), expected);
    let mut other = split(&precise().encode());
    other.last_mut().unwrap().body[0] += 1;
    let expected = TemplateError::RecordLength {
        expected: PRECISION_LENGTH,
        found: PRECISION_LENGTH + 1,
    };
    assert_eq!(refused(&other), expected);
}

#[test]
fn a_factor_that_makes_no_positive_definite_matrix_is_refused_by_its_component() {
    // The diagonal is the words 0, 2 and 5.
    for (component, word, value) in [
        (0, 0, 0.0),
        (1, 2, -1.0),
        (1, 5, 1e-40),
        (0, 1, f32::NAN),
        (1, 4, f32::INFINITY),
    ] {
        let mut sections = split(&precise().encode());
        let at = 2 + component * PRECISION_LENGTH + 4 * word;
        let body = &mut sections.last_mut().unwrap().body;
        body[at..at + 4].copy_from_slice(&f32::to_le_bytes(value));
        assert_eq!(refused(&sections), TemplateError::Precision { component });
    }
}
