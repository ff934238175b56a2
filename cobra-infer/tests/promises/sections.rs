//! A template's bytes taken apart by the format's document, changed, and put together again with
//! the right length and checksum: damage that the checksum does not find.

/// Tags of the format's sections.
pub(crate) const OBJECT: u16 = 1;
pub(crate) const MODEL: u16 = 2;
pub(crate) const COMPONENTS: u16 = 3;
pub(crate) const TERMS: u16 = 4;
pub(crate) const DEPTH: u16 = 8;

/// The flag of a section that a reader must understand.
pub(crate) const REQUIRED: u16 = 1;

const HEADER: usize = 16;

#[derive(Clone, Debug)]
pub(crate) struct Raw {
    pub(crate) tag: u16,
    pub(crate) flags: u16,
    pub(crate) body: Vec<u8>,
}

pub(crate) fn split(bytes: &[u8]) -> Vec<Raw> {
    let mut sections = Vec::new();
    let mut rest = &bytes[HEADER..];
    while let Some((header, behind)) = rest.split_first_chunk::<8>() {
        let [t0, t1, f0, f1, length @ ..] = *header;
        let (body, behind) = behind.split_at(u32::from_le_bytes(length) as usize);
        sections.push(Raw {
            tag: u16::from_le_bytes([t0, t1]),
            flags: u16::from_le_bytes([f0, f1]),
            body: body.to_vec(),
        });
        rest = behind;
    }
    sections
}

pub(crate) fn join(sections: &[Raw]) -> Vec<u8> {
    let mut bytes = b"CBRA\x01\0\0\0\0\0\0\0\0\0\0\0".to_vec();
    for section in sections {
        bytes.extend(section.tag.to_le_bytes());
        bytes.extend(section.flags.to_le_bytes());
        bytes.extend((section.body.len() as u32).to_le_bytes());
        bytes.extend(&section.body);
    }
    reseal(&mut bytes);
    bytes
}

/// Writes the length and the checksum that belong to the bytes as they are.
pub(crate) fn reseal(bytes: &mut [u8]) {
    let length = (bytes.len() as u32).to_le_bytes();
    bytes[8..12].copy_from_slice(&length);
    let checksum = crc32(&bytes[HEADER..]).to_le_bytes();
    bytes[12..16].copy_from_slice(&checksum);
}

/// CRC-32/ISO-HDLC bit by bit, from its definition.
pub(crate) fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| {
            (crc >> 1) ^ (0xedb8_8320 * (crc & 1))
        })
    })
}

/// The template with the body of section `tag` changed.
pub(crate) fn with_body(bytes: &[u8], tag: u16, change: impl FnOnce(&mut Vec<u8>)) -> Vec<u8> {
    let mut sections = split(bytes);
    let section = sections.iter_mut().find(|section| section.tag == tag);
    change(&mut section.unwrap().body);
    join(&sections)
}

/// Writes `value` over word `word` of record `component`: two varint bytes lead the records of a
/// small template, its stride and, below 128 bytes, the array's length.
pub(crate) fn set_record_word(
    bytes: &[u8],
    component: usize,
    word: usize,
    value: [u8; 4],
) -> Vec<u8> {
    with_body(bytes, COMPONENTS, |body| {
        let at = 2 + component * 36 + word * 4;
        body[at..at + 4].copy_from_slice(&value);
    })
}

/// Writes `value` over word `word` of the terms: the encoding and the array's length lead them.
pub(crate) fn set_term_word(bytes: &[u8], word: usize, value: f32) -> Vec<u8> {
    with_body(bytes, TERMS, |body| {
        let at = 2 + word * 4;
        body[at..at + 4].copy_from_slice(&value.to_le_bytes());
    })
}
