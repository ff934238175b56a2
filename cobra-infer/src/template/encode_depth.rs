//! Writes the section of depth mode, with a template or into one that exists.
//!
//! Owns the copy that changes nothing else: a calibration comes long after training, and what scores
//! is not encoded anew for it.

use super::depth::{CALIBRATION_LENGTH, DepthSource, PROVENANCE_CAPACITY};
use super::encode::{seal, section};
use super::encode_error::EncodeError;
use super::error::Section;
use super::validate;
use super::wire::{self, DepthSection, HEADER_LENGTH, SECTION_HEADER_LENGTH, SectionHeader};

/// Most bytes that [`with_depth`] adds to a template.
// A varint of a length below 128 has one byte.
pub const DEPTH_CAPACITY: usize =
    SECTION_HEADER_LENGTH + 4 + (1 + CALIBRATION_LENGTH) + (1 + PROVENANCE_CAPACITY);

/// Copies the template in `bytes` to the start of `out` with what it knows for depth mode replaced, or
/// added where it knew nothing, and returns the length; `bytes.len()` + [`DEPTH_CAPACITY`] is enough
/// room. All other sections stay as they are, byte by byte and in their order; this one comes last.
///
/// # Errors
/// [`EncodeError`]: `bytes` are no template, words that are too long or belong to no calibration, a
/// number out of its range, a buffer that is too small.
pub fn with_depth(
    bytes: &[u8],
    depth: &DepthSource<'_>,
    out: &mut [u8],
) -> Result<usize, EncodeError> {
    validate::template(bytes).map_err(EncodeError::Invalid)?;
    let mut used = HEADER_LENGTH;
    let mut rest = bytes.get(HEADER_LENGTH..).unwrap_or(&[]);
    while let Some(header) = rest.first_chunk::<SECTION_HEADER_LENGTH>() {
        let header = SectionHeader::from_bytes(*header);
        let length = usize::try_from(header.length)
            .map_err(|_| EncodeError::TooLarge)?
            .saturating_add(SECTION_HEADER_LENGTH);
        let Some((whole, behind)) = rest.split_at_checked(length) else {
            break;
        };
        rest = behind;
        if header.tag != wire::tag(Section::Depth) {
            let found = out.len();
            out.get_mut(used..)
                .and_then(|room| room.get_mut(..length))
                .ok_or(EncodeError::Buffer { found })?
                .copy_from_slice(whole);
            used = used.saturating_add(length);
        }
    }
    write(depth, out, &mut used)?;
    seal(out, used)?;
    Ok(used)
}

/// Appends the section.
pub(super) fn write(
    depth: &DepthSource<'_>,
    out: &mut [u8],
    used: &mut usize,
) -> Result<(), EncodeError> {
    let capacity = match depth.calibration {
        Some(_) => PROVENANCE_CAPACITY,
        None => 0,
    };
    let found = depth.provenance.len();
    if found > capacity {
        return Err(EncodeError::Provenance { capacity, found });
    }
    let record = depth.calibration.map(|calibration| calibration.to_record());
    let body = DepthSection {
        noise_share: depth.noise_share.to_le_bytes(),
        calibration: record.as_ref().map_or(&[], |record| record.as_flattened()),
        provenance: depth.provenance.as_bytes(),
    };
    section(out, used, Section::Depth, &body)
}

/// Bytes of the section, its header included.
pub(super) fn length(depth: Option<&DepthSource<'_>>) -> usize {
    depth.map_or(0, |_| DEPTH_CAPACITY)
}
