//! What is refused of pointers and memory.

use super::*;
use crate::camera::{cobra_check_distortion, cobra_pose_orthonormalise};
use crate::scorer::{
    cobra_max_components, cobra_scorer_align, cobra_scorer_finish, cobra_scorer_push,
    cobra_scorer_size,
};
use crate::template::{
    cobra_template_align, cobra_template_explain, cobra_template_info, cobra_template_peek_length,
    cobra_template_size,
};
use crate::types::{CobraCorrespondence, CobraDecision, CobraReport};

use CobraStatus as S;

static CORRESPONDENCE: CobraCorrespondence = CobraCorrespondence {
    u: 320.0,
    v: 240.0,
    x: 0.0,
    y: 0.0,
    z: 1.0,
    weight: 1.0,
};

/// A pointer to no object that is not aligned for anything.
fn odd<T>() -> *mut T {
    ptr::without_provenance_mut(0x1001)
}

#[test]
fn the_sizes_of_the_header_are_enough_and_not_wasteful() {
    assert!((COBRA_TEMPLATE_SIZE / 2..=COBRA_TEMPLATE_SIZE).contains(&cobra_template_size()));
    assert!((COBRA_SCORER_SIZE / 2..=COBRA_SCORER_SIZE).contains(&cobra_scorer_size()));
    assert!(align_of::<TemplateMemory>().is_multiple_of(cobra_template_align()));
    assert!(align_of::<ScorerMemory>().is_multiple_of(cobra_scorer_align()));
    assert_eq!(cobra_max_components(), crate::layout::MAX_COMPONENTS);
}

#[test]
fn a_template_is_loaded_into_exactly_its_size() {
    let mut memory = TemplateMemory::new();
    let place = memory.start();
    let mut out = stale();
    for (size, expected) in [
        (0, S::MemoryTooSmall),
        (cobra_template_size() - 1, S::MemoryTooSmall),
        (cobra_template_size(), S::Ok),
    ] {
        let (bytes, length) = (TEMPLATE.as_ptr(), TEMPLATE.len());
        let status = unsafe { cobra_template_load(place, size, bytes, length, &raw mut out) };
        assert_eq!(status, expected);
        assert_eq!(out.is_null(), expected != S::Ok);
    }
}

#[test]
fn load_refuses_pointers_that_cannot_be_used() {
    let mut memory = TemplateMemory::new();
    let (place, size) = (memory.start(), size_of::<TemplateMemory>());
    let (bytes, length) = (TEMPLATE.as_ptr(), TEMPLATE.len());
    let load = |place, bytes, length| {
        let mut out = stale();
        let status = unsafe { cobra_template_load(place, size, bytes, length, &raw mut out) };
        assert!(out.is_null(), "{status:?}");
        status
    };
    let shifted = place.wrapping_byte_add(1);
    assert_eq!(load(ptr::null_mut(), bytes, length), S::NullPointer);
    assert_eq!(load(place, ptr::null(), length), S::NullPointer);
    assert_eq!(load(shifted, bytes, length), S::Misaligned);
    assert_eq!(load(place, bytes, usize::MAX), S::LengthTooLarge);
    let last = ptr::without_provenance(usize::MAX - 1);
    assert_eq!(load(place, last, 16), S::LengthTooLarge);
    assert_eq!(load(place, place.cast(), 16), S::Overlap);
    let last_byte = place.wrapping_byte_add(cobra_template_size() - 1);
    assert_eq!(load(place, last_byte.cast(), 16), S::Overlap);

    for (out, expected) in [(ptr::null_mut(), S::NullPointer), (odd(), S::Misaligned)] {
        let status = unsafe { cobra_template_load(place, size, bytes, length, out) };
        assert_eq!(status, expected);
    }
    let inside = place.cast();
    let status = unsafe { cobra_template_load(place, size, bytes, length, inside) };
    assert_eq!(status, S::Overlap);
}

#[test]
fn a_handle_that_was_not_made_is_refused() {
    let mut template_memory = TemplateMemory::new();
    let template: *mut CobraTemplate = template_memory.start().cast();
    let mut info = core::mem::MaybeUninit::uninit();
    let mut scorer_memory = ScorerMemory::new();
    let fresh: *mut CobraScorer = scorer_memory.start().cast();
    let mut report = CobraReport::NOT_SCORED;

    for (handle, expected) in [
        (template, S::NotReady),
        (ptr::null_mut(), S::NullPointer),
        (odd(), S::Misaligned),
    ] {
        let status = unsafe { cobra_template_info(handle, info.as_mut_ptr()) };
        assert_eq!(status, expected);
        let settings = CobraSettings {
            delta: 2.0,
            sigma_kind: 0,
            sigma: 0.0,
            likelihood: 0,
            assignment: 0,
            threshold: 0,
            minimum_points: 10,
        };
        let started = start(&mut scorer_memory, handle, &CAMERA, &POSE, &settings);
        assert_eq!(started, (expected, ptr::null_mut()));
    }
    for (handle, expected) in [
        (fresh, S::NotReady),
        (ptr::null_mut(), S::NullPointer),
        (odd(), S::Misaligned),
    ] {
        let mut likelihood = f32::NAN;
        let status = unsafe { cobra_scorer_push(handle, &CORRESPONDENCE, &raw mut likelihood) };
        assert_eq!((status, likelihood), (expected, 0.0));
        report.decision = CobraDecision::Accept;
        let status = unsafe { cobra_scorer_finish(handle, &raw mut report) };
        assert_eq!((status, report), (expected, CobraReport::NOT_SCORED));
    }
}

#[test]
fn a_load_that_fails_leaves_no_handle_behind() {
    let mut memory = TemplateMemory::new();
    let first = loaded(&mut memory);
    let (status, second) = load(&mut memory, &TEMPLATE[..40]);
    assert_eq!((status, second), (S::TemplateLength, ptr::null_mut()));
    let mut info = core::mem::MaybeUninit::uninit();
    let status = unsafe { cobra_template_info(first, info.as_mut_ptr()) };
    assert_eq!(status, S::NotReady);
}

#[test]
fn start_refuses_pointers_that_cannot_be_used() {
    let (mut template, mut memory) = (TemplateMemory::new(), ScorerMemory::new());
    let place = template.start();
    let template = loaded(&mut template);
    let settings = settings(template);
    let size = size_of::<ScorerMemory>();
    let with = |place: *mut c_void, size, camera, pose, settings| {
        let mut out = stale();
        let status = unsafe {
            cobra_scorer_start(place, size, template, camera, pose, settings, &raw mut out)
        };
        assert_eq!(out.is_null(), status != S::Ok);
        status
    };
    let own = memory.start();
    let (c, p, s): (*const _, *const _, *const _) = (&CAMERA, &POSE, &settings);
    assert_eq!(with(own, cobra_scorer_size(), c, p, s), S::Ok);
    assert_eq!(
        with(own, cobra_scorer_size() - 1, c, p, s),
        S::MemoryTooSmall
    );
    assert_eq!(with(ptr::null_mut(), size, c, p, s), S::NullPointer);
    assert_eq!(with(own.wrapping_byte_add(2), size, c, p, s), S::Misaligned);
    assert_eq!(with(place, size, c, p, s), S::Overlap);
    assert_eq!(with(own, size, ptr::null(), p, s), S::NullPointer);
    assert_eq!(with(own, size, c, ptr::null(), s), S::NullPointer);
    assert_eq!(with(own, size, c, p, ptr::null()), S::NullPointer);
    assert_eq!(with(own, size, odd(), p, s), S::Misaligned);
    assert_eq!(with(own, size, c, odd(), s), S::Misaligned);
    assert_eq!(with(own, size, c, p, odd()), S::Misaligned);
    for (out, expected) in [(ptr::null_mut(), S::NullPointer), (odd(), S::Misaligned)] {
        let status = unsafe { cobra_scorer_start(own, size, template, c, p, s, out) };
        assert_eq!(status, expected);
    }
}

#[test]
fn what_is_pushed_through_a_bad_pointer_is_not_counted() {
    let (mut template, mut memory) = (TemplateMemory::new(), ScorerMemory::new());
    let template = loaded(&mut template);
    let (_, scorer) = start(&mut memory, template, &CAMERA, &POSE, &settings(template));
    for (correspondence, likelihood, expected) in [
        (ptr::null(), ptr::null_mut(), S::NullPointer),
        (
            odd::<CobraCorrespondence>().cast_const(),
            ptr::null_mut(),
            S::Misaligned,
        ),
        (&raw const CORRESPONDENCE, odd(), S::Misaligned),
        (&raw const CORRESPONDENCE, ptr::null_mut(), S::Ok),
    ] {
        let status = unsafe { cobra_scorer_push(scorer, correspondence, likelihood) };
        assert_eq!(status, expected);
    }
    let mut report = CobraReport::NOT_SCORED;
    let status = unsafe { cobra_scorer_finish(scorer, &raw mut report) };
    assert_eq!((status, report.points), (S::Ok, 1));
    for (out, expected) in [(ptr::null_mut(), S::NullPointer), (odd(), S::Misaligned)] {
        assert_eq!(unsafe { cobra_scorer_finish(scorer, out) }, expected);
    }
}

#[test]
fn the_other_functions_refuse_pointers_that_cannot_be_used() {
    let (bytes, length) = (TEMPLATE.as_ptr(), TEMPLATE.len());
    let mut memory = TemplateMemory::new();
    let template = loaded(&mut memory);
    for (address, expected) in [(0, S::NullPointer), (0x1001, S::Misaligned)] {
        let bad = address;
        let out = ptr::without_provenance_mut(bad);
        assert_eq!(
            unsafe { cobra_template_peek_length(bytes, length, out) },
            expected
        );
        let out = ptr::without_provenance_mut(bad);
        assert_eq!(
            unsafe { cobra_template_explain(bytes, length, out) },
            expected
        );
        let out = ptr::without_provenance_mut(bad);
        assert_eq!(unsafe { cobra_template_info(template, out) }, expected);
        let out = ptr::without_provenance_mut(bad);
        assert_eq!(
            unsafe { cobra_settings_default(template, 2.0, out) },
            expected
        );
        let pose = ptr::without_provenance_mut(bad);
        assert_eq!(unsafe { cobra_pose_orthonormalise(pose) }, expected);
        let numbers = ptr::without_provenance(bad);
        assert_eq!(unsafe { cobra_check_distortion(numbers, 1) }, expected);
    }
    let mut found = 1;
    let status = unsafe { cobra_template_peek_length(ptr::null(), 16, &raw mut found) };
    assert_eq!((status, found), (S::NullPointer, 0));
    let numbers = [0.0; 5];
    let status = unsafe { cobra_check_distortion(numbers.as_ptr(), usize::MAX / 2) };
    assert_eq!(status, S::LengthTooLarge);
    assert_eq!(unsafe { cobra_check_distortion(ptr::null(), 0) }, S::Ok);
}
