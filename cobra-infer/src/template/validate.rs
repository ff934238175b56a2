//! Everything that is checked before a template is used.

use super::Template;
use super::wire::{
    self, ComponentsSection, HEADER_LENGTH, Header, ModelSection, ObjectSection, RECORD_LENGTH,
    REQUIRED, Record, SECTION_HEADER_LENGTH, SectionHeader, TermsSection,
};
use crate::error::{Section, TemplateError};
use crate::gp::Word;
use crate::kernel::Kernel;
use crate::math;
use crate::tolerance;
use serde::Deserialize;

pub(super) fn template(bytes: &[u8]) -> Result<Template<'_>, TemplateError> {
    let header = Header::read(bytes)?;
    let expected = wire::peek_len(bytes)?;
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
    let object: ObjectSection = decode(Section::Object, bodies.object)?;
    let model: ModelSection = decode(Section::Model, bodies.model)?;
    let components: ComponentsSection<&[u8]> = decode(Section::Components, bodies.components)?;
    let terms: TermsSection<&[u8]> = decode(Section::Terms, bodies.terms)?;

    let template = Template {
        name: object.name,
        unit: object.unit,
        centre: object.centre,
        radius: object.radius,
        diameter: object.diameter,
        metric: model.metric,
        kernel: model.kernel,
        records: records(&components)?,
        words: words(&terms)?,
    };
    check_object(&template)?;
    check_ranges(&template)?;
    check_components(&template)?;
    Ok(template)
}

/// The bodies of the known sections.
struct Bodies<'a> {
    object: &'a [u8],
    model: &'a [u8],
    components: &'a [u8],
    terms: &'a [u8],
}

impl<'a> Bodies<'a> {
    fn find(payload: &'a [u8]) -> Result<Self, TemplateError> {
        let mut object = None;
        let mut model = None;
        let mut components = None;
        let mut terms = None;
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
        })
    }
}

fn decode<'a, T: Deserialize<'a>>(section: Section, body: &'a [u8]) -> Result<T, TemplateError> {
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

fn records<'a>(section: &ComponentsSection<&'a [u8]>) -> Result<&'a [Record], TemplateError> {
    if usize::from(section.stride) != RECORD_LENGTH {
        return Err(TemplateError::RecordLength {
            expected: RECORD_LENGTH,
            found: usize::from(section.stride),
        });
    }
    let (words, odd_bytes) = section.records.as_chunks();
    let (records, odd_words) = words.as_chunks();
    if !odd_bytes.is_empty() || !odd_words.is_empty() {
        return Err(TemplateError::ArrayLength {
            section: Section::Components,
            element: RECORD_LENGTH,
            found: section.records.len(),
        });
    }
    if records.is_empty() {
        return Err(TemplateError::NoComponents);
    }
    Ok(records)
}

fn words<'a>(section: &TermsSection<&'a [u8]>) -> Result<&'a [Word], TemplateError> {
    let wire::TermEncoding::Float32 = section.encoding;
    let (words, odd) = section.values.as_chunks();
    if !odd.is_empty() || !words.len().is_multiple_of(4) {
        return Err(TemplateError::ArrayLength {
            section: Section::Terms,
            element: 16,
            found: section.values.len(),
        });
    }
    Ok(words)
}

fn check_object(template: &Template<'_>) -> Result<(), TemplateError> {
    let [x, y, z] = template.centre;
    for (field, found) in [("centre x", x), ("centre y", y), ("centre z", z)] {
        if !found.is_finite() {
            return Err(TemplateError::ObjectNumber { field, found });
        }
    }
    for (field, found) in [("radius", template.radius), ("diameter", template.diameter)] {
        if !positive(found) {
            return Err(TemplateError::ObjectNumber { field, found });
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
        if first != next || wire::term_words(record, template.words).is_none() {
            return Err(TemplateError::TermRange { component });
        }
        next = first.saturating_add(count);
    }
    let expected = usize::try_from(next).unwrap_or(usize::MAX);
    if expected != template.term_count() {
        return Err(TemplateError::UnusedTerms {
            expected,
            found: template.term_count(),
        });
    }
    Ok(())
}

fn check_components(template: &Template<'_>) -> Result<(), TemplateError> {
    for (index, component) in template.components().enumerate() {
        let number = |field, expected, found, holds: bool| {
            if holds {
                Ok(())
            } else {
                Err(TemplateError::ComponentNumber {
                    component: index,
                    field,
                    expected,
                    found,
                })
            }
        };
        for found in component.centre {
            number("the centre", "finite", found, found.is_finite())?;
        }
        let sigma_hat = component.sigma_hat;
        let normal = "positive, finite and no subnormal";
        number("sigma-hat", normal, sigma_hat, positive(sigma_hat))?;
        let h = &component.hyperparameters;
        let l = h.length_scale;
        // The kernel sees only the square, which would hide a sign.
        let square = "positive, with a square that is finite and no subnormal";
        number("the length scale", square, l, l > 0.0 && positive(l * l))?;
        let Kernel::RationalQuadratic(exponent) = template.kernel;
        match exponent.fixed() {
            Some(fixed) => number(
                "the exponent",
                "what the kernel fixes",
                h.exponent,
                h.exponent == fixed,
            )?,
            None => number(
                "the exponent",
                "positive, and 2*exponent*(length scale)^2 finite and no subnormal",
                h.exponent,
                positive(2.0 * h.exponent * l * l),
            )?,
        }
        let m = h.prior_mean;
        number("the prior mean", "finite", m, m.is_finite())?;
        for (term, (direction, weight)) in component.terms.iter().enumerate() {
            if !weight.is_finite() {
                return Err(TemplateError::Weight {
                    component: index,
                    term,
                });
            }
            let squared_norm = math::dot(direction, direction);
            let unit = math::abs(squared_norm - 1.0) <= tolerance::UNIT_DIRECTION;
            if !unit {
                return Err(TemplateError::Direction {
                    component: index,
                    term,
                    squared_norm,
                });
            }
        }
    }
    Ok(())
}

/// Finite, positive, and with a finite inverse.
fn positive(value: f32) -> bool {
    value.is_finite() && value >= f32::MIN_POSITIVE
}
