//! Scoring one pose: start, push each correspondence, finish.
#![allow(
    unsafe_code,
    reason = "raw pointers come from C, and symbols are exported"
)]

use crate::layout::MAX_COMPONENTS;
use crate::pointer::{self, Handle, Region};
use crate::status::CobraStatus;
use crate::template::CobraTemplate;
use crate::types::{CobraCamera, CobraCorrespondence, CobraPose, CobraReport, CobraSettings};
use cobra_infer::{Scorer, Settings};
use core::ffi::c_void;
use core::mem::offset_of;

/// A pose that is being scored, in memory of the caller's.
pub struct CobraScorer {
    seal: u32,
    scorer: Scorer<'static, MAX_COMPONENTS>,
}

impl Handle for CobraScorer {
    type Content = Scorer<'static, MAX_COMPONENTS>;
    const SEAL: u32 = 0x7c0b_5c02;
    const SEAL_OFFSET: usize = offset_of!(CobraScorer, seal);
    const CONTENT_OFFSET: usize = offset_of!(CobraScorer, scorer);
}

/// Exactly how many bytes `cobra_scorer_start` needs.
#[unsafe(no_mangle)]
pub extern "C" fn cobra_scorer_size() -> usize {
    size_of::<CobraScorer>()
}

/// Exactly how those bytes must be aligned.
#[unsafe(no_mangle)]
pub extern "C" fn cobra_scorer_align() -> usize {
    align_of::<CobraScorer>()
}

/// The most components that a template may have to be scored by this build: 32, unless
/// COBRA_MAX_COMPONENTS was set when the library was built.
#[unsafe(no_mangle)]
pub extern "C" fn cobra_max_components() -> usize {
    MAX_COMPONENTS
}

/// The defaults: peak likelihood, nearest component, the template's sigma without measurement
/// noise, the paper's threshold, at least 10 points, and a tolerance in millimetres, whatever the
/// template's unit. That the tolerance is above 0 is checked by `cobra_scorer_start`.
///
/// # Safety
/// `template` was loaded and its bytes are still there; `out` points to a CobraSettings.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cobra_settings_default(
    template: *const CobraTemplate,
    delta_millimetres: f32,
    out: *mut CobraSettings,
) -> CobraStatus {
    // SAFETY: the caller's promise.
    let template = unsafe { pointer::open(template) };
    pointer::status(template.and_then(|template| {
        let settings = Settings::for_template(&template.template, delta_millimetres);
        // SAFETY: the caller's promise.
        unsafe { pointer::write(out, CobraSettings::from_rust(&settings)) }
    }))
}

/// Starts on a pose: puts a scorer into `memory` and tells `out` where it is, or sets `*out` to
/// NULL. Camera, pose and settings are copied; the template is borrowed. The same memory serves
/// pose after pose.
///
/// # Safety
/// `memory` points to `memory_size` writable bytes; `template` was loaded, and it and its bytes
/// stay where they are, unchanged, for as long as the scorer is used; the other pointers point to
/// what their types say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cobra_scorer_start(
    memory: *mut c_void,
    memory_size: usize,
    template: *const CobraTemplate,
    camera: *const CobraCamera,
    pose: *const CobraPose,
    settings: *const CobraSettings,
    out: *mut *mut CobraScorer,
) -> CobraStatus {
    let start = || {
        // SAFETY: the caller's promise.
        unsafe { pointer::clear(out) }?;
        // SAFETY: the caller's promise, which reaches as far as the scorer is used.
        let loaded: &'static CobraTemplate = unsafe { pointer::open(template) }?;
        // SAFETY: the caller's promise; any bits are a CobraCamera.
        let camera = unsafe { pointer::read(camera) }?;
        // SAFETY: the caller's promise; any bits are a CobraPose.
        let pose = unsafe { pointer::read(pose) }?;
        // SAFETY: the caller's promise; any bits are a CobraSettings.
        let settings = unsafe { pointer::read(settings) }?;
        let borrowed = Region::new(template, size_of::<CobraTemplate>())?;
        // SAFETY: the caller's promise.
        let claimed = unsafe { pointer::claim(memory, memory_size, out, borrowed) }?;
        let (camera, pose) = (camera.checked()?, pose.checked()?);
        let scorer = Scorer::new(&loaded.template, &camera, &pose, &settings.to_rust()?);
        // SAFETY: the caller's promise.
        unsafe { pointer::fill(claimed, scorer) }
    };
    pointer::status(start())
}

/// Takes one correspondence and, where `likelihood` is not NULL, tells its likelihood: 0 for a
/// point behind the camera or with invalid numbers. A number that is not finite or a negative
/// weight is no failure of the call: it makes the decision undecided. When the call fails, the
/// correspondence is not counted.
///
/// # Safety
/// `scorer` was started and nobody else uses it meanwhile; `correspondence` and, unless NULL,
/// `likelihood` point to what their types say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cobra_scorer_push(
    scorer: *mut CobraScorer,
    correspondence: *const CobraCorrespondence,
    likelihood: *mut f32,
) -> CobraStatus {
    let push = || {
        // Before anything can fail, and before anything is counted.
        // SAFETY: the caller's promise.
        unsafe { pointer::write_optional(likelihood, 0.0) }?;
        // SAFETY: the caller's promise; any bits are a CobraCorrespondence.
        let correspondence = unsafe { pointer::read(correspondence) }?;
        // SAFETY: the caller's promise.
        let scorer = unsafe { pointer::open_mut(scorer) }?;
        let point = scorer.scorer.push(&correspondence.to_rust());
        // SAFETY: the caller's promise.
        unsafe { pointer::write_optional(likelihood, point.likelihood) }
    };
    pointer::status(push())
}

/// The confidence, the threshold and the decision on everything pushed so far; more may be pushed
/// afterwards. When the call fails and `report` can be written, it says undecided.
///
/// # Safety
/// `scorer` was started and nobody pushes meanwhile; `report` points to a CobraReport.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cobra_scorer_finish(
    scorer: *const CobraScorer,
    report: *mut CobraReport,
) -> CobraStatus {
    let finish = || {
        // SAFETY: the caller's promise.
        unsafe { pointer::write(report, CobraReport::NOT_SCORED) }?;
        // SAFETY: the caller's promise.
        let scorer = unsafe { pointer::open(scorer) }?;
        let finished = CobraReport::from_rust(&scorer.scorer.finish());
        // SAFETY: the caller's promise.
        unsafe { pointer::write(report, finished) }
    };
    pointer::status(finish())
}
