//! The bytes: header, section headers, records, and the postcard structures of the sections.

use super::error::{Section, TemplateError};
use crate::gp::compact::TERM_LENGTH;
use crate::gp::map::{self, Map};
use crate::gp::{Terms, Word};
use crate::unit::Unit;
use crate::validity::LARGEST_SIDE;
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

/// Words in a component's validity.
const VALIDITY_WORDS: usize = 4;

/// Bytes in a component's validity, the stride of the validities' array.
pub const VALIDITY_LENGTH: usize = VALIDITY_WORDS * 4;

/// A component's validity: low x, y, z and the pole's number; high x, y, z and the blocks along a
/// side; the first row of blocks, the number of rows (both `u8`) and of mixed blocks (`u16`); where
/// its cells start (`u32`).
pub(super) type ValidityRecord = [Word; VALIDITY_WORDS];

/// Cells along the side of a block.
pub(super) const BLOCK_SIDE: u8 = 4;

/// Most blocks along the side of a grid.
pub(super) const MOST_BLOCKS: u8 = LARGEST_SIDE / BLOCK_SIDE;

/// Bytes of a row of blocks: which are full, which are mixed, and how many mixed ones lie before it.
pub(super) const ROW_LENGTH: usize = 5;

/// Bytes of a mixed block's cells.
pub(super) const LEAF_LENGTH: usize = 2;

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
        Section::Validity => 6,
        Section::Quality => 7,
        Section::Depth => 8,
    }
}

/// The flags that a section is written with.
pub(super) const fn flags(section: Section) -> u16 {
    match section {
        Section::Quality | Section::Depth => 0,
        _ => REQUIRED,
    }
}

pub(super) fn section_of(found: u16) -> Option<Section> {
    [
        Section::Object,
        Section::Model,
        Section::Components,
        Section::Terms,
        Section::Precisions,
        Section::Validity,
        Section::Quality,
        Section::Depth,
    ]
    .into_iter()
    .find(|section| tag(*section) == found)
}

#[derive(Debug, Serialize, Deserialize)]
pub(super) struct ObjectSection<'a> {
    /// A postcard string, which is a byte array that ought to be UTF-8.
    pub(super) name: &'a [u8],
    pub(super) unit: Unit,
    // Words, not `f32`: in what postcard makes of these a panic can be reached at `opt-level = "s"`.
    pub(super) centre: [Word; 3],
    pub(super) radius: Word,
    pub(super) diameter: Word,
}

/// An array of records: the components' or the precisions'. `B` is `&[u8]` when reading and a
/// sequence of the same bytes when writing.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct RecordsSection<B> {
    pub(super) stride: u16,
    pub(super) records: B,
}

/// How directions and weights are stored.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) enum TermEncoding {
    /// All x, all y, all z, all weights of a component, each a run of little-endian `f32`.
    Float32,
    /// Of each component the scale of its weights, all x, all y, all z in grid steps, all weights in
    /// units of the scale: `f32`, `i8`, little-endian `i16`.
    Compact,
    /// Of each component a map in their place: [`map::Header`], then its nodes, `i8`.
    Map,
}

#[derive(Debug, Serialize, Deserialize)]
pub(super) struct TermsSection<B> {
    pub(super) encoding: TermEncoding,
    pub(super) values: B,
}

/// As [`RecordsSection`], of validities, and the cells that they name ranges of.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct ValiditySection<A, B> {
    pub(super) stride: u16,
    pub(super) records: A,
    pub(super) cells: B,
}

#[derive(Debug, Serialize, Deserialize)]
pub(super) struct QualitySection<B> {
    pub(super) covered: f32,
    pub(super) deviation_max: f32,
    pub(super) deviation_rms: f32,
    /// A little-endian `u16` for each component, in 1/65535.
    pub(super) unexplained: B,
}

#[derive(Debug, Serialize, Deserialize)]
pub(super) struct DepthSection<'a> {
    // A word, as in the object section.
    pub(super) noise_share: Word,
    /// Empty, or one record.
    pub(super) calibration: &'a [u8],
    /// A postcard string, which is a byte array that ought to be UTF-8.
    pub(super) provenance: &'a [u8],
}

/// The term range that a record names: the first term, or the first byte of compact ones, and the
/// number of terms.
#[inline(always)]
pub(super) fn term_range(record: &Record) -> (u32, u32) {
    let [.., first, count] = *record;
    (u32::from_le_bytes(first), u32::from_le_bytes(count))
}

/// Four words: as many bytes as one term has in the four arrays of its component together.
pub(super) type Quad = [Word; 4];

/// The terms of all components, one component's behind the other's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum TermValues<'a> {
    Exact(&'a [Quad]),
    Compact(&'a [u8]),
    /// Compact ones, and what [`super::decoded`] has made of them.
    Decoded(&'a [u8], &'a [Quad]),
    Map(&'a [u8]),
}

impl<'a> TermValues<'a> {
    /// A component's terms, if they lie inside the section.
    #[inline]
    pub(super) fn of(self, record: &Record) -> Option<Terms<'a>> {
        let (first, count) = term_range(record);
        let (first, count) = (usize::try_from(first).ok()?, usize::try_from(count).ok()?);
        match self {
            Self::Exact(quads) => Some(Terms::from_quads(quads.get(first..)?.get(..count)?)),
            Self::Compact(bytes) => {
                let (scale, behind) = bytes.get(first..)?.split_first_chunk()?;
                let (terms, _) = behind.as_chunks::<TERM_LENGTH>();
                Some(Terms::from_compact(
                    f32::from_le_bytes(*scale),
                    terms.get(..count)?,
                ))
            }
            Self::Decoded(bytes, quads) => {
                let (scale, _) = bytes.get(first..)?.split_first_chunk()?;
                let quads = quads.get(decoded_at(first)..)?.get(..count)?;
                Some(Terms::from_decoded(f32::from_le_bytes(*scale), quads))
            }
            Self::Map(_) => self.map(record).map(Terms::from_map),
        }
    }

    /// A component's map, where components have maps.
    #[inline(always)]
    pub(super) fn map(self, record: &Record) -> Option<Map<'a>> {
        let Self::Map(bytes) = self else {
            return None;
        };
        let (first, count) = term_range(record);
        let (first, count) = (usize::try_from(first).ok()?, usize::try_from(count).ok()?);
        let (header, nodes) = bytes
            .get(first..)?
            .split_first_chunk::<{ map::HEADER_LENGTH }>()?;
        let header = header.as_chunks().0.first_chunk()?;
        Some(Map::new(header, nodes.get(..count)?))
    }

    /// Where the terms behind a component's start, in the unit of its record.
    pub(super) fn behind(self, record: &Record) -> u32 {
        let (first, count) = term_range(record);
        first.saturating_add(match self {
            Self::Exact(_) => count,
            Self::Compact(_) | Self::Decoded(..) => count
                .saturating_mul(TERM_LENGTH as u32)
                .saturating_add(size_of::<Word>() as u32),
            Self::Map(_) => count.saturating_add(map::HEADER_LENGTH as u32),
        })
    }

    /// Where the last component's terms have to end.
    pub(super) fn end(self) -> usize {
        match self {
            Self::Exact(quads) => quads.len(),
            Self::Compact(bytes) | Self::Decoded(bytes, _) | Self::Map(bytes) => bytes.len(),
        }
    }
}

/// Where the decoded terms of a component start whose compact ones start at this byte: no two components
/// overlap, because before a component's terms lies its scale.
pub(super) const fn decoded_at(first: usize) -> usize {
    first.div_ceil(TERM_LENGTH)
}

/// C_k.
#[inline]
pub(super) fn centre(record: &Record) -> [f32; 3] {
    let [x, y, z, ..] = record;
    numbers(&[*x, *y, *z])
}

/// Three numbers, one by one: a `map` is a loop at `opt-level = "s"`.
#[inline]
pub(super) fn numbers([x, y, z]: &[Word; 3]) -> [f32; 3] {
    [
        f32::from_le_bytes(*x),
        f32::from_le_bytes(*y),
        f32::from_le_bytes(*z),
    ]
}

/// P − C_k.
#[inline]
pub(super) fn offset(record: &Record, [px, py, pz]: [f32; 3]) -> [f32; 3] {
    let [x, y, z] = centre(record);
    [px - x, py - y, pz - z]
}
