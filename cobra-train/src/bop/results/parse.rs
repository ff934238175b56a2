//! From the bytes of a results file to its rows.

use super::{COLUMNS, PoseEstimate, ReadResultsError, Results, Row, RowError};
use csv::ByteRecord;
use std::path::Path;

/// How much of what was found a message quotes.
const QUOTED: usize = 60;

pub(super) fn parse(bytes: &[u8], path: &Path) -> Result<Results, ReadResultsError> {
    let text = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(bytes);
    let mut lines = (1..).zip(text.split(|byte| *byte == b'\n').map(without_return));
    let header = lines.next().map(|(_, line)| line).unwrap_or_default();
    let names: Vec<String> = record(header).iter().map(text_of).collect();
    if !names.iter().map(|name| name.trim()).eq(COLUMNS) {
        return Err(ReadResultsError::Header {
            path: path.to_owned(),
            found: match text_of(header).trim() {
                "" => "nothing".to_owned(),
                found => short(found),
            },
        });
    }
    let filled = lines.filter(|(_, line)| !line.trim_ascii().is_empty());
    Ok(Results {
        rows: filled
            .map(|(number, line)| row(number, &record(line)))
            .collect(),
    })
}

fn without_return(line: &[u8]) -> &[u8] {
    line.strip_suffix(b"\r").unwrap_or(line)
}

/// The fields of one line. Lines are taken apart one by one, so that a quote that is never closed
/// does not swallow the rows below.
fn record(line: &[u8]) -> ByteRecord {
    let mut record = ByteRecord::new();
    let read = csv::ReaderBuilder::new()
        .has_headers(false)
        .buffer_capacity(line.len().max(1))
        .terminator(csv::Terminator::Any(b'\n'))
        .from_reader(line)
        .read_byte_record(&mut record);
    // Memory cannot fail to be read, and one record cannot differ in length from others.
    debug_assert!(read.is_ok());
    record
}

fn row(line: u64, record: &ByteRecord) -> Row {
    let fields: Vec<String> = record.iter().map(text_of).collect();
    let is_text = record
        .iter()
        .all(|field| std::str::from_utf8(field).is_ok());
    Row {
        line,
        estimate: if is_text {
            estimate(&fields)
        } else {
            Err(RowError::NotUtf8)
        },
        fields,
    }
}

fn estimate(fields: &[String]) -> Result<PoseEstimate, RowError> {
    let [scene_id, im_id, obj_id, score, r, t, time] = fields else {
        return Err(RowError::Fields {
            found: fields.len(),
        });
    };
    for (column, field) in COLUMNS.into_iter().zip(fields) {
        if field.contains('\r') {
            return Err(RowError::Lines { column });
        }
    }
    let [score] = numbers("score", score)?;
    let [time] = numbers("time", time)?;
    Ok(PoseEstimate {
        scene_id: id("scene_id", scene_id)?,
        im_id: id("im_id", im_id)?,
        obj_id: id("obj_id", obj_id)?,
        score,
        r: numbers("R", r)?,
        t: numbers("t", t)?,
        time,
    })
}

fn id(column: &'static str, field: &str) -> Result<u32, RowError> {
    let found = field.trim();
    found.parse().map_err(|_| RowError::Id {
        column,
        found: short(found),
    })
}

fn numbers<const N: usize>(column: &'static str, field: &str) -> Result<[f64; N], RowError> {
    let mut numbers = [0.0; N];
    let mut words = field.split_whitespace();
    for (found, number) in numbers.iter_mut().enumerate() {
        let word = words.next().ok_or(RowError::Count {
            column,
            expected: N,
            found,
        })?;
        *number = word
            .parse()
            .ok()
            .filter(|number: &f64| number.is_finite())
            .ok_or_else(|| RowError::Number {
                column,
                found: short(word),
            })?;
    }
    match words.count() {
        0 => Ok(numbers),
        more => Err(RowError::Count {
            column,
            expected: N,
            found: N + more,
        }),
    }
}

fn text_of(field: &[u8]) -> String {
    String::from_utf8_lossy(field).into_owned()
}

/// The text without what would break a line, cut short.
fn short(text: &str) -> String {
    let one_line = text.chars().map(|c| if c.is_control() { ' ' } else { c });
    one_line.take(QUOTED).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "scene_id,im_id,obj_id,score,R,t,time";
    const GOOD: &str = "2,3,1,0.5,1 0 0 0 1 0 0 0 1,10 -20.5 1e3,-1";

    fn read(text: &str) -> Result<Results, ReadResultsError> {
        parse(text.as_bytes(), Path::new("some.csv"))
    }

    fn only_row(line: &str) -> Row {
        let mut results = read(&format!("{HEADER}\n{line}\n")).unwrap();
        assert_eq!(results.rows.len(), 1);
        results.rows.remove(0)
    }

    #[test]
    fn a_row_is_read_whatever_program_wrote_it() {
        let expected = PoseEstimate {
            scene_id: 2,
            im_id: 3,
            obj_id: 1,
            score: 0.5,
            r: [1., 0., 0., 0., 1., 0., 0., 0., 1.],
            t: [10.0, -20.5, 1000.0],
            time: -1.0,
        };
        let quoted = GOOD.replace("1 0 0 0 1 0 0 0 1", "\"1 0 0  0 1 0 0 0 1 \"");
        let blanks = GOOD.replace(',', " , ");
        for text in [
            format!("{HEADER}\n{GOOD}"),
            format!("\u{feff}{HEADER}\r\n{GOOD}\r\n"),
            format!("{HEADER}\n{quoted}\n"),
            format!("{}\n{blanks}\n", HEADER.replace(',', ", ")),
            format!("{HEADER}\n\n{GOOD}\n\n  \n"),
            format!(
                "{HEADER}\n{}\n",
                GOOD.replace("2,3,1", "000002,000003,000001")
            ),
        ] {
            let rows = read(&text).unwrap().rows;
            assert_eq!(rows.len(), 1, "{text}");
            assert_eq!(rows[0].estimate, Ok(expected), "{text}");
        }
    }

    #[test]
    fn the_line_is_the_files_and_the_fields_are_verbatim() {
        let text = format!("{HEADER}\r\n{GOOD}\r\n\r\n 2,3,1,0.50,a,b,c\r\n");
        let rows = read(&text).unwrap().rows;
        assert_eq!((rows[0].line, rows[1].line), (2, 4));
        assert_eq!(rows[1].fields[..4], [" 2", "3", "1", "0.50"]);
    }

    #[test]
    fn a_bad_row_says_what_was_expected_and_found_and_the_others_are_read() {
        for (from, to, expected) in [
            (" 0 1,", " 0,", "R: expected 9 numbers, found 8"),
            (" 0 1,", " 0 1 7 7,", "R: expected 9 numbers, found 11"),
            (",10 ", ",", "t: expected 3 numbers, found 2"),
            (
                "0 1,",
                "0 nan,",
                "R: expected a finite number, found \"nan\"",
            ),
            (
                "1e3",
                "1e999",
                "t: expected a finite number, found \"1e999\"",
            ),
            (
                "0.5",
                "high",
                "score: expected a finite number, found \"high\"",
            ),
            ("0.5", "", "score: expected 1 number, found 0"),
            (
                "0.5",
                "NaN",
                "score: expected a finite number, found \"NaN\"",
            ),
            (
                "3,1,",
                "3,1.0,",
                "obj_id: expected a whole number, found \"1.0\"",
            ),
            (
                "2,3",
                "-2,3",
                "scene_id: expected a whole number, found \"-2\"",
            ),
            ("2,3", "2,99999999999", "im_id: expected a whole number"),
            (",-1", "", "expected 7 fields, found 6"),
            (",-1", ",-1,", "expected 7 fields, found 8"),
            ("0 1 0", "\"0\n1 0", "expected 7 fields"),
            (
                "10 -20.5 1e3",
                "10 -20.5\r1e3",
                "t: expected a field on one line",
            ),
        ] {
            let bad = GOOD.replacen(from, to, 1);
            let rows = read(&format!("{HEADER}\n{GOOD}\n{bad}\n")).unwrap().rows;
            assert!(rows[0].estimate.is_ok());
            let error = rows[1].estimate.clone().unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
            assert_eq!((rows[1].line, error.lines().count()), (3, 1));
        }
    }

    #[test]
    fn bytes_that_are_no_text_spoil_their_row_alone() {
        let text = [
            HEADER.as_bytes(),
            b"\n2,3,\xff,",
            GOOD.as_bytes(),
            b"\n",
            GOOD.as_bytes(),
        ];
        let rows = parse(&text.concat(), Path::new("x")).unwrap().rows;
        assert_eq!(rows[0].estimate, Err(RowError::NotUtf8));
        assert!(rows[1].estimate.is_ok());
    }

    #[test]
    fn another_header_is_an_error_of_the_file() {
        for text in [
            String::new(),
            format!("{GOOD}\n{GOOD}\n"),
            HEADER.replace("R,t", "t,R"),
            format!("{HEADER},more\n"),
            HEADER.replace(',', ";"),
        ] {
            let error = read(&text).unwrap_err().to_string();
            let expected =
                "some.csv: line 1: expected the header scene_id,im_id,obj_id,score,R,t,time";
            assert!(error.starts_with(expected), "{error}");
            assert_eq!(error.lines().count(), 1);
        }
        assert!(read("").unwrap_err().to_string().ends_with("found nothing"));
    }

    #[test]
    fn a_quote_that_is_never_closed_spoils_its_row_alone() {
        let bad = GOOD.replace("0.5,", "\"0.5,");
        let rows = read(&format!("{HEADER}\n{bad}\n{GOOD}\n")).unwrap().rows;
        assert_eq!(rows[0].estimate, Err(RowError::Fields { found: 4 }));
        assert!(rows[1].estimate.is_ok());
    }

    #[test]
    fn a_missing_file_is_named() {
        let error = super::super::read_results(Path::new("no/such.csv")).unwrap_err();
        assert!(error.is_io() && error.to_string().starts_with("no/such.csv: "));
    }

    #[test]
    fn a_pose_is_of_the_nearest_rotation_and_a_matrix_that_is_none_is_refused() {
        let scaled =
            only_row(&GOOD.replace("1 0 0 0 1 0 0 0 1", ".99985 0 0 0 .99985 0 0 0 .99985"));
        let estimate = scaled.estimate.unwrap();
        assert_eq!(estimate.r[0], 0.99985);
        let rotation = estimate.isometry().unwrap().rotation;
        assert!(rotation.angle() < 1e-9 && (rotation.norm() - 1.0).abs() < 1e-15);
        assert!((estimate.pose().unwrap().rotation()[(0, 0)] - 1.0).abs() < 1e-6);
        let zeros = only_row(&GOOD.replace("1 0 0 0 1 0 0 0 1", "0 0 0 0 0 0 0 0 0"));
        let zeros = zeros.estimate.unwrap();
        assert!(zeros.isometry().is_err() && zeros.pose().is_err());
    }
}
