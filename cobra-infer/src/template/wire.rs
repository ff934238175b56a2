//! The bytes: header, section headers, records, and the postcard structures of the sections.

use super::error::{Section, TemplateError};
use crate::gp::Word;
use crate::unit::Unit;
use crc::{CRC_32_ISO_HDLC, Crc, NoTable};
use serde::{Deserialize, Serialize};

/// The first four bytes of every template.
pub const MAGIC: [u8; 4] = *b"CBRA";

/// The format version that this build reads and writes.
pub const VERSION: u16 = 1;

/// Bytes in the header.
pub const HEADER_LENGTH: usize = 16;

/// Bytes in a section's header: tag, flags, length of the body.
pub(super) const SECTION_HEADER_LENGTH: usize = 8;

/// The flag of a section that a reader must understand.
pub(super) const REQUIRED: u16 = 1;

/// Most bytes in an object's name.
pub const NAME_CAPACITY: usize = 32;

/// Words in a component's record.
const RECORD_WORDS: usize = 9;

/// Bytes in a component's record, the stride of the records' array.
pub const RECORD_LENGTH: usize = RECORD_WORDS * 4;

/// A component's record as it lies in the file: centre x, y, z; σ̂; length scale; parameter; prior
/// mean (all `f32`); index of the first term; number of terms (both `u32`).
pub(super) type Record = [Word; RECORD_WORDS];

/// Words in a component's precision.
const PRECISION_WORDS: usize = 6;

/// Bytes in a component's precision, the stride of the precisions' array.
pub const PRECISION_LENGTH: usize = PRECISION_WORDS * 4;

/// The factor L of a component's Q = LLᵀ, row by row.
pub(super) type PrecisionRecord = [Word; PRECISION_WORDS];

/// Without a table: a template is loaded once, and a kilobyte of flash is kept for good. A host takes
/// 0.4 ms longer for 160 kB, which is not worth a second way to the same number.
const CHECKSUM: Crc<u32, NoTable> = Crc::<u32, NoTable>::new(&CRC_32_ISO_HDLC);

pub(super) fn checksum(payload: &[u8]) -> u32 {
    CHECKSUM.checksum(payload)
}

/// The header: magic, version, reserved, length of the file, checksum of what follows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Header {
    pub(super) length: u32,
    pub(super) checksum: u32,
}

impl Header {
    pub(super) fn read(bytes: &[u8]) -> Result<Self, TemplateError> {
        let header =
            bytes
                .first_chunk::<HEADER_LENGTH>()
                .ok_or(TemplateError::HeaderTruncated {
                    expected: HEADER_LENGTH,
                    found: bytes.len(),
                })?;
        let [
            m0,
            m1,
            m2,
            m3,
            v0,
            v1,
            r0,
            r1,
            l0,
            l1,
            l2,
            l3,
            c0,
            c1,
            c2,
            c3,
        ] = *header;
        let magic = [m0, m1, m2, m3];
        if magic != MAGIC {
            return Err(TemplateError::Magic { found: magic });
        }
        let version = u16::from_le_bytes([v0, v1]);
        if version != VERSION {
            return Err(TemplateError::Version {
                supported: VERSION,
                found: version,
            });
        }
        let reserved = u16::from_le_bytes([r0, r1]);
        if reserved != 0 {
            return Err(TemplateError::Reserved { found: reserved });
        }
        Ok(Self {
            length: u32::from_le_bytes([l0, l1, l2, l3]),
            checksum: u32::from_le_bytes([c0, c1, c2, c3]),
        })
    }

    /// Where usize has 16 bits no slice is that long, and the length check will say so.
    pub(super) fn length(&self) -> usize {
        usize::try_from(self.length).unwrap_or(usize::MAX)
    }

    pub(super) fn to_bytes(self) -> [u8; HEADER_LENGTH] {
        let [m0, m1, m2, m3] = MAGIC;
        let [v0, v1] = VERSION.to_le_bytes();
        let [l0, l1, l2, l3] = self.length.to_le_bytes();
        let [c0, c1, c2, c3] = self.checksum.to_le_bytes();
        [m0, m1, m2, m3, v0, v1, 0, 0, l0, l1, l2, l3, c0, c1, c2, c3]
    }
}

/// The length of the template that `bytes` start with, from its header alone.
///
/// `bytes` may go on behind the template, as flash does; only the first [`HEADER_LENGTH`] are read.
///
/// # Errors
/// [`TemplateError`] when the header is truncated or not that of a template of this version.
pub fn peek_len(bytes: &[u8]) -> Result<usize, TemplateError> {
    Ok(Header::read(bytes)?.length())
}

/// A section's header.
#[derive(Clone, Copy, Debug)]
pub(super) struct SectionHeader {
    pub(super) tag: u16,
    pub(super) flags: u16,
    pub(super) length: u32,
}

impl SectionHeader {
    pub(super) fn from_bytes(bytes: [u8; SECTION_HEADER_LENGTH]) -> Self {
        let [t0, t1, f0, f1, l0, l1, l2, l3] = bytes;
        Self {
            tag: u16::from_le_bytes([t0, t1]),
            flags: u16::from_le_bytes([f0, f1]),
            length: u32::from_le_bytes([l0, l1, l2, l3]),
        }
    }

    pub(super) fn to_bytes(self) -> [u8; SECTION_HEADER_LENGTH] {
        let [t0, t1] = self.tag.to_le_bytes();
        let [f0, f1] = self.flags.to_le_bytes();
        let [l0, l1, l2, l3] = self.length.to_le_bytes();
        [t0, t1, f0, f1, l0, l1, l2, l3]
    }
}

pub(super) const fn tag(section: Section) -> u16 {
    match section {
        Section::Object => 1,
        Section::Model => 2,
        Section::Components => 3,
        Section::Terms => 4,
        Section::Precisions => 5,
    }
}

pub(super) fn section_of(found: u16) -> Option<Section> {
    [
        Section::Object,
        Section::Model,
        Section::Components,
        Section::Terms,
        Section::Precisions,
    ]
    .into_iter()
    .find(|section| tag(*section) == found)
}

#[derive(Debug, Serialize, Deserialize)]
pub(super) struct ObjectSection<'a> {
    /// A postcard string, which is a byte array that ought to be UTF-8.
    pub(super) name: &'a [u8],
    pub(super) unit: Unit,
    pub(super) centre: [f32; 3],
    pub(super) radius: f32,
    pub(super) diameter: f32,
}

/// An array of records: the components' or the precisions'. `B` is `&[u8]` when reading and a
/// sequence of the same bytes when writing.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct RecordsSection<B> {
    pub(super) stride: u16,
    pub(super) records: B,
}

/// How directions and weights are stored.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) enum TermEncoding {
    /// All x, all y, all z, all weights of a component, each a run of little-endian `f32`.
    Float32,
}

#[derive(Debug, Serialize, Deserialize)]
pub(super) struct TermsSection<B> {
    pub(super) encoding: TermEncoding,
    pub(super) values: B,
}

/// The term range that a record names: first term and number of terms.
pub(super) fn term_range(record: &Record) -> (u32, u32) {
    let [.., first, count] = *record;
    (u32::from_le_bytes(first), u32::from_le_bytes(count))
}

/// Four words: as many bytes as one term has in the four arrays of its component together.
pub(super) type Quad = [Word; 4];

/// A component's terms, if they lie inside the section.
#[inline]
pub(super) fn term_quads<'a>(record: &Record, quads: &'a [Quad]) -> Option<&'a [Quad]> {
    let (first, count) = term_range(record);
    let behind = quads.get(usize::try_from(first).ok()?..)?;
    behind.get(..usize::try_from(count).ok()?)
}

/// C_k.
#[inline]
pub(super) fn centre(record: &Record) -> [f32; 3] {
    let [x, y, z, ..] = *record;
    [x, y, z].map(f32::from_le_bytes)
}

/// P − C_k.
#[inline]
pub(super) fn offset(record: &Record, [px, py, pz]: [f32; 3]) -> [f32; 3] {
    let [x, y, z] = centre(record);
    [px - x, py - y, pz - z]
}
