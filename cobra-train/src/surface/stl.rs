//! STL files, ASCII and binary.
//!
//! Owns the decision which of the two a file is and the joining of a file's several solids;
//! `stl_io` owns the syntax. Facet normals are ignored: the order of the vertices says the same.

use std::collections::HashMap;
use std::io::Cursor;

use nalgebra::Point3;
use stl_io::Vertex;

use super::content::{BadContent, Place, Soup};

const HEADER: usize = 80;
const COUNT: usize = 4;
const FACET: usize = 50;

/// The facets of the STL file in `bytes`; corners with the same coordinates become one vertex.
///
/// # Errors
/// [`BadContent`]: a file shorter than its facet count says, or text that is not STL.
pub(super) fn parse(mut bytes: Vec<u8>) -> Result<Soup, BadContent> {
    let mut soup = FacetSoup::default();
    if is_ascii(&bytes) {
        for solid in solids(&String::from_utf8_lossy(&bytes)) {
            soup.extend(solid.into_bytes())?;
        }
    } else {
        check_length(&bytes)?;
        // The library takes any file for text whose header begins with "solid ".
        bytes[..HEADER].fill(0);
        soup.extend(bytes)?;
    }
    Ok((soup.vertices, soup.triangles))
}

/// Text begins with "solid" and, unlike binary facets, holds no zero byte.
fn is_ascii(bytes: &[u8]) -> bool {
    let text = bytes.trim_ascii_start();
    let says_solid = text
        .get(..5)
        .is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    says_solid && declared_length(bytes) != Some(bytes.len()) && !bytes.contains(&0)
}

fn facet_count(bytes: &[u8]) -> Option<u32> {
    let count = bytes.get(HEADER..HEADER + COUNT)?;
    Some(u32::from_le_bytes(count.try_into().ok()?))
}

fn declared_length(bytes: &[u8]) -> Option<usize> {
    let facets = usize::try_from(facet_count(bytes)?).ok()?;
    facets.checked_mul(FACET)?.checked_add(HEADER + COUNT)
}

fn check_length(bytes: &[u8]) -> Result<(), BadContent> {
    let Some(facets) = facet_count(bytes) else {
        return Err(BadContent::new(
            None,
            format!(
                "`solid` or a binary header of {} bytes with the number of facets",
                HEADER + COUNT
            ),
            format!("{} bytes of something else", bytes.len()),
        ));
    };
    match declared_length(bytes) {
        Some(length) if length <= bytes.len() => Ok(()),
        length => Err(BadContent::new(
            None,
            format!(
                "{} bytes for the {facets} facets that the header of a binary STL announces",
                length.map_or_else(|| "more".to_owned(), |length| length.to_string())
            ),
            format!("{} bytes", bytes.len()),
        )),
    }
}

/// The solids of an ASCII file, each as the library wants to see it: alone, in lower case (it
/// knows no other), and introduced by "solid " with a space.
fn solids(text: &str) -> Vec<String> {
    let mut solids: Vec<String> = Vec::new();
    for line in text.lines() {
        let line = line.trim().to_ascii_lowercase();
        if line.split_whitespace().next() == Some("solid") {
            solids.push("solid \n".to_owned());
        } else if let Some(solid) = solids.last_mut() {
            solid.push_str(&line);
            solid.push('\n');
        }
    }
    solids
}

#[derive(Default)]
struct FacetSoup {
    vertices: Vec<Point3<f64>>,
    triangles: Vec<[u32; 3]>,
    index_of: HashMap<[u32; 3], u32>,
}

impl FacetSoup {
    fn extend(&mut self, solid: Vec<u8>) -> Result<(), BadContent> {
        let mut cursor = Cursor::new(solid);
        let facets = stl_io::create_stl_reader(&mut cursor)
            .map_err(|e| BadContent::new(None, "an STL file", e))?;
        for facet in facets {
            let place = Some(Place::Facet(self.triangles.len()));
            let facet = facet.map_err(|e| BadContent::new(place, "a facet or `endsolid`", e))?;
            let mut triangle = [0; 3];
            for (index, corner) in triangle.iter_mut().zip(&facet.vertices) {
                *index = self.index(corner).ok_or_else(|| {
                    BadContent::new(place, "at most 4294967295 vertices", "one more")
                })?;
            }
            self.triangles.push(triangle);
        }
        Ok(())
    }

    fn index(&mut self, corner: &Vertex) -> Option<u32> {
        let next = u32::try_from(self.vertices.len()).ok()?;
        let index = *self
            .index_of
            .entry(corner.0.map(f32::to_bits))
            .or_insert(next);
        if index == next {
            let [x, y, z] = corner.0.map(f64::from);
            self.vertices.push(Point3::new(x, y, z));
        }
        Some(index)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ASCII: &str = "solid part\nfacet normal 0 0 1\n outer loop\n  vertex 0 0 0\n\
        vertex 1 0 0\n  vertex 1 1 0\n endloop\nendfacet\nfacet normal 0 0 1\n outer loop\n\
        vertex 0 0 0\n  vertex 1 1 0\n  vertex 0 1 0.5\n endloop\nendfacet\nendsolid part\n";

    fn binary(header: &str, facets: &[[[f32; 3]; 3]]) -> Vec<u8> {
        let mut bytes = header.as_bytes().to_vec();
        bytes.resize(HEADER, b' ');
        bytes.extend((facets.len() as u32).to_le_bytes());
        for facet in facets {
            bytes.extend([0; 12]);
            bytes.extend(facet.iter().flatten().flat_map(|c| c.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    const FACETS: [[[f32; 3]; 3]; 2] = [
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]],
        [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.5]],
    ];

    fn assert_is_the_square(soup: Result<Soup, BadContent>) {
        let (vertices, triangles) = soup.unwrap();
        assert_eq!(vertices.len(), 4);
        assert_eq!(vertices[3], Point3::new(0.0, 1.0, 0.5));
        assert_eq!(triangles, [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn an_ascii_stl_is_read_in_any_case_and_with_any_name() {
        assert_is_the_square(parse(ASCII.into()));
        assert_is_the_square(parse(ASCII.to_ascii_uppercase().into()));
        assert_is_the_square(parse(ASCII.replace(" part", "").into()));
        let mut latin = ASCII.replace("part", "X").into_bytes();
        latin[6] = 0xe4;
        assert_is_the_square(parse(latin));
    }

    #[test]
    fn a_binary_stl_is_read() {
        assert_is_the_square(parse(binary("exported", &FACETS)));
    }

    #[test]
    fn a_binary_stl_whose_header_says_solid_is_read() {
        assert_is_the_square(parse(binary("solid part", &FACETS)));
        let mut padded = binary("solid part", &FACETS);
        padded.extend([0; 7]);
        assert_is_the_square(parse(padded));
    }

    #[test]
    fn the_solids_of_an_ascii_file_are_joined() {
        let (first, second) = ASCII.split_at(ASCII.rfind("facet normal").unwrap());
        let two = format!("{first}endsolid part\n\nsolid other\n{second}");
        assert_is_the_square(parse(two.into()));
    }

    #[test]
    fn a_count_beyond_the_file_costs_nothing_and_is_an_error() {
        let mut bytes = binary("exported", &FACETS);
        bytes[HEADER..HEADER + COUNT].copy_from_slice(&u32::MAX.to_le_bytes());
        let bad = parse(bytes).unwrap_err();
        assert!(bad.expected.contains("4294967295 facets"), "{bad:?}");
        assert_eq!(bad.found, "184 bytes");
    }

    #[test]
    fn a_truncated_file_is_an_error_at_every_length() {
        let whole = binary("exported", &FACETS);
        for length in 0..whole.len() {
            assert!(parse(whole[..length].to_vec()).is_err(), "{length}");
        }
        let text = ASCII.trim_end();
        for length in 5..text.len() - "endsolid part".len() {
            assert!(
                parse(text.as_bytes()[..length].to_vec()).is_err(),
                "{length}"
            );
        }
    }

    #[test]
    fn a_bad_facet_names_itself() {
        for (good, bad) in [
            ("0 1 0.5", "0 1 nan"),
            ("0 1 0.5", "0 1"),
            ("0 1 0.5", "0 1 1e999"),
        ] {
            let error = parse(ASCII.replace(good, bad).into()).unwrap_err();
            assert_eq!(error.place, Some(Place::Facet(1)), "{error:?}");
        }
    }

    #[test]
    fn garbage_is_an_error() {
        for bytes in [
            vec![],
            b"garbage".to_vec(),
            b"solid".to_vec(),
            vec![0xff; 200],
        ] {
            let result = parse(bytes.clone());
            assert!(result.is_err(), "{bytes:?}");
        }
    }
}
