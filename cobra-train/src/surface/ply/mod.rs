//! PLY files: the elements `vertex` and `face`; everything else in the file is skipped.
//!
//! Owns the checks that keep a hostile header from costing memory or time; `ply-rs-bw` owns the
//! syntax, `rows` which properties count.

mod rows;

use nalgebra::Point3;
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{ElementDef, Encoding, Header, PropertyType, ScalarType};

use super::content::{BadContent, Place, Soup};
use super::triangulate::Triangulator;
use rows::{Face, INDEX_NAMES, Skipped, Vertex};

/// The vertices and the triangulated faces of the PLY file in `bytes`; without an element `face`,
/// or with none in it, there are no triangles.
///
/// # Errors
/// [`BadContent`]: the header or a row breaks the format, the file is shorter than its header
/// says, a face has fewer than three vertices or names one that does not exist.
pub(super) fn parse(mut bytes: Vec<u8>) -> Result<Soup, BadContent> {
    replace_non_ascii_in_header(&mut bytes);
    let mut reader = Reader::new(bytes.as_slice());
    let header = Parser::<Skipped>::new()
        .read_header(&mut reader)
        .map_err(|e| syntax_error(&e, true))?;
    check_length(&header, reader.get_ref().len())?;
    let ascii = header.encoding == Encoding::Ascii;
    let syntax = |e| syntax_error(&e, ascii);
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for element in header.elements.values() {
        match element.name.as_str() {
            "vertex" => {
                check_coordinates(element)?;
                vertices = Parser::<Vertex>::new()
                    .read_payload_for_element(&mut reader, element, &header)
                    .map_err(syntax)?;
            }
            "face" => {
                check_indices(element)?;
                faces = Parser::<Face>::new()
                    .read_payload_for_element(&mut reader, element, &header)
                    .map_err(syntax)?;
            }
            _ => {
                Parser::<Skipped>::new()
                    .read_payload_for_element(&mut reader, element, &header)
                    .map_err(syntax)?;
            }
        }
    }
    let vertices: Vec<Point3<f64>> = vertices.into_iter().map(|v| v.0).collect();
    let triangles = triangulate(&faces, &vertices)?;
    Ok((vertices, triangles))
}

/// Comments may hold a path in any encoding, where the parser insists on UTF-8.
fn replace_non_ascii_in_header(bytes: &mut [u8]) {
    const END: &[u8] = b"end_header";
    if let Some(end) = bytes.windows(END.len()).position(|w| w == END) {
        for byte in &mut bytes[..end] {
            if !byte.is_ascii() {
                *byte = b'?';
            }
        }
    }
}

fn syntax_error(error: &ParseError, in_lines: bool) -> BadContent {
    let text = error.to_string();
    // What follows is a dump of the library's grammar.
    let text = text.split("\n\tError: ParseError").next().unwrap_or(&text);
    let Some(line) = error.line() else {
        return BadContent::new(None, "a PLY file", text);
    };
    let message = text.strip_prefix(&format!("Line {line}: "));
    let place = in_lines.then_some(Place::Line(line));
    BadContent::new(place, "a PLY file", message.unwrap_or(text))
}

/// A header may promise anything; each row costs memory, so the rows must fit into the file.
fn check_length(header: &Header, available: usize) -> Result<(), BadContent> {
    let mut needed = 0_usize;
    for element in header.elements.values() {
        let row = match header.encoding {
            Encoding::Ascii => 1,
            Encoding::BinaryBigEndian | Encoding::BinaryLittleEndian => {
                let bytes = element.properties.values().map(|p| match &p.data_type {
                    PropertyType::Scalar(scalar) | PropertyType::List(scalar, _) => size(scalar),
                });
                bytes.sum::<usize>().max(1)
            }
        };
        needed = needed.saturating_add(row.saturating_mul(element.count));
        if needed > available {
            return Err(BadContent::new(
                None,
                format!(
                    "at least {needed} bytes after the header, for {} rows up to element `{}`",
                    element.count, element.name
                ),
                format!("{available} bytes"),
            ));
        }
    }
    Ok(())
}

fn size(scalar: &ScalarType) -> usize {
    match scalar {
        ScalarType::Char | ScalarType::UChar => 1,
        ScalarType::Short | ScalarType::UShort => 2,
        ScalarType::Int | ScalarType::UInt | ScalarType::Float => 4,
        ScalarType::Double => 8,
    }
}

fn check_coordinates(element: &ElementDef) -> Result<(), BadContent> {
    for name in ["x", "y", "z"] {
        let found = element.properties.get(name).map(|p| &p.data_type);
        if !matches!(found, Some(PropertyType::Scalar(_))) {
            return Err(BadContent::new(
                None,
                format!("element `vertex` with a number as property `{name}`"),
                found.map_or("no such property", |_| "a list"),
            ));
        }
    }
    Ok(())
}

fn check_indices(element: &ElementDef) -> Result<(), BadContent> {
    let found = INDEX_NAMES
        .iter()
        .find_map(|&name| element.properties.get(name));
    let of_integers = found.is_some_and(|p| match &p.data_type {
        PropertyType::List(_, item) => !matches!(item, ScalarType::Float | ScalarType::Double),
        PropertyType::Scalar(_) => false,
    });
    if of_integers || element.count == 0 {
        return Ok(());
    }
    Err(BadContent::new(
        None,
        "element `face` with a list of integers as property `vertex_indices` or `vertex_index`",
        found.map_or_else(
            || "no such property".to_owned(),
            |p| format!("{:?}", p.data_type),
        ),
    ))
}

fn triangulate(faces: &[Face], vertices: &[Point3<f64>]) -> Result<Vec<[u32; 3]>, BadContent> {
    let mut triangulator = Triangulator::default();
    let mut triangles = Vec::with_capacity(faces.len());
    let mut polygon = Vec::new();
    for (row, face) in faces.iter().enumerate() {
        polygon.clear();
        for &index in &face.0 {
            match u32::try_from(index) {
                Ok(i) if (i as usize) < vertices.len() => polygon.push(i),
                _ => {
                    return Err(BadContent::new(
                        Some(Place::Face(row)),
                        format!("indices of the {} vertices, counted from 0", vertices.len()),
                        index,
                    ));
                }
            }
        }
        if polygon.len() < 3 {
            return Err(too_few(row, polygon.len()));
        }
        triangulator.append(&polygon, vertices, &mut triangles);
    }
    Ok(triangles)
}

fn too_few(row: usize, found: usize) -> BadContent {
    BadContent::new(Some(Place::Face(row)), "at least 3 vertices", found)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n\
        property float y\nproperty float z\nelement face 1\n\
        property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";

    /// A binary square whose face list has these types and holds these bytes.
    fn binary_square(
        order: &str,
        types: &str,
        face: &[u8],
        coordinate: fn(f64) -> Vec<u8>,
    ) -> Vec<u8> {
        let real = if coordinate(0.0).len() == 4 {
            "float32"
        } else {
            "float64"
        };
        let mut bytes = format!(
            "ply\nformat binary_{order}_endian 1.0\nelement vertex 4\nproperty {real} x\n\
             property {real} y\nproperty {real} z\nproperty uchar red\nelement face 1\n\
             property uchar flags\nproperty list {types} vertex_index\nend_header\n"
        )
        .into_bytes();
        for [x, y, z] in [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0, 0.5],
        ] {
            bytes.extend([x, y, z].into_iter().flat_map(coordinate));
            bytes.push(255);
        }
        bytes.push(9);
        bytes.extend(face);
        bytes
    }

    #[test]
    fn polygons_become_triangles() {
        let (vertices, triangles) = parse(SQUARE.into()).unwrap();
        assert_eq!(vertices.len(), 4);
        assert_eq!(triangles, [[0, 1, 2], [0, 2, 3]]);
        let dented = SQUARE.replace("\n1 1 0\n", "\n0.1 0.1 0\n");
        let (_, triangles) = parse(dented.replace("4 0 1 2 3", "4 1 2 3 0").into()).unwrap();
        assert!(triangles.iter().all(|t| t.contains(&0) && t.contains(&2)));
    }

    #[test]
    fn a_file_without_faces_has_vertices_only() {
        let (head, _) = SQUARE.split_once("element face").unwrap();
        let rows = "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
        let (vertices, triangles) = parse(format!("{head}{rows}").into()).unwrap();
        assert_eq!((vertices.len(), triangles.len()), (4, 0));
    }

    #[test]
    fn binary_files_of_either_byte_order_and_any_integer_types_are_read() {
        let little = |v: f64| v.to_le_bytes().to_vec();
        let big = |v: f64| (v as f32).to_be_bytes().to_vec();
        let files = [
            binary_square("little", "uint8 int8", &[4, 0, 1, 2, 3], little),
            binary_square(
                "little",
                "short ushort",
                &[4, 0, 0, 0, 1, 0, 2, 0, 3, 0],
                little,
            ),
            binary_square("big", "uint16 int16", &[0, 4, 0, 0, 0, 1, 0, 2, 0, 3], big),
            binary_square(
                "big",
                "int uint",
                &[0, 0, 0, 4, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3],
                big,
            ),
        ];
        for bytes in files {
            let (vertices, triangles) = parse(bytes).unwrap();
            assert_eq!(vertices[3], Point3::new(0.0, 1.0, 0.5));
            assert_eq!(triangles, [[0, 1, 2], [0, 2, 3]]);
        }
    }

    #[test]
    fn a_comment_need_not_be_utf_8() {
        let mut bytes = SQUARE
            .replace("element vertex", "comment X\nelement vertex")
            .into_bytes();
        let place = bytes.iter().position(|&b| b == b'X').unwrap();
        bytes[place] = 0xe4;
        assert!(parse(bytes).is_ok());
    }

    fn error(text: &str) -> BadContent {
        parse(text.into()).unwrap_err()
    }

    #[test]
    fn a_wrong_index_names_its_face() {
        for (row, found) in [("4 0 1 2 4", "4"), ("4 0 1 -2 3", "-2")] {
            let bad = error(&SQUARE.replace("4 0 1 2 3", row));
            assert_eq!(bad.place, Some(Place::Face(0)));
            assert_eq!(bad.found, found);
        }
        let unsigned = SQUARE.replace("uchar int", "uchar uint");
        let bad = error(&unsigned.replace("4 0 1 2 3", "4 0 1 2 4294967295"));
        assert_eq!(bad.found, "4294967295");
    }

    #[test]
    fn a_face_of_fewer_than_three_vertices_is_an_error() {
        for (row, found) in [("2 0 1", "2"), ("1 0", "1"), ("0", "0")] {
            let bad = error(&SQUARE.replace("4 0 1 2 3", row));
            assert_eq!(
                (bad.place, bad.found.as_str()),
                (Some(Place::Face(0)), found)
            );
        }
    }

    #[test]
    fn a_header_that_promises_more_than_the_file_holds_costs_nothing() {
        for count in ["4294967295", "18446744073709551615"] {
            let bad = error(&SQUARE.replace("vertex 4", &format!("vertex {count}")));
            assert!(bad.expected.contains(count), "{bad:?}");
        }
        let empty_rows =
            "ply\nformat binary_little_endian 1.0\nelement nothing 4294967295\nend_header\n";
        assert!(error(empty_rows).expected.contains("nothing"));
        let long_list = SQUARE.replace("4 0 1 2 3", "4294967295 0 1 2 3");
        assert_eq!(error(&long_list).place, Some(Place::Line(14)));
    }

    #[test]
    fn a_truncated_file_is_an_error_at_every_length() {
        let little = |v: f64| v.to_le_bytes().to_vec();
        let whole = binary_square("little", "uint8 int8", &[4, 0, 1, 2, 3], little);
        for length in 0..whole.len() {
            assert!(parse(whole[..length].to_vec()).is_err(), "{length}");
        }
    }

    #[test]
    fn a_word_in_place_of_a_number_names_its_line() {
        let bad = error(&SQUARE.replace("1 1 0", "1 one 0"));
        assert_eq!(bad.place, Some(Place::Line(12)));
        assert!(bad.found.contains("1 one 0"), "{bad:?}");
    }

    #[test]
    fn missing_or_unusable_properties_are_named() {
        assert!(
            error(&SQUARE.replace("float z", "float w"))
                .expected
                .contains("`z`")
        );
        assert!(
            error(&SQUARE.replace("uchar int", "uchar float"))
                .found
                .contains("Float")
        );
        assert!(
            error(&SQUARE.replace("vertex_indices", "corners"))
                .expected
                .contains("vertex_indices")
        );
    }
}
