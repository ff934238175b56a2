//! XYZ files: a point a line.
//!
//! Owns which lines count. There is no library to speak of: three numbers a line are all of the
//! format.

use super::content::{BadContent, Place, Soup, leading_point, lines_of_words};

/// The points of the XYZ file in `bytes`: the first three numbers of each line, separated by
/// blanks, commas or semicolons. What follows them, such as colours and normals, is ignored, and
/// so are empty lines and what stands behind `#`.
///
/// # Errors
/// [`BadContent`]: a line that does not begin with three numbers.
pub(super) fn parse(bytes: Vec<u8>) -> Result<Soup, BadContent> {
    let text = String::from_utf8_lossy(&bytes);
    let mut points = Vec::new();
    for (line, words) in lines_of_words(&text) {
        let point = leading_point(&words).ok_or_else(|| {
            let found = format!("`{}`", words.join(" "));
            BadContent::new(Some(Place::Line(line)), "three numbers x y z", found)
        })?;
        points.push(point);
    }
    Ok((points, Vec::new()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;

    #[test]
    fn each_line_is_a_point_and_what_follows_is_ignored() {
        let text = "# scanned\n1 2 3\n\n 4,5, 6e0 # seen\r\n-7;8;9 255 0 0 red\n";
        let (points, triangles) = parse(text.into()).unwrap();
        assert!(triangles.is_empty());
        let expected = [[1., 2., 3.], [4., 5., 6.], [-7., 8., 9.]].map(Point3::from);
        assert_eq!(points, expected);
    }

    #[test]
    fn a_line_without_three_numbers_names_itself() {
        for (line, found) in [("1 2", "`1 2`"), ("x y z", "`x y z`"), ("1 2 z", "`1 2 z`")] {
            let bad = parse(format!("0 0 0\n{line}\n").into()).unwrap_err();
            assert_eq!(bad.place, Some(Place::Line(2)));
            assert_eq!(bad.found, found);
        }
        assert!(parse(vec![0xff; 50]).is_err());
        assert_eq!(parse(vec![]).unwrap().0, []);
    }
}
