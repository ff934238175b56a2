//! C gets what Rust gets, bit by bit.

use super::*;
use crate::scorer::{cobra_scorer_finish, cobra_scorer_push};
use crate::template::cobra_template_info;
use crate::types::{
    CobraAssignment, CobraCorrespondence, CobraLikelihood, CobraReport, CobraSigmaKind,
    CobraTemplateInfo, CobraThreshold, CobraUnit,
};
use cobra_infer::{
    Assignment, Camera, Likelihood, Pose, Scorer, Settings, Sigma, Template, Threshold,
};
use core::ffi::CStr;

/// Points around the object's centre, seen where the pose puts them, give or take a pixel.
fn correspondences() -> Vec<CobraCorrespondence> {
    let template = Template::from_bytes(TEMPLATE).unwrap();
    let (centre, radius) = (template.centre(), template.radius());
    (0..200)
        .map(|index| {
            let turn = index as f32 * 2.4;
            let height = index as f32 / 100.0 - 1.0;
            let ring = (1.0 - height * height).sqrt();
            let point = [
                centre[0] + 0.6 * radius * ring * turn.cos(),
                centre[1] + 0.6 * radius * ring * turn.sin(),
                centre[2] + 0.6 * radius * height,
            ];
            let depth = point[2] + 500.0;
            CobraCorrespondence {
                u: 423.9 * point[0] / depth + 318.7 + height,
                v: 423.1 * point[1] / depth + 243.0 - height,
                x: point[0],
                y: point[1],
                z: point[2],
                weight: 0.5 + (index % 3) as f32,
            }
        })
        .collect()
}

/// The bits of all likelihoods and of the report.
fn in_c(settings: &CobraSettings, stream: &[CobraCorrespondence]) -> (Vec<u32>, CobraReport) {
    let (mut template, mut scorer) = (TemplateMemory::new(), ScorerMemory::new());
    let template = loaded(&mut template);
    let (status, scorer) = start(&mut scorer, template, &CAMERA, &POSE, settings);
    assert_eq!(status, CobraStatus::Ok);
    let mut likelihoods = Vec::new();
    for correspondence in stream {
        let mut likelihood = f32::NAN;
        let status = unsafe { cobra_scorer_push(scorer, correspondence, &raw mut likelihood) };
        assert_eq!(status, CobraStatus::Ok);
        likelihoods.push(likelihood.to_bits());
    }
    let mut report = CobraReport::NOT_SCORED;
    let status = unsafe { cobra_scorer_finish(scorer, &raw mut report) };
    assert_eq!(status, CobraStatus::Ok);
    (likelihoods, report)
}

fn in_rust(settings: &Settings, stream: &[CobraCorrespondence]) -> (Vec<u32>, CobraReport) {
    let template = Template::from_bytes(TEMPLATE).unwrap();
    let camera = Camera::from_matrix(CAMERA.matrix).unwrap();
    let pose = Pose::from_row_major(POSE.rotation, POSE.translation).unwrap();
    let mut scorer = Scorer::<4>::new(&template, &camera, &pose, settings).unwrap();
    let push = |c: &CobraCorrespondence| scorer.push(&c.to_rust()).likelihood.to_bits();
    let likelihoods = stream.iter().map(push).collect();
    (likelihoods, CobraReport::from_rust(&scorer.finish()))
}

fn equal_bits(a: &CobraReport, b: &CobraReport) -> bool {
    let floats = |r: &CobraReport| {
        [r.confidence, r.threshold, r.weight_sum, r.inlier_share].map(f32::to_bits)
    };
    floats(a) == floats(b) && a == b
}

#[test]
fn every_way_of_scoring_gives_the_bits_of_rust() {
    let stream = correspondences();
    let assignments = [
        (CobraAssignment::Nearest, Assignment::Nearest),
        (CobraAssignment::Maximum, Assignment::Maximum),
        (CobraAssignment::Soft, Assignment::Soft),
    ];
    let likelihoods = [
        (CobraLikelihood::Peak, Likelihood::Peak),
        (CobraLikelihood::Density, Likelihood::Density),
    ];
    let thresholds = [
        (CobraThreshold::Paper, Threshold::Paper),
        (CobraThreshold::Mean, Threshold::Mean),
        (CobraThreshold::Worst, Threshold::Worst),
    ];
    let sigmas = [
        (CobraSigmaKind::Template, Sigma::Template { noise: 0.5 }),
        (CobraSigmaKind::Fixed, Sigma::Fixed(0.5)),
    ];
    for (c_assignment, assignment) in assignments {
        for (c_likelihood, likelihood) in likelihoods {
            for (c_threshold, threshold) in thresholds {
                for (c_sigma, sigma) in sigmas {
                    let c = CobraSettings {
                        delta: 2.0,
                        sigma_kind: c_sigma as u32,
                        sigma: 0.5,
                        likelihood: c_likelihood as u32,
                        assignment: c_assignment as u32,
                        threshold: c_threshold as u32,
                        minimum_points: 7,
                    };
                    let rust = Settings {
                        likelihood,
                        assignment,
                        sigma,
                        threshold,
                        delta: 2.0,
                        minimum_points: 7,
                    };
                    assert_eq!(CobraSettings::from_rust(&rust).to_rust(), c.to_rust());
                    let (ours, theirs) = (in_c(&c, &stream), in_rust(&rust, &stream));
                    assert_eq!(ours.0, theirs.0);
                    assert!(equal_bits(&ours.1, &theirs.1), "{ours:?} {theirs:?}");
                }
            }
        }
    }
}

#[test]
fn the_default_settings_are_those_of_rust() {
    let template = Template::from_bytes(TEMPLATE).unwrap();
    let expected = Settings::for_template(&template, 2.0);
    let mut memory = TemplateMemory::new();
    let found = settings(loaded(&mut memory)).to_rust();
    assert_eq!(found, Ok(expected));
}

#[test]
fn a_template_says_what_it_says_in_rust() {
    let expected = Template::from_bytes(TEMPLATE).unwrap();
    let mut memory = TemplateMemory::new();
    let template = loaded(&mut memory);
    let mut info = core::mem::MaybeUninit::<CobraTemplateInfo>::uninit();
    let status = unsafe { cobra_template_info(template, info.as_mut_ptr()) };
    assert_eq!(status, CobraStatus::Ok);
    let info = unsafe { info.assume_init() };
    let name = unsafe { CStr::from_ptr(info.name.as_ptr()) };
    assert_eq!(name.to_str(), Ok(expected.name()));
    assert_eq!(info.unit, CobraUnit::from(expected.unit()));
    assert_eq!(info.millimetres_per_unit, expected.unit().millimetres());
    assert_eq!(info.centre, expected.centre());
    assert_eq!(info.radius, expected.radius());
    assert_eq!(info.diameter, expected.diameter());
    assert_eq!(info.components as usize, expected.component_count());
    assert_eq!(info.terms as usize, expected.term_count());
    assert_eq!(info.cost_nearest as usize, expected.cost().nearest);
    assert_eq!(info.cost_maximum as usize, expected.cost().maximum);
}

#[test]
fn a_repaired_pose_is_that_of_rust() {
    let mut pose = POSE;
    pose.rotation[1] = 0.03;
    let expected = Pose::from_row_major_orthonormalised(pose.rotation, pose.translation).unwrap();
    let status = unsafe { crate::camera::cobra_pose_orthonormalise(&raw mut pose) };
    assert_eq!(status, CobraStatus::Ok);
    let found = Pose::from_row_major(pose.rotation, pose.translation).unwrap();
    assert_eq!(found, expected);
}
