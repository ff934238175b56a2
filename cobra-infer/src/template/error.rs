//! What can be wrong with a template: small `Copy` values that say what was found and, where there
//! is a choice, what was expected.

use super::number::{Number, Range};
use crate::kernel::{Kernel, Metric};

/// A section of a template, by its tag.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Section {
    /// Name, unit, bounding sphere, diameter.
    Object,
    /// Metric and kernel.
    Model,
    /// One record per component.
    Components,
    /// Directions and weights.
    Terms,
    /// The precision Q_k of each component.
    Precisions,
    /// Where each component may speak.
    Validity,
    /// What was measured of the template.
    Quality,
    /// What it knows for depth mode.
    Depth,
}

impl Section {
    /// The section's name in the format's document.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Section::Object => "object",
            Section::Model => "model",
            Section::Components => "components",
            Section::Terms => "terms",
            Section::Precisions => "precisions",
            Section::Validity => "validity",
            Section::Quality => "quality",
            Section::Depth => "depth",
        }
    }
}

/// Why bytes are not a template.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
// A tag of a word, so that errors are moved in words, not by `memcpy`.
#[repr(u32)]
pub enum TemplateError {
    /// The bytes end before the header does.
    HeaderTruncated {
        /// Bytes in a header.
        expected: usize,
        /// Bytes there are.
        found: usize,
    },
    /// The first four bytes are not `CBRA`.
    Magic {
        /// The four bytes.
        found: [u8; 4],
    },
    /// The format version is not one that this build reads.
    Version {
        /// The version it reads.
        supported: u16,
        /// The version in the header.
        found: u16,
    },
    /// The header's reserved bytes are not zero.
    Reserved {
        /// Their value.
        found: u16,
    },
    /// The number of bytes is not the length in the header.
    Length {
        /// The length in the header.
        expected: usize,
        /// Bytes there are.
        found: usize,
    },
    /// The payload is not what was written.
    Checksum {
        /// The checksum in the header.
        expected: u32,
        /// The checksum of the payload.
        found: u32,
    },
    /// A section's header or body reaches past the end of the payload.
    SectionTruncated {
        /// Where the section starts, in bytes from the file's start.
        offset: usize,
    },
    /// A section that must be understood is not known to this build.
    UnknownSection {
        /// Its tag.
        tag: u16,
    },
    /// A section's flags have a bit that this version does not define.
    SectionFlags {
        /// Its tag.
        tag: u16,
        /// The flags.
        found: u16,
    },
    /// A section occurs twice.
    DuplicateSection {
        /// Which one.
        section: Section,
    },
    /// A required section is missing.
    MissingSection {
        /// Which one.
        section: Section,
    },
    /// A section's body does not decode.
    MalformedSection {
        /// Which one.
        section: Section,
    },
    /// A section's body goes on behind its content.
    TrailingBytes {
        /// Which one.
        section: Section,
        /// How many bytes too many.
        found: usize,
    },
    /// The records' stride is not this version's.
    RecordLength {
        /// Bytes in a record.
        expected: usize,
        /// The stride in the file.
        found: usize,
    },
    /// An array's byte count is not a multiple of its element's.
    ArrayLength {
        /// Which section.
        section: Section,
        /// Bytes in an element.
        element: usize,
        /// Bytes there are.
        found: usize,
    },
    /// This build leaves the template's kernel out.
    KernelLeftOut {
        /// The kernel.
        kernel: Kernel,
    },
    /// This build leaves the template's metric out.
    MetricLeftOut {
        /// The metric.
        metric: Metric,
    },
    /// There is no component.
    NoComponents,
    /// A component has no term.
    NoTerms {
        /// Which component.
        component: usize,
    },
    /// The components' terms do not lie one behind the other, or not inside the terms section.
    TermRange {
        /// Which component.
        component: usize,
    },
    /// Terms that belong to no component.
    UnusedTerms {
        /// Terms that the components use; of compact ones, bytes.
        expected: usize,
        /// Terms there are; of compact ones, bytes.
        found: usize,
    },
    /// A number of the object section is not finite and positive (the centre: not finite).
    ObjectNumber {
        /// Which one.
        number: Number,
        /// Its value.
        found: f32,
    },
    /// A number of a component is out of its range.
    ComponentNumber {
        /// Which component.
        component: usize,
        /// Which number.
        number: Number,
        /// What it must be.
        expected: Range,
        /// Its value.
        found: f32,
    },
    /// A weight is not finite.
    Weight {
        /// Which component.
        component: usize,
        /// Which of its terms.
        term: usize,
    },
    /// A direction is not a unit vector within [`crate::tolerance::UNIT_DIRECTION`].
    Direction {
        /// Which component.
        component: usize,
        /// Which of its terms.
        term: usize,
        /// Its squared norm.
        squared_norm: f32,
    },
    /// A direction's angles are not (φ, θ, 0) with φ in [0, π] and θ in [−π, π].
    Angles {
        /// Which component.
        component: usize,
        /// Which of its terms.
        term: usize,
    },
    /// There are not as many precisions as components.
    PrecisionCount {
        /// How many components.
        expected: usize,
        /// How many precisions.
        found: usize,
    },
    /// A component's precision has a factor that is not finite or whose diagonal is not positive.
    Precision {
        /// Which component.
        component: usize,
    },
    /// Compact terms, and the metric of angles, which has none.
    CompactAngles,
    /// Maps, and no validity to say where they hold.
    MapValidity,
    /// A component's map has not four columns and four rows, not as many nodes as they make, another
    /// pole than its validity, or a byte that is not 0 where 0 must be.
    MapGrid {
        /// Which component.
        component: usize,
        /// Nodes in a row.
        columns: u8,
        /// Rows.
        rows: u8,
        /// The pole's number.
        pole: u8,
        /// How many nodes there are.
        found: usize,
    },
    /// There are not as many validities as components.
    ValidityCount {
        /// How many components.
        expected: usize,
        /// How many validities.
        found: usize,
    },
    /// A component's box is not low ≤ high < [`crate::validity::BOX_STEPS`] along each axis.
    ValidityBox {
        /// Which component.
        component: usize,
        /// The least position.
        low: [u8; 3],
        /// The largest.
        high: [u8; 3],
    },
    /// A component's grid of directions has no such pole, not from 1 to 16 blocks along a side, or rows
    /// of blocks outside of it.
    ValidityGrid {
        /// Which component.
        component: usize,
        /// The pole's number.
        pole: u8,
        /// Blocks along a side.
        blocks: u8,
        /// The first row of blocks.
        first: u8,
        /// How many rows.
        rows: u8,
    },
    /// The components' cells do not lie one behind the other, or not inside the validity section.
    ValidityRange {
        /// Which component.
        component: usize,
    },
    /// A row of a component's blocks is not coded as it must be, or no cell is valid.
    ValidityCells {
        /// Which component.
        component: usize,
        /// Which of the rows that it has; as many as it has where no row but their sum is wrong.
        row: usize,
    },
    /// Cells that belong to no component.
    UnusedCells {
        /// Bytes that the components use.
        expected: usize,
        /// Bytes there are.
        found: usize,
    },
    /// A number of the depth section is out of its range.
    DepthNumber {
        /// Which one.
        number: Number,
        /// Its value.
        found: f32,
    },
}
