//! Reads a mesh or a point cloud from a file, whatever its format.
//!
//! Owns the choice of format by the file's extension and the error that names the file. What the
//! bytes of a format mean is the business of the module of its name; whether the result is an
//! object, of [`Mesh::new`] and [`PointCloud::new`].

use std::io;
use std::path::{Path, PathBuf};

use cobra_infer::Unit;
use nalgebra::Point3;

use super::cloud::{CloudError, PointCloud};
use super::content::{BadContent, Place, Soup};
use super::geometry::Geometry;
use super::mesh::{Mesh, MeshError};
use super::{gltf, obj, off, ply, stl, xyz};

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
        "{}: expected the extension .ply, .obj, .stl, .off, .glb, .gltf or .xyz, found {}",
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
    /// The content follows its format, but its points are no point cloud.
    #[error("{}: {source}", path.display())]
    NotACloud {
        /// The file.
        path: PathBuf,
        /// What is missing or wrong.
        source: CloudError,
    },
}

impl ReadMeshError {
    /// Whether the file could not be read at all, as opposed to holding something unusable.
    #[must_use]
    pub fn is_io(&self) -> bool {
        matches!(self, Self::Io { .. })
    }
}

/// What a file holds.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadGeometry {
    /// The mesh, or the points of a file without faces.
    pub geometry: Geometry,
    /// The unit that the format prescribes: metres for glTF, none for all others.
    pub unit: Option<Unit>,
}

/// Reads the mesh or the point cloud in `path`: PLY (ASCII, binary of either byte order), OBJ, STL
/// (ASCII or binary), OFF (ASCII), glTF (`.gltf` with the files it names, or `.glb`) or XYZ, told
/// apart by the extension in any case. A file without faces is a point cloud. Coordinates keep the
/// file's unit. Polygons become triangles; materials, colours and normals are ignored.
///
/// # Errors
/// [`ReadMeshError`]: the file cannot be read, its extension is not known, its content breaks its
/// format, or what it describes is no surface ([`MeshError`]) and no point cloud ([`CloudError`]).
pub fn read_geometry(path: &Path) -> Result<ReadGeometry, ReadMeshError> {
    let (format, (vertices, triangles)) = read(path)?;
    let geometry = if triangles.is_empty() && !vertices.is_empty() {
        let cloud = PointCloud::new(vertices).map_err(|source| ReadMeshError::NotACloud {
            path: path.to_owned(),
            source,
        })?;
        Geometry::Cloud(cloud)
    } else {
        Geometry::Mesh(to_mesh(path, vertices, triangles)?)
    };
    Ok(ReadGeometry {
        geometry,
        unit: format.unit(),
    })
}

/// Reads the mesh in `path`, as [`read_geometry`] does.
///
/// # Errors
/// As [`read_geometry`]; a point cloud is told that it has no faces ([`MeshError::NoFaces`]).
pub fn read_mesh(path: &Path) -> Result<Mesh, ReadMeshError> {
    let (_, (vertices, triangles)) = read(path)?;
    to_mesh(path, vertices, triangles)
}

#[derive(Clone, Copy, Debug)]
enum Format {
    Ply,
    Obj,
    Stl,
    Off,
    Gltf,
    Xyz,
}

impl Format {
    fn of(extension: &str) -> Option<Self> {
        Some(match extension {
            "ply" => Self::Ply,
            "obj" => Self::Obj,
            "stl" => Self::Stl,
            "off" => Self::Off,
            "glb" | "gltf" => Self::Gltf,
            "xyz" => Self::Xyz,
            _ => return None,
        })
    }

    fn parse(self, bytes: Vec<u8>, folder: &Path) -> Result<Soup, BadContent> {
        match self {
            Self::Ply => ply::parse(bytes),
            Self::Obj => obj::parse(bytes),
            Self::Stl => stl::parse(bytes),
            Self::Off => off::parse(bytes),
            Self::Gltf => gltf::parse(&bytes, folder),
            Self::Xyz => xyz::parse(bytes),
        }
    }

    /// "The units for all linear distances are meters", says glTF 2.0; no other format says any.
    fn unit(self) -> Option<Unit> {
        match self {
            Self::Gltf => Some(Unit::Metre),
            Self::Ply | Self::Obj | Self::Stl | Self::Off | Self::Xyz => None,
        }
    }
}

fn read(path: &Path) -> Result<(Format, Soup), ReadMeshError> {
    let extension = path
        .extension()
        .map(|e| e.to_string_lossy().to_ascii_lowercase());
    let Some(format) = extension.as_deref().and_then(Format::of) else {
        return Err(ReadMeshError::UnknownFormat {
            path: path.to_owned(),
            extension,
        });
    };
    let bytes = std::fs::read(path).map_err(|source| ReadMeshError::Io {
        path: path.to_owned(),
        source,
    })?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let soup = format
        .parse(bytes, folder)
        .map_err(|bad| ReadMeshError::Malformed {
            path: path.to_owned(),
            place: bad.place,
            expected: bad.expected,
            found: bad.found,
        })?;
    Ok((format, soup))
}

fn to_mesh(
    path: &Path,
    vertices: Vec<Point3<f64>>,
    triangles: Vec<[u32; 3]>,
) -> Result<Mesh, ReadMeshError> {
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

    fn read_any(name: &str, content: &[u8]) -> Result<ReadGeometry, ReadMeshError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, content).unwrap();
        read_geometry(&path)
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
        for (name, found) in [("part.step", ".step"), ("part", "no extension")] {
            let error = read(name, b"?").unwrap_err();
            assert!(matches!(error, ReadMeshError::UnknownFormat { .. }));
            assert!(!error.is_io());
            let message = message(&error);
            for word in [
                name, found, ".ply", ".obj", ".stl", ".off", ".glb", ".gltf", ".xyz",
            ] {
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
        for extension in ["ply", "obj", "stl", "off", "glb", "gltf", "xyz"] {
            for content in [
                &b""[..],
                b"\n\n",
                b"garbage",
                b"\xff\xfe\0\x01",
                &[b'a'; 5000],
            ] {
                for error in [
                    read(&format!("part.{extension}"), content).unwrap_err(),
                    read_any(&format!("part.{extension}"), content).unwrap_err(),
                ] {
                    assert!(!error.is_io());
                    assert!(message(&error).len() < 500);
                }
            }
        }
    }

    #[test]
    fn a_file_without_faces_is_a_point_cloud_in_every_format_that_can_say_so() {
        let rows: Vec<String> = (0..12).map(|i| format!("{i} {} 0", i * i)).collect();
        let lines = rows.join("\n");
        let ply = format!(
            "ply\nformat ascii 1.0\nelement vertex 12\nproperty float x\nproperty float y\n\
             property float z\nelement face 0\nproperty list uchar int vertex_indices\n\
             end_header\n{lines}\n"
        );
        let obj = format!("v {}\n", rows.join("\nv "));
        let off = format!("OFF\n12 0 0\n{lines}\n");
        for (name, text) in [
            ("a.ply", ply),
            ("a.obj", obj),
            ("a.off", off),
            ("a.xyz", lines),
        ] {
            let read_geometry = read_any(name, text.as_bytes()).unwrap();
            assert_eq!(read_geometry.unit, None);
            let Geometry::Cloud(cloud) = read_geometry.geometry else {
                panic!("{name}");
            };
            assert_eq!(cloud.points()[3], Point3::new(3.0, 9.0, 0.0));
            assert_eq!(cloud.points().len(), 12);
            let error = read(name, text.as_bytes()).unwrap_err();
            let vertices = 12;
            assert!(
                matches!(&error, ReadMeshError::NotASurface { source, .. }
                    if *source == MeshError::NoFaces { vertices }),
                "{error}"
            );
        }
    }

    #[test]
    fn a_file_with_faces_is_a_mesh_and_too_few_points_are_nothing() {
        let mesh = read_any("part.obj", TRIANGLE.as_bytes()).unwrap();
        assert!(matches!(mesh.geometry, Geometry::Mesh(_)));
        let error = read_any("part.xyz", b"0 0 0\n1 1 1\n").unwrap_err();
        assert!(matches!(error, ReadMeshError::NotACloud { .. }));
        assert!(message(&error).contains("2 distinct points"));
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
