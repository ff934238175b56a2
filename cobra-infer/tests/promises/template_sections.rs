//! The header and the sections: what a reader skips, and what it refuses with which words.
//!
//! Every file here has the right length and checksum unless the test is about them.

use crate::content::Content;
use crate::sections::{
    COMPONENTS, MODEL, OBJECT, REQUIRED, Raw, TERMS, join, reseal, split, with_body,
};
use cobra_infer::{Section, Template, TemplateError};

fn refused(bytes: &[u8]) -> TemplateError {
    Template::from_bytes(bytes).unwrap_err()
}

const SECTIONS: [(u16, Section); 4] = [
    (OBJECT, Section::Object),
    (MODEL, Section::Model),
    (COMPONENTS, Section::Components),
    (TERMS, Section::Terms),
];

#[test]
fn splitting_and_joining_changes_nothing() {
    let bytes = Content::small().encode();
    assert_eq!(join(&split(&bytes)), bytes);
}

#[test]
fn another_magic_version_or_reserved_value_is_refused_in_that_order() {
    let mut bytes = Content::small().encode();
    bytes[6] = 2;
    let error = refused(&bytes);
    assert_eq!(error, TemplateError::Reserved { found: 2 });
    assert!(error.to_string().contains("0x0002"), "{error}");
    bytes[4] = 9;
    let error = refused(&bytes);
    let expected = TemplateError::Version {
        supported: 1,
        found: 9,
    };
    assert_eq!(error, expected);
    assert!(error.to_string().contains("version 9"), "{error}");
    bytes[0] = b'X';
    let error = refused(&bytes);
    assert_eq!(error, TemplateError::Magic { found: *b"XBRA" });
    assert!(error.to_string().contains("58 42 52 41"), "{error}");
}

#[test]
fn a_length_that_is_wrong_says_truncated_or_too_many() {
    let bytes = Content::small().encode();
    let error = refused(&bytes[..bytes.len() - 3]);
    assert!(error.to_string().contains("truncated"), "{error}");
    let error = refused(&[&bytes[..], b"abc"].concat());
    assert!(error.to_string().contains("3 too many"), "{error}");
}

#[test]
fn damage_is_called_damage() {
    let mut bytes = Content::small().encode();
    bytes[40] ^= 0x10;
    assert!(refused(&bytes).to_string().contains("damaged"));
}

#[test]
fn an_unknown_optional_section_is_skipped_wherever_it_stands() {
    let bytes = Content::small().encode();
    let template = Template::from_bytes(&bytes).unwrap();
    for place in 0..=4 {
        for body in [vec![], vec![0xff; 77]] {
            let mut sections = split(&bytes);
            let section = Raw {
                tag: 900,
                flags: 0,
                body,
            };
            sections.insert(place, section);
            let extended = join(&sections);
            assert_eq!(Template::from_bytes(&extended).as_ref(), Ok(&template));
        }
    }
}

#[test]
fn an_unknown_required_section_is_refused() {
    let mut sections = split(&Content::small().encode());
    sections.push(Raw {
        tag: 900,
        flags: REQUIRED,
        body: vec![],
    });
    let error = refused(&join(&sections));
    assert_eq!(error, TemplateError::UnknownSection { tag: 900 });
}

#[test]
fn every_flag_bit_that_has_no_meaning_is_refused() {
    let bytes = Content::small().encode();
    for bit in 1..16 {
        for (place, (tag, _)) in SECTIONS.into_iter().enumerate() {
            let mut sections = split(&bytes);
            let found = REQUIRED | 1 << bit;
            sections[place].flags = found;
            let error = refused(&join(&sections));
            assert_eq!(error, TemplateError::SectionFlags { tag, found });
        }
        let mut sections = split(&bytes);
        sections.push(Raw {
            tag: 900,
            flags: 1 << bit,
            body: vec![],
        });
        assert!(matches!(
            refused(&join(&sections)),
            TemplateError::SectionFlags { tag: 900, .. }
        ));
    }
}

#[test]
fn a_section_twice_or_not_at_all_is_refused_by_name() {
    let bytes = Content::small().encode();
    for (place, (_, section)) in SECTIONS.into_iter().enumerate() {
        let mut twice = split(&bytes);
        twice.push(twice[place].clone());
        let error = refused(&join(&twice));
        assert_eq!(error, TemplateError::DuplicateSection { section });
        let mut missing = split(&bytes);
        missing.remove(place);
        let error = refused(&join(&missing));
        assert_eq!(error, TemplateError::MissingSection { section });
        assert!(error.to_string().contains(section.name()), "{error}");
    }
}

#[test]
fn sections_may_stand_in_any_order() {
    let bytes = Content::small().encode();
    let mut sections = split(&bytes);
    sections.reverse();
    let reversed = join(&sections);
    assert_eq!(
        Template::from_bytes(&reversed),
        Template::from_bytes(&bytes)
    );
}

#[test]
fn bytes_behind_a_sections_content_are_refused() {
    let bytes = Content::small().encode();
    for (tag, section) in SECTIONS {
        let longer = with_body(&bytes, tag, |body| body.extend([0, 0]));
        let error = refused(&longer);
        assert_eq!(error, TemplateError::TrailingBytes { section, found: 2 });
    }
}

#[test]
fn a_section_that_ends_early_is_malformed() {
    let bytes = Content::small().encode();
    for (tag, section) in SECTIONS {
        let shorter = with_body(&bytes, tag, |body| {
            body.pop();
        });
        assert_eq!(
            refused(&shorter),
            TemplateError::MalformedSection { section }
        );
        let empty = with_body(&bytes, tag, Vec::clear);
        assert_eq!(refused(&empty), TemplateError::MalformedSection { section });
    }
}

#[test]
fn a_section_that_reaches_past_the_end_is_refused_by_its_offset() {
    let bytes = Content::small().encode();
    // The last section's header follows the three before it.
    let offset = 16
        + split(&bytes)[..3]
            .iter()
            .map(|s| 8 + s.body.len())
            .sum::<usize>();
    for length in [
        u32::MAX,
        u32::MAX - 7,
        1 << 31,
        (bytes.len() - offset - 7) as u32,
    ] {
        let mut damaged = bytes.clone();
        damaged[offset + 4..offset + 8].copy_from_slice(&length.to_le_bytes());
        reseal(&mut damaged);
        assert_eq!(
            refused(&damaged),
            TemplateError::SectionTruncated { offset },
            "length {length}"
        );
    }
}

#[test]
fn a_section_header_that_is_cut_is_refused() {
    let bytes = Content::small().encode();
    for extra in 1..8 {
        let mut longer = bytes.clone();
        longer.resize(bytes.len() + extra, 0);
        reseal(&mut longer);
        let offset = bytes.len();
        assert_eq!(refused(&longer), TemplateError::SectionTruncated { offset });
    }
}

#[test]
fn values_that_no_version_1_writer_writes_are_malformed() {
    let bytes = Content::small().encode();
    let object = Section::Object;
    let model = Section::Model;
    let terms = Section::Terms;
    let unit = 1 + "nut".len();
    type Change = fn(&mut Vec<u8>, usize);
    let cases: [(u16, Section, usize, Change); 6] = [
        (OBJECT, object, 0, |body, at| body[at] = 33),
        (OBJECT, object, unit, |body, at| body[at] = 4),
        (MODEL, model, 0, |body, at| body[at] = 2),
        (MODEL, model, 1, |body, at| body[at] = 6),
        (MODEL, model, 2, |body, at| body[at] = 3),
        (TERMS, terms, 0, |body, at| body[at] = 3),
    ];
    for (tag, section, at, change) in cases {
        let damaged = with_body(&bytes, tag, |body| change(body, at));
        assert_eq!(
            refused(&damaged),
            TemplateError::MalformedSection { section },
            "byte {at} of section {tag}"
        );
    }
}

#[test]
fn of_a_name_that_is_no_utf_8_there_is_what_comes_before() {
    let bytes = Content::small().encode();
    for (at, expected) in [(1, ""), (2, "n"), (3, "nu")] {
        let damaged = with_body(&bytes, OBJECT, |body| body[at] = 0xff);
        assert_eq!(Template::from_bytes(&damaged).unwrap().name(), expected);
    }
}

#[test]
fn a_name_of_33_bytes_is_malformed_though_all_of_it_is_there() {
    let bytes = Content::small().encode();
    let longer = with_body(&bytes, OBJECT, |body| {
        body.splice(..4, [33].into_iter().chain([b'x'; 33]));
    });
    let section = Section::Object;
    assert_eq!(
        refused(&longer),
        TemplateError::MalformedSection { section }
    );
}

#[test]
fn another_stride_is_refused() {
    let bytes = Content::small().encode();
    for stride in [0, 1, 35, 37, 72] {
        let other = with_body(&bytes, COMPONENTS, |body| body[0] = stride);
        let expected = TemplateError::RecordLength {
            expected: 36,
            found: usize::from(stride),
        };
        assert_eq!(refused(&other), expected);
    }
}

#[test]
fn arrays_that_hold_no_whole_number_of_elements_are_refused() {
    let bytes = Content::small().encode();
    for less in [1_u8, 2, 4, 35] {
        let odd = with_body(&bytes, COMPONENTS, |body| {
            body[1] -= less;
            body.truncate(body.len() - usize::from(less));
        });
        let expected = TemplateError::ArrayLength {
            section: Section::Components,
            element: 36,
            found: 72 - usize::from(less),
        };
        assert_eq!(refused(&odd), expected);
    }
    for less in [1_u8, 4, 8, 12, 15] {
        let odd = with_body(&bytes, TERMS, |body| {
            body[1] -= less;
            body.truncate(body.len() - usize::from(less));
        });
        let expected = TemplateError::ArrayLength {
            section: Section::Terms,
            element: 16,
            found: 80 - usize::from(less),
        };
        assert_eq!(refused(&odd), expected);
    }
}

#[test]
fn a_template_without_components_is_refused() {
    let bytes = Content::small().encode();
    let none = with_body(&bytes, COMPONENTS, |body| {
        body.truncate(1);
        body.push(0);
    });
    assert_eq!(refused(&none), TemplateError::NoComponents);
}
