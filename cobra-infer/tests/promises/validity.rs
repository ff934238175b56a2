//! Compact terms, validity and quality in the file: what is written is read, and what does not fit is
//! refused with the component and the reason.

use crate::charts::{charts, small};
use crate::content::{Compact, Content};
use crate::sections::{REQUIRED, Raw, join, split, with_body};
use cobra_infer::template::{Number, Range, VALIDITY_LENGTH};
use cobra_infer::validity::{Cell, direction};
use cobra_infer::{EncodeError, Metric, Section, Template, TemplateError};
use proptest::prelude::*;

const TERMS: u16 = 4;
const VALIDITY: u16 = 6;
const QUALITY: u16 = 7;

fn refused(bytes: &[u8]) -> TemplateError {
    Template::from_bytes(bytes).unwrap_err()
}

proptest! {
    #![proptest_config(crate::seed::config())]

    #[test]
    fn what_is_encoded_is_decoded(content in charts()) {
        let bytes = content.encode();
        let template = Template::from_bytes(&bytes).unwrap();
        prop_assert!(template.has_validity());
        let terms = content.parts.iter().map(|part| part.weights.len());
        prop_assert_eq!(template.term_count(), terms.sum::<usize>());
        let (terms, count) = (template.term_count(), template.component_count());
        let compact = 5 * terms + 4 * count;
        let expected = if template.has_compact_terms() { compact } else { 16 * terms };
        prop_assert_eq!(template.terms_len(), expected);
        // A record each, a row of blocks at least, and no more than all rows of mixed blocks.
        let rest = template.validity_len() - 16 * count;
        prop_assert!((5 * count..=(5 * 16 + 2 * 256) * count).contains(&rest), "{}", rest);
        for (component, part) in template.components().zip(&content.parts) {
            let (read, written) = (component.validity.unwrap(), part.validity.as_ref().unwrap());
            prop_assert_eq!(read.pole(), written.pole);
            prop_assert_eq!(read.side(), written.side);
            prop_assert_eq!((read.low(), read.high()), (written.low, written.high));
            let side = usize::from(written.side);
            for (place, valid) in written.cells.iter().enumerate() {
                let cell = Cell { column: (place % side) as u8, row: (place / side) as u8 };
                prop_assert_eq!(read.contains(cell), *valid);
                let middle = direction(written.pole, written.side, cell, [0.5, 0.5]);
                prop_assert_eq!(read.contains_direction(middle), *valid);
            }
            let valid = written.cells.iter().filter(|valid| **valid).count();
            prop_assert_eq!(read.cells().count(), valid);
            prop_assert_eq!(
                component.terms.compact_scale(),
                part.compact.as_ref().map(|compact| compact.scale)
            );
            let Some(compact) = &part.compact else { continue };
            let written = compact.directions.iter().zip(&compact.weights);
            for ((direction, weight), (steps, steps_of_weight)) in component.terms.iter().zip(written) {
                prop_assert_eq!(direction, steps.map(|step| f32::from(step) / 127.0));
                prop_assert_eq!(weight, f32::from(*steps_of_weight) * compact.scale);
            }
        }
        let (read, written) = (template.quality().unwrap(), content.quality.unwrap());
        prop_assert_eq!(read.covered, written.covered);
        prop_assert_eq!([read.deviation_max, read.deviation_rms], written.deviations);
        for (read, written) in read.unexplained().zip(written.unexplained) {
            prop_assert!((read - written).abs() <= 0.51 / 65535.0, "{} {}", read, written);
        }
    }
}

#[test]
fn validity_is_required_of_readers_and_quality_is_not() {
    let sections = split(&small().encode());
    let flags: Vec<_> = sections[4..]
        .iter()
        .map(|raw| (raw.tag, raw.flags))
        .collect();
    assert_eq!(flags, [(VALIDITY, REQUIRED), (QUALITY, 0)]);
}

#[test]
fn a_template_without_them_says_so() {
    let bytes = Content::small().encode();
    let template = Template::from_bytes(&bytes).unwrap();
    assert!(!template.has_validity() && !template.has_compact_terms());
    assert_eq!(template.quality(), None);
    assert_eq!(template.component(0).unwrap().validity, None);
}

#[test]
fn components_that_differ_in_what_they_have_are_not_written() {
    let mut content = small();
    content.parts[1].validity = None;
    assert_eq!(content.try_encode(), Err(EncodeError::Validities));
    let mut content = small();
    content.parts[0].compact = None;
    assert_eq!(content.try_encode(), Err(EncodeError::TermEncodings));
}

#[test]
fn a_grid_of_another_size_is_not_written() {
    for (side, found) in [(0, 0), (6, 36), (68, 4624), (8, 63), (8, 65)] {
        let mut content = small();
        let valid = content.parts[1].validity.as_mut().unwrap();
        (valid.side, valid.cells) = (side, vec![true; found]);
        let expected = EncodeError::ValidityCells {
            component: 1,
            side,
            found,
        };
        assert_eq!(content.try_encode(), Err(expected));
    }
}

#[test]
fn no_valid_cell_or_a_box_that_is_none_is_not_written() {
    let mut content = small();
    content.parts[1]
        .validity
        .as_mut()
        .unwrap()
        .cells
        .fill(false);
    let component = 1;
    let expected = TemplateError::ValidityCells { component, row: 0 };
    assert_eq!(content.try_encode(), Err(EncodeError::Invalid(expected)));
    for (low, high) in [([5, 9, 0], [6, 8, 0]), ([0, 0, 128], [0, 0, 128])] {
        let mut content = small();
        let valid = content.parts[1].validity.as_mut().unwrap();
        (valid.low, valid.high) = (low, high);
        let expected = TemplateError::ValidityBox {
            component,
            low,
            high,
        };
        assert_eq!(content.try_encode(), Err(EncodeError::Invalid(expected)));
    }
}

#[test]
fn a_quality_that_is_none_is_not_written_and_of_a_file_not_believed() {
    type Change = fn(&mut crate::content::Measured);
    let changes: [Change; 5] = [
        |measured| measured.covered = 1.5,
        |measured| measured.covered = f32::NAN,
        |measured| measured.deviations[0] = -1.0,
        |measured| measured.deviations[1] = f32::INFINITY,
        |measured| measured.unexplained.truncate(1),
    ];
    for change in changes {
        let mut content = small();
        change(content.quality.as_mut().unwrap());
        assert_eq!(content.try_encode(), Err(EncodeError::Quality));
    }
    let bytes = with_body(&small().encode(), QUALITY, |body| body.truncate(5));
    let template = Template::from_bytes(&bytes).unwrap();
    assert_eq!(template.quality(), None);
}

#[test]
fn compact_terms_have_no_angles() {
    let mut content = small();
    content.model.metric = Metric::Angles;
    let expected = EncodeError::Invalid(TemplateError::CompactAngles);
    assert_eq!(content.try_encode(), Err(expected));
}

fn with_compact(change: impl FnOnce(&mut Compact)) -> Result<Vec<u8>, EncodeError> {
    let mut content = small();
    change(content.parts[1].compact.as_mut().unwrap());
    content.try_encode()
}

#[test]
fn compact_numbers_out_of_their_range_are_refused() {
    for scale in [0.0, -1.0, f32::NAN, f32::INFINITY, 1e-40] {
        let found = with_compact(|compact| compact.scale = scale).unwrap_err();
        let EncodeError::Invalid(TemplateError::ComponentNumber {
            component: 1,
            number: Number::WeightScale,
            expected: Range::Normal,
            ..
        }) = found
        else {
            panic!("{scale}: {found}");
        };
    }
    for (direction, holds) in [
        ([127, 0, 0], true),
        ([126, 0, 0], true),
        ([125, 0, 0], false),
        ([-128, 0, 0], false),
        ([0, 127, 16], false),
        ([0, 127, -15], true),
        ([0, 0, 0], false),
    ] {
        let found = with_compact(|compact| compact.directions[1] = direction);
        assert_eq!(found.is_ok(), holds, "{direction:?}");
        if let Err(error) = found {
            let EncodeError::Invalid(TemplateError::Direction {
                component: 1,
                term: 1,
                ..
            }) = error
            else {
                panic!("{error}");
            };
        }
    }
    assert!(with_compact(|compact| compact.weights.fill(i16::MIN)).is_ok());
}

#[test]
fn compact_runs_lie_one_behind_the_other() {
    // Two runs, of 4 + 15 and 4 + 10 bytes, behind the encoding and the length.
    let bytes = small().encode();
    for (length, expected) in [
        (32, TemplateError::TermRange { component: 1 }),
        (
            34,
            TemplateError::UnusedTerms {
                expected: 33,
                found: 34,
            },
        ),
    ] {
        let damaged = with_body(&bytes, TERMS, |body| {
            body[1] = length;
            body.resize(2 + usize::from(length), 0);
        });
        assert_eq!(refused(&damaged), expected);
    }
    for first in [0, 18, 20, u32::MAX] {
        let damaged = crate::sections::set_record_word(&bytes, 1, 7, first.to_le_bytes());
        assert_eq!(refused(&damaged), TemplateError::TermRange { component: 1 });
    }
}

/// Where the small template's second component is in its validity section: records of two components,
/// then two runs of two rows and two leaves each.
const RECORD: usize = 2 + VALIDITY_LENGTH;
const CELLS: usize = 2 + 2 * VALIDITY_LENGTH + 1;
const RUN: usize = CELLS + 14;

#[test]
fn hostile_validity_sections_are_refused_by_what_is_wrong() {
    let bytes = small().encode();
    let component = 1;
    let low = |low| TemplateError::ValidityBox {
        component,
        low,
        high: [120, 127, 110],
    };
    let grid = |pole, blocks, first, rows| TemplateError::ValidityGrid {
        component,
        pole,
        blocks,
        first,
        rows,
    };
    let range = TemplateError::ValidityRange { component };
    let cells = |row| TemplateError::ValidityCells { component, row };
    type Change = (usize, u8, TemplateError);
    let cases: [Change; 20] = [
        (RECORD, 121, low([121, 0, 3])),
        (RECORD + 1, 255, low([1, 255, 3])),
        (RECORD + 3, 6, grid(6, 2, 0, 2)),
        (RECORD + 7, 0, grid(4, 0, 0, 2)),
        (RECORD + 7, 17, grid(4, 17, 0, 2)),
        (RECORD + 8, 1, grid(4, 2, 1, 2)),
        (RECORD + 9, 3, grid(4, 2, 0, 3)),
        (RECORD + 9, 255, grid(4, 2, 0, 255)),
        (RECORD + 10, 3, range),
        (RECORD + 11, 255, range),
        (RECORD + 12, 13, range),
        (RECORD + 15, 255, range),
        // Of three blocks a side, the third's bit would be one.
        (RUN, 4, cells(0)),
        // Both full and mixed.
        (RUN, 3, cells(0)),
        // One mixed block more than there are.
        (RUN + 7, 3, cells(1)),
        // A rank that is not the number of those before.
        (RUN + 4, 1, cells(0)),
        (RUN + 9, 0, cells(1)),
        // No row.
        (RECORD + 9, 0, cells(0)),
        // A mixed block less than there are.
        (RUN + 2, 0, cells(1)),
        (RECORD + 10, 1, cells(1)),
    ];
    for (at, value, expected) in cases {
        let damaged = with_body(&bytes, VALIDITY, |body| {
            assert_ne!(body[at], value, "{at}");
            body[at] = value;
        });
        assert_eq!(refused(&damaged), expected, "byte {at}: {value}");
    }
    for leaf in [0_u16, u16::MAX] {
        let damaged = with_body(&bytes, VALIDITY, |body| {
            body[RUN + 10..RUN + 12].copy_from_slice(&leaf.to_le_bytes());
        });
        assert_eq!(refused(&damaged), cells(0));
    }
}

#[test]
fn a_validity_section_of_another_length_is_refused() {
    let bytes = small().encode();
    let unused = with_body(&bytes, VALIDITY, |body| {
        body[CELLS - 1] += 1;
        body.push(0);
    });
    let expected = 28;
    let found = 29;
    assert_eq!(
        refused(&unused),
        TemplateError::UnusedCells { expected, found }
    );
    let stride = with_body(&bytes, VALIDITY, |body| body[0] = 17);
    let expected = TemplateError::RecordLength {
        expected: 16,
        found: 17,
    };
    assert_eq!(refused(&stride), expected);
    for count in [0, 1, 3] {
        let damaged = with_body(&bytes, VALIDITY, |body| {
            body[1] = (count * VALIDITY_LENGTH) as u8;
            let cells = body.split_off(2 + 2 * VALIDITY_LENGTH);
            body.resize(2 + count * VALIDITY_LENGTH, 0);
            body.extend(cells);
        });
        let expected = TemplateError::ValidityCount {
            expected: 2,
            found: count,
        };
        assert_eq!(refused(&damaged), expected);
    }
    let odd = with_body(&bytes, VALIDITY, |body| {
        body[1] += 1;
        body.insert(2, 0);
    });
    let expected = TemplateError::ArrayLength {
        section: Section::Validity,
        element: 16,
        found: 33,
    };
    assert_eq!(refused(&odd), expected);
    let mut twice = split(&bytes);
    let again: Raw = twice[4].clone();
    twice.push(again);
    let expected = TemplateError::DuplicateSection {
        section: Section::Validity,
    };
    assert_eq!(refused(&join(&twice)), expected);
}
