//! What a template knows for depth mode.
//!
//! Owns the section's layout, its ranges, and how it is read and written. Loading checks it, because a
//! controller decides by it; how a pose is scored against a depth image is not its business.

use super::error::{Section, TemplateError};
use super::number::Number;
use super::validate_components::normal;
use super::wire::DepthSection;
use crate::gp::Word;

/// Most bytes in the words that say where a calibration comes from.
pub const PROVENANCE_CAPACITY: usize = 48;

/// Words in a calibration.
const CALIBRATION_WORDS: usize = 10;

/// Bytes in a calibration.
pub const CALIBRATION_LENGTH: usize = CALIBRATION_WORDS * 4;

/// A calibration as it lies in the file: accept, reject, target, share, low, high (all `f32`); minimum
/// of points, wrong, right, where the labels come from (all `u32`).
type Record = [Word; CALIBRATION_WORDS];

/// Where the labels of a calibration come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum CalibrationSource {
    /// Estimates of which somebody knows whether they are right.
    Labelled,
    /// Pose errors that were simulated on the object.
    Simulated,
}

impl CalibrationSource {
    /// All of them, in the order of their numbers in the file.
    pub const ALL: [Self; 2] = [Self::Labelled, Self::Simulated];

    /// `labelled` or `simulated`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Labelled => "labelled",
            Self::Simulated => "simulated",
        }
    }
}

/// A share that was measured, with the bounds of its Wilson interval at 95 %: 0 ≤ low ≤ share ≤
/// high ≤ 1.
///
/// Reference: E. B. Wilson, Probable inference, the law of succession, and statistical inference,
/// J. Am. Stat. Assoc. 22 (1927).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct MeasuredShare {
    /// What was measured.
    pub share: f32,
    /// The interval's lower bound.
    pub low: f32,
    /// Its upper bound.
    pub high: f32,
}

/// Two thresholds on the confidence of depth mode, and what they were measured on.
///
/// A confidence of at least `accept` is accepted, one below `reject` is rejected; between them, and with
/// fewer valid pixels than `minimum_points`, the answer is undecided.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Calibration {
    /// The least confidence that is accepted: 0 ≤ `reject` ≤ `accept` ≤ 1.
    pub accept: f32,
    /// The least confidence that is not rejected.
    pub reject: f32,
    /// With fewer valid pixels than this no confidence decides.
    pub minimum_points: u32,
    /// The share of wrong estimates that was to be accepted at most, above 0 and at most 1.
    pub target: f32,
    /// The share of wrong estimates that `accept` did accept.
    pub false_accepts: MeasuredShare,
    /// How many wrong estimates it was measured on, at least one.
    pub wrong: u32,
    /// How many right ones, at least one.
    pub right: u32,
    /// Where the labels come from.
    pub source: CalibrationSource,
}

/// What a template knows for depth mode, as it is read.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct DepthRecord<'a> {
    /// The measurement's standard deviation σ_m as a share of the object's diameter: finite and at
    /// least [`f32::MIN_POSITIVE`].
    pub noise_share: f32,
    /// The thresholds, where they were calibrated.
    pub calibration: Option<Calibration>,
    provenance: &'a [u8],
}

/// What is written of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthSource<'a> {
    /// As [`DepthRecord::noise_share`].
    pub noise_share: f32,
    /// As [`DepthRecord::calibration`].
    pub calibration: Option<Calibration>,
    /// Where the calibration comes from, in at most [`PROVENANCE_CAPACITY`] bytes; empty without one.
    pub provenance: &'a str,
}

impl<'a> DepthRecord<'a> {
    /// σ_m as a share of the diameter, for templates that do not say theirs.
    ///
    /// Of 5 % to 10 % all order the estimates of LineMOD-Occlusion about as well; with 6 % a threshold that was
    /// found on some objects accepts no more wrong estimates of others than it should (`docs/DEPTH.md`).
    pub const NOISE_SHARE: f32 = 0.06;

    /// Where the calibration comes from, in words; of bytes that are no UTF-8, what there is before the
    /// first such byte. Loading does not look at it, as at [`super::Template::name`].
    #[must_use]
    pub fn provenance(&self) -> &'a str {
        super::text(self.provenance)
    }

    /// The section's body, checked.
    pub(super) fn read(body: &'a [u8]) -> Result<Self, TemplateError> {
        let section: DepthSection<'a> = super::validate::decode(Section::Depth, body)?;
        let malformed = TemplateError::MalformedSection {
            section: Section::Depth,
        };
        let noise_share = f32::from_le_bytes(section.noise_share);
        if !normal(noise_share) {
            return Err(TemplateError::DepthNumber {
                number: Number::NoiseShare,
                found: noise_share,
            });
        }
        let calibration = match section.calibration {
            [] => None,
            bytes => {
                let (words, odd) = bytes.as_chunks();
                let record = <&Record>::try_from(words).map_err(|_| malformed)?;
                if !odd.is_empty() {
                    return Err(malformed);
                }
                Some(Calibration::from_record(record)?)
            }
        };
        let most = match calibration {
            Some(_) => PROVENANCE_CAPACITY,
            None => 0,
        };
        if section.provenance.len() > most {
            return Err(malformed);
        }
        Ok(Self {
            noise_share,
            calibration,
            provenance: section.provenance,
        })
    }
}

impl Calibration {
    fn from_record(record: &Record) -> Result<Self, TemplateError> {
        let [accept, reject, target, share, low, high, counts @ ..] = *record;
        let [accept, reject, target, share, low, high] =
            [accept, reject, target, share, low, high].map(f32::from_le_bytes);
        let [minimum_points, wrong, right, source] = counts.map(u32::from_le_bytes);
        let source = match source {
            0 => CalibrationSource::Labelled,
            1 => CalibrationSource::Simulated,
            _ => {
                return Err(TemplateError::MalformedSection {
                    section: Section::Depth,
                });
            }
        };
        // Each from what must not lie above it to what must not lie below it; of a NaN neither holds.
        for (number, least, found, most) in [
            (Number::Accept, 0.0, accept, 1.0),
            (Number::Reject, 0.0, reject, accept),
            (Number::Target, f32::MIN_POSITIVE, target, 1.0),
            (Number::FalseAccepts, 0.0, share, 1.0),
            (Number::LowerBound, 0.0, low, share),
            (Number::UpperBound, share, high, 1.0),
        ] {
            if !(least <= found && found <= most) {
                return Err(TemplateError::DepthNumber { number, found });
            }
        }
        if wrong == 0 || right == 0 {
            return Err(TemplateError::DepthNumber {
                number: Number::Estimates,
                found: 0.0,
            });
        }
        Ok(Self {
            accept,
            reject,
            minimum_points,
            target,
            false_accepts: MeasuredShare { share, low, high },
            wrong,
            right,
            source,
        })
    }

    /// The record that reads as this.
    pub(super) fn to_record(self) -> Record {
        let MeasuredShare { share, low, high } = self.false_accepts;
        let source = match self.source {
            CalibrationSource::Labelled => 0_u32,
            CalibrationSource::Simulated => 1,
        };
        [
            self.accept.to_le_bytes(),
            self.reject.to_le_bytes(),
            self.target.to_le_bytes(),
            share.to_le_bytes(),
            low.to_le_bytes(),
            high.to_le_bytes(),
            self.minimum_points.to_le_bytes(),
            self.wrong.to_le_bytes(),
            self.right.to_le_bytes(),
            source.to_le_bytes(),
        ]
    }
}
