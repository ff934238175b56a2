//! Writes a template into a caller's buffer.
//!
//! Here and not in the trainer, because the format exists once. What was written is read back and
//! validated, so that no file is made that a controller would refuse.

use super::Template;
use super::encode_depth;
use super::encode_error::EncodeError;
use super::encode_validity::{self, Cells};
use super::error::Section;
use super::source::{self, ComponentSource, TemplateSource, TermsSource};
use super::validate;
use super::wire::{
    self, HEADER_LENGTH, Header, ObjectSection, PRECISION_LENGTH, QualitySection, RECORD_LENGTH,
    RecordsSection, SECTION_HEADER_LENGTH, SectionHeader, TermEncoding, TermsSection,
    VALIDITY_LENGTH, ValiditySection,
};
use crate::gp::Word;
use crate::gp::compact::TERM_LENGTH;
use crate::gp::map;
use serde::ser::SerializeSeq;
use serde::{Serialize, Serializer};

/// An upper bound of the bytes that [`encode`] writes, tight to a few dozen.
#[must_use]
pub fn encoded_len(source: &TemplateSource<'_>) -> usize {
    // A varint has at most 5 bytes, an enum 1 to 2; the object section holds 5 floats, the quality
    // section 3.
    let sections =
        7 * SECTION_HEADER_LENGTH + (6 + source.name.len() + 2 + 5 * 4) + (6 + 8 + 7 + 8 + 13 + 17);
    let components = source.components.iter().map(|component| {
        RECORD_LENGTH
            .saturating_add(PRECISION_LENGTH)
            .saturating_add(run_length(&component.terms))
            .saturating_add(component.validity.map_or(0, |validity| {
                VALIDITY_LENGTH.saturating_add(encode_validity::run_length(validity))
            }))
    });
    let unexplained = source
        .quality
        .map_or(0, |quality| quality.unexplained.len());
    components
        .fold(HEADER_LENGTH, usize::saturating_add)
        .saturating_add(sections)
        .saturating_add(unexplained.saturating_mul(2))
        .saturating_add(encode_depth::length(source.depth.as_ref()))
}

/// The bytes of a component's terms.
fn run_length(terms: &TermsSource<'_>) -> usize {
    let (_, count) = terms.lengths();
    match terms {
        TermsSource::Exact { .. } => count.saturating_mul(16),
        TermsSource::Compact { .. } => count
            .saturating_mul(TERM_LENGTH)
            .saturating_add(size_of::<Word>()),
        TermsSource::Map { nodes, .. } => nodes.len().saturating_add(map::HEADER_LENGTH),
    }
}

/// Writes a template to the start of `out` and returns its length.
///
/// # Errors
/// [`EncodeError`]: a name that is too long, unequal numbers of directions and weights, components
/// that differ in what they have, a grid of the wrong size, a provenance that is too long, a buffer
/// that is too small, or content that [`super::Template::from_bytes`] would refuse.
pub fn encode(source: &TemplateSource<'_>, out: &mut [u8]) -> Result<usize, EncodeError> {
    source::check(source)?;
    let first = source.components.first();
    let mut used = HEADER_LENGTH;
    section(
        out,
        &mut used,
        Section::Object,
        &ObjectSection {
            name: source.name.as_bytes(),
            unit: source.unit,
            centre: source.centre.map(f32::to_le_bytes),
            radius: source.radius.to_le_bytes(),
            diameter: source.diameter.to_le_bytes(),
        },
    )?;
    section(out, &mut used, Section::Model, &source.model)?;
    section(
        out,
        &mut used,
        Section::Components,
        &RecordsSection {
            stride: RECORD_LENGTH as u16,
            records: Records(source.components),
        },
    )?;
    section(
        out,
        &mut used,
        Section::Terms,
        &TermsSection {
            encoding: first.map_or(TermEncoding::Float32, |component| {
                component.terms.encoding()
            }),
            values: Values(source),
        },
    )?;
    if first.is_some_and(|component| component.precision.is_some()) {
        section(
            out,
            &mut used,
            Section::Precisions,
            &RecordsSection {
                stride: PRECISION_LENGTH as u16,
                records: Factors(source.components),
            },
        )?;
    }
    if first.is_some_and(|component| component.validity.is_some()) {
        section(
            out,
            &mut used,
            Section::Validity,
            &ValiditySection {
                stride: VALIDITY_LENGTH as u16,
                records: encode_validity::Records(source.components),
                cells: Cells(source.components),
            },
        )?;
    }
    if let Some(quality) = source.quality {
        section(
            out,
            &mut used,
            Section::Quality,
            &QualitySection {
                covered: quality.covered,
                deviation_max: quality.deviation_max,
                deviation_rms: quality.deviation_rms,
                unexplained: Shares(quality.unexplained),
            },
        )?;
    }
    if let Some(depth) = &source.depth {
        encode_depth::write(depth, out, &mut used)?;
    }
    let template = seal(out, used)?;
    if source.quality.is_some() && template.quality().is_none() {
        return Err(EncodeError::Quality);
    }
    Ok(used)
}

/// Writes the header before the sections that end at `used`, and reads all of it back.
pub(super) fn seal(out: &mut [u8], used: usize) -> Result<Template<'_>, EncodeError> {
    let buffer = EncodeError::Buffer { found: out.len() };
    let written = out.get_mut(..used).ok_or(buffer)?;
    let (header, payload) = written
        .split_first_chunk_mut::<HEADER_LENGTH>()
        .ok_or(buffer)?;
    *header = Header {
        length: u32::try_from(used).map_err(|_| EncodeError::TooLarge)?,
        checksum: wire::checksum(payload),
    }
    .to_bytes();
    validate::template(written).map_err(EncodeError::Invalid)
}

/// Appends a section behind what is used of the buffer.
pub(super) fn section<T: Serialize>(
    out: &mut [u8],
    used: &mut usize,
    section: Section,
    body: &T,
) -> Result<(), EncodeError> {
    let buffer = EncodeError::Buffer { found: out.len() };
    let (header, rest) = out
        .get_mut(*used..)
        .and_then(|rest| rest.split_first_chunk_mut::<SECTION_HEADER_LENGTH>())
        .ok_or(buffer)?;
    let length = postcard::to_slice(body, rest).map_err(|_| buffer)?.len();
    *header = SectionHeader {
        tag: wire::tag(section),
        flags: wire::flags(section),
        length: u32::try_from(length).map_err(|_| EncodeError::TooLarge)?,
    }
    .to_bytes();
    *used = used
        .saturating_add(SECTION_HEADER_LENGTH)
        .saturating_add(length);
    Ok(())
}

/// Bytes, as many as said. In postcard a sequence of bytes and a byte array are the same, so the
/// reader borrows what is written here element by element.
pub(super) fn byte_array<S: Serializer>(
    serializer: S,
    length: usize,
    bytes: impl Iterator<Item = u8>,
) -> Result<S::Ok, S::Error> {
    let mut sequence = serializer.serialize_seq(Some(length))?;
    for byte in bytes {
        sequence.serialize_element(&byte)?;
    }
    sequence.end()
}

/// The components' records.
struct Records<'a>(&'a [ComponentSource<'a>]);

impl Serialize for Records<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut next = 0_u32;
        let records = self.0.iter().flat_map(|component| {
            let [x, y, z] = component.centre;
            let h = &component.hyperparameters;
            let (_, count) = component.terms.lengths();
            let taken = match component.terms {
                TermsSource::Exact { .. } => count,
                TermsSource::Compact { .. } | TermsSource::Map { .. } => {
                    run_length(&component.terms)
                }
            };
            let narrow = |number| u32::try_from(number).unwrap_or(u32::MAX);
            let first = next;
            next = next.saturating_add(narrow(taken));
            let numbers = [
                x,
                y,
                z,
                component.sigma_hat,
                h.length_scale,
                h.parameter,
                h.prior_mean,
            ];
            numbers
                .into_iter()
                .map(f32::to_le_bytes)
                .chain([first.to_le_bytes(), narrow(count).to_le_bytes()])
                .flatten()
        });
        byte_array(
            serializer,
            self.0.len().saturating_mul(RECORD_LENGTH),
            records,
        )
    }
}

/// The components' directions and weights.
struct Values<'a>(&'a TemplateSource<'a>);

impl Serialize for Values<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self(source) = self;
        let lengths = source.components.iter().map(|c| run_length(&c.terms));
        let mut sequence =
            serializer.serialize_seq(Some(lengths.fold(0, usize::saturating_add)))?;
        let metric = source.model.metric;
        for component in source.components {
            match component.terms {
                TermsSource::Exact {
                    directions,
                    weights,
                } => {
                    // A metric that this build leaves out is refused when the bytes are read back.
                    let directions = directions.iter().map(|u| {
                        let unit_vector = [u.x, u.y, u.z];
                        metric.coordinates(unit_vector).unwrap_or(unit_vector)
                    });
                    let xs = directions.clone().map(|[x, _, _]| x);
                    let ys = directions.clone().map(|[_, y, _]| y);
                    let zs = directions.map(|[_, _, z]| z);
                    for byte in xs
                        .chain(ys)
                        .chain(zs)
                        .chain(weights.iter().copied())
                        .flat_map(f32::to_le_bytes)
                    {
                        sequence.serialize_element(&byte)?;
                    }
                }
                TermsSource::Compact {
                    directions,
                    weights,
                    scale,
                } => {
                    let xs = directions.iter().map(|[x, _, _]| *x as u8);
                    let ys = directions.iter().map(|[_, y, _]| *y as u8);
                    let zs = directions.iter().map(|[_, _, z]| *z as u8);
                    let weights = weights.iter().flat_map(|weight| weight.to_le_bytes());
                    let scale = scale.to_le_bytes().into_iter();
                    for byte in scale.chain(xs).chain(ys).chain(zs).chain(weights) {
                        sequence.serialize_element(&byte)?;
                    }
                }
                TermsSource::Map {
                    pole,
                    size: [columns, rows],
                    spacing,
                    origin: [x, y],
                    scale,
                    nodes,
                } => {
                    let numbers = [scale, spacing, x, y].map(f32::to_le_bytes);
                    let numbers = numbers.into_iter().flatten();
                    let header = numbers.chain([columns, rows, pole as u8, 0]);
                    for byte in header.chain(nodes.iter().map(|node| *node as u8)) {
                        sequence.serialize_element(&byte)?;
                    }
                }
            }
        }
        sequence.end()
    }
}

/// The components' precisions.
struct Factors<'a>(&'a [ComponentSource<'a>]);

impl Serialize for Factors<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let length = self.0.len().saturating_mul(PRECISION_LENGTH);
        let factors = self.0.iter().filter_map(|c| c.precision);
        let bytes = factors.flat_map(|precision| precision.factor().map(f32::to_le_bytes));
        byte_array(serializer, length, bytes.flatten())
    }
}

/// Shares of 1 in steps of 1/65535.
struct Shares<'a>(&'a [f32]);

impl Serialize for Shares<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        // Rust's conversion rounds down, and clamps what leaves the range.
        let steps = |share: &f32| (share * f32::from(u16::MAX) + 0.5) as u16;
        let bytes = self.0.iter().flat_map(|share| steps(share).to_le_bytes());
        byte_array(serializer, self.0.len().saturating_mul(2), bytes)
    }
}
