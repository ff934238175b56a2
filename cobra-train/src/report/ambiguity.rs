//! Ambiguities as `cobra ambiguity --json` writes them.
//!
//! Owns what a page shows of that file and what it refuses; its form, and how they are found, are
//! [`crate::ambiguity`]'s.

use crate::ambiguity::{AmbiguityDocument, SCHEMA};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// A document of more than this share of another diameter is of another object.
const DIAMETER: f64 = 0.01;

/// Larger files are no such document.
const MOST_BYTES: u64 = 64 << 20;

/// What `cobra ambiguity` found.
#[derive(Clone, Debug, Serialize)]
pub struct AmbiguityReport {
    /// In so many views of the object.
    pub views: usize,
    /// With so many rotations in each.
    pub candidates: usize,
    /// Poses of at least this ADD are wrong.
    pub limit_mm: f64,
    /// Whether the template's own threshold said what is accepted.
    pub calibrated: bool,
    /// The mean confidence of the right poses.
    pub true_confidence: f64,
    /// The least confidence that was accepted in some view.
    pub accepted_from: f64,
    /// Those in most views first.
    pub found: Vec<ReportedAmbiguity>,
    /// What follows, a sentence a line.
    pub conclusion: String,
}

/// Wrong poses that score as well as the true one.
#[derive(Clone, Debug, Serialize)]
pub struct ReportedAmbiguity {
    /// The motion, in words.
    pub motion: String,
    /// In so many views.
    pub views: usize,
    /// Their mean confidence.
    pub confidence: f64,
    /// The largest ADD.
    pub add_mm: f64,
    /// The largest ADD-S.
    pub add_s_mm: f64,
    /// The largest MSSD.
    pub mssd_mm: f64,
    /// Whether a data set states the symmetry; `None` where nothing is known of that.
    pub stated: Option<bool>,
}

/// Why a file tells of no ambiguities.
#[derive(Debug, thiserror::Error)]
pub enum ReadAmbiguityError {
    /// The system refused.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// It is no such document.
    #[error("{}: expected what cobra ambiguity --json writes: {what}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        what: String,
    },
    /// It is of another object.
    #[error(
        "{}: expected ambiguities of `{expected}` with a diameter of {expected_mm:.1} mm, found those of \
         `{found}` with one of {found_mm:.1} mm", path.display()
    )]
    OtherObject {
        /// The file.
        path: PathBuf,
        /// The template's name.
        expected: String,
        /// Its diameter.
        expected_mm: f64,
        /// The name in the file.
        found: String,
        /// The diameter there.
        found_mm: f64,
    },
    /// Another threshold said what is accepted.
    #[error(
        "{}: expected ambiguities found {expected}, as the template is now, found those {found}: run cobra \
         ambiguity again", path.display()
    )]
    OtherThreshold {
        /// The file.
        path: PathBuf,
        /// What the template says.
        expected: String,
        /// What the file says.
        found: String,
    },
}

impl ReadAmbiguityError {
    /// Whether the system refused, rather than the file being wrong.
    #[must_use]
    pub fn is_io(&self) -> bool {
        matches!(self, Self::Io { .. })
    }
}

/// More than rounding between a threshold in a template and in a document.
const SAME_THRESHOLD: f64 = 1e-5;

/// Reads what was found of the object of this name and diameter, with this threshold if the template has one.
///
/// # Errors
/// [`ReadAmbiguityError`].
pub fn read_ambiguity_report(
    path: &Path,
    name: &str,
    diameter_mm: f64,
    accept: Option<f64>,
) -> Result<AmbiguityReport, ReadAmbiguityError> {
    let io = |source| ReadAmbiguityError::Io {
        path: path.to_owned(),
        source,
    };
    let malformed = |what: String| ReadAmbiguityError::Malformed {
        path: path.to_owned(),
        what,
    };
    let metadata = path.metadata().map_err(io)?;
    if !metadata.is_file() || metadata.len() > MOST_BYTES {
        return Err(malformed("found no file, or a very large one".to_owned()));
    }
    let text = std::fs::read(path).map_err(io)?;
    let document: AmbiguityDocument =
        serde_json::from_slice(&text).map_err(|error| malformed(error.to_string()))?;
    if document.schema != SCHEMA {
        return Err(malformed(format!(
            "schema {SCHEMA}, found {}",
            document.schema
        )));
    }
    if document.template != name || (document.diameter_mm / diameter_mm - 1.0).abs() > DIAMETER {
        return Err(ReadAmbiguityError::OtherObject {
            path: path.to_owned(),
            expected: name.to_owned(),
            expected_mm: diameter_mm,
            found: document.template,
            found_mm: document.diameter_mm,
        });
    }
    let same = match accept {
        Some(accept) => {
            document.calibrated && (document.accepted_from - accept).abs() < SAME_THRESHOLD
        }
        None => !document.calibrated,
    };
    if !same {
        let threshold = |accept: Option<f64>| {
            accept.map_or_else(
                || "without a threshold of the template's".to_owned(),
                |accept| format!("with the threshold {accept:.4}"),
            )
        };
        let found = document.calibrated.then_some(document.accepted_from);
        return Err(ReadAmbiguityError::OtherThreshold {
            path: path.to_owned(),
            expected: threshold(accept),
            found: threshold(found),
        });
    }
    Ok(AmbiguityReport {
        views: document.views,
        candidates: document.candidates,
        limit_mm: document.limit_mm,
        calibrated: document.calibrated,
        true_confidence: document.true_confidence,
        accepted_from: document.accepted_from,
        found: document
            .ambiguities
            .iter()
            .map(|entry| ReportedAmbiguity {
                motion: entry.what.what().words(1.0),
                views: entry.views,
                confidence: entry.confidence,
                add_mm: entry.add_mm,
                add_s_mm: entry.add_s_mm,
                mssd_mm: entry.mssd_mm,
                stated: entry.stated,
            })
            .collect(),
        conclusion: document.conclusion,
    })
}
