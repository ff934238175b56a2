//! glTF 2.0 files, `.gltf` and `.glb`: the triangles and points of the scene.
//!
//! Owns which nodes, primitives and extensions count, and the limits that keep a hostile file
//! from costing memory or time. `gltf` owns the document's syntax; the bytes behind it are
//! `accessor`'s and `buffers`', because the crate's own readers panic on documents that lie.

mod accessor;
mod buffers;
mod document;
mod primitive;
mod scene;

use std::path::Path;

use super::content::{BadContent, Soup};
use buffers::Buffers;
use scene::Assembly;

/// The triangles of the scene in the glTF file `bytes`, in metres; where there is none, its
/// points. `folder` is where files are that it names. Lines, materials, skins and morph targets
/// are ignored.
///
/// # Errors
/// [`BadContent`]: the document breaks the format, needs an extension that is not read, names a
/// file that is missing or outside of the folder, or announces more data than there is.
pub(super) fn parse(bytes: &[u8], folder: &Path) -> Result<Soup, BadContent> {
    let file = document::parse(bytes)?;
    let buffers = Buffers::load(&file, folder)?;
    let mut assembly = Assembly::new(&buffers);
    assembly.append_scene(&file.document)?;
    Ok(assembly.into_soup())
}

#[cfg(test)]
mod tests;
