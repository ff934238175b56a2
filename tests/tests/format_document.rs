//! `docs/FORMAT.md` says what the code does: its example is the encoder's output, its table says
//! where things lie in it, and its constants are the code's.

use cobra_infer::gp::compact::GRID;
use cobra_infer::gp::{Hyperparameters, UnitDirection};
use cobra_infer::template::{
    CALIBRATION_LENGTH, ComponentSource, HEADER_LENGTH, MAGIC, NAME_CAPACITY, PRECISION_LENGTH,
    PROVENANCE_CAPACITY, RECORD_LENGTH, TemplateSource, TermsSource, VALIDITY_LENGTH, VERSION,
    encode, encoded_len, peek_len,
};
use cobra_infer::validity::{BOX_STEPS, LARGEST_SIDE, Pole};
use cobra_infer::{Exponent, Kernel, Model, Template, Unit, tolerance};
use nalgebra::Vector3;

const PAGE: &str = include_str!("../../docs/FORMAT.md");

fn example() -> Vec<u8> {
    let directions =
        [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0]].map(|u| UnitDirection::new_unchecked(Vector3::from(u)));
    let component = ComponentSource {
        centre: [0.0, 0.0, -2.0],
        sigma_hat: 0.125,
        precision: None,
        hyperparameters: Hyperparameters {
            length_scale: 0.5,
            parameter: 1.0,
            prior_mean: 10.0,
        },
        terms: TermsSource::Exact {
            directions: &directions,
            weights: &[0.25, -0.5],
        },
        validity: None,
    };
    let source = TemplateSource {
        name: "nut",
        unit: Unit::Millimetre,
        centre: [0.0; 3],
        radius: 12.0,
        diameter: 24.0,
        model: Model::chord(Kernel::RationalQuadratic(Exponent::One)),
        components: &[component],
        quality: None,
        depth: None,
    };
    let mut bytes = vec![0; encoded_len(&source)];
    let length = encode(&source, &mut bytes).unwrap();
    bytes.truncate(length);
    bytes
}

/// Sixteen bytes a line behind their offset.
fn hexdump(bytes: &[u8]) -> String {
    let line = |(index, chunk): (usize, &[u8])| {
        let digits: String = chunk.iter().map(|byte| format!(" {byte:02x}")).collect();
        format!("{:02x} {digits}\n", 16 * index)
    };
    bytes.chunks(16).enumerate().map(line).collect()
}

fn documented_dump() -> &'static str {
    let start = PAGE.find("```hexdump\n").expect("a hexdump") + "```hexdump\n".len();
    let length = PAGE[start..].find("```").expect("the hexdump's end");
    &PAGE[start..start + length]
}

/// The first and last byte of every row of the example's table, with the row's text.
fn documented_ranges() -> Vec<(usize, usize, &'static str)> {
    PAGE.lines()
        .filter_map(|line| {
            let (range, text) = line.strip_prefix("| ")?.split_once(" | ")?;
            let (first, last) = range.split_once('–')?;
            let offset = |digits| usize::from_str_radix(digits, 16).ok();
            Some((offset(first)?, offset(last)?, text))
        })
        .collect()
}

#[test]
fn the_documented_example_is_what_the_encoder_writes() {
    let expected = hexdump(&example());
    assert_eq!(
        documented_dump(),
        expected,
        "the page must show\n{expected}"
    );
}

#[test]
fn the_documented_example_loads() {
    let bytes: Vec<u8> = documented_dump()
        .lines()
        .flat_map(|line| line.split_ascii_whitespace().skip(1))
        .map(|digits| u8::from_str_radix(digits, 16).unwrap())
        .collect();
    let template = Template::from_bytes(&bytes).unwrap();
    assert_eq!((template.name(), template.radius()), ("nut", 12.0));
    let component = template.components().next().unwrap();
    let terms: Vec<_> = component.terms.iter().collect();
    assert_eq!(terms, [([1., 0., 0.], 0.25), ([0., 0., -1.], -0.5)]);
}

#[test]
fn the_documented_ranges_cover_the_example_without_a_gap() {
    let bytes = example();
    let ranges = documented_ranges();
    let mut next = 0;
    for (first, last, text) in &ranges {
        assert_eq!(*first, next, "{text}");
        next = last + 1;
    }
    assert_eq!(next, bytes.len());
    for pair in ranges[1..].chunks_exact(2) {
        let [(header, end, text), (body, last, _)] = [pair[0], pair[1]];
        assert_eq!(end - header + 1, 8);
        let words = |at: usize| u16::from_le_bytes([bytes[at], bytes[at + 1]]);
        let length = last - body + 1;
        assert_eq!(usize::from(words(header + 4)), length);
        let expected = format!("section {}, required, {length} bytes", words(header));
        assert_eq!(text.trim_end_matches([' ', '|']), expected);
        assert_eq!(words(header + 2), 1);
    }
}

#[test]
fn the_documented_constants_are_the_codes() {
    let magic: String = MAGIC.iter().map(|byte| format!("{byte:02x} ")).collect();
    for phrase in [
        format!("# The template format, version {VERSION}\n"),
        format!("magic: `{}`, \"CBRA\"", magic.trim_end()),
        format!("version, `u16`: {VERSION} |"),
        format!("## Header\n\n{HEADER_LENGTH} bytes."),
        format!("A record is {RECORD_LENGTH} bytes."),
        format!("bytes in a record: {RECORD_LENGTH} |"),
        format!("bytes in a factor: {PRECISION_LENGTH} |"),
        format!("bytes in a validity: {VALIDITY_LENGTH} |"),
        format!("A validity is {VALIDITY_LENGTH} bytes."),
        format!(
            "high: the largest position along x, y, z, at most {} |",
            BOX_STEPS - 1
        ),
        format!("1 to {}: it has (4B)² cells", LARGEST_SIDE / 4),
        format!("in grid steps of 1/{GRID}, from −{GRID} to {GRID};"),
        format!("| name | {NAME_CAPACITY} bytes |"),
        format!("string, at most {NAME_CAPACITY} bytes"),
        format!("A calibration is {CALIBRATION_LENGTH} bytes."),
        format!("byte array | empty, or {CALIBRATION_LENGTH} bytes |"),
        format!("string, at most {PROVENANCE_CAPACITY} bytes"),
        format!("| provenance of a calibration | {PROVENANCE_CAPACITY} bytes |"),
        format!("|‖uᵢ‖² − 1| ≤ {:e},", tolerance::UNIT_DIRECTION),
        format!("length {}, checksum", peek_len(&example()).unwrap()),
    ] {
        assert!(PAGE.contains(&phrase), "the page must say {phrase:?}");
    }
    for (index, unit) in Unit::ALL.into_iter().enumerate() {
        let name = format!("{index} {unit:?}").to_lowercase();
        assert!(PAGE.contains(&name), "{name}");
    }
    for (index, pole) in Pole::ALL.into_iter().enumerate() {
        let axis = format!("{pole:?}")
            .replace("Plus", "+")
            .replace("Minus", "−");
        let name = format!("{index} {}", axis.to_lowercase());
        assert!(PAGE.contains(&name), "{name}");
    }
}
