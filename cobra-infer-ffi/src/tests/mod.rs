//! The interface as C calls it, in Rust.
#![allow(
    unsafe_code,
    clippy::undocumented_unsafe_blocks,
    reason = "every call is unsafe; what each may do is what the test is about"
)]

mod agreement;
mod depth;
mod depth_refusals;
mod memory;
mod refusals;
mod texts;

use crate::layout::{COBRA_SCORER_SIZE, COBRA_TEMPLATE_SIZE};
use crate::scorer::{CobraScorer, cobra_scorer_start, cobra_settings_default};
use crate::status::CobraStatus;
use crate::template::{CobraTemplate, cobra_template_load};
use crate::types::{CobraCamera, CobraPose, CobraSettings};
use core::ffi::c_void;
use core::ptr;

const TEMPLATE: &[u8] = include_bytes!("../../../tests/golden/v1-exponent-half.cobra");

const CAMERA: CobraCamera = CobraCamera {
    matrix: [423.9, 0.0, 318.7, 0.0, 423.1, 243.0, 0.0, 0.0, 1.0],
};

const POSE: CobraPose = CobraPose {
    rotation: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
    translation: [0.0, 0.0, 500.0],
};

/// Memory as C has it: bytes, aligned, that start as something else.
#[repr(C, align(8))]
struct Memory<const BYTES: usize>([u8; BYTES]);

impl<const BYTES: usize> Memory<BYTES> {
    fn new() -> Self {
        Self([0xa5; BYTES])
    }

    fn start(&mut self) -> *mut c_void {
        (&raw mut self.0).cast()
    }
}

type TemplateMemory = Memory<COBRA_TEMPLATE_SIZE>;
type ScorerMemory = Memory<COBRA_SCORER_SIZE>;

/// A pointer that is not NULL and that no call may leave as it is.
fn stale<T>() -> *mut T {
    ptr::without_provenance_mut(16)
}

fn load(memory: &mut TemplateMemory, bytes: &[u8]) -> (CobraStatus, *mut CobraTemplate) {
    let mut out = stale();
    let (start, size) = (memory.start(), size_of::<TemplateMemory>());
    let status =
        unsafe { cobra_template_load(start, size, bytes.as_ptr(), bytes.len(), &raw mut out) };
    (status, out)
}

fn loaded(memory: &mut TemplateMemory) -> *mut CobraTemplate {
    let (status, template) = load(memory, TEMPLATE);
    assert_eq!(status, CobraStatus::Ok);
    template
}

fn settings(template: *const CobraTemplate) -> CobraSettings {
    let mut settings = CobraSettings {
        delta: 0.0,
        sigma_kind: 9,
        sigma: 9.0,
        likelihood: 9,
        assignment: 9,
        threshold: 9,
        minimum_points: 0,
    };
    let status = unsafe { cobra_settings_default(template, 2.0, &raw mut settings) };
    assert_eq!(status, CobraStatus::Ok);
    settings
}

fn start(
    memory: &mut ScorerMemory,
    template: *const CobraTemplate,
    camera: &CobraCamera,
    pose: &CobraPose,
    settings: &CobraSettings,
) -> (CobraStatus, *mut CobraScorer) {
    let mut out = stale();
    let (start, size) = (memory.start(), size_of::<ScorerMemory>());
    let status =
        unsafe { cobra_scorer_start(start, size, template, camera, pose, settings, &raw mut out) };
    (status, out)
}
