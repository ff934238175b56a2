//! What is refused of numbers, and under which status.

use super::*;
use crate::camera::{cobra_check_distortion, cobra_pose_orthonormalise};
use crate::template::{cobra_template_explain, cobra_template_peek_length, detail};
use crate::types::{COBRA_NOT_APPLICABLE, CobraTemplateDetail};
use cobra_infer::template::{Number, Range};
use cobra_infer::{Exponent, Kernel, Metric, Section, TemplateError as E};

use CobraStatus as S;

fn explained(bytes: &[u8]) -> CobraTemplateDetail {
    let mut out = core::mem::MaybeUninit::uninit();
    let status = unsafe { cobra_template_explain(bytes.as_ptr(), bytes.len(), out.as_mut_ptr()) };
    assert_eq!(status, S::Ok);
    unsafe { out.assume_init() }
}

#[test]
fn a_damaged_template_is_refused_and_explained() {
    let mut memory = TemplateMemory::new();
    let mut bytes = TEMPLATE.to_vec();
    assert_eq!(explained(&bytes).status, S::Ok);
    let last = bytes.len() - 1;
    bytes[last] ^= 1;
    assert_eq!(
        load(&mut memory, &bytes),
        (S::TemplateChecksum, ptr::null_mut())
    );
    let damaged = explained(&bytes);
    assert_eq!(damaged.status, S::TemplateChecksum);
    assert_ne!(damaged.expected, damaged.found);
    let cut = explained(&TEMPLATE[..last]);
    assert_eq!(cut.status, S::TemplateLength);
    assert_eq!(
        (cut.expected as usize, cut.found as usize),
        (last + 1, last)
    );
    assert_eq!(load(&mut memory, &[]).0, S::TemplateHeaderTruncated);
    assert_eq!(load(&mut memory, &[0xff; 64]).0, S::TemplateMagic);
}

#[test]
fn the_length_is_found_in_front_of_padding() {
    let mut flash = TEMPLATE.to_vec();
    flash.resize(TEMPLATE.len() + 100, 0xff);
    let mut length = 0;
    let peek =
        |bytes: &[u8], out| unsafe { cobra_template_peek_length(bytes.as_ptr(), bytes.len(), out) };
    assert_eq!(peek(&flash, &raw mut length), S::Ok);
    assert_eq!(length, TEMPLATE.len());
    assert_eq!(peek(&[0xff; 64], &raw mut length), S::TemplateMagic);
    assert_eq!(length, 0);
    let mut memory = TemplateMemory::new();
    assert_eq!(load(&mut memory, &flash).0, S::TemplateLength);
}

#[test]
fn every_template_error_has_a_status_of_its_own() {
    let section = Section::Terms;
    let (component, term) = (3, 4);
    let (expected, found) = (5, 6);
    let kernel = Kernel::RationalQuadratic(Exponent::Free);
    let errors = [
        E::HeaderTruncated { expected, found },
        E::Magic { found: *b"ABCD" },
        E::Version {
            supported: 1,
            found: 2,
        },
        E::Reserved { found: 1 },
        E::Length { expected, found },
        E::Checksum {
            expected: 1,
            found: 2,
        },
        E::SectionTruncated { offset: 7 },
        E::UnknownSection { tag: 9 },
        E::SectionFlags { tag: 1, found: 8 },
        E::DuplicateSection { section },
        E::MissingSection { section },
        E::MalformedSection { section },
        E::TrailingBytes { section, found },
        E::RecordLength { expected, found },
        E::ArrayLength {
            section,
            element: 16,
            found,
        },
        E::KernelLeftOut { kernel },
        E::MetricLeftOut {
            metric: Metric::Angles,
        },
        E::NoComponents,
        E::NoTerms { component },
        E::TermRange { component },
        E::UnusedTerms { expected, found },
        E::ObjectNumber {
            number: Number::Radius,
            found: -1.0,
        },
        E::ComponentNumber {
            component,
            number: Number::SigmaHat,
            expected: Range::Normal,
            found: -1.0,
        },
        E::Weight { component, term },
        E::Direction {
            component,
            term,
            squared_norm: 2.0,
        },
        E::Angles { component, term },
        E::PrecisionCount { expected, found },
        E::Precision { component },
    ];
    // In the order of the numbers, so that none is skipped or used twice.
    for (number, error) in (100..).zip(errors) {
        assert_eq!(detail(error).status as u32, number, "{error:?}");
    }
    assert_eq!(100 + errors.len() as u32 - 1, S::TemplatePrecision as u32);
    let weight = detail(E::Weight { component, term });
    assert_eq!((weight.component, weight.term), (3, 4));
    assert_eq!(weight.section, COBRA_NOT_APPLICABLE);
    let trailing = detail(E::TrailingBytes { section, found });
    assert_eq!(
        (trailing.section, trailing.expected, trailing.found),
        (4, 0, 6)
    );
    let magic = detail(E::Magic { found: *b"ABCD" });
    assert_eq!((magic.expected, magic.found), (0x4342_5241, 0x4142_4344));
}

#[test]
fn a_camera_a_pose_or_a_setting_out_of_range_has_a_status_of_its_own() {
    let (mut template, mut memory) = (TemplateMemory::new(), ScorerMemory::new());
    let template = loaded(&mut template);
    let defaults = settings(template);
    let mut refused = |camera: &CobraCamera, pose: &CobraPose, settings: &CobraSettings| {
        let (status, scorer) = start(&mut memory, template, camera, pose, settings);
        assert!(scorer.is_null(), "{status:?}");
        status
    };
    for (entry, value, expected) in [
        (0, f32::NAN, S::CameraNotFinite),
        (4, -1.0, S::CameraFocalLength),
        (6, 1.0, S::CameraShape),
    ] {
        let mut camera = CAMERA;
        camera.matrix[entry] = value;
        assert_eq!(refused(&camera, &POSE, &defaults), expected);
    }
    for (entry, value, expected) in [
        (0, f32::INFINITY, S::PoseNotFinite),
        (0, 1.1, S::PoseNotARotation),
        (0, -1.0, S::PoseReflection),
    ] {
        let mut pose = POSE;
        pose.rotation[entry] = value;
        assert_eq!(refused(&CAMERA, &pose, &defaults), expected);
    }
    type Change = fn(&mut CobraSettings);
    let changes: [(Change, S); 8] = [
        (|s| s.delta = 0.0, S::ScoreDelta),
        (|s| (s.sigma_kind, s.sigma) = (1, 0.0), S::ScoreSigma),
        (|s| s.sigma = -1.0, S::ScoreNoise),
        (|s| s.likelihood = 2, S::SettingsLikelihood),
        (|s| s.assignment = 3, S::SettingsAssignment),
        (|s| s.sigma_kind = 2, S::SettingsSigmaKind),
        (|s| s.threshold = u32::MAX, S::SettingsThreshold),
        (|s| *s = unsafe { core::mem::zeroed() }, S::ScoreDelta),
    ];
    for (change, expected) in changes {
        let mut settings = defaults;
        change(&mut settings);
        assert_eq!(refused(&CAMERA, &POSE, &settings), expected);
    }
}

#[test]
fn a_template_with_more_components_than_room_is_refused() {
    let error = cobra_infer::ScoreError::TooManyComponents {
        capacity: 32,
        found: 33,
    };
    assert_eq!(S::from(error), S::ScoreTooManyComponents);
}

#[test]
fn distortion_and_hopeless_rotations_are_refused() {
    let check =
        |numbers: &[f32]| unsafe { cobra_check_distortion(numbers.as_ptr(), numbers.len()) };
    assert_eq!(check(&[0.0; 5]), S::Ok);
    assert_eq!(check(&[0.0, 0.1]), S::CameraDistorted);
    assert_eq!(check(&[f32::NAN]), S::CameraDistorted);
    let mut pose = POSE;
    pose.rotation[0] = 2.0;
    let status = unsafe { cobra_pose_orthonormalise(&raw mut pose) };
    assert_eq!((status, pose.rotation[0]), (S::PoseNotARotation, 2.0));
}
