//! OBJ files: the lines `v` and `f`; everything else in the file is skipped.
//!
//! Owns the reduction of the text to its geometry; `tobj` owns the syntax.

use std::io::Cursor;

use nalgebra::Point3;
use tobj::{LoadError, LoadOptions};

use super::content::{BadContent, Place, Soup};

/// The vertices and the fan-triangulated faces of the OBJ file in `bytes`. Only vertices that a
/// face uses are kept, in the order of their first use. Lines, points and faces of fewer than
/// three vertices have no surface and are left out.
///
/// # Errors
/// [`BadContent`]: a vertex or a face that is not made of numbers, a face that names a vertex that
/// does not exist, or no face at all.
pub(super) fn parse(bytes: Vec<u8>) -> Result<Soup, BadContent> {
    let geometry = geometry(&String::from_utf8_lossy(&bytes));
    let options = LoadOptions {
        triangulate: true,
        ignore_points: true,
        ignore_lines: true,
        ..LoadOptions::default()
    };
    let mut cursor = Cursor::new(geometry.as_bytes());
    let (models, _) = tobj::load_obj_buf(&mut cursor, &options, |_| Err(LoadError::GenericFailure))
        .map_err(|error| {
            // The parser stops at the line it cannot parse, and looks vertices up at the end.
            let read = usize::try_from(cursor.position()).unwrap_or(geometry.len());
            syntax_error(error, &geometry[..read])
        })?;
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for mesh in models.into_iter().map(|model| model.mesh) {
        let first = u32::try_from(vertices.len()).map_err(|_| too_many(vertices.len()))?;
        let xyz = mesh.positions.chunks_exact(3);
        vertices.extend(xyz.map(|p| Point3::new(p[0], p[1], p[2])));
        u32::try_from(vertices.len()).map_err(|_| too_many(vertices.len()))?;
        let corners = mesh.indices.chunks_exact(3);
        triangles.extend(corners.map(|t| [first + t[0], first + t[1], first + t[2]]));
    }
    if triangles.is_empty() {
        return Err(BadContent::new(
            None,
            "a face: `f` and at least three vertex indices",
            format!("{} vertices and none", vertex_count(&geometry)),
        ));
    }
    Ok((vertices, triangles))
}

/// The text with nothing but positions and the position indices of faces, line for line.
///
/// Texture coordinates, normals, colours and materials are no part of the surface, and the parser
/// fails on files that hold few of them or overflows on absurd indices into them.
fn geometry(text: &str) -> String {
    let mut kept = String::with_capacity(text.len());
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let numbers = words.clone().take_while(|w| !w.starts_with('#')).count();
                // Four numbers are x y z w; six are x y z and a colour.
                let position = if numbers == 4 { 4 } else { 3 };
                kept.push('v');
                for word in words.take(position) {
                    kept.push(' ');
                    kept.push_str(word);
                }
            }
            Some("f") => {
                kept.push('f');
                for word in words.take_while(|w| !w.starts_with('#')) {
                    kept.push(' ');
                    let position = word.split('/').next().filter(|index| !index.is_empty());
                    kept.push_str(position.unwrap_or(word));
                }
            }
            _ => {}
        }
        kept.push('\n');
    }
    kept
}

fn vertex_count(geometry: &str) -> usize {
    geometry.lines().filter(|l| l.starts_with('v')).count()
}

fn syntax_error(error: LoadError, read: &str) -> BadContent {
    let row = Some(Place::Line(read.lines().count()));
    let line = read.lines().last().unwrap_or_default();
    match error {
        LoadError::PositionParseError | LoadError::ScalingByZeroError => {
            BadContent::new(row, "`v` and three numbers", format!("`{line}`"))
        }
        LoadError::FaceParseError => {
            BadContent::new(row, "`f` and vertex indices", format!("`{line}`"))
        }
        LoadError::FaceVertexOutOfBounds => BadContent::new(
            None,
            format!(
                "faces that name the {} vertices, counted from 1",
                vertex_count(read)
            ),
            "a face that names another",
        ),
        other => BadContent::new(None, "an OBJ file", other),
    }
}

fn too_many(found: usize) -> BadContent {
    BadContent::new(None, "at most 4294967295 vertices", found)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.1\nf 1 2 3 4\n";

    fn error(text: &str) -> BadContent {
        parse(text.into()).unwrap_err()
    }

    #[test]
    fn polygons_become_fans_of_double_precision_vertices() {
        let (vertices, triangles) = parse(SQUARE.into()).unwrap();
        assert_eq!(vertices[3], Point3::new(0.0, 1.0, 0.1));
        assert_eq!(triangles, [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn materials_groups_colours_and_absurd_texture_indices_do_not_matter() {
        let text = "mtllib missing.mtl\no a\nv 0 0 0 1 0 0\nv 1 0 0\nusemtl x\nvt 0 0\n\
                    v 1 1 0 # corner\nvn 0 0\nf 1/9223372036854775807 2//5 3\ng b\n\
                    f -1/1/1 -2 -3\nl 1 2\nf 1 2\nf 1\n";
        let (vertices, triangles) = parse(text.into()).unwrap();
        assert_eq!(triangles, [[0, 1, 2], [2, 1, 0]]);
        assert_eq!(vertices.len(), 3);
    }

    #[test]
    fn a_homogeneous_coordinate_divides() {
        let (vertices, _) = parse("v 2 4 6 2\nv 1 0 0\nv 0 1 0\nf 1 2 3".into()).unwrap();
        assert_eq!(vertices[0], Point3::new(1.0, 2.0, 3.0));
    }

    #[test]
    fn what_cannot_be_parsed_names_its_line() {
        let bad = error(&SQUARE.replace("v 1 1 0", "v 1 one 0"));
        assert_eq!(bad.place, Some(Place::Line(3)));
        assert_eq!(bad.found, "`v 1 one 0`");
        let bad = error(&SQUARE.replace("v 1 1 0", "v 1 1"));
        assert_eq!(bad.place, Some(Place::Line(3)));
        for face in ["f 1 x 3", "f 1 99999999999999999999 3", "f 1 2.5 3"] {
            let bad = error(&SQUARE.replace("f 1 2 3 4", face));
            assert_eq!(bad.place, Some(Place::Line(5)), "{face}");
        }
    }

    #[test]
    fn an_index_without_a_vertex_is_an_error() {
        for face in [
            "f 1 2 5",
            "f 0 1 2",
            "f -5 1 2",
            "f 1 2 9223372036854775807",
            "f 1 2 /3",
        ] {
            let bad = error(&SQUARE.replace("f 1 2 3 4", face));
            assert!(bad.expected.contains("4 vertices"), "{face}: {bad:?}");
        }
    }

    #[test]
    fn a_file_without_faces_is_an_error() {
        for text in ["", "garbage\nof words", "\0\u{1}\u{2}"] {
            assert_eq!(error(text).found, "0 vertices and none");
        }
        assert_eq!(
            error("v 0 0 0\nv 1 0 0\nf 1 2").found,
            "2 vertices and none"
        );
        assert!(parse(vec![0xff; 100]).is_err());
    }
}
