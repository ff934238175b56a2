//! Reads a mesh from a file, whatever its format.
//!
//! Owns the choice of format by the file's extension and the error that names the file. What the
//! bytes of a format mean is the business of `surface::ply`, `surface::obj` and `surface::stl`;
//! whether the result is a surface, of [`Mesh::new`].

use std::io;
use std::path::{Path, PathBuf};

use super::content::{BadContent, Place, Soup};
use super::mesh::{Mesh, MeshError};
use super::{obj, ply, stl};

/// Why a file did not become a mesh. Its `Display` is one line that names the file.
#[derive(Debug, thiserror::Error)]
pub enum ReadMeshError {
    /// The file could not be read at all: missing, a directory, no permission, a failing disk.
    #[error("{}: cannot be read: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        source: io::Error,
    },
    /// The extension does not name a format that is read.
    #[error(
        "{}: expected a mesh with the extension .ply, .obj or .stl, found {}; \
         OFF, GLB and point clouds without faces are not read yet",
        path.display(),
        extension.as_ref().map_or_else(|| "no extension".to_owned(), |e| format!(".{e}"))
    )]
    UnknownFormat {
        /// The file.
        path: PathBuf,
        /// Its extension, if it has one.
        extension: Option<String>,
    },
    /// The content breaks the rules of its format.
    #[error(
        "{}{}: expected {expected}, found {found}",
        path.display(),
        place.map_or_else(String::new, |place| format!(", {place}"))
    )]
    Malformed {
        /// The file.
        path: PathBuf,
        /// Where in the file, as far as it is known.
        place: Option<Place>,
        /// What belongs there.
        expected: String,
        /// What is there, on one line and cut short.
        found: String,
    },
    /// The content follows its format, but is not a surface.
    #[error("{}: {source}", path.display())]
    NotASurface {
        /// The file.
        path: PathBuf,
        /// What is missing or wrong.
        source: MeshError,
    },
}

impl ReadMeshError {
    /// Whether the file could not be read at all, as opposed to holding something unusable.
    #[must_use]
    pub fn is_io(&self) -> bool {
        matches!(self, Self::Io { .. })
    }
}

/// Reads the mesh in `path`: PLY (ASCII, binary of either byte order), OBJ or STL (ASCII or
/// binary), told apart by the extension in any case. Coordinates keep the file's unit. Polygons
/// become fans of triangles around their first vertex; materials, colours and normals are ignored.
///
/// # Errors
/// [`ReadMeshError`]: the file cannot be read, its extension is not known, its content breaks its
/// format, or what it describes is no surface ([`MeshError`]).
pub fn read_mesh(path: &Path) -> Result<Mesh, ReadMeshError> {
    let extension = path
        .extension()
        .map(|e| e.to_string_lossy().to_ascii_lowercase());
    let parse: fn(Vec<u8>) -> Result<Soup, BadContent> = match extension.as_deref() {
        Some("ply") => ply::parse,
        Some("obj") => obj::parse,
        Some("stl") => stl::parse,
        _ => {
            return Err(ReadMeshError::UnknownFormat {
                path: path.to_owned(),
                extension,
            });
        }
    };
    let bytes = std::fs::read(path).map_err(|source| ReadMeshError::Io {
        path: path.to_owned(),
        source,
    })?;
    let (vertices, triangles) = parse(bytes).map_err(|bad| ReadMeshError::Malformed {
        path: path.to_owned(),
        place: bad.place,
        expected: bad.expected,
        found: bad.found,
    })?;
    Mesh::new(vertices, triangles).map_err(|source| ReadMeshError::NotASurface {
        path: path.to_owned(),
        source,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

    fn read(name: &str, content: &[u8]) -> Result<Mesh, ReadMeshError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, content).unwrap();
        read_mesh(&path)
    }

    fn message(error: &ReadMeshError) -> String {
        let message = error.to_string();
        assert_eq!(message.lines().count(), 1, "{message}");
        message
    }

    #[test]
    fn the_extension_is_understood_in_any_case() {
        assert!(read("part.OBJ", TRIANGLE.as_bytes()).is_ok());
        assert!(read("part.Obj", TRIANGLE.as_bytes()).is_ok());
    }

    #[test]
    fn an_unknown_extension_lists_the_known_ones() {
        for (name, found) in [("part.off", ".off"), ("part", "no extension")] {
            let error = read(name, b"OFF").unwrap_err();
            assert!(matches!(error, ReadMeshError::UnknownFormat { .. }));
            assert!(!error.is_io());
            let message = message(&error);
            for word in [name, found, ".ply", ".obj", ".stl"] {
                assert!(message.contains(word), "{message}");
            }
        }
    }

    #[test]
    fn a_missing_file_and_a_directory_are_input_output_errors() {
        let folder = tempfile::tempdir().unwrap();
        let directory = folder.path().join("folder.ply");
        std::fs::create_dir(&directory).unwrap();
        for path in [directory, folder.path().join("missing.stl")] {
            let error = read_mesh(&path).unwrap_err();
            assert!(error.is_io(), "{error}");
            assert!(message(&error).contains(&*path.to_string_lossy()));
        }
    }

    #[test]
    fn bad_content_is_told_in_one_line_with_file_and_place() {
        let error = read("part.obj", b"v 0 0 zero\n").unwrap_err();
        assert!(!error.is_io());
        let message = message(&error);
        let end = "part.obj, line 1: expected `v` and three numbers, found `v 0 0 zero`";
        assert!(message.ends_with(end), "{message}");
    }

    #[test]
    fn empty_files_and_garbage_are_bad_content_in_every_format() {
        for name in ["part.ply", "part.obj", "part.stl"] {
            for content in [
                &b""[..],
                b"\n\n",
                b"garbage",
                b"\xff\xfe\0\x01",
                &[b'a'; 5000],
            ] {
                let error = read(name, content).unwrap_err();
                assert!(!error.is_io());
                assert!(message(&error).len() < 500);
            }
        }
    }

    #[test]
    fn a_point_cloud_is_told_that_it_has_no_faces() {
        let cloud = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n\
                     property float y\nproperty float z\nend_header\n0 0 0\n";
        let error = read("cloud.ply", cloud.as_bytes()).unwrap_err();
        let ReadMeshError::NotASurface { source, .. } = &error else {
            panic!("{error}");
        };
        assert_eq!(*source, MeshError::NoFaces { vertices: 1 });
        assert!(message(&error).contains("cloud.ply"));
    }

    #[test]
    fn a_coordinate_that_is_not_finite_or_absurd_is_refused() {
        for word in ["nan", "inf", "-inf", "1e200"] {
            let error = read(
                "part.obj",
                TRIANGLE.replace("1 0 0", &format!("{word} 0 0")).as_bytes(),
            );
            assert!(
                matches!(error, Err(ReadMeshError::NotASurface { .. })),
                "{word}"
            );
        }
    }
}
