//! Reports of scored estimates: JSON as `cobra bop score --report` writes it.

use super::json::{Misfit, to_f32};
use super::read_text;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// What was said of every estimate of a results file.
#[derive(Clone, Debug, PartialEq)]
pub struct ScoreReport {
    /// The dataset's name, where the report has one.
    pub dataset: Option<String>,
    /// The estimates, in the report's order.
    pub estimates: Vec<ReportedEstimate>,
}

/// What was said of one estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReportedEstimate {
    /// Its row in the results file.
    pub row: u64,
    /// The object's id.
    pub object: Option<u64>,
    /// Its score, from 0 to 1; none where it could not be scored.
    pub scored: Option<ScoredEstimate>,
    /// Whether it is right, where the truth is known.
    pub right: Option<bool>,
}

/// The score of an estimate in depth mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScoredEstimate {
    /// The confidence, from 0 to 1.
    pub confidence: f32,
    /// Pixels that it rests on.
    pub valid_pixels: u32,
    /// With fewer of them the confidence was 0 whatever they said; `None` where the report does not say.
    pub minimum_points: Option<u32>,
}

/// Why a file is no such report.
#[derive(Debug, thiserror::Error)]
pub enum ReadReportError {
    /// The file could not be read.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The file is not JSON; the message holds line and column.
    #[error("{}: not valid JSON: {source}", path.display())]
    Json {
        /// The file.
        path: PathBuf,
        /// What is wrong, and where.
        source: serde_json::Error,
    },
    /// The JSON does not have the form of a report.
    #[error("{}: {place}: expected {expected}, found {found}", path.display())]
    Form {
        /// The file.
        path: PathBuf,
        /// Where in the document.
        place: String,
        /// What should stand there.
        expected: &'static str,
        /// What does.
        found: String,
    },
}

/// Reads `{"dataset": {"name": …}, "estimates": [{"row": 2, "obj_id": 1, "confidence": 0.83,
/// "valid_pixels": 412, "minimum_points": 10, "truth": {"right": true}}, …]}`; other keys are ignored. A
/// confidence may be `null` or missing, and so may the truth; `minimum_points` may be missing.
///
/// # Errors
/// [`ReadReportError`] names the file and the place in it.
pub fn read_score_report(path: &Path) -> Result<ScoreReport, ReadReportError> {
    let text = read_text(path).map_err(|source| ReadReportError::Io {
        path: path.to_owned(),
        source,
    })?;
    let document: Value = serde_json::from_str(&text).map_err(|source| ReadReportError::Json {
        path: path.to_owned(),
        source,
    })?;
    report(&document).map_err(|misfit| ReadReportError::Form {
        path: path.to_owned(),
        place: misfit.place,
        expected: misfit.expected,
        found: misfit.found,
    })
}

fn report(document: &Value) -> Result<ScoreReport, Misfit> {
    let entries = document
        .get("estimates")
        .and_then(Value::as_array)
        .ok_or_else(|| {
            let found = document.get("estimates").unwrap_or(document);
            Misfit::new("estimates", "a list of estimates", found)
        })?;
    let name = document.pointer("/dataset/name").and_then(Value::as_str);
    let estimates = entries.iter().enumerate();
    Ok(ScoreReport {
        dataset: name.map(str::to_owned),
        estimates: estimates
            .map(|(index, entry)| estimate(&format!("estimates[{index}]"), entry))
            .collect::<Result<_, _>>()?,
    })
}

fn estimate(place: &str, entry: &Value) -> Result<ReportedEstimate, Misfit> {
    let missing = Value::Null;
    let at = |key: &str| entry.get(key).unwrap_or(&missing);
    let misfit = |key: &str, expected| Misfit::new(format!("{place}.{key}"), expected, at(key));
    let whole = |key: &str| {
        at(key)
            .as_u64()
            .ok_or_else(|| misfit(key, "a whole number"))
    };
    let pixels = |key: &str| {
        let number = whole(key)?;
        u32::try_from(number).map_err(|_| misfit(key, "a number of pixels"))
    };
    let scored = match at("confidence") {
        Value::Null => None,
        confidence => Some(ScoredEstimate {
            confidence: to_f32(confidence)
                .filter(|confidence| (0.0..=1.0).contains(confidence))
                .ok_or_else(|| misfit("confidence", "a number from 0 to 1, or null"))?,
            valid_pixels: pixels("valid_pixels")?,
            minimum_points: match at("minimum_points") {
                Value::Null => None,
                _ => Some(pixels("minimum_points")?),
            },
        }),
    };
    let right = match at("truth") {
        Value::Null => None,
        truth => {
            let right = truth.get("right").unwrap_or(&missing);
            let place = || format!("{place}.truth.right");
            let found = right.as_bool();
            Some(found.ok_or_else(|| Misfit::new(place(), "true or false", right))?)
        }
    };
    Ok(ReportedEstimate {
        row: whole("row")?,
        object: match entry.get("obj_id") {
            Some(Value::Null) => None,
            _ => Some(whole("obj_id")?),
        },
        scored,
        right,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = r#"{"dataset": {"name": "lmo"}, "estimates": [
        {"row": 2, "scene_id": 2, "im_id": 3, "obj_id": 1, "own_score": 0.5, "confidence": 0.83,
         "valid_pixels": 412, "minimum_points": 10, "truth": {"error_mm": 4.1, "diameter_mm": 102.1, "right": true}},
        {"row": 3, "obj_id": 5, "confidence": null},
        {"row": 4, "obj_id": 5, "confidence": 0, "valid_pixels": 0}]}"#;

    fn read(text: &str) -> Result<ScoreReport, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("report.json");
        std::fs::write(&path, text).unwrap();
        read_score_report(&path).map_err(|error| error.to_string())
    }

    #[test]
    fn estimates_come_with_what_is_known_of_them() {
        let report = read(GOOD).unwrap();
        assert_eq!(report.dataset.as_deref(), Some("lmo"));
        let [first, second, third] = report.estimates[..] else {
            panic!("{report:?}");
        };
        let scored = ScoredEstimate {
            confidence: 0.83,
            valid_pixels: 412,
            minimum_points: Some(10),
        };
        assert_eq!((first.scored, first.right), (Some(scored), Some(true)));
        assert_eq!((first.row, first.object), (2, Some(1)));
        assert_eq!((second.scored, second.right), (None, None));
        assert_eq!(third.scored.map(|scored| scored.confidence), Some(0.0));
        assert_eq!(third.scored.map(|scored| scored.minimum_points), Some(None));
        assert_eq!(read(r#"{"estimates": []}"#).unwrap().dataset, None);
    }

    #[test]
    fn what_is_missing_or_wrong_is_named_with_its_place() {
        for (from, to, expected) in [
            (
                "0.83",
                "1.5",
                "estimates[0].confidence: expected a number from 0 to 1, or null, found 1.5",
            ),
            ("0.83", "\"high\"", "or null, found \"high\""),
            (
                "412",
                "-1",
                "estimates[0].valid_pixels: expected a whole number, found -1",
            ),
            (
                "412",
                "4294967296",
                "estimates[0].valid_pixels: expected a number of pixels",
            ),
            (
                "\"minimum_points\": 10",
                "\"minimum_points\": 0.5",
                "estimates[0].minimum_points: expected a whole number, found 0.5",
            ),
            (
                "\"obj_id\": 5",
                "\"id\": 5",
                "estimates[1].obj_id: expected a whole number, found nothing",
            ),
            (
                "\"right\": true",
                "\"right\": 1",
                "estimates[0].truth.right: expected true or false, found 1",
            ),
            (
                "\"estimates\"",
                "\"poses\"",
                "estimates: expected a list of estimates",
            ),
            ("{\"dataset\"", "{dataset", "not valid JSON"),
        ] {
            let error = read(&GOOD.replacen(from, to, 1)).unwrap_err();
            assert!(error.contains(expected), "{error}");
            assert!(
                error.contains("report.json") && !error.contains('\n'),
                "{error}"
            );
        }
    }
}
