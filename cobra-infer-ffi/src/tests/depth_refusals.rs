//! What a check against depth refuses, and the memory that it asks for.

use super::depth::{Cells, Scene, charts, defaults, numbers, scene};
use super::*;
use crate::depth::*;
use crate::depth_types::*;
use crate::types::CobraDecision;

/// An argument that is wrong, and everything else as it should be.
struct Call<'a> {
    memory: *mut c_void,
    size: usize,
    template: *const CobraTemplate,
    camera: *const CobraCamera,
    pose: *const CobraPose,
    settings: CobraDepthSettings,
    observed: CobraDepthObserved,
    scene: &'a Scene,
}

impl Call<'_> {
    fn status(&self) -> CobraStatus {
        let mut report = CobraDepthReport {
            decision: CobraDecision::Accept,
            ..CobraDepthReport::NOT_CHECKED
        };
        assert!(!self.scene.words.is_empty());
        let status = unsafe {
            cobra_depth_check(
                self.memory,
                self.size,
                self.template,
                self.camera,
                self.pose,
                &self.settings,
                &self.observed,
                &raw mut report,
            )
        };
        if status != CobraStatus::Ok {
            assert_eq!(numbers(&report), numbers(&CobraDepthReport::NOT_CHECKED));
        }
        status
    }
}

fn odd<T>() -> *mut T {
    ptr::without_provenance_mut(0x1001)
}

#[test]
fn what_cannot_be_used_is_refused_and_leaves_an_undecided_report() {
    use CobraStatus as S;
    let scene = scene();
    let (mut memory, mut cells) = (TemplateMemory::new(), Cells::new());
    let (mut other, start) = (TemplateMemory::new(), cells.start());
    let everywhere = loaded(&mut other);
    let template = charts(&mut memory);
    let good = || Call {
        memory: start,
        size: size_of::<Cells>(),
        template,
        camera: &raw const scene.camera,
        pose: &raw const scene.poses[0],
        settings: defaults(template),
        observed: scene.observed(true),
        scene: &scene,
    };
    let with = |change: &dyn Fn(&mut Call<'_>)| {
        let mut call = good();
        change(&mut call);
        call.status()
    };
    assert_eq!(with(&|_| ()), S::Ok);
    assert_eq!(with(&|call| call.observed.pixel_count = 0), S::Ok);
    assert_eq!(with(&|call| call.memory = ptr::null_mut()), S::NullPointer);
    assert_eq!(with(&|call| call.memory = odd()), S::Misaligned);
    assert_eq!(with(&|call| call.size -= 1), S::MemoryTooSmall);
    assert_eq!(with(&|call| call.template = ptr::null()), S::NullPointer);
    assert_eq!(with(&|call| call.template = start.cast()), S::NotReady);
    assert_eq!(with(&|call| call.template = everywhere), S::DepthNoValidity);
    assert_eq!(with(&|call| call.camera = ptr::null()), S::NullPointer);
    assert_eq!(with(&|call| call.camera = odd()), S::Misaligned);
    assert_eq!(with(&|call| call.pose = ptr::null()), S::NullPointer);
    assert_eq!(with(&|call| call.pose = odd()), S::Misaligned);
    assert_eq!(
        with(&|call| call.observed.words = ptr::null()),
        S::NullPointer
    );
    assert_eq!(with(&|call| call.observed.words = odd()), S::Misaligned);
    assert_eq!(with(&|call| call.observed.words = start.cast()), S::Overlap);
    assert_eq!(
        with(&|call| call.observed.pixels = ptr::null()),
        S::NullPointer
    );
    assert_eq!(with(&|call| call.observed.pixels = odd()), S::Misaligned);
    assert_eq!(
        with(&|call| call.observed.pixels = start.cast()),
        S::Overlap
    );
    let huge = |call: &mut Call<'_>| call.observed.pixel_count = usize::MAX / 2;
    assert_eq!(with(&huge), S::LengthTooLarge);
    assert_eq!(with(&|call| call.observed.width = 0), S::DepthImage);
    for scale in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        assert_eq!(with(&|call| call.observed.scale = scale), S::DepthImage);
    }
    assert_eq!(
        with(&|call| call.settings.noise_kind = 2),
        S::SettingsNoiseKind
    );
    let both = |call: &mut Call<'_>| call.settings.has_thresholds = 2;
    assert_eq!(with(&both), S::SettingsHasThresholds);
    assert_eq!(with(&|call| call.settings.noise_share = 0.0), S::DepthNoise);
    for side in [0, 7, 257] {
        assert_eq!(with(&|call| call.settings.side = side), S::DepthSide);
    }
    assert_eq!(
        with(&|call| call.settings.step_pixels = 0),
        S::DepthStepPixels
    );
    let reversed = |call: &mut Call<'_>| {
        let settings = &mut call.settings;
        (settings.has_thresholds, settings.accept, settings.reject) = (1, 0.2, 0.4);
    };
    assert_eq!(with(&reversed), S::DepthThresholds);
    let zeros = unsafe { core::mem::zeroed::<CobraDepthSettings>() };
    assert_ne!(with(&|call| call.settings = zeros), S::Ok);

    let call = good();
    for (settings, observed, report, expected) in [
        (ptr::null(), &raw const call.observed, odd(), S::Misaligned),
        (
            ptr::null(),
            &raw const call.observed,
            ptr::null_mut(),
            S::NullPointer,
        ),
    ] {
        let (camera, pose) = (call.camera, call.pose);
        let status = unsafe {
            cobra_depth_check(
                start, call.size, template, camera, pose, settings, observed, report,
            )
        };
        assert_eq!(status, expected);
    }
}

#[test]
fn the_memory_that_is_asked_for_is_exactly_enough() {
    let mut memory = TemplateMemory::new();
    let mut settings = defaults(charts(&mut memory));
    assert!(align_of::<Cells>().is_multiple_of(cobra_depth_memory_align()));
    let size = |settings: *const CobraDepthSettings| {
        let mut size = 1;
        let status = unsafe { cobra_depth_memory_size(settings, &raw mut size) };
        (status, size)
    };
    assert_eq!(
        size(&raw const settings),
        (CobraStatus::Ok, size_of::<Cells>())
    );
    settings.side = 20;
    let expected = 20 * 20 * COBRA_DEPTH_CELL_SIZE;
    assert_eq!(size(&raw const settings), (CobraStatus::Ok, expected));
    settings.side = 300;
    assert_eq!(size(&raw const settings), (CobraStatus::DepthSide, 0));
    assert_eq!(size(ptr::null()), (CobraStatus::NullPointer, 0));
    assert_eq!(size(odd()), (CobraStatus::Misaligned, 0));
    let status = unsafe { cobra_depth_memory_size(&raw const settings, ptr::null_mut()) };
    assert_eq!(status, CobraStatus::NullPointer);
}
