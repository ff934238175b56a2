//! Loading a template and asking about it.
#![allow(
    unsafe_code,
    reason = "raw pointers come from C, and symbols are exported"
)]

use crate::layout::COBRA_NAME_SIZE;
use crate::pointer::{self, Handle, Region};
use crate::status::CobraStatus;
use crate::types::{COBRA_NOT_APPLICABLE, CobraTemplateDetail, CobraTemplateInfo};
use cobra_infer::template::{self, MAGIC};
use cobra_infer::{Section, Template, TemplateError};
use core::ffi::{c_char, c_void};
use core::mem::offset_of;

/// A template that was checked, in memory of the caller's. It borrows its bytes.
pub struct CobraTemplate {
    seal: u32,
    pub(crate) template: Template<'static>,
}

impl Handle for CobraTemplate {
    type Content = Template<'static>;
    const SEAL: u32 = 0x7c0b_7e01;
    const SEAL_OFFSET: usize = offset_of!(CobraTemplate, seal);
    const CONTENT_OFFSET: usize = offset_of!(CobraTemplate, template);
}

/// Exactly how many bytes `cobra_template_load` needs.
#[unsafe(no_mangle)]
pub extern "C" fn cobra_template_size() -> usize {
    size_of::<CobraTemplate>()
}

/// Exactly how those bytes must be aligned.
#[unsafe(no_mangle)]
pub extern "C" fn cobra_template_align() -> usize {
    align_of::<CobraTemplate>()
}

/// The length of the template at the start of `bytes`, from its header alone: flash is padded
/// behind a template, and what is loaded must be exactly as long as the template. `*out` is 0 when
/// the call fails; a length above `length` says that the template is cut off.
///
/// # Safety
/// `bytes` points to `length` bytes, `out` to a size_t.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cobra_template_peek_length(
    bytes: *const u8,
    length: usize,
    out: *mut usize,
) -> CobraStatus {
    let peek = || {
        // SAFETY: the caller's promise.
        unsafe { pointer::write(out, 0) }?;
        // SAFETY: the caller's promise.
        let bytes = unsafe { pointer::slice(bytes, length) }?;
        // SAFETY: the caller's promise.
        unsafe { pointer::write(out, template::peek_len(bytes)?) }
    };
    pointer::status(peek())
}

/// Checks `length` bytes, which must be exactly one template, puts a handle into `memory` and tells
/// `out` where it is, or sets `*out` to NULL. The bytes may lie at any address and are not copied.
///
/// # Safety
/// `memory` points to `memory_size` writable bytes and `out` to a pointer; `bytes` points to
/// `length` bytes that stay where they are, unchanged, for as long as the handle is used.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cobra_template_load(
    memory: *mut c_void,
    memory_size: usize,
    bytes: *const u8,
    length: usize,
    out: *mut *mut CobraTemplate,
) -> CobraStatus {
    let load = || {
        // SAFETY: the caller's promise.
        unsafe { pointer::clear(out) }?;
        // SAFETY: the caller's promise, which reaches as far as the handle is used.
        let content: &'static [u8] = unsafe { pointer::slice(bytes, length) }?;
        let borrowed = Region::new(bytes, length)?;
        // SAFETY: the caller's promise.
        let claimed = unsafe { pointer::claim(memory, memory_size, out, borrowed) }?;
        // SAFETY: the caller's promise.
        unsafe { pointer::fill(claimed, Template::from_bytes(content)) }
    };
    pointer::status(load())
}

/// What a template says of itself.
///
/// # Safety
/// `template` was loaded and its bytes are still there; `out` points to a CobraTemplateInfo.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cobra_template_info(
    template: *const CobraTemplate,
    out: *mut CobraTemplateInfo,
) -> CobraStatus {
    // SAFETY: the caller's promise.
    let loaded = unsafe { pointer::open(template) };
    // SAFETY: the caller's promise.
    pointer::status(
        loaded.and_then(|loaded| unsafe { pointer::write(out, info(&loaded.template)) }),
    )
}

fn info(template: &Template<'_>) -> CobraTemplateInfo {
    let mut name = [0; COBRA_NAME_SIZE];
    for (to, from) in name.iter_mut().zip(template.name().as_bytes()) {
        *to = c_char::from_ne_bytes([*from]);
    }
    let cost = template.cost();
    CobraTemplateInfo {
        unit: template.unit().into(),
        millimetres_per_unit: template.unit().millimetres(),
        centre: template.centre(),
        radius: template.radius(),
        diameter: template.diameter(),
        components: number(template.component_count()),
        terms: number(template.term_count()),
        cost_nearest: number(cost.nearest),
        cost_maximum: number(cost.maximum),
        name,
    }
}

/// Where and by how much bytes are wrong that `cobra_template_load` refuses: they are checked once
/// more. Where nothing is wrong with them, `out->status` is `COBRA_STATUS_OK`.
///
/// # Safety
/// `bytes` points to `length` bytes, `out` to a CobraTemplateDetail.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cobra_template_explain(
    bytes: *const u8,
    length: usize,
    out: *mut CobraTemplateDetail,
) -> CobraStatus {
    // SAFETY: the caller's promise.
    let bytes = unsafe { pointer::slice(bytes, length) };
    pointer::status(bytes.and_then(|bytes| {
        let detail = match Template::from_bytes(bytes) {
            Ok(_) => detail_of(CobraStatus::Ok),
            Err(error) => detail(error),
        };
        // SAFETY: the caller's promise.
        unsafe { pointer::write(out, detail) }
    }))
}

/// No `usize` of an error is above the template's length, which is a `u32`, but that of a buffer on
/// a 64-bit machine.
fn number(value: usize) -> u32 {
    u32::try_from(value).unwrap_or(COBRA_NOT_APPLICABLE)
}

fn detail_of(status: CobraStatus) -> CobraTemplateDetail {
    CobraTemplateDetail {
        status,
        section: COBRA_NOT_APPLICABLE,
        component: COBRA_NOT_APPLICABLE,
        term: COBRA_NOT_APPLICABLE,
        expected: COBRA_NOT_APPLICABLE,
        found: COBRA_NOT_APPLICABLE,
        value: 0.0,
    }
}

pub(crate) fn detail(error: TemplateError) -> CobraTemplateDetail {
    use TemplateError as E;
    let mut detail = detail_of(error.into());
    match error {
        E::HeaderTruncated { expected, found }
        | E::Length { expected, found }
        | E::RecordLength { expected, found }
        | E::UnusedTerms { expected, found }
        | E::PrecisionCount { expected, found }
        | E::ValidityCount { expected, found }
        | E::UnusedCells { expected, found } => {
            detail.expected = number(expected);
            detail.found = number(found);
        }
        E::Magic { found } => {
            detail.expected = u32::from_be_bytes(MAGIC);
            detail.found = u32::from_be_bytes(found);
        }
        E::Version { supported, found } => {
            detail.expected = supported.into();
            detail.found = found.into();
        }
        E::Reserved { found } => {
            detail.expected = 0;
            detail.found = found.into();
        }
        E::Checksum { expected, found } => {
            detail.expected = expected;
            detail.found = found;
        }
        E::SectionTruncated { offset } => detail.found = number(offset),
        E::UnknownSection { tag } => detail.section = tag.into(),
        E::SectionFlags { tag, found } => {
            detail.section = tag.into();
            detail.found = found.into();
        }
        E::DuplicateSection { section }
        | E::MissingSection { section }
        | E::MalformedSection { section } => detail.section = tag(section),
        E::TrailingBytes { section, found } => {
            detail.section = tag(section);
            detail.expected = 0;
            detail.found = number(found);
        }
        E::ArrayLength {
            section,
            element,
            found,
        } => {
            detail.section = tag(section);
            detail.expected = number(element);
            detail.found = number(found);
        }
        E::NoTerms { component }
        | E::TermRange { component }
        | E::Precision { component }
        | E::ValidityBox { component, .. }
        | E::ValidityGrid { component, .. }
        | E::ValidityRange { component } => {
            detail.component = number(component);
        }
        E::ObjectNumber { found, .. } => detail.value = found,
        E::DepthNumber { found, .. } => {
            detail.section = tag(Section::Depth);
            detail.value = found;
        }
        E::ComponentNumber {
            component, found, ..
        } => {
            detail.component = number(component);
            detail.value = found;
        }
        E::Weight { component, term } | E::Angles { component, term } => {
            detail.component = number(component);
            detail.term = number(term);
        }
        E::Direction {
            component,
            term,
            squared_norm,
        } => {
            detail.component = number(component);
            detail.term = number(term);
            detail.value = squared_norm;
        }
        E::ValidityCells { component, row } => {
            detail.component = number(component);
            detail.found = number(row);
        }
        E::MapGrid {
            component, found, ..
        } => {
            detail.component = number(component);
            detail.found = number(found);
        }
        E::KernelLeftOut { .. }
        | E::MetricLeftOut { .. }
        | E::NoComponents
        | E::CompactAngles
        | E::MapValidity => {}
    }
    detail
}

/// The tags of `docs/FORMAT.md`.
const fn tag(section: Section) -> u32 {
    match section {
        Section::Object => 1,
        Section::Model => 2,
        Section::Components => 3,
        Section::Terms => 4,
        Section::Precisions => 5,
        Section::Validity => 6,
        Section::Quality => 7,
        Section::Depth => 8,
    }
}
