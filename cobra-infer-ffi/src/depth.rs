//! Checking one pose against a depth image.
#![allow(
    unsafe_code,
    reason = "raw pointers come from C, and symbols are exported"
)]

use crate::depth_types::{
    CobraDepthObserved, CobraDepthPixel, CobraDepthReport, CobraDepthSettings,
};
use crate::layout::MAX_COMPONENTS;
use crate::pointer::{self, Region};
use crate::status::CobraStatus;
use crate::template::CobraTemplate;
use crate::types::{CobraCamera, CobraPose};
use cobra_infer::depth::{
    Cell, Correction, DepthCheck, DepthPixel, DepthReport, DepthSettings, DepthWords, Observed,
    TemplateSurface,
};
use cobra_infer::{Camera, Pose, Template};
use core::ffi::c_void;

/// What the template knows: its measurement noise, and its thresholds where it was calibrated. The
/// rest: a depth buffer of 32 by 32 cells, four steps on at most 150 pixels; at least 10 points, or as many
/// as it was calibrated with.
///
/// # Safety
/// `template` was loaded and its bytes are still there; `out` points to a CobraDepthSettings.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cobra_depth_settings_default(
    template: *const CobraTemplate,
    out: *mut CobraDepthSettings,
) -> CobraStatus {
    // SAFETY: the caller's promise.
    let template = unsafe { pointer::open(template) };
    pointer::status(template.and_then(|template| {
        let settings = DepthSettings::for_template(&template.template);
        // SAFETY: the caller's promise.
        unsafe { pointer::write(out, CobraDepthSettings::from_rust(&settings)) }
    }))
}

/// Exactly how many bytes of scratch memory `cobra_depth_check` needs with these settings, into
/// `out`; 0 when the call fails. It is `COBRA_DEPTH_CELL_SIZE` for each of the buffer's cells.
///
/// # Safety
/// `settings` points to a CobraDepthSettings, `out` to a size_t.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cobra_depth_memory_size(
    settings: *const CobraDepthSettings,
    out: *mut usize,
) -> CobraStatus {
    let size = || {
        // SAFETY: the caller's promise.
        unsafe { pointer::write(out, 0) }?;
        // SAFETY: the caller's promise; any bits are a CobraDepthSettings.
        let settings = unsafe { pointer::read(settings) }?.to_rust()?;
        settings.check()?;
        // SAFETY: the caller's promise.
        unsafe { pointer::write(out, settings.cells() * size_of::<Cell>()) }
    };
    pointer::status(size())
}

/// Exactly how those bytes must be aligned.
#[unsafe(no_mangle)]
pub extern "C" fn cobra_depth_memory_align() -> usize {
    align_of::<Cell>()
}

/// Checks a pose against what a depth camera saw, both ways: whether the observed pixels lie on the
/// object's surface, and whether the surface that the pose says is visible was seen. When the call
/// fails and `report` can be written, it says undecided. Nothing is kept: the memory, whatever it
/// holds, is scratch, and free again when the call returns.
///
/// # Safety
/// `memory` points to `memory_size` writable bytes that nobody uses meanwhile; `template` was loaded
/// and its bytes are still there; the other pointers, those in `observed` too, point to what their
/// types say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cobra_depth_check(
    memory: *mut c_void,
    memory_size: usize,
    template: *const CobraTemplate,
    camera: *const CobraCamera,
    pose: *const CobraPose,
    settings: *const CobraDepthSettings,
    observed: *const CobraDepthObserved,
    report: *mut CobraDepthReport,
) -> CobraStatus {
    let check = || {
        // SAFETY: the caller's promise.
        unsafe { pointer::write(report, CobraDepthReport::NOT_CHECKED) }?;
        // SAFETY: the caller's promise.
        let loaded = unsafe { pointer::open(template) }?;
        // SAFETY: the caller's promise; any bits are a CobraCamera.
        let camera = unsafe { pointer::read(camera) }?.checked()?;
        // SAFETY: the caller's promise; any bits are a CobraPose.
        let pose = unsafe { pointer::read(pose) }?.checked()?;
        // SAFETY: the caller's promise; any bits are a CobraDepthSettings.
        let settings = unsafe { pointer::read(settings) }?.to_rust()?;
        // SAFETY: the caller's promise; any bits are a CobraDepthObserved.
        let observed = unsafe { pointer::read(observed) }?;
        // SAFETY: the caller's promise.
        let seen = unsafe { seen(&observed) }?;
        settings.check()?;
        let borrowed = [
            Region::new(template, size_of::<CobraTemplate>())?,
            Region::new(report, size_of::<CobraDepthReport>())?,
            Region::of(seen.words)?,
            Region::of(seen.pixels.unwrap_or_default())?,
        ];
        // SAFETY: the caller's promise.
        let cells = unsafe { pointer::scratch(memory, memory_size, settings.cells(), &borrowed) }?;
        let checked = run(&loaded.template, &camera, &pose, &settings, &seen, cells)?;
        let correction = Correction::between(&pose, &checked.refined, loaded.template.centre());
        let checked = CobraDepthReport::from_rust(&checked, &correction);
        // SAFETY: the caller's promise.
        unsafe { pointer::write(report, checked) }
    };
    pointer::status(check())
}

/// What there is to look at, and whom to call.
struct Seen<'a> {
    pixels: Option<&'a [DepthPixel]>,
    words: &'a [u16],
    image: DepthWords<'a>,
    alive: Option<extern "C" fn(*mut c_void)>,
    context: *mut c_void,
}

/// # Safety
/// The pointers in `observed` point to what they should for as long as the result is used.
unsafe fn seen<'a>(observed: &CobraDepthObserved) -> Result<Seen<'a>, CobraStatus> {
    let count = usize::from(observed.width) * usize::from(observed.height);
    // SAFETY: the caller's promise; any bits are a `u16`.
    let words = unsafe { pointer::slice(observed.words, count) }?;
    let pixels = if observed.pixels.is_null() && observed.pixel_count == 0 {
        None
    } else {
        let pixels = observed.pixels.cast::<DepthPixel>();
        // SAFETY: the caller's promise; both structures have the same fields at the same places, which
        // is checked beside `CobraDepthPixel`, and any bits are one.
        Some(unsafe { pointer::slice(pixels, observed.pixel_count) }?)
    };
    let image = DepthWords::new(words, observed.width, observed.scale);
    Ok(Seen {
        pixels,
        words,
        image: image.ok_or(CobraStatus::DepthImage)?,
        alive: observed.alive,
        context: observed.context,
    })
}

/// Out of line, so that what it needs of the stack is not held while arguments are checked.
#[inline(never)]
fn run(
    template: &Template<'_>,
    camera: &Camera,
    pose: &Pose,
    settings: &DepthSettings,
    seen: &Seen<'_>,
    cells: &mut [Cell],
) -> Result<DepthReport, CobraStatus> {
    let surface = TemplateSurface::<MAX_COMPONENTS>::at_pose(template, settings, pose);
    // Used inside its result: moved out, it would lie on the stack twice.
    let surface = match &surface {
        Ok(surface) => surface,
        Err(error) => return Err((*error).into()),
    };
    let observed = seen.pixels.map_or(Observed::Silhouette, Observed::Pixels);
    let mut alive = || {
        if let Some(alive) = seen.alive {
            alive(seen.context);
        }
    };
    let check = DepthCheck::new(surface, camera, settings)?;
    Ok(check.run(pose, observed, &seen.image, cells, &mut alive)?)
}

/// Where the fields of a pixel lie in Rust.
const _: () = {
    use core::mem::offset_of;
    assert!(size_of::<CobraDepthPixel>() == size_of::<DepthPixel>());
    assert!(align_of::<CobraDepthPixel>() == align_of::<DepthPixel>());
    assert!(offset_of!(CobraDepthPixel, column) == offset_of!(DepthPixel, column));
    assert!(offset_of!(CobraDepthPixel, row) == offset_of!(DepthPixel, row));
    assert!(offset_of!(CobraDepthPixel, depth) == offset_of!(DepthPixel, depth));
};
