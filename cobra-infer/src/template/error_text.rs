//! What an error says of a template: what was expected, what was found, and where.

use super::error::TemplateError;
use super::number::{Number, Range};
use core::fmt;

impl fmt::Display for TemplateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        use TemplateError as E;
        match *self {
            E::HeaderTruncated { expected, found } => write!(
                f,
                "a template starts with a header of {expected} bytes, found {found} bytes"
            ),
            E::Magic {
                found: [0xff, 0xff, 0xff, 0xff],
            } => f.write_str("not a template: expected \"CBRA\", found blank flash (ff ff ff ff)"),
            E::Magic {
                found: [a, b, c, d],
            } => write!(
                f,
                "not a template: expected \"CBRA\", found bytes {a:02x} {b:02x} {c:02x} {d:02x}"
            ),
            E::Version { supported, found } => write!(
                f,
                "template format version {found}, this build reads version {supported}"
            ),
            E::Reserved { found } => write!(
                f,
                "the header's reserved bytes must be zero, found {found:#06x}"
            ),
            E::Length { expected, found } if found < expected => write!(
                f,
                "the template is truncated: its header says {expected} bytes, found {found}"
            ),
            E::Length { expected, found } => write!(
                f,
                "the template's header says {expected} bytes, but there are {found}: {} too many",
                found.saturating_sub(expected)
            ),
            E::Checksum { expected, found } => write!(
                f,
                "the template is damaged: checksum {found:08x}, expected {expected:08x}"
            ),
            E::SectionTruncated { offset } => write!(
                f,
                "the section at byte {offset} reaches past the template's end"
            ),
            E::UnknownSection { tag } => write!(
                f,
                "section {tag:#06x} is required and this build does not know it"
            ),
            E::SectionFlags { tag, found } => write!(
                f,
                "section {tag:#06x} has flags {found:#06x} that this build does not know"
            ),
            E::DuplicateSection { section } => {
                write!(f, "the {} section occurs twice", section.name())
            }
            E::MissingSection { section } => {
                write!(f, "the {} section is missing", section.name())
            }
            E::MalformedSection { section } => {
                write!(f, "the {} section does not decode", section.name())
            }
            E::TrailingBytes { section, found } => write!(
                f,
                "the {} section has {found} bytes behind its content",
                section.name()
            ),
            E::RecordLength { expected, found } => write!(
                f,
                "component records have {found} bytes, this build reads {expected}"
            ),
            E::ArrayLength {
                section,
                element,
                found,
            } => write!(
                f,
                "the {} section's array has {found} bytes, which is no multiple of {element}",
                section.name()
            ),
            E::KernelLeftOut { kernel } => write!(
                f,
                "the template's kernel is {}, which this build leaves out: enable the feature \
                 \"{}\" of cobra-infer",
                kernel.name(),
                kernel.feature()
            ),
            E::MetricLeftOut { metric } => write!(
                f,
                "the template's metric is {}, which this build leaves out: enable the feature \
                 \"{}\" of cobra-infer",
                metric.name(),
                metric.feature().unwrap_or_default()
            ),
            E::NoComponents => f.write_str("the template has no component"),
            E::NoTerms { component } => write!(f, "component {component} has no term"),
            E::TermRange { component } => write!(
                f,
                "the terms of component {component} do not follow those before it, or are missing"
            ),
            E::UnusedTerms { expected, found } => write!(
                f,
                "the components use {expected} terms, but the terms section holds {found}"
            ),
            E::ObjectNumber { number, found } => {
                write!(f, "the object's {} is {found}", number.name())
            }
            E::ComponentNumber {
                component,
                number,
                expected,
                found,
            } => write!(
                f,
                "component {component}: {} must be {}, found {found}",
                number.name(),
                expected.text()
            ),
            E::Weight { component, term } => {
                write!(f, "component {component}: weight {term} is not finite")
            }
            E::Direction {
                component,
                term,
                squared_norm,
            } => write!(
                f,
                "component {component}: direction {term} is no unit vector (squared norm \
                 {squared_norm})"
            ),
            E::Angles { component, term } => write!(
                f,
                "component {component}: direction {term} is not (phi, theta, 0) with phi in \
                 [0, pi] and theta in [-pi, pi]"
            ),
            E::PrecisionCount { expected, found } => {
                write!(f, "{found} precisions for {expected} components")
            }
            E::Precision { component } => write!(
                f,
                "component {component}: the precision's factor must be finite with a positive \
                 diagonal"
            ),
            E::CompactAngles => f.write_str("compact terms have no metric of angles"),
            E::MapValidity => f.write_str("maps need a validity section"),
            E::MapGrid {
                component,
                columns,
                rows,
                pole,
                found,
            } => write!(
                f,
                "component {component}: a map needs 4 columns and rows or more and its validity's pole, \
                 found {found} nodes in {columns} columns and {rows} rows around pole {pole}"
            ),
            E::ValidityCount { expected, found } => {
                write!(f, "{found} validities for {expected} components")
            }
            E::ValidityBox {
                component,
                low,
                high,
            } => write!(
                f,
                "component {component}: the box must have low <= high < 128, found {low:?} to {high:?}"
            ),
            E::ValidityGrid {
                component,
                pole,
                blocks,
                first,
                rows,
            } => write!(
                f,
                "component {component}: the directions need a pole below 6, 1 to 16 blocks a side and \
                 rows inside them, found pole {pole}, {blocks} blocks, {rows} rows from {first}"
            ),
            E::ValidityRange { component } => write!(
                f,
                "the cells of component {component} do not follow those before it, or are missing"
            ),
            E::ValidityCells { component, row } => {
                write!(
                    f,
                    "component {component}: row {row} of its cells is malformed"
                )
            }
            E::UnusedCells { expected, found } => write!(
                f,
                "the components use {expected} bytes of cells, but the validity section holds {found}"
            ),
            E::DepthNumber { number, found } => write!(
                f,
                "the depth section's {} must be {}, found {found}",
                number.name(),
                of_depth(number)
            ),
        }
    }
}

/// What a number of the depth section must be.
const fn of_depth(number: Number) -> &'static str {
    match number {
        Number::Accept | Number::Reject => "in order: 0 <= reject <= accept <= 1",
        Number::Target => "above 0, no subnormal, and at most 1",
        Number::FalseAccepts | Number::LowerBound | Number::UpperBound => {
            "in order: 0 <= lower bound <= rate <= upper bound <= 1"
        }
        Number::Estimates => "at least 1",
        _ => Range::Normal.text(),
    }
}

impl core::error::Error for TemplateError {}
