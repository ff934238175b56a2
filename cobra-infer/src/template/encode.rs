//! Writes a template into a caller's buffer.
//!
//! Here and not in the trainer, because the format exists once. What was written is read back and
//! validated, so that no file is made that a controller would refuse.

use super::encode_error::EncodeError;
use super::error::Section;
use super::wire::{
    self, HEADER_LENGTH, Header, NAME_CAPACITY, ObjectSection, PRECISION_LENGTH, RECORD_LENGTH,
    REQUIRED, RecordsSection, SECTION_HEADER_LENGTH, SectionHeader, TermEncoding, TermsSection,
};
use super::{Precision, validate};
use crate::gp::{Hyperparameters, UnitDirection};
use crate::kernel::Model;
use crate::unit::Unit;
use serde::ser::SerializeSeq;
use serde::{Serialize, Serializer};

/// The content of a template, borrowed from whoever trained it.
#[derive(Clone, Copy, Debug)]
pub struct TemplateSource<'a> {
    /// The object's name, at most [`NAME_CAPACITY`] bytes.
    pub name: &'a str,
    /// The unit of every length.
    pub unit: Unit,
    /// Centre of the bounding sphere.
    pub centre: [f32; 3],
    /// Radius of the bounding sphere.
    pub radius: f32,
    /// Largest distance between two points of the object.
    pub diameter: f32,
    /// Metric and covariance function.
    pub model: Model,
    /// The components, in the order in which the scorer visits them.
    pub components: &'a [ComponentSource<'a>],
}

/// The content of one component.
#[derive(Clone, Copy, Debug)]
pub struct ComponentSource<'a> {
    /// C_k.
    pub centre: [f32; 3],
    /// σ̂_k.
    pub sigma_hat: f32,
    /// Q_k, in 1/unit²: of all components or, for the identity in the unit sphere, of none.
    pub precision: Option<Precision>,
    /// The hyperparameters that the mean needs.
    pub hyperparameters: Hyperparameters,
    /// The directions, as many as weights: unit vectors, which are written in the metric's
    /// coordinates.
    pub directions: &'a [UnitDirection],
    /// The weights K⁻¹(d − m), times the signal variance.
    pub weights: &'a [f32],
}

/// An upper bound of the bytes that [`encode`] writes, tight to a few dozen.
#[must_use]
pub fn encoded_len(source: &TemplateSource<'_>) -> usize {
    // A varint has at most 5 bytes, an enum 1 to 2; the object section holds 5 floats.
    let sections = 5 * SECTION_HEADER_LENGTH + (6 + source.name.len() + 2 + 5 * 4) + 6 + 8 + 7 + 8;
    let terms: usize = source.components.iter().map(|c| c.weights.len()).sum();
    HEADER_LENGTH
        .saturating_add(sections)
        .saturating_add(
            source
                .components
                .len()
                .saturating_mul(RECORD_LENGTH + PRECISION_LENGTH),
        )
        .saturating_add(terms.saturating_mul(16))
}

/// Writes a template to the start of `out` and returns its length.
///
/// # Errors
/// [`EncodeError`]: a name that is too long, unequal numbers of directions and weights, a buffer
/// that is too small, or content that [`super::Template::from_bytes`] would refuse.
pub fn encode(source: &TemplateSource<'_>, out: &mut [u8]) -> Result<usize, EncodeError> {
    if source.name.len() > NAME_CAPACITY {
        return Err(EncodeError::Name {
            capacity: NAME_CAPACITY,
            found: source.name.len(),
        });
    }
    for (component, c) in source.components.iter().enumerate() {
        if c.directions.len() != c.weights.len() {
            return Err(EncodeError::TermCount {
                component,
                directions: c.directions.len(),
                weights: c.weights.len(),
            });
        }
    }
    let with_precision = source
        .components
        .iter()
        .filter(|c| c.precision.is_some())
        .count();
    if with_precision != 0 && with_precision != source.components.len() {
        return Err(EncodeError::Precisions);
    }
    let found = out.len();
    let mut used = HEADER_LENGTH;
    section(
        out,
        &mut used,
        Section::Object,
        &ObjectSection {
            name: source.name.as_bytes(),
            unit: source.unit,
            centre: source.centre,
            radius: source.radius,
            diameter: source.diameter,
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
            encoding: TermEncoding::Float32,
            values: Values(source),
        },
    )?;
    if with_precision > 0 {
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
    let written = out.get_mut(..used).ok_or(EncodeError::Buffer { found })?;
    let (header, payload) = written
        .split_first_chunk_mut::<HEADER_LENGTH>()
        .ok_or(EncodeError::Buffer { found })?;
    *header = Header {
        length: u32::try_from(used).map_err(|_| EncodeError::TooLarge)?,
        checksum: wire::checksum(payload),
    }
    .to_bytes();
    validate::template(written).map_err(EncodeError::Invalid)?;
    Ok(used)
}

fn section<T: Serialize>(
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
        flags: REQUIRED,
        length: u32::try_from(length).map_err(|_| EncodeError::TooLarge)?,
    }
    .to_bytes();
    *used = used
        .saturating_add(SECTION_HEADER_LENGTH)
        .saturating_add(length);
    Ok(())
}

/// The components' records. In postcard a sequence of bytes and a byte array are the same, so the
/// reader borrows what is written here element by element.
struct Records<'a>(&'a [ComponentSource<'a>]);

impl Serialize for Records<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut sequence =
            serializer.serialize_seq(Some(self.0.len().saturating_mul(RECORD_LENGTH)))?;
        let mut first = 0_u32;
        for component in self.0 {
            let [x, y, z] = component.centre;
            let h = &component.hyperparameters;
            let count = u32::try_from(component.weights.len()).unwrap_or(u32::MAX);
            let numbers = [
                x,
                y,
                z,
                component.sigma_hat,
                h.length_scale,
                h.parameter,
                h.prior_mean,
            ];
            for byte in numbers
                .into_iter()
                .map(f32::to_le_bytes)
                .chain([first.to_le_bytes(), count.to_le_bytes()])
                .flatten()
            {
                sequence.serialize_element(&byte)?;
            }
            first = first.saturating_add(count);
        }
        sequence.end()
    }
}

/// The components' directions and weights.
struct Values<'a>(&'a TemplateSource<'a>);

impl Serialize for Values<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self(source) = self;
        let terms: usize = source.components.iter().map(|c| c.weights.len()).sum();
        let mut sequence = serializer.serialize_seq(Some(terms.saturating_mul(16)))?;
        let metric = source.model.metric;
        for component in source.components {
            // A metric that this build leaves out is refused when the bytes are read back.
            let directions = component.directions.iter().map(|u| {
                let unit_vector = [u.x, u.y, u.z];
                metric.coordinates(unit_vector).unwrap_or(unit_vector)
            });
            let xs = directions.clone().map(|[x, _, _]| x);
            let ys = directions.clone().map(|[_, y, _]| y);
            let zs = directions.map(|[_, _, z]| z);
            for byte in xs
                .chain(ys)
                .chain(zs)
                .chain(component.weights.iter().copied())
                .flat_map(f32::to_le_bytes)
            {
                sequence.serialize_element(&byte)?;
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
        let mut sequence = serializer.serialize_seq(Some(length))?;
        for precision in self.0.iter().filter_map(|c| c.precision) {
            for byte in precision.factor().into_iter().flat_map(f32::to_le_bytes) {
                sequence.serialize_element(&byte)?;
            }
        }
        sequence.end()
    }
}
