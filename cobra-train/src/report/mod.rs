//! A page that says whether a template can be trusted: one HTML file that needs nothing else.
//!
//! Owns what is on the page, as data ([`ReportData`]), and how the data becomes HTML ([`html`]). What a
//! template does on a surface is `evaluate`'s to measure, thresholds are `calibrate`'s to find, and the picture
//! that one can turn is drawn by `assets/viewer`, from what [`View`] hands to it.
//!
//! How to read the page: `docs/REPORT.md`.

mod ambiguity;
mod budget;
mod colours;
mod content;
mod coverage;
mod curves;
mod page;
mod verdict;
mod view;

pub use ambiguity::{
    AmbiguityReport, ReadAmbiguityError, ReportedAmbiguity, read_ambiguity_report,
};
pub use budget::{Board, BoardBudget, Instructions, boards, compiler};
pub use content::{Bytes, ComponentData, Content};
pub use coverage::{Coverage, Own, Region};
pub use curves::{CURVES, Curve, ReadCurvesError, read_curves};
pub use page::html;
pub use view::View;

use crate::surface::Geometry;
use cobra_infer::template::{Calibration, DepthRecord};
use cobra_infer::{ScoreError, Settings, Template};
use nalgebra::Point3;
use serde::Serialize;

/// What a page is made of besides the template.
pub struct ReportInput<'a> {
    /// The object that the template was trained from, in the template's unit, and points of its surface that
    /// training did not see ([`crate::evaluate::evaluation_points`]).
    pub object: Option<(&'a Geometry, &'a [Point3<f64>])>,
    /// Curves of its calibration.
    pub curves: Vec<Curve>,
    /// Poses that shape cannot tell apart.
    pub ambiguities: Option<AmbiguityReport>,
    /// Seed of what is drawn at random.
    pub seed: u64,
    /// The command that makes the page, as it was typed.
    pub command: String,
}

/// Everything on the page. Lengths are in the template's unit unless their name says millimetres.
#[derive(Clone, Debug, Serialize)]
pub struct ReportData {
    /// What is in the template.
    pub content: Content,
    /// What it covers of the surface, and what not.
    pub coverage: Coverage,
    /// What it takes on controllers.
    pub budget: Vec<BoardBudget>,
    /// What it knows for checks against depth.
    pub depth: Option<DepthData>,
    /// Curves of its calibration.
    pub curves: Vec<Curve>,
    /// Poses that shape cannot tell apart.
    pub ambiguities: Option<AmbiguityReport>,
    /// The picture that one can turn.
    pub view: View,
    /// How the page was made.
    pub made: Made,
}

/// What the template knows for checks against depth.
#[derive(Clone, Debug, Serialize)]
pub struct DepthData {
    /// σ_m in millimetres.
    pub noise_mm: f64,
    /// Its thresholds.
    pub calibration: Option<CalibrationData>,
}

/// Thresholds, and what they were measured on; shares are percent.
#[derive(Clone, Debug, Serialize)]
pub struct CalibrationData {
    /// The least confidence that is accepted.
    pub accept: f64,
    /// The least that is not rejected.
    pub reject: f64,
    /// With fewer valid pixels the answer is undecided.
    pub minimum_points: u32,
    /// The false-accept rate that was aimed at.
    pub target: f64,
    /// The one that was measured, and its Wilson interval at 95 %.
    pub false_accepts: [f64; 3],
    /// Wrong estimates that it was measured on.
    pub wrong: u32,
    /// Right ones.
    pub right: u32,
    /// `labelled` or `simulated`.
    pub source: &'static str,
    /// Where they come from, in words.
    pub provenance: String,
}

/// How the page was made.
#[derive(Clone, Debug, Serialize)]
pub struct Made {
    /// The command, as it was typed.
    pub command: String,
    /// Of this library.
    pub version: &'static str,
    /// The template's CRC-32, as its header has it.
    pub checksum: u32,
    /// Seed of what was drawn at random.
    pub seed: u64,
}

/// What the page says of a template of which `bytes` are the file.
///
/// # Errors
/// [`ScoreError::TooManyComponents`] beyond [`crate::train::LARGEST_TEMPLATE`].
pub fn report(
    template: &Template<'_>,
    bytes: &[u8],
    input: ReportInput<'_>,
) -> Result<ReportData, ScoreError> {
    let assignment = Settings::for_template(template, 1.0).assignment;
    let (coverage, spoken) = Coverage::new(template, assignment, input.object, input.seed)?;
    let content = Content::new(template, bytes.len(), spoken.as_deref());
    let view = View::new(
        template,
        assignment,
        input.object.map(|(object, _)| object),
        &content,
    )?;
    Ok(ReportData {
        budget: budget::of(template, assignment, input.object.map(|(_, points)| points)),
        depth: template
            .depth()
            .map(|depth| DepthData::new(template, &depth)),
        curves: input.curves,
        ambiguities: input.ambiguities,
        made: Made {
            command: input.command,
            version: env!("CARGO_PKG_VERSION"),
            checksum: checksum(bytes),
            seed: input.seed,
        },
        content,
        coverage,
        view,
    })
}

/// The last word of the header (`docs/FORMAT.md`).
fn checksum(bytes: &[u8]) -> u32 {
    let word = bytes.get(12..16).and_then(<[u8]>::first_chunk);
    u32::from_le_bytes(word.copied().unwrap_or_default())
}

impl DepthData {
    fn new(template: &Template<'_>, depth: &DepthRecord<'_>) -> Self {
        let percent = |share: f32| 100.0 * f64::from(share);
        let of = |calibration: Calibration| CalibrationData {
            accept: f64::from(calibration.accept),
            reject: f64::from(calibration.reject),
            minimum_points: calibration.minimum_points,
            target: percent(calibration.target),
            false_accepts: [
                percent(calibration.false_accepts.share),
                percent(calibration.false_accepts.low),
                percent(calibration.false_accepts.high),
            ],
            wrong: calibration.wrong,
            right: calibration.right,
            source: calibration.source.name(),
            provenance: depth.provenance().to_owned(),
        };
        Self {
            noise_mm: f64::from(
                depth.noise_share * template.diameter() * template.unit().millimetres(),
            ),
            calibration: depth.calibration.map(of),
        }
    }
}
