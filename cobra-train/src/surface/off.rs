//! OFF files: the vertices and polygons of ASCII OFF, COFF, NOFF and STOFF.
//!
//! Owns the format. The one maintained library, `off-rs`, knows neither the variants nor
//! ModelNet's counts on the line of the keyword, and rounds coordinates to `f32`; the rest of the
//! format is smaller than a translation of its errors.

use nalgebra::Point3;

use super::content::{BadContent, Place, Soup, leading_point, lines_of_words};
use super::triangulate::Triangulator;

/// A line's number and its words.
type Line<'a> = (usize, Vec<&'a str>);

/// The vertices and the triangulated faces of the OFF file in `bytes`. A vertex is the first three
/// numbers of its line, a face a count and as many indices; colours, normals and texture
/// coordinates behind them are ignored, and so are `#` comments, faces of fewer than three
/// vertices, and whatever follows the last face.
///
/// # Errors
/// [`BadContent`]: no keyword, a variant that is not read (binary, four or n dimensions), counts
/// that are none, a line that is no vertex or face, an index without a vertex, or too few lines.
pub(super) fn parse(bytes: Vec<u8>) -> Result<Soup, BadContent> {
    let text = String::from_utf8_lossy(&bytes);
    let mut lines = lines_of_words(&text);
    let (vertex_count, face_count) = read_counts(&mut lines)?;

    // A header may promise anything: nothing is reserved for it.
    let mut vertices: Vec<Point3<f64>> = Vec::new();
    while vertices.len() < vertex_count {
        let (number, words) = lines
            .next()
            .ok_or_else(|| too_short("vertices", vertex_count, vertices.len()))?;
        let vertex = leading_point(&words)
            .ok_or_else(|| bad_line("a vertex: three numbers", number, &words))?;
        vertices.push(vertex);
    }
    let mut triangulator = Triangulator::default();
    let (mut triangles, mut polygon) = (Vec::new(), Vec::new());
    for read in 0..face_count {
        let (number, words) = lines
            .next()
            .ok_or_else(|| too_short("faces", face_count, read))?;
        read_polygon(number, &words, vertices.len(), &mut polygon)?;
        if polygon.len() >= 3 {
            triangulator.append(&polygon, &vertices, &mut triangles);
        }
    }
    Ok((vertices, triangles))
}

/// The numbers of vertices and faces behind the keyword, on its line or on the next; the number of
/// edges is ignored.
fn read_counts<'a>(
    lines: &mut impl Iterator<Item = Line<'a>>,
) -> Result<(usize, usize), BadContent> {
    let (number, mut words) = lines.next().unwrap_or_default();
    let keyword = words.first().copied().unwrap_or_default();
    let end = keyword
        .find("OFF")
        .map(|begin| (begin, begin + "OFF".len()));
    let Some((begin, end)) = end.filter(|&(begin, _)| is_variant(&keyword[..begin])) else {
        let place = (number > 0).then_some(Place::Line(number));
        let found = format!("`{}`", words.join(" "));
        return Err(BadContent::new(place, "the keyword `OFF`", found));
    };
    if keyword[..begin].contains(['4', 'n']) {
        return Err(BadContent::new(
            Some(Place::Line(number)),
            "an OFF file of three dimensions",
            format!("`{}`", &keyword[..end]),
        ));
    }
    match &keyword[end..] {
        "" => drop(words.remove(0)),
        glued => words[0] = glued,
    }
    if words
        .first()
        .is_some_and(|w| w.eq_ignore_ascii_case("binary"))
    {
        return Err(BadContent::new(
            Some(Place::Line(number)),
            "an OFF file of text",
            "a binary one",
        ));
    }
    let (number, words) = if words.is_empty() {
        lines.next().unwrap_or((number + 1, words))
    } else {
        (number, words)
    };
    let count = |index: usize| words.get(index).and_then(|word| word.parse().ok());
    match (count(0), count(1)) {
        (Some(vertices), Some(faces)) if words.len() <= 3 => Ok((vertices, faces)),
        _ => Err(bad_line(
            "the numbers of vertices, faces and edges",
            number,
            &words,
        )),
    }
}

/// Whether what stands before `OFF` is made of its prefixes: texture coordinates, colours,
/// normals, four dimensions, n dimensions.
fn is_variant(prefix: &str) -> bool {
    let rest = prefix.strip_prefix("ST").unwrap_or(prefix);
    rest.len() <= 4 && rest.chars().all(|c| matches!(c, 'C' | 'N' | '4' | 'n'))
}

fn read_polygon(
    number: usize,
    words: &[&str],
    vertices: usize,
    polygon: &mut Vec<u32>,
) -> Result<(), BadContent> {
    let corners = words.first().and_then(|word| word.parse::<usize>().ok());
    let indices = corners.and_then(|corners| words[1..].get(..corners));
    let indices = indices.ok_or_else(|| {
        bad_line(
            "a face: how many vertices, and their indices",
            number,
            words,
        )
    })?;
    polygon.clear();
    for word in indices {
        match word.parse::<u32>() {
            Ok(index) if (index as usize) < vertices => polygon.push(index),
            _ => {
                return Err(BadContent::new(
                    Some(Place::Line(number)),
                    format!("indices of the {vertices} vertices, counted from 0"),
                    format!("`{word}`"),
                ));
            }
        }
    }
    Ok(())
}

fn bad_line(expected: &str, number: usize, words: &[&str]) -> BadContent {
    let found = match words {
        [] => "nothing".to_owned(),
        _ => format!("`{}`", words.join(" ")),
    };
    BadContent::new(Some(Place::Line(number)), expected, found)
}

fn too_short(what: &str, promised: usize, read: usize) -> BadContent {
    BadContent::new(
        None,
        format!("the {promised} {what} that the header announces"),
        format!("{read}"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: &str = "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0.25\n0 1 0\n4 0 1 2 3\n";

    fn error(text: &str) -> BadContent {
        parse(text.into()).unwrap_err()
    }

    fn assert_is_the_square(text: &str) {
        let (vertices, triangles) = parse(text.into()).unwrap();
        assert_eq!(vertices.len(), 4, "{text}");
        assert_eq!(vertices[2], Point3::new(1.0, 1.0, 0.25));
        assert_eq!(triangles, [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn counts_may_stand_on_the_line_of_the_keyword_or_touch_it() {
        for counts in [
            "OFF\n4 1 0",
            "OFF 4 1 0",
            "OFF4 1 0",
            "OFF4 1",
            "OFF\r\n\r\n4 1 4\r",
        ] {
            assert_is_the_square(&SQUARE.replace("OFF\n4 1 0", counts));
        }
    }

    #[test]
    fn comments_and_columns_behind_the_coordinates_are_ignored() {
        let text = "# made by hand\nCOFF # colours\n4 1 0\n\n0 0 0 255 0 0 255\n\
                    1 0 0 0 0 1.0 1\n1 1 0.25 # corner\n0 1 0 red\n4 0 1 2 3 255 0 0\nrest";
        assert_is_the_square(text);
        for variant in ["NOFF", "CNOFF", "STCNOFF"] {
            assert_is_the_square(&text.replace("COFF", variant));
        }
    }

    #[test]
    fn concave_polygons_are_covered_once() {
        let dented = SQUARE.replace("1 1 0.25", "0.1 0.1 0");
        let (_, triangles) = parse(dented.replace("4 0 1 2 3", "4 1 2 3 0").into()).unwrap();
        assert!(triangles.iter().all(|t| t.contains(&0) && t.contains(&2)));
    }

    #[test]
    fn a_file_without_faces_has_vertices_only() {
        let cloud = SQUARE.replace("4 1 0", "4 0 0");
        assert_eq!(parse(cloud.into()).unwrap().1, [[0; 3]; 0]);
        let lines = SQUARE.replace("4 0 1 2 3", "2 0 1");
        assert_eq!(parse(lines.into()).unwrap().1, [[0; 3]; 0]);
    }

    #[test]
    fn variants_that_are_not_read_are_named() {
        let bad = error(&SQUARE.replace("OFF\n", "OFF BINARY\n"));
        assert_eq!(
            (bad.expected.as_str(), bad.found.as_str()),
            ("an OFF file of text", "a binary one")
        );
        for variant in ["4OFF", "nOFF", "C4nOFF"] {
            assert_eq!(
                error(&SQUARE.replace("OFF", variant)).found,
                format!("`{variant}`")
            );
        }
        for other in ["PLY", "XOFF", "", "é"] {
            assert_eq!(
                error(&SQUARE.replace("OFF", other)).expected,
                "the keyword `OFF`"
            );
        }
    }

    #[test]
    fn what_is_wrong_names_its_line() {
        for (from, to, line) in [
            ("4 1 0", "4", 2),
            ("4 1 0", "-4 1 0", 2),
            ("4 1 0", "4 1 0 0", 2),
            ("4 1 0", "99999999999999999999 1 0", 2),
            ("1 1 0.25", "1 one 0.25", 5),
            ("1 1 0.25", "1 1", 5),
            ("4 0 1 2 3", "4 0 1 2", 7),
            ("4 0 1 2 3", "4 0 1 2 4", 7),
            ("4 0 1 2 3", "4 0 1 2 -1", 7),
            ("4 0 1 2 3", "18446744073709551615 0 1 2 3", 7),
            ("4 0 1 2 3", "x", 7),
        ] {
            let bad = error(&SQUARE.replace(from, to));
            assert_eq!(bad.place, Some(Place::Line(line)), "{to}: {bad:?}");
        }
    }

    #[test]
    fn counts_beyond_the_file_cost_nothing_and_are_errors() {
        let bad = error("OFF\n18446744073709551615 18446744073709551615 0\n0 0 0\n");
        assert!(
            bad.expected.contains("18446744073709551615 vertices"),
            "{bad:?}"
        );
        assert_eq!(bad.found, "1");
        let bad = error(&SQUARE.replace("4 1 0", "4 4000000000 0"));
        assert!(bad.expected.contains("4000000000 faces"), "{bad:?}");
        assert!(parse(b"OFF\n0 0 0\n".to_vec()).unwrap().0.is_empty());
    }

    #[test]
    fn a_truncated_file_is_an_error_at_every_length() {
        for length in 0..SQUARE.len() - "3\n".len() {
            assert!(
                parse(SQUARE.as_bytes()[..length].to_vec()).is_err(),
                "{length}"
            );
        }
    }
}
