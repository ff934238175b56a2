//! Everything that is checked before a template is used.

use super::depth::DepthRecord;
use super::error::{Section, TemplateError};
use super::number::Number;
use super::validate_components::{check_components, check_precisions, normal};
use super::validate_validity;
use super::wire::{
    self, HEADER_LENGTH, Header, NAME_CAPACITY, ObjectSection, REQUIRED, RecordsSection,
    SECTION_HEADER_LENGTH, SectionHeader, TermEncoding, TermValues, TermsSection, ValiditySection,
};
use super::{Template, Validities};
use crate::gp::Word;
use crate::kernel::{Metric, Model};
use serde::Deserialize;

pub(super) fn template(bytes: &[u8]) -> Result<Template<'_>, TemplateError> {
    let header = Header::read(bytes)?;
    let expected = header.length();
    if expected != bytes.len() {
        return Err(TemplateError::Length {
            expected,
            found: bytes.len(),
        });
    }
    let payload = bytes.get(HEADER_LENGTH..).unwrap_or(&[]);
    let checksum = wire::checksum(payload);
    if checksum != header.checksum {
        return Err(TemplateError::Checksum {
            expected: header.checksum,
            found: checksum,
        });
    }
    let bodies = Bodies::find(payload)?;
    let object: ObjectSection<'_> = decode(Section::Object, bodies.object)?;
    if object.name.len() > NAME_CAPACITY {
        return Err(TemplateError::MalformedSection {
            section: Section::Object,
        });
    }
    let model: Model = decode(Section::Model, bodies.model)?;
    let components: RecordsSection<&[u8]> = decode(Section::Components, bodies.components)?;
    let terms: TermsSection<&[u8]> = decode(Section::Terms, bodies.terms)?;
    let precisions: Option<RecordsSection<&[u8]>> = match bodies.precisions {
        Some(body) => Some(decode(Section::Precisions, body)?),
        None => None,
    };
    let validities: Option<ValiditySection<&[u8], &[u8]>> = match bodies.validity {
        Some(body) => Some(decode(Section::Validity, body)?),
        None => None,
    };
    // A map is not evaluated with it.
    if !matches!(terms.encoding, TermEncoding::Map) {
        check_model(model)?;
    }

    let components = records(Section::Components, components.stride, components.records)?;
    if components.is_empty() {
        return Err(TemplateError::NoComponents);
    }
    // Checked inside the result: a template moved into it would lie on the stack twice.
    let result = Ok(Template {
        name: object.name,
        unit: object.unit,
        centre: wire::numbers(&object.centre),
        radius: f32::from_le_bytes(object.radius),
        diameter: f32::from_le_bytes(object.diameter),
        model,
        records: components,
        precisions: match &precisions {
            Some(RecordsSection { stride, records }) => {
                Some(self::records(Section::Precisions, *stride, records)?)
            }
            None => None,
        },
        values: values(&terms, model.metric, validities.is_some())?,
        validities: match &validities {
            Some(section) => Some(Validities {
                records: records(Section::Validity, section.stride, section.records)?,
                cells: section.cells,
            }),
            None => None,
        },
        quality: bodies.quality,
        depth: bodies.depth,
    });
    if let Ok(template) = &result {
        check_object(template)?;
        check_ranges(template)?;
        check_components(template)?;
        check_precisions(template)?;
        if let Some(validities) = &template.validities {
            validate_validity::check(validities, template.component_count())?;
        }
        if let Some(body) = template.depth {
            DepthRecord::read(body)?;
        }
    }
    result
}

/// The bodies of the known sections.
struct Bodies<'a> {
    object: &'a [u8],
    model: &'a [u8],
    components: &'a [u8],
    terms: &'a [u8],
    precisions: Option<&'a [u8]>,
    validity: Option<&'a [u8]>,
    quality: Option<&'a [u8]>,
    depth: Option<&'a [u8]>,
}

impl<'a> Bodies<'a> {
    fn find(payload: &'a [u8]) -> Result<Self, TemplateError> {
        let mut object = None;
        let mut model = None;
        let mut components = None;
        let mut terms = None;
        let mut precisions = None;
        let mut validity = None;
        let mut quality = None;
        let mut depth = None;
        let mut rest = payload;
        while !rest.is_empty() {
            let offset = HEADER_LENGTH.saturating_add(payload.len().saturating_sub(rest.len()));
            let truncated = TemplateError::SectionTruncated { offset };
            let (header, behind) = rest
                .split_first_chunk::<SECTION_HEADER_LENGTH>()
                .ok_or(truncated)?;
            let header = SectionHeader::from_bytes(*header);
            let length = usize::try_from(header.length).map_err(|_| truncated)?;
            let (body, behind) = behind.split_at_checked(length).ok_or(truncated)?;
            rest = behind;
            if header.flags & !REQUIRED != 0 {
                return Err(TemplateError::SectionFlags {
                    tag: header.tag,
                    found: header.flags,
                });
            }
            let Some(section) = wire::section_of(header.tag) else {
                if header.flags & REQUIRED != 0 {
                    return Err(TemplateError::UnknownSection { tag: header.tag });
                }
                continue;
            };
            let place = match section {
                Section::Object => &mut object,
                Section::Model => &mut model,
                Section::Components => &mut components,
                Section::Terms => &mut terms,
                Section::Precisions => &mut precisions,
                Section::Validity => &mut validity,
                Section::Quality => &mut quality,
                Section::Depth => &mut depth,
            };
            if place.replace(body).is_some() {
                return Err(TemplateError::DuplicateSection { section });
            }
        }
        let found = |place: Option<&'a [u8]>, section| {
            place.ok_or(TemplateError::MissingSection { section })
        };
        Ok(Self {
            object: found(object, Section::Object)?,
            model: found(model, Section::Model)?,
            components: found(components, Section::Components)?,
            terms: found(terms, Section::Terms)?,
            precisions,
            validity,
            quality,
            depth,
        })
    }
}

pub(super) fn decode<'a, T: Deserialize<'a>>(
    section: Section,
    body: &'a [u8],
) -> Result<T, TemplateError> {
    let (value, rest) =
        postcard::take_from_bytes(body).map_err(|_| TemplateError::MalformedSection { section })?;
    if rest.is_empty() {
        Ok(value)
    } else {
        Err(TemplateError::TrailingBytes {
            section,
            found: rest.len(),
        })
    }
}

/// The records of a section, of `WORDS` words each.
fn records<const WORDS: usize>(
    section: Section,
    stride: u16,
    bytes: &[u8],
) -> Result<&[[Word; WORDS]], TemplateError> {
    let length = WORDS * size_of::<Word>();
    if usize::from(stride) != length {
        return Err(TemplateError::RecordLength {
            expected: length,
            found: usize::from(stride),
        });
    }
    let (words, odd_bytes) = bytes.as_chunks();
    let (records, odd_words) = words.as_chunks();
    if !odd_bytes.is_empty() || !odd_words.is_empty() {
        return Err(TemplateError::ArrayLength {
            section,
            element: length,
            found: bytes.len(),
        });
    }
    Ok(records)
}

fn values<'a>(
    section: &TermsSection<&'a [u8]>,
    metric: Metric,
    validity: bool,
) -> Result<TermValues<'a>, TemplateError> {
    match (section.encoding, metric) {
        (TermEncoding::Map, _) if !validity => return Err(TemplateError::MapValidity),
        (TermEncoding::Map, _) => return Ok(TermValues::Map(section.values)),
        (TermEncoding::Compact, Metric::Angles) => return Err(TemplateError::CompactAngles),
        (TermEncoding::Compact, Metric::Chord) => return Ok(TermValues::Compact(section.values)),
        (TermEncoding::Float32, _) => {}
    }
    let (words, odd_bytes) = section.values.as_chunks::<4>();
    let (quads, odd_words) = words.as_chunks();
    if !odd_bytes.is_empty() || !odd_words.is_empty() {
        return Err(TemplateError::ArrayLength {
            section: Section::Terms,
            element: 16,
            found: section.values.len(),
        });
    }
    Ok(TermValues::Exact(quads))
}

fn check_model(model: Model) -> Result<(), TemplateError> {
    let Model { metric, kernel } = model;
    if !kernel.is_compiled_in() {
        return Err(TemplateError::KernelLeftOut { kernel });
    }
    if !metric.is_compiled_in() {
        return Err(TemplateError::MetricLeftOut { metric });
    }
    Ok(())
}

fn check_object(template: &Template<'_>) -> Result<(), TemplateError> {
    let [x, y, z] = template.centre;
    for (number, found) in [
        (Number::CentreX, x),
        (Number::CentreY, y),
        (Number::CentreZ, z),
        (Number::Radius, template.radius),
        (Number::Diameter, template.diameter),
    ] {
        let holds = match number {
            Number::Radius | Number::Diameter => normal(found),
            _ => found.is_finite(),
        };
        if !holds {
            return Err(TemplateError::ObjectNumber { number, found });
        }
    }
    Ok(())
}

fn check_ranges(template: &Template<'_>) -> Result<(), TemplateError> {
    let mut next = 0_u32;
    for (component, record) in template.records.iter().enumerate() {
        let (first, count) = wire::term_range(record);
        if count == 0 {
            return Err(TemplateError::NoTerms { component });
        }
        if first != next || template.values.of(record).is_none() {
            return Err(TemplateError::TermRange { component });
        }
        next = template.values.behind(record);
    }
    let expected = usize::try_from(next).unwrap_or(usize::MAX);
    let found = template.values.end();
    if expected != found {
        return Err(TemplateError::UnusedTerms { expected, found });
    }
    Ok(())
}
