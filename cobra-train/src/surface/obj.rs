//! OBJ files: the lines `v` and `f`; everything else in the file is skipped.
//!
//! Owns the reduction of the text to its geometry; `tobj` owns the syntax.

use std::borrow::Cow;
use std::fmt::Write;
use std::io::Cursor;
use std::path::Path;

use nalgebra::Point3;
use tobj::{LoadError, LoadOptions};

use super::content::{BadContent, Place, Soup};
use super::triangulate::Triangulator;

/// The vertices and the triangulated faces of the OBJ file in `bytes`. Only vertices that a face
/// uses are kept, in the order of their first use; in a file without faces, all are. Lines, points
/// and faces of fewer than three vertices have no surface and are left out.
///
/// # Errors
/// [`BadContent`]: a vertex or a face that is not made of numbers, a face that names a vertex that
/// does not exist, or no vertex at all.
pub(super) fn parse(bytes: Vec<u8>) -> Result<Soup, BadContent> {
    let mut geometry = geometry(&String::from_utf8_lossy(&bytes));
    let (vertices, triangles) = load(&geometry, true)?;
    if !triangles.is_empty() {
        return Ok((vertices, triangles));
    }
    let count = vertex_count(&geometry);
    if count == 0 {
        return Err(BadContent::new(
            None,
            "vertices: lines with `v` and three numbers",
            "none",
        ));
    }
    // The parser hands over vertices that an element names, so each gets one.
    for index in 1..=count {
        let _ = writeln!(geometry, "f {index}");
    }
    Ok((load(&geometry, false)?.0, triangles))
}

/// The vertices that faces of three or more name, or of one, and the triangles of the former.
fn load(geometry: &str, ignore_points: bool) -> Result<Soup, BadContent> {
    let options = LoadOptions {
        ignore_points,
        ignore_lines: true,
        ..LoadOptions::default()
    };
    let mut cursor = Cursor::new(geometry.as_bytes());
    let no_materials = |_: &Path| Err(LoadError::GenericFailure);
    let (models, _) = tobj::load_obj_buf(&mut cursor, &options, no_materials).map_err(|error| {
        // The parser stops at the line it cannot parse, and looks vertices up at the end.
        let read = usize::try_from(cursor.position()).unwrap_or(geometry.len());
        syntax_error(error, &geometry[..read])
    })?;
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    let mut triangulator = Triangulator::default();
    for mesh in models.into_iter().map(|model| model.mesh) {
        let first = u32::try_from(vertices.len()).map_err(|_| too_many(vertices.len()))?;
        let xyz = mesh.positions.chunks_exact(3);
        vertices.extend(xyz.map(|p| Point3::new(p[0], p[1], p[2])));
        u32::try_from(vertices.len()).map_err(|_| too_many(vertices.len()))?;
        let indices: Vec<u32> = mesh.indices.iter().map(|i| first + i).collect();
        if mesh.face_arities.is_empty() {
            let corners = indices.chunks_exact(3);
            triangles.extend(corners.map(|t| [t[0], t[1], t[2]]));
        }
        let mut rest = indices.as_slice();
        for &corners in &mesh.face_arities {
            let (polygon, after) = rest.split_at(corners as usize);
            triangulator.append(polygon, &vertices, &mut triangles);
            rest = after;
        }
    }
    Ok((vertices, triangles))
}

/// The text with nothing but positions and the position indices of faces, line for line.
///
/// Texture coordinates, normals, colours, materials and groups are no part of the surface, and the
/// parser fails on files that hold few of them or overflows on absurd indices into them. A vertex or
/// a face that goes on behind a backslash is joined, which leaves empty lines behind.
fn geometry(text: &str) -> String {
    let mut kept = String::with_capacity(text.len());
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        let counts = matches!(line.split_whitespace().next(), Some("v" | "f"));
        let (mut whole, mut last) = (Cow::Borrowed(line), line);
        let mut continued = 0;
        while let Some(begin) = before_backslash(last).filter(|_| counts) {
            let joined = whole.to_mut();
            joined.truncate(joined.len() - (last.len() - begin.len()));
            let Some(next) = lines.next() else { break };
            joined.push(' ');
            joined.push_str(next);
            last = next;
            continued += 1;
        }
        keep_geometry(&whole, &mut kept);
        kept.extend(std::iter::repeat_n('\n', 1 + continued));
    }
    kept
}

/// What stands before the backslash at a line's end; a comment may end in a path.
fn before_backslash(line: &str) -> Option<&str> {
    let begin = line.trim_end().strip_suffix('\\')?;
    (!line.contains('#')).then_some(begin)
}

fn keep_geometry(line: &str, kept: &mut String) {
    let line = line.split('#').next().unwrap_or_default();
    let mut words = line.split_whitespace();
    match words.next() {
        Some("v") => {
            // Four numbers are x y z w; six are x y z and a colour.
            let position = if words.clone().count() == 4 { 4 } else { 3 };
            kept.push('v');
            for word in words.take(position) {
                kept.push(' ');
                kept.push_str(word);
            }
        }
        Some("f") => {
            kept.push('f');
            for word in words {
                kept.push(' ');
                let position = word.split('/').next().filter(|index| !index.is_empty());
                kept.push_str(position.unwrap_or(word));
            }
        }
        _ => {}
    }
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
    fn polygons_become_triangles_of_double_precision_vertices() {
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
    fn concave_polygons_are_covered_once() {
        let dented = SQUARE.replace("v 1 1 0", "v 0.1 0.1 0");
        let (_, triangles) = parse(dented.replace("f 1 2 3 4", "f 2 3 4 1").into()).unwrap();
        // Corners are numbered in the order of their use: 2 becomes 0, 3 becomes 1.
        assert_eq!(triangles.len(), 2);
        assert!(triangles.iter().all(|t| t.contains(&1) && t.contains(&3)));
    }

    #[test]
    fn relative_indices_count_back_from_their_line_across_groups() {
        let text = "o one\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf -3//1 -2//2 -1//3\ng two\nv 5 0 0\n\
                    v 6 0 0\nv 6 1 0\nf -3/1/1 -2/2/2 -1/3/3\ng three\nf -6 -1 -2\nv 9 9 9\n";
        let (vertices, triangles) = parse(text.into()).unwrap();
        assert_eq!(triangles, [[0, 1, 2], [3, 4, 5], [0, 5, 4]]);
        assert_eq!(vertices.len(), 6);
        assert_eq!(vertices[3], Point3::new(5.0, 0.0, 0.0));
    }

    #[test]
    fn a_backslash_continues_a_line_and_the_count_of_lines_goes_on() {
        let text = "v 0 0 \\\n0\nv 1 0 0\nv 1 1 0\nv 0 1 0.1\nf 1 2 \\\r\n 3 \\ \n4\n";
        assert_eq!(parse(text.into()).unwrap(), parse(SQUARE.into()).unwrap());
        let bad = error(&format!("{text}f 1 x 3\n"));
        assert_eq!(bad.place, Some(Place::Line(9)));
        assert!(parse(b"v 0 0 0 \\".to_vec()).is_ok());
        let commented = format!("# from C:\\parts\\\n{}", SQUARE.replace("\nf", " # a\\\nf"));
        assert_eq!(
            parse(commented.into()).unwrap(),
            parse(SQUARE.into()).unwrap()
        );
    }

    #[test]
    fn a_file_without_faces_has_all_of_its_vertices_in_order() {
        for elements in ["", "l 1 2\n", "f 2 1\n", "p 1 2 3\n", "f 3\n", "f\n"] {
            let text = format!("v 7 8 9\nv 2 0 0 2 # half\n{elements}v 1 1 0 0.5 0.5 0.5\n");
            let (vertices, triangles) = parse(text.into()).unwrap();
            assert!(triangles.is_empty());
            let mut expected = [[7., 8., 9.], [1., 0., 0.], [1., 1., 0.]].map(Point3::from);
            if elements == "f 3\n" {
                expected.rotate_right(1);
            }
            assert_eq!(vertices, expected, "{elements}");
        }
    }

    #[test]
    fn a_file_without_vertices_is_an_error() {
        for text in ["", "garbage\nof words", "\0\u{1}\u{2}", "f\n"] {
            assert_eq!(error(text).found, "none");
        }
        assert!(parse(vec![0xff; 100]).is_err());
    }
}
