//! The status numbers: part of the interface's ABI, so that one is appended but never changed.
//!
//! Needs `cobra-infer` alone, so that a program in Rust can take this file and print the same texts.

use cobra_infer::depth::DepthError;
use cobra_infer::{CameraError, PoseError, ScoreError, TemplateError};
use core::ffi::CStr;

/// What a call came to. Every function but the ones that only tell a size, a text or a constant
/// returns one.
///
/// The numbers are part of the ABI: new ones are appended to their group, none is ever changed.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CobraStatus {
    /// It did what it should.
    Ok = 0,

    /// A pointer that must not be NULL is.
    NullPointer = 1,
    /// A pointer is not aligned as its type asks for.
    Misaligned = 2,
    /// The memory for a handle is smaller than the handle, or that for a depth buffer too small.
    MemoryTooSmall = 3,
    /// Bytes, or the memory for a handle, would reach past the end of the address space.
    LengthTooLarge = 4,
    /// The memory for a handle overlaps something that the call reads or writes.
    Overlap = 5,
    /// The handle was never made, or making it failed.
    NotReady = 6,

    /// The bytes end before the template's header does.
    TemplateHeaderTruncated = 100,
    /// The bytes do not start with "CBRA".
    TemplateMagic = 101,
    /// This build reads another version of the format.
    TemplateVersion = 102,
    /// The header's reserved bytes are not zero.
    TemplateReserved = 103,
    /// The number of bytes is not the length in the header.
    TemplateLength = 104,
    /// The content is not what was written.
    TemplateChecksum = 105,
    /// A section reaches past the end.
    TemplateSectionTruncated = 106,
    /// A section that must be understood is unknown.
    TemplateUnknownSection = 107,
    /// A section's flags have an unknown bit.
    TemplateSectionFlags = 108,
    /// A section occurs twice.
    TemplateDuplicateSection = 109,
    /// A required section is missing.
    TemplateMissingSection = 110,
    /// A section does not decode.
    TemplateMalformedSection = 111,
    /// A section goes on behind its content.
    TemplateTrailingBytes = 112,
    /// The component records have another length than this version's.
    TemplateRecordLength = 113,
    /// An array's byte count is no multiple of its element's.
    TemplateArrayLength = 114,
    /// This build leaves the template's kernel out.
    TemplateKernelLeftOut = 115,
    /// This build leaves the template's metric out.
    TemplateMetricLeftOut = 116,
    /// There is no component.
    TemplateNoComponents = 117,
    /// A component has no term.
    TemplateNoTerms = 118,
    /// The components' terms do not follow each other, or are missing.
    TemplateTermRange = 119,
    /// Terms belong to no component.
    TemplateUnusedTerms = 120,
    /// A number that describes the object is out of its range.
    TemplateObjectNumber = 121,
    /// A number of a component is out of its range.
    TemplateComponentNumber = 122,
    /// A weight is not finite.
    TemplateWeight = 123,
    /// A direction is no unit vector.
    TemplateDirection = 124,
    /// A direction's angles are out of their range.
    TemplateAngles = 125,
    /// There are not as many precisions as components.
    TemplatePrecisionCount = 126,
    /// A precision's factor is not finite or has no positive diagonal.
    TemplatePrecision = 127,
    /// Compact terms have no metric of angles.
    TemplateCompactAngles = 128,
    /// There are not as many validities as components.
    TemplateValidityCount = 129,
    /// A component's box is empty or leaves its grid.
    TemplateValidityBox = 130,
    /// A component's grid of directions is not one that there is.
    TemplateValidityGrid = 131,
    /// The components' cells do not follow each other, or are missing.
    TemplateValidityRange = 132,
    /// A component's cells are malformed, or none is valid.
    TemplateValidityCells = 133,
    /// Cells belong to no component.
    TemplateUnusedCells = 134,
    /// Maps have no validity that says where they hold.
    TemplateMapValidity = 135,
    /// A component's map has not the nodes, the size or the pole that it must have.
    TemplateMapGrid = 136,
    /// A number of the depth section is out of its range.
    TemplateDepthNumber = 137,

    /// An entry of the camera matrix is not finite.
    CameraNotFinite = 200,
    /// A focal length is not positive.
    CameraFocalLength = 201,
    /// The camera matrix does not have the form (fx s cx; 0 fy cy; 0 0 1).
    CameraShape = 202,
    /// A coefficient of lens distortion is not 0.
    CameraDistorted = 203,

    /// An entry of R or t is not finite.
    PoseNotFinite = 300,
    /// R is no rotation.
    PoseNotARotation = 301,
    /// R mirrors.
    PoseReflection = 302,

    /// The template has more components than this build's scorer has room for.
    ScoreTooManyComponents = 400,
    /// The tolerance is not a positive number.
    ScoreDelta = 401,
    /// The fixed sigma is not a positive number.
    ScoreSigma = 402,
    /// The measurement noise is not a number of at least 0.
    ScoreNoise = 403,
    /// The settings' `likelihood` is no CobraLikelihood.
    SettingsLikelihood = 404,
    /// The settings' `assignment` is no CobraAssignment.
    SettingsAssignment = 405,
    /// The settings' `sigma_kind` is no CobraSigmaKind.
    SettingsSigmaKind = 406,
    /// The settings' `threshold` is no CobraThreshold.
    SettingsThreshold = 407,
    /// The depth settings' `noise_kind` is no CobraNoiseKind.
    SettingsNoiseKind = 408,
    /// The depth settings' `has_thresholds` is neither 0 nor 1.
    SettingsHasThresholds = 409,

    /// The template's components may speak everywhere: it does not say where its surface is.
    DepthNoValidity = 500,
    /// The measurement noise is not a positive number at the object's depth.
    DepthNoise = 501,
    /// The depth buffer has fewer than 8 or more than 256 cells along a side.
    DepthSide = 502,
    /// Refinement has no pixel a step.
    DepthStepPixels = 503,
    /// The thresholds are not 0 <= reject <= accept <= 1.
    DepthThresholds = 504,
    /// The depth image has no column, or its scale is not a positive number.
    DepthImage = 505,
}

use CobraStatus as S;

impl CobraStatus {
    /// Every status, in the order of its number.
    pub(crate) const ALL: [Self; 68] = [
        S::Ok,
        S::NullPointer,
        S::Misaligned,
        S::MemoryTooSmall,
        S::LengthTooLarge,
        S::Overlap,
        S::NotReady,
        S::TemplateHeaderTruncated,
        S::TemplateMagic,
        S::TemplateVersion,
        S::TemplateReserved,
        S::TemplateLength,
        S::TemplateChecksum,
        S::TemplateSectionTruncated,
        S::TemplateUnknownSection,
        S::TemplateSectionFlags,
        S::TemplateDuplicateSection,
        S::TemplateMissingSection,
        S::TemplateMalformedSection,
        S::TemplateTrailingBytes,
        S::TemplateRecordLength,
        S::TemplateArrayLength,
        S::TemplateKernelLeftOut,
        S::TemplateMetricLeftOut,
        S::TemplateNoComponents,
        S::TemplateNoTerms,
        S::TemplateTermRange,
        S::TemplateUnusedTerms,
        S::TemplateObjectNumber,
        S::TemplateComponentNumber,
        S::TemplateWeight,
        S::TemplateDirection,
        S::TemplateAngles,
        S::TemplatePrecisionCount,
        S::TemplatePrecision,
        S::TemplateCompactAngles,
        S::TemplateValidityCount,
        S::TemplateValidityBox,
        S::TemplateValidityGrid,
        S::TemplateValidityRange,
        S::TemplateValidityCells,
        S::TemplateUnusedCells,
        S::TemplateMapValidity,
        S::TemplateMapGrid,
        S::TemplateDepthNumber,
        S::CameraNotFinite,
        S::CameraFocalLength,
        S::CameraShape,
        S::CameraDistorted,
        S::PoseNotFinite,
        S::PoseNotARotation,
        S::PoseReflection,
        S::ScoreTooManyComponents,
        S::ScoreDelta,
        S::ScoreSigma,
        S::ScoreNoise,
        S::SettingsLikelihood,
        S::SettingsAssignment,
        S::SettingsSigmaKind,
        S::SettingsThreshold,
        S::SettingsNoiseKind,
        S::SettingsHasThresholds,
        S::DepthNoValidity,
        S::DepthNoise,
        S::DepthSide,
        S::DepthStepPixels,
        S::DepthThresholds,
        S::DepthImage,
    ];

    /// The status of a number, if it is one.
    #[must_use]
    pub(crate) fn from_number(number: u32) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|status| *status as u32 == number)
    }

    /// What it says, as a phrase.
    #[must_use]
    pub(crate) const fn text(self) -> &'static CStr {
        match self {
            S::Ok => c"ok",
            S::NullPointer => c"a pointer is NULL",
            S::Misaligned => c"a pointer is not aligned for its type",
            S::MemoryTooSmall => c"the memory for the handle is too small",
            S::LengthTooLarge => c"a length reaches past the end of the address space",
            S::Overlap => c"the memory for the handle overlaps an argument",
            S::NotReady => c"the handle was not made, or making it failed",
            S::TemplateHeaderTruncated => c"the template ends within its header",
            S::TemplateMagic => c"not a template: it does not start with CBRA",
            S::TemplateVersion => c"this build reads another version of the template format",
            S::TemplateReserved => c"the header's reserved bytes are not zero",
            S::TemplateLength => c"the number of bytes is not the length in the template's header",
            S::TemplateChecksum => c"the template is damaged: its checksum is wrong",
            S::TemplateSectionTruncated => c"a section reaches past the template's end",
            S::TemplateUnknownSection => c"a required section is not known to this build",
            S::TemplateSectionFlags => c"a section has flags that this build does not know",
            S::TemplateDuplicateSection => c"a section occurs twice",
            S::TemplateMissingSection => c"a required section is missing",
            S::TemplateMalformedSection => c"a section does not decode",
            S::TemplateTrailingBytes => c"a section has bytes behind its content",
            S::TemplateRecordLength => c"component records do not have the length of this version",
            S::TemplateArrayLength => c"an array's bytes are no multiple of its element",
            S::TemplateKernelLeftOut => c"this build leaves the template's kernel out",
            S::TemplateMetricLeftOut => c"this build leaves the template's metric out",
            S::TemplateNoComponents => c"the template has no component",
            S::TemplateNoTerms => c"a component has no term",
            S::TemplateTermRange => c"a component's terms do not follow those before it",
            S::TemplateUnusedTerms => c"the template has terms that no component uses",
            S::TemplateObjectNumber => c"a number of the object is out of its range",
            S::TemplateComponentNumber => c"a number of a component is out of its range",
            S::TemplateWeight => c"a weight is not finite",
            S::TemplateDirection => c"a direction is no unit vector",
            S::TemplateAngles => c"a direction's angles are out of their range",
            S::TemplatePrecisionCount => c"there are not as many precisions as components",
            S::TemplatePrecision => c"a component's precision is not positive definite",
            S::TemplateCompactAngles => c"compact terms have no metric of angles",
            S::TemplateValidityCount => c"there are not as many validities as components",
            S::TemplateValidityBox => c"a component's box is empty or leaves its grid",
            S::TemplateValidityGrid => c"a component's grid of directions is not one that there is",
            S::TemplateValidityRange => c"a component's cells do not follow those before it",
            S::TemplateValidityCells => c"a component's cells are malformed, or none is valid",
            S::TemplateUnusedCells => c"the template has cells that no component uses",
            S::TemplateMapValidity => c"maps need a validity section",
            S::TemplateMapGrid => {
                c"a component's map has not the nodes, the size or the pole it must have"
            }
            S::TemplateDepthNumber => c"a number of the depth section is out of its range",
            S::CameraNotFinite => c"an entry of the camera matrix is not finite",
            S::CameraFocalLength => c"a focal length is not positive",
            S::CameraShape => c"the camera matrix is not (fx s cx; 0 fy cy; 0 0 1)",
            S::CameraDistorted => c"the camera is a pinhole: undistort the image points first",
            S::PoseNotFinite => c"an entry of R or t is not finite",
            S::PoseNotARotation => c"R is no rotation",
            S::PoseReflection => c"R mirrors instead of rotating",
            S::ScoreTooManyComponents => {
                c"the template has more components than the scorer has room for"
            }
            S::ScoreDelta => c"the tolerance delta is not a positive number",
            S::ScoreSigma => c"the fixed sigma is not a positive number",
            S::ScoreNoise => c"the measurement noise is not a number of at least 0",
            S::SettingsLikelihood => c"the settings' likelihood is none of CobraLikelihood",
            S::SettingsAssignment => c"the settings' assignment is none of CobraAssignment",
            S::SettingsSigmaKind => c"the settings' sigma_kind is none of CobraSigmaKind",
            S::SettingsThreshold => c"the settings' threshold is none of CobraThreshold",
            S::SettingsNoiseKind => c"the depth settings' noise_kind is none of CobraNoiseKind",
            S::SettingsHasThresholds => c"the depth settings' has_thresholds is neither 0 nor 1",
            S::DepthNoValidity => c"the template does not say where its surface is",
            S::DepthNoise => c"the measurement noise is not a positive number",
            S::DepthSide => c"a depth buffer has 8 to 256 cells along a side",
            S::DepthStepPixels => c"refinement needs at least one pixel a step",
            S::DepthThresholds => c"thresholds must be 0 <= reject <= accept <= 1",
            S::DepthImage => c"the depth image has no column, or no positive scale",
        }
    }
}

impl From<TemplateError> for CobraStatus {
    fn from(error: TemplateError) -> Self {
        use TemplateError as E;
        match error {
            E::HeaderTruncated { .. } => S::TemplateHeaderTruncated,
            E::Magic { .. } => S::TemplateMagic,
            E::Version { .. } => S::TemplateVersion,
            E::Reserved { .. } => S::TemplateReserved,
            E::Length { .. } => S::TemplateLength,
            E::Checksum { .. } => S::TemplateChecksum,
            E::SectionTruncated { .. } => S::TemplateSectionTruncated,
            E::UnknownSection { .. } => S::TemplateUnknownSection,
            E::SectionFlags { .. } => S::TemplateSectionFlags,
            E::DuplicateSection { .. } => S::TemplateDuplicateSection,
            E::MissingSection { .. } => S::TemplateMissingSection,
            E::MalformedSection { .. } => S::TemplateMalformedSection,
            E::TrailingBytes { .. } => S::TemplateTrailingBytes,
            E::RecordLength { .. } => S::TemplateRecordLength,
            E::ArrayLength { .. } => S::TemplateArrayLength,
            E::KernelLeftOut { .. } => S::TemplateKernelLeftOut,
            E::MetricLeftOut { .. } => S::TemplateMetricLeftOut,
            E::NoComponents => S::TemplateNoComponents,
            E::NoTerms { .. } => S::TemplateNoTerms,
            E::TermRange { .. } => S::TemplateTermRange,
            E::UnusedTerms { .. } => S::TemplateUnusedTerms,
            E::ObjectNumber { .. } => S::TemplateObjectNumber,
            E::ComponentNumber { .. } => S::TemplateComponentNumber,
            E::Weight { .. } => S::TemplateWeight,
            E::Direction { .. } => S::TemplateDirection,
            E::Angles { .. } => S::TemplateAngles,
            E::PrecisionCount { .. } => S::TemplatePrecisionCount,
            E::Precision { .. } => S::TemplatePrecision,
            E::CompactAngles => S::TemplateCompactAngles,
            E::ValidityCount { .. } => S::TemplateValidityCount,
            E::ValidityBox { .. } => S::TemplateValidityBox,
            E::ValidityGrid { .. } => S::TemplateValidityGrid,
            E::ValidityRange { .. } => S::TemplateValidityRange,
            E::ValidityCells { .. } => S::TemplateValidityCells,
            E::UnusedCells { .. } => S::TemplateUnusedCells,
            E::MapValidity => S::TemplateMapValidity,
            E::MapGrid { .. } => S::TemplateMapGrid,
            E::DepthNumber { .. } => S::TemplateDepthNumber,
        }
    }
}

impl From<CameraError> for CobraStatus {
    fn from(error: CameraError) -> Self {
        match error {
            CameraError::NotFinite { .. } => S::CameraNotFinite,
            CameraError::FocalLength { .. } => S::CameraFocalLength,
            CameraError::Shape { .. } => S::CameraShape,
            CameraError::Distorted { .. } => S::CameraDistorted,
        }
    }
}

impl From<PoseError> for CobraStatus {
    fn from(error: PoseError) -> Self {
        match error {
            PoseError::NotFinite => S::PoseNotFinite,
            PoseError::NotARotation { .. } => S::PoseNotARotation,
            PoseError::Reflection { .. } => S::PoseReflection,
        }
    }
}

impl From<DepthError> for CobraStatus {
    fn from(error: DepthError) -> Self {
        match error {
            DepthError::Score(error) => error.into(),
            DepthError::NoValidity => S::DepthNoValidity,
            DepthError::Noise { .. } => S::DepthNoise,
            DepthError::Side { .. } => S::DepthSide,
            DepthError::StepPixels => S::DepthStepPixels,
            DepthError::Thresholds { .. } => S::DepthThresholds,
            DepthError::Cells { .. } => S::MemoryTooSmall,
        }
    }
}

impl From<ScoreError> for CobraStatus {
    fn from(error: ScoreError) -> Self {
        match error {
            ScoreError::TooManyComponents { .. } => S::ScoreTooManyComponents,
            ScoreError::Delta { .. } => S::ScoreDelta,
            ScoreError::Sigma { .. } => S::ScoreSigma,
            ScoreError::Noise { .. } => S::ScoreNoise,
        }
    }
}
