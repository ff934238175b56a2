//! Curves of a calibration, as `cobra calibrate --curves` writes them.
//!
//! Owns that they are of this template: a curve must say as many estimates and the same threshold as the
//! template's calibration.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use cobra_infer::template::Calibration;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// The files of a folder, and what each shows.
pub const CURVES: [(&str, &str); 3] = [
    (
        "roc.svg",
        "Right against wrong estimates that are accepted, for every threshold",
    ),
    (
        "precision-recall.svg",
        "How many of the accepted estimates are right, and how many of the right ones are accepted",
    ),
    (
        "reliability.svg",
        "How often estimates of a confidence are right",
    ),
];

/// Larger files are no curves.
const MOST_BYTES: u64 = 4 << 20;

/// A curve, as an image that needs no other file.
#[derive(Clone, Debug, Serialize)]
pub struct Curve {
    /// What it shows.
    pub title: &'static str,
    /// An SVG, as a `data:` address. As an image, not as part of the page: no script of it would run.
    #[serde(skip)]
    pub address: String,
}

/// Why there are no curves.
#[derive(Debug, thiserror::Error)]
pub enum ReadCurvesError {
    /// The system refused.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// It is no picture of a curve.
    #[error("{}: expected an SVG as cobra calibrate --curves writes it, found {found}", path.display())]
    NoCurve {
        /// The file.
        path: PathBuf,
        /// What it is.
        found: String,
    },
    /// It is of other estimates than the template's thresholds, or of another threshold.
    #[error(
        "{}: expected curves of the template's calibration, on {expected}: these are of others or of another threshold", path.display()
    )]
    OtherEstimates {
        /// The file.
        path: PathBuf,
        /// What the template says.
        expected: String,
    },
    /// The template has no thresholds that they could be of.
    #[error("the template stores no thresholds that curves could be of: run cobra calibrate first")]
    NotCalibrated,
}

impl ReadCurvesError {
    /// Whether the system refused, rather than a file being wrong.
    #[must_use]
    pub fn is_io(&self) -> bool {
        matches!(self, Self::Io { .. })
    }
}

/// The curves in a folder, which must be of the calibration that the template stores.
///
/// # Errors
/// [`ReadCurvesError`].
pub fn read_curves(
    folder: &Path,
    calibration: Option<&Calibration>,
) -> Result<Vec<Curve>, ReadCurvesError> {
    let calibration = calibration.ok_or(ReadCurvesError::NotCalibrated)?;
    let estimates = format!(
        "{} right and {} wrong estimates",
        calibration.right, calibration.wrong
    );
    let threshold = format!("accepted from {:.3}", calibration.accept);
    CURVES
        .iter()
        .map(|(name, title)| {
            let path = folder.join(name);
            let text = text(&path)?;
            if !text.trim_start().starts_with("<svg") {
                let found = text.chars().take(20).collect();
                return Err(ReadCurvesError::NoCurve { path, found });
            }
            // Not "110 right" for "10 right".
            let alone = |at: usize| !text[..at].ends_with(|c: char| c.is_ascii_digit());
            let same = text.match_indices(&estimates).any(|(at, _)| alone(at));
            if !same || !text.contains(&threshold) {
                return Err(ReadCurvesError::OtherEstimates {
                    path,
                    expected: format!("{estimates}, {threshold}"),
                });
            }
            Ok(Curve {
                title,
                address: format!("data:image/svg+xml;base64,{}", STANDARD.encode(text)),
            })
        })
        .collect()
}

fn text(path: &Path) -> Result<String, ReadCurvesError> {
    let io = |source| ReadCurvesError::Io {
        path: path.to_owned(),
        source,
    };
    let metadata = path.metadata().map_err(io)?;
    if !metadata.is_file() || metadata.len() > MOST_BYTES {
        return Err(ReadCurvesError::NoCurve {
            path: path.to_owned(),
            found: "no file, or a very large one".to_owned(),
        });
    }
    std::fs::read_to_string(path).map_err(io)
}
