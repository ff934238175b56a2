//! The buffers of a glTF file: its binary chunk, data URIs, and files beside it.
//!
//! Owns which URIs are followed: relative ones that stay below the file's folder.

use std::collections::HashMap;
use std::path::{Component, Path};

use base64::Engine;
use base64::engine::DecodePaddingMode;
use base64::engine::general_purpose::{GeneralPurpose, GeneralPurposeConfig};
use gltf::Gltf;
use gltf::buffer::Source;
use percent_encoding::percent_decode_str;

use super::super::content::BadContent;

/// Exporters disagree about the padding.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &base64::alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// The bytes of all buffers.
pub(super) struct Buffers<'a> {
    files: Vec<Vec<u8>>,
    blob: &'a [u8],
    /// For each buffer its length and its file, or none for the binary chunk.
    buffers: Vec<(usize, Option<usize>)>,
}

impl<'a> Buffers<'a> {
    /// Loads each buffer of `file` once, however many buffers share it.
    pub(super) fn load(file: &'a Gltf, folder: &Path) -> Result<Self, BadContent> {
        let mut loaded = Self {
            files: Vec::new(),
            blob: file.blob.as_deref().unwrap_or_default(),
            buffers: Vec::new(),
        };
        let mut by_uri: HashMap<&str, usize> = HashMap::new();
        for buffer in file.document.buffers() {
            let place = match buffer.source() {
                Source::Bin => None,
                Source::Uri(uri) => Some(match by_uri.get(uri) {
                    Some(&place) => place,
                    None => {
                        loaded.files.push(load_uri(uri, folder)?);
                        by_uri.insert(uri, loaded.files.len() - 1);
                        loaded.files.len() - 1
                    }
                }),
            };
            let found = match place {
                Some(place) => loaded.files[place].len(),
                // The binary chunk is the first buffer's, and no other's.
                None if buffer.index() == 0 => loaded.blob.len(),
                None => 0,
            };
            if found < buffer.length() {
                return Err(BadContent::new(
                    None,
                    format!("{} bytes in buffer {}", buffer.length(), buffer.index()),
                    format!("{found}"),
                ));
            }
            loaded.buffers.push((buffer.length(), place));
        }
        Ok(loaded)
    }

    /// `length` bytes of a buffer.
    pub(super) fn slice(&self, buffer: usize, offset: usize, length: usize) -> Option<&[u8]> {
        let &(size, place) = self.buffers.get(buffer)?;
        let bytes = place.map_or(self.blob, |place| &self.files[place]);
        bytes.get(..size)?.get(offset..offset.checked_add(length)?)
    }
}

fn load_uri(uri: &str, folder: &Path) -> Result<Vec<u8>, BadContent> {
    if let Some(data) = uri.strip_prefix("data:") {
        let expected = "a data URI in base64";
        let (_, text) = data
            .split_once(";base64,")
            .ok_or_else(|| BadContent::new(None, expected, format!("`{uri}`")))?;
        return BASE64
            .decode(text.as_bytes())
            .map_err(|error| BadContent::new(None, expected, error));
    }
    let name = percent_decode_str(uri)
        .decode_utf8()
        .map_err(|_| BadContent::new(None, "a buffer's file name in UTF-8", format!("`{uri}`")))?;
    let relative = Path::new(&*name);
    let inside = relative
        .components()
        .all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    if !inside || name.is_empty() || name.contains([':', '\\', '\0']) {
        return Err(BadContent::new(
            None,
            "buffers in files below the glTF file's own folder",
            format!("`{name}`"),
        ));
    }
    let path = folder.join(relative);
    let missing = |reason: String| {
        BadContent::new(
            None,
            "a file beside the glTF file for each buffer",
            format!("`{name}`: {reason}"),
        )
    };
    let metadata = std::fs::metadata(&path).map_err(|error| missing(error.to_string()))?;
    if !metadata.is_file() {
        return Err(missing("no file".to_owned()));
    }
    std::fs::read(&path).map_err(|error| missing(error.to_string()))
}
