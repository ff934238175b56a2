//! The document of a glTF file: JSON, alone or in a binary file.
//!
//! Owns the checks before and after `gltf` parses it: those that keep the crate from panicking,
//! and the extensions without which geometry is not what it seems.

use gltf::json::validation::Validate;
use gltf::{Document, Gltf, json};

use super::super::content::{BadContent, Place};

const GLB_HEADER: usize = 12;

/// Required extensions that leave the geometry as it is, or that are read.
const HARMLESS: [&str; 6] = [
    "KHR_mesh_quantization",
    "KHR_materials_",
    "KHR_texture_",
    "EXT_texture_",
    "KHR_lights_",
    "MSFT_texture_",
];

/// Parts of a document that geometry does not need, and that may be wrong.
const UNUSED: [&str; 7] = [
    "animations",
    "cameras",
    "images",
    "materials",
    "samplers",
    "skins",
    "textures",
];

/// Fields of meshes that geometry does not need, or that [`check_attributes`] has checked.
const UNUSED_FIELDS: [&str; 3] = [".attributes", ".material", ".targets"];

/// The document in `bytes`, whose indices are valid as far as the scene is concerned.
pub(super) fn parse(bytes: &[u8]) -> Result<Gltf, BadContent> {
    let bytes = without_trailer(bytes)?;
    let Gltf { document, blob } =
        Gltf::from_slice_without_validation(bytes).map_err(syntax_error)?;
    let mut root = document.into_json();
    check_extensions(&root)?;
    root.extensions_required.clear();
    check_attributes(&root)?;
    check_indices(&root)?;
    let document = Document::from_json_without_validation(root);
    Ok(Gltf { document, blob })
}

/// A binary file up to the length that its header announces, or the whole text of another; the
/// crate subtracts the header's size from that length without looking.
fn without_trailer(bytes: &[u8]) -> Result<&[u8], BadContent> {
    let Some(rest) = bytes.strip_prefix(b"glTF") else {
        return Ok(bytes);
    };
    let word = |at: usize| {
        let word = rest.get(at..at + 4)?.try_into().ok()?;
        Some(u32::from_le_bytes(word))
    };
    let (Some(version), Some(length)) = (word(0), word(4)) else {
        let expected = format!("a header of {GLB_HEADER} bytes");
        return Err(BadContent::new(
            None,
            expected,
            format!("{} bytes", bytes.len()),
        ));
    };
    if version != 2 {
        return Err(BadContent::new(
            None,
            "glTF of version 2",
            format!("version {version}"),
        ));
    }
    usize::try_from(length)
        .ok()
        .filter(|&length| length >= GLB_HEADER)
        .and_then(|length| bytes.get(..length))
        .ok_or_else(|| {
            let expected = format!("the {length} bytes that the header announces");
            BadContent::new(None, expected, format!("{} bytes", bytes.len()))
        })
}

fn syntax_error(error: gltf::Error) -> BadContent {
    let place = match &error {
        gltf::Error::Deserialize(error) => {
            Some(Place::Line(error.line())).filter(|_| error.line() > 0)
        }
        _ => None,
    };
    BadContent::new(place, "a glTF file", error)
}

/// Draco, meshopt and others keep the geometry where only they find it.
fn check_extensions(root: &json::Root) -> Result<(), BadContent> {
    let unread = root
        .extensions_required
        .iter()
        .find(|name| !HARMLESS.iter().any(|harmless| name.starts_with(harmless)));
    unread.map_or(Ok(()), |name| {
        Err(BadContent::new(
            None,
            "uncompressed geometry without required extensions",
            format!("the required extension `{name}`"),
        ))
    })
}

/// The crate's validation looks accessors up before it has validated their indices.
fn check_attributes(root: &json::Root) -> Result<(), BadContent> {
    for (mesh, json) in root.meshes.iter().enumerate() {
        for (primitive, json) in json.primitives.iter().enumerate() {
            let wrong = json
                .attributes
                .values()
                .find(|index| index.value() >= root.accessors.len());
            if let Some(index) = wrong {
                return Err(BadContent::new(
                    Some(Place::Primitive { mesh, primitive }),
                    format!("attributes among the {} accessors", root.accessors.len()),
                    format!("accessor {}", index.value()),
                ));
            }
        }
    }
    Ok(())
}

/// What is looked up later must exist. The bounds of positions, which the specification demands
/// and exporters forget, and names of attributes are nothing to refuse a file for.
fn check_indices(root: &json::Root) -> Result<(), BadContent> {
    let mut first = None;
    root.validate(root, json::Path::new, &mut |path, error| {
        if first.is_none() {
            let path = path().to_string();
            let unused = UNUSED.iter().any(|part| path.starts_with(part))
                || UNUSED_FIELDS.iter().any(|field| path.contains(field));
            if !unused {
                first = Some(BadContent::new(
                    None,
                    "a valid glTF document",
                    format!("`{path}`: {error}"),
                ));
            }
        }
    });
    first.map_or(Ok(()), Err)
}
