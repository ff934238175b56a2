//! The same results with other scores.

use super::{COLUMNS, PoseEstimate, Results};
use std::fmt::Display;

/// The score of an estimate that has none: below every confidence.
const NOT_SCORED: &str = "-1";

impl Results {
    /// The file's bytes with `score` replaced: the same rows in the same order, every other field
    /// byte for byte as it was read, lines ended by `\n`.
    ///
    /// `new_score` is asked of every estimate, with its index among [`Results::rows`]; where it
    /// knows none, or one that is not finite, the row gets −1. Numbers are written with the fewest
    /// digits that are read back as the same `f32` or `f64`. Rows that are no estimates are left
    /// out: `bop_toolkit` reads no file that has one.
    #[must_use]
    pub fn rescored<S: Copy + Display + Into<f64>>(
        &self,
        mut new_score: impl FnMut(usize, &PoseEstimate) -> Option<S>,
    ) -> String {
        let mut text = COLUMNS.join(",");
        text.push('\n');
        for (index, row) in self.rows.iter().enumerate() {
            let Ok(estimate) = &row.estimate else {
                continue;
            };
            let score = new_score(index, estimate).filter(|&score| score.into().is_finite());
            let score = score.map_or_else(|| NOT_SCORED.to_owned(), |score| score.to_string());
            for (place, (column, field)) in COLUMNS.iter().zip(&row.fields).enumerate() {
                if place > 0 {
                    text.push(',');
                }
                text.push_str(if *column == "score" { &score } else { field });
            }
            text.push('\n');
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::super::parse::parse;
    use std::path::Path;

    const FILE: &str = "\u{feff}scene_id,im_id,obj_id,score,R,t,time\r\n\
        2,3,01,0.50,\"1.0 0 0 0 1 0 0 0  1\",10 -20.50 1e3,-1\r\n\
        2,3,5,0.9,1 0 0 0 1 0 0 0,1 2 3,-1\r\n\
        2,3,6,1,1 0 0 0 1 0 0 0 1, 1 2 3,0.250\r\n";

    #[test]
    fn only_the_score_changes_and_what_is_no_estimate_is_left_out() {
        let results = parse(FILE.as_bytes(), Path::new("some.csv")).unwrap();
        let mut asked = Vec::new();
        let text = results.rescored(|index, estimate| {
            asked.push((index, estimate.obj_id));
            (estimate.obj_id == 1).then_some(0.1_f32)
        });
        assert_eq!(asked, [(0, 1), (2, 6)]);
        assert_eq!(
            text,
            "scene_id,im_id,obj_id,score,R,t,time\n\
             2,3,01,0.1,1.0 0 0 0 1 0 0 0  1,10 -20.50 1e3,-1\n\
             2,3,6,-1,1 0 0 0 1 0 0 0 1, 1 2 3,0.250\n"
        );
        let again = parse(text.as_bytes(), Path::new("some.csv")).unwrap();
        assert!(again.rows.iter().all(|row| row.estimate.is_ok()));
    }

    #[test]
    fn scores_are_written_so_that_the_same_number_is_read_back() {
        let results = parse(FILE.as_bytes(), Path::new("some.csv")).unwrap();
        let score_of = |text: &str| -> f64 {
            let rows = parse(text.as_bytes(), Path::new("x")).unwrap().rows;
            rows[0].estimate.as_ref().unwrap().score
        };
        for score in [0.1, 1.0 / 3.0, 1e-30, f64::MIN_POSITIVE, 1.0] {
            assert_eq!(score_of(&results.rescored(|_, _| Some(score))), score);
        }
        let single = 1.0_f32 / 3.0;
        let text = results.rescored(|_, _| Some(single));
        assert!(text.contains(",0.33333334,"), "{text}");
        for nothing in [f64::NAN, f64::INFINITY] {
            assert_eq!(score_of(&results.rescored(|_, _| Some(nothing))), -1.0);
        }
    }
}
