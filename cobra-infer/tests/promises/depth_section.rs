//! What a template knows for depth mode is read as it was written, changes nothing else, and is refused
//! where a controller could not decide by it.

use crate::content::{Content, content};
use crate::sections::{DEPTH, REQUIRED, join, reseal, split, with_body};
use crate::template_mutations::{SPECIAL, every_byte_at_its_extremes, load_and_use};
use cobra_infer::template::{
    CALIBRATION_LENGTH, Calibration, CalibrationSource, DEPTH_CAPACITY, DepthSource, MeasuredShare,
    Number, PROVENANCE_CAPACITY, with_depth,
};
use cobra_infer::{EncodeError, Section, Template, TemplateError};
use proptest::prelude::*;

const CALIBRATION: Calibration = Calibration {
    accept: 0.625,
    reject: 0.25,
    minimum_points: 30,
    target: 0.01,
    false_accepts: MeasuredShare {
        share: 0.008,
        low: 0.004,
        high: 0.017,
    },
    wrong: 900,
    right: 1200,
    source: CalibrationSource::Simulated,
};

const DEPTH_MODE: DepthSource<'static> = DepthSource {
    noise_share: 0.04,
    calibration: Some(CALIBRATION),
    provenance: "lmo gdrnpp, masks simulated",
};

fn small() -> Content {
    Content {
        depth: Some(DEPTH_MODE),
        ..Content::small()
    }
}

fn calibrated(bytes: &[u8], depth: &DepthSource<'_>) -> Result<Vec<u8>, EncodeError> {
    let mut out = vec![0; bytes.len() + DEPTH_CAPACITY];
    let length = with_depth(bytes, depth, &mut out)?;
    out.truncate(length);
    Ok(out)
}

/// The small template with word `word` of its calibration replaced; its varint of 40 leads it.
fn with_word(word: usize, value: [u8; 4]) -> Result<(), TemplateError> {
    let damaged = with_body(&small().encode(), DEPTH, |body| {
        body[5 + 4 * word..][..4].copy_from_slice(&value);
    });
    Template::from_bytes(&damaged).map(drop)
}

#[test]
fn what_is_written_is_read_bit_by_bit() {
    let bytes = small().encode();
    let depth = Template::from_bytes(&bytes).unwrap().depth().unwrap();
    assert_eq!(depth.noise_share, 0.04);
    assert_eq!(depth.calibration, Some(CALIBRATION));
    assert_eq!(depth.provenance(), "lmo gdrnpp, masks simulated");
}

#[test]
fn without_thresholds_the_noise_stands_alone() {
    let mut content = small();
    content.depth = Some(DepthSource {
        calibration: None,
        provenance: "",
        ..DEPTH_MODE
    });
    let bytes = content.encode();
    let depth = Template::from_bytes(&bytes).unwrap().depth().unwrap();
    assert_eq!((depth.noise_share, depth.calibration), (0.04, None));
    assert_eq!(depth.provenance(), "");
    assert_eq!(split(&bytes).last().unwrap().body.len(), 6);
}

#[test]
fn a_template_without_it_has_none_and_no_byte_of_it() {
    let bytes = Content::small().encode();
    assert_eq!(Template::from_bytes(&bytes).unwrap().depth(), None);
    assert_eq!(split(&bytes).len(), 4);
}

#[test]
fn a_reader_may_skip_it() {
    assert_eq!(split(&small().encode()).last().unwrap().flags, 0);
    let mut sections = split(&small().encode());
    sections[4].flags = REQUIRED;
    assert!(Template::from_bytes(&join(&sections)).is_ok());
}

proptest! {
    #![proptest_config(crate::seed::config())]

    #[test]
    fn adding_it_later_is_encoding_it_at_once(content in content()) {
        let bytes = content.encode();
        let with = Content { depth: Some(DEPTH_MODE), ..content };
        prop_assert_eq!(calibrated(&bytes, &DEPTH_MODE).unwrap(), with.encode());
    }
}

#[test]
fn replacing_it_leaves_every_other_section_as_it_is() {
    let mut sections = split(&small().encode());
    // First, and with a section that nobody knows behind it.
    sections.rotate_right(1);
    sections.insert(
        2,
        crate::sections::Raw {
            tag: 900,
            flags: 0,
            body: vec![7; 9],
        },
    );
    let other = DepthSource {
        noise_share: 0.08,
        ..DEPTH_MODE
    };
    let bytes = calibrated(&join(&sections), &other).unwrap();
    let depth = Template::from_bytes(&bytes).unwrap().depth().unwrap();
    assert_eq!(depth.noise_share, 0.08);
    let (before, after) = (split(&join(&sections)), split(&bytes));
    assert_eq!(before.len(), after.len());
    for (before, after) in before[1..].iter().zip(&after) {
        assert_eq!((before.tag, before.flags), (after.tag, after.flags));
        assert_eq!(before.body, after.body);
    }
}

#[test]
fn the_capacity_is_enough_and_a_byte_less_than_needed_is_refused() {
    let bytes = Content::small().encode();
    let provenance = "x".repeat(PROVENANCE_CAPACITY);
    let longest = DepthSource {
        provenance: &provenance,
        ..DEPTH_MODE
    };
    let whole = calibrated(&bytes, &longest).unwrap();
    assert_eq!(whole.len(), bytes.len() + DEPTH_CAPACITY);
    let mut out = vec![0; whole.len()];
    for found in 0..whole.len() {
        assert_eq!(
            with_depth(&bytes, &longest, &mut out[..found]),
            Err(EncodeError::Buffer { found })
        );
    }
}

#[test]
fn words_that_are_too_long_or_of_no_calibration_are_not_written() {
    let bytes = Content::small().encode();
    let long = "x".repeat(PROVENANCE_CAPACITY + 1);
    for (calibration, provenance, capacity) in [(Some(CALIBRATION), &long[..], 48), (None, "x", 0)]
    {
        let depth = DepthSource {
            calibration,
            provenance,
            ..DEPTH_MODE
        };
        let found = provenance.len();
        assert_eq!(
            calibrated(&bytes, &depth),
            Err(EncodeError::Provenance { capacity, found })
        );
    }
}

#[test]
fn what_is_no_template_gets_no_calibration() {
    let mut bytes = Content::small().encode();
    bytes[40] ^= 1;
    assert!(matches!(
        calibrated(&bytes, &DEPTH_MODE),
        Err(EncodeError::Invalid(TemplateError::Checksum { .. }))
    ));
}

#[test]
fn noise_that_is_not_positive_and_finite_is_refused_by_name() {
    for found in [0.0, -0.04, 1e-40, f32::INFINITY, f32::NAN] {
        let depth = DepthSource {
            noise_share: found,
            ..DEPTH_MODE
        };
        let error = calibrated(&Content::small().encode(), &depth).unwrap_err();
        let said = error.to_string();
        assert!(
            said.contains("noise as a share of the diameter must be positive"),
            "{said}"
        );
    }
}

#[test]
fn every_number_out_of_its_range_is_refused_by_name() {
    for (word, value, number) in [
        (0, 1.25, Number::Accept),
        (0, f32::NAN, Number::Accept),
        // Below the threshold to reject.
        (0, 0.125, Number::Reject),
        (1, -0.5, Number::Reject),
        (1, 0.75, Number::Reject),
        (2, 0.0, Number::Target),
        (2, 1.5, Number::Target),
        (3, f32::NAN, Number::FalseAccepts),
        (3, -1.0, Number::FalseAccepts),
        (4, 0.5, Number::LowerBound),
        (5, 0.001, Number::UpperBound),
        (5, f32::INFINITY, Number::UpperBound),
    ] {
        match with_word(word, f32::to_le_bytes(value)) {
            Err(TemplateError::DepthNumber { number: named, .. }) => assert_eq!(named, number),
            other => panic!("word {word} = {value}: {other:?}"),
        }
    }
    let number = Number::Estimates;
    for word in [7, 8] {
        let error = TemplateError::DepthNumber { number, found: 0.0 };
        assert_eq!(with_word(word, [0; 4]), Err(error));
    }
    assert_eq!(with_word(6, [0; 4]), Ok(()));
}

#[test]
fn another_layout_is_malformed() {
    let section = Section::Depth;
    let malformed = Err(TemplateError::MalformedSection { section });
    // A source of labels that nobody knows.
    assert_eq!(with_word(9, 2_u32.to_le_bytes()), malformed);
    let bytes = small().encode();
    let refused = |change: fn(&mut Vec<u8>)| {
        Template::from_bytes(&with_body(&bytes, DEPTH, change)).map(drop)
    };
    assert_eq!(refused(Vec::clear), malformed);
    assert_eq!(refused(|body| body.truncate(body.len() - 1)), malformed);
    // A record of 39 and of 44 bytes, and words where no calibration is.
    for change in [
        |body: &mut Vec<u8>| {
            body[4] = 39;
            body.remove(5);
        },
        |body: &mut Vec<u8>| {
            body[4] = 44;
            body.splice(5..5, [0; 4]);
        },
        |body: &mut Vec<u8>| {
            body.drain(5..5 + CALIBRATION_LENGTH);
            body[4] = 0;
        },
    ] {
        assert_eq!(refused(change), malformed);
    }
    let trailing = TemplateError::TrailingBytes { section, found: 1 };
    assert_eq!(refused(|body| body.push(0)), Err(trailing));
    let mut sections = split(&bytes);
    sections.push(sections[4].clone());
    assert_eq!(
        Template::from_bytes(&join(&sections)),
        Err(TemplateError::DuplicateSection { section })
    );
}

#[test]
fn of_words_that_are_no_utf_8_there_is_what_comes_before() {
    let damaged = with_body(&small().encode(), DEPTH, |body| {
        body[6 + CALIBRATION_LENGTH + 3] = 0xff;
    });
    let template = Template::from_bytes(&damaged).unwrap();
    assert_eq!(template.depth().unwrap().provenance(), "lmo");
}

#[test]
fn damage_with_the_right_checksum_never_panics() {
    every_byte_at_its_extremes(&small());
    for value in SPECIAL {
        for word in 0..6 {
            let damaged = with_body(&small().encode(), DEPTH, |body| {
                body[5 + 4 * word..][..4].copy_from_slice(&value.to_le_bytes());
            });
            if load_and_use(&damaged) {
                let template = Template::from_bytes(&damaged).unwrap();
                let c = template.depth().unwrap().calibration.unwrap();
                assert!(0.0 <= c.reject && c.reject <= c.accept && c.accept <= 1.0);
            }
        }
    }
    let mut bytes = small().encode();
    let length = bytes.len();
    bytes[length - 1] = 0;
    reseal(&mut bytes);
    assert!(load_and_use(&bytes));
}
