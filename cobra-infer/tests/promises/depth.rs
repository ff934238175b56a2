//! The check against depth, on a sphere.

use crate::depth_scene::{RADIUS, SIGMA, Scene, cause, run, settings, sphere};
use crate::scene::{IDENTITY, camera, pose};
use cobra_infer::depth::{Cause, Cell, DepthError, DepthSettings, Noise, Observed, check_depth};
use cobra_infer::tracking::{Tracker, TrackerSettings, TrackingState};
use cobra_infer::{Decision, Doubt, Pose, Rejection, Template};

#[test]
fn a_sphere_where_it_is_seen_has_confidence_one_and_no_error_to_speak_of() {
    for masked in [true, false] {
        let report = run(&pose(0.0), &Scene::at(0.0, 500.0), masked, &settings());
        assert!(report.confidence > 0.995, "{report:?}");
        assert!(report.estimated_error < 0.1 * SIGMA, "{report:?}");
        assert!(report.displacement < 0.1 && report.residual < 0.5);
        assert_eq!(report.decision, Decision::Accept);
        assert_eq!(cause(&pose(0.0), &report), Cause::Fits);
        assert_eq!((report.hidden, report.unmeasured), (0, 0));
        assert!(report.visible > 200 && report.judged == report.visible);
    }
}

#[test]
fn an_offset_along_the_ray_is_estimated_and_named_and_undone_by_the_suggestion() {
    for (offset, masked) in [(12.0, true), (-12.0, true), (12.0, false)] {
        let scene = Scene::at(0.0, 500.0 + offset);
        let report = run(&pose(0.0), &scene, masked, &settings());
        let off = report.estimated_error / offset.abs();
        assert!((0.8..1.4).contains(&off), "{offset}: {report:?}");
        // Every visible point is seen 12 behind, or in front of, where it must be.
        let expected = cobra_infer::math::exp(-0.5 * (12.0 / SIGMA) * (12.0 / SIGMA));
        assert!((report.reverse - expected).abs() < 0.06, "{report:?}");
        let moved = report.refined.translation().z - 500.0;
        assert!((moved - offset).abs() < 1.5, "{moved}");
        let Cause::AlongRay { distance } = cause(&pose(0.0), &report) else {
            panic!("{report:?}");
        };
        assert!((distance - offset).abs() < 1.5);
        assert_eq!(report.decision, Decision::Reject(Rejection::BelowThreshold));
    }
}

#[test]
fn an_offset_across_the_ray_is_undone_too() {
    let report = run(&pose(0.0), &Scene::at(10.0, 500.0), true, &settings());
    let shift = report.refined.translation();
    assert!((shift.x - 10.0).abs() < 1.0, "{report:?}");
    assert!((0.8..1.4).contains(&(report.estimated_error / 10.0)));
    assert!(matches!(cause(&pose(0.0), &report), Cause::Sideways { .. }));
}

#[test]
fn what_stands_in_front_is_no_evidence_against_a_right_pose() {
    for masked in [true, false] {
        let scene = Scene {
            wall: Some((320, 300.0)),
            ..Scene::at(0.0, 500.0)
        };
        let report = run(&pose(0.0), &scene, masked, &settings());
        assert!(report.confidence > 0.99, "{report:?}");
        let share = report.hidden as f32 / report.visible as f32;
        assert!((0.45..0.55).contains(&share), "{report:?}");
    }
}

#[test]
fn what_would_have_been_seen_and_was_not_counts_against_the_pose() {
    // Right where it is seen, but the camera looks past it everywhere else.
    for masked in [true, false] {
        let scene = Scene::at(300.0, 500.0);
        let report = run(&pose(0.0), &scene, masked, &settings());
        assert!(report.confidence < 1e-6, "{report:?}");
        assert_eq!(report.seen_through, report.judged);
        assert_eq!(cause(&pose(0.0), &report), Cause::SeenThrough);
        assert!(matches!(report.decision, Decision::Reject(_)));
        assert!(report.estimated_error > 0.5 * 2.0 * RADIUS);
    }
}

#[test]
fn what_the_object_itself_hides_is_not_expected_to_be_seen() {
    let mut content = sphere();
    let mut inner = content.parts[0].clone();
    inner.hyperparameters.prior_mean = 0.4 * RADIUS;
    content.parts.push(inner);
    let bytes = content.encode();
    let template = Template::from_bytes(&bytes).unwrap();
    let mut cells = vec![Cell::EMPTY; settings().cells()];
    let report = check_depth::<8>(
        &template,
        &camera(),
        &pose(0.0),
        &settings(),
        Observed::Silhouette,
        &Scene::at(0.0, 500.0),
        &mut cells,
    )
    .unwrap();
    assert!(report.reverse > 0.99, "{report:?}");
}

#[test]
fn without_evidence_there_is_no_decision() {
    let hidden = Scene {
        wall: Some((640, 300.0)),
        ..Scene::at(0.0, 500.0)
    };
    let report = run(&pose(0.0), &hidden, false, &settings());
    assert_eq!(report.decision, Decision::Undecided(Doubt::Hidden));
    assert_eq!(report.confidence, 0.0);
    assert_eq!(cause(&pose(0.0), &report), Cause::InFront);
    let blind = Scene {
        background: None,
        ..Scene::at(900.0, 500.0)
    };
    let report = run(&pose(0.0), &blind, false, &settings());
    assert_eq!(report.unmeasured, report.visible);
    assert_eq!(cause(&pose(0.0), &report), Cause::Unmeasured);
    assert_eq!(report.decision, Decision::Undecided(Doubt::TooFewPoints));
    let outside = Pose::from_row_major(IDENTITY, [3000.0, 0.0, 500.0]).unwrap();
    let report = run(&outside, &Scene::at(0.0, 500.0), false, &settings());
    assert_eq!(report.decision, Decision::Undecided(Doubt::TooFewPoints));
}

#[test]
fn what_fits_by_chance_in_a_few_points_has_no_confidence() {
    // Of a right pose so much is hidden that fewer points are left than a decision needs.
    let most = |edge| Scene {
        wall: Some((edge, 300.0)),
        ..Scene::at(0.0, 500.0)
    };
    let reports = [320, 345, 350].map(|edge| run(&pose(0.0), &most(edge), false, &settings()));
    let [half, some, few] = &reports;
    assert!(half.confidence > 0.99 && some.confidence > 0.9, "{some:?}");
    assert!(few.judged > 0 && few.judged < 10, "{few:?}");
    assert_eq!(few.confidence, 0.0);
    assert_eq!(few.decision, Decision::Undecided(Doubt::Hidden));
}

#[test]
fn an_object_of_three_pixels_is_undecided() {
    let far = Pose::from_row_major(IDENTITY, [0.0, 0.0, 10_700.0]).unwrap();
    for masked in [true, false] {
        let report = run(&far, &Scene::at(0.0, 10_700.0), masked, &settings());
        let few = Decision::Undecided(Doubt::TooFewPoints);
        assert_eq!(report.decision, few, "{report:?}");
        assert!(report.judged <= 9, "{report:?}");
        assert_eq!(report.evidence(), None);
    }
}

#[test]
fn an_object_at_the_edge_of_a_wide_image_is_seen_whole() {
    let wide = Pose::from_row_major(IDENTITY, [350.0, 0.0, 500.0]).unwrap();
    let mut scene = Scene::at(0.0, 500.0);
    scene.centre = [350.0, 0.0, 500.0];
    let report = run(&wide, &scene, false, &settings());
    let middle = run(&pose(0.0), &Scene::at(0.0, 500.0), false, &settings());
    assert!(report.confidence > 0.98, "{report:?}");
    assert!(report.visible > middle.visible * 2 / 3, "{report:?}");
}

#[test]
fn a_mask_that_shows_the_object_elsewhere_contradicts_a_pose_behind_something() {
    let mut scene = Scene::at(0.0, 500.0);
    scene.wall = Some((312, 450.0));
    let behind = Pose::from_row_major(IDENTITY, [-80.0, 0.0, 700.0]).unwrap();
    let report = run(&behind, &scene, true, &settings());
    assert!(report.hidden > 0 && report.judged == 0, "{report:?}");
    assert_eq!(
        report.decision,
        Decision::Reject(Rejection::BelowThreshold),
        "{report:?}"
    );
    assert!(report.estimated_error >= report.displacement);
    assert_ne!(cause(&behind, &report), Cause::InFront);
    // Without a mask something may stand in front of it.
    let report = run(&behind, &scene, false, &settings());
    assert_eq!(report.decision, Decision::Undecided(Doubt::Hidden));
    assert_eq!(cause(&behind, &report), Cause::InFront);
}

#[test]
fn a_hand_in_front_is_no_evidence_for_a_tracker_and_a_frame_between_the_thresholds_is() {
    let mut covered = Scene::at(0.0, 500.0);
    covered.wall = Some((640, 200.0));
    let hidden = run(&pose(0.0), &covered, false, &settings());
    assert_eq!(hidden.decision, Decision::Undecided(Doubt::Hidden));
    assert_eq!((hidden.confidence, hidden.evidence()), (0.0, None));
    let between = run(&pose(0.0), &Scene::at(0.0, 507.0), true, &settings());
    let right = run(&pose(0.0), &Scene::at(0.0, 500.0), true, &settings());
    let mut tracker = Tracker::new(TrackerSettings::with_thresholds(0.3, 0.6)).unwrap();
    for report in [right, right, right, hidden, hidden, hidden, right] {
        tracker.update(report.evidence());
    }
    for _ in 0..20 {
        assert_eq!(tracker.update(between.evidence()), TrackingState::Tracking);
    }
    let gone = run(&pose(0.0), &Scene::at(0.0, 900.0), false, &settings());
    for _ in 0..10 {
        tracker.update(gone.evidence());
    }
    assert!(matches!(tracker.state(), TrackingState::Lost(_)));
}

#[test]
fn a_pose_behind_the_camera_or_around_it_is_rejected() {
    for z in [-500.0, 0.0, 30.0] {
        let behind = Pose::from_row_major(IDENTITY, [0.0, 0.0, z]).unwrap();
        let report = run(&behind, &Scene::at(0.0, 500.0), false, &settings());
        let expected = Decision::Reject(Rejection::BehindCamera);
        assert_eq!(report.decision, expected);
        assert_eq!(cause(&behind, &report), Cause::BehindCamera);
    }
}

#[test]
fn between_the_thresholds_and_without_them_the_answer_is_undecided() {
    let scene = Scene::at(0.0, 507.0);
    let report = run(&pose(0.0), &scene, true, &settings());
    assert!((0.3..0.6).contains(&report.confidence), "{report:?}");
    let between = Decision::Undecided(Doubt::BetweenThresholds);
    assert_eq!(report.decision, between);
    let without = DepthSettings {
        thresholds: None,
        ..settings()
    };
    let report = run(&pose(0.0), &scene, true, &without);
    let unknown = Decision::Undecided(Doubt::NotCalibrated);
    assert_eq!(report.decision, unknown);
}

#[test]
fn the_error_and_the_confidence_say_the_same() {
    for offset in [0.0, 2.0, 5.0, 9.0, 14.0] {
        let scene = Scene::at(0.5 * offset, 500.0 + offset);
        let report = run(&pose(0.0), &scene, true, &settings());
        let scaled = report.estimated_error / report.noise;
        let expected = cobra_infer::math::exp(-0.5 * scaled * scaled);
        assert!((report.confidence - expected).abs() < 1e-5, "{report:?}");
    }
}

#[test]
fn a_pose_behind_the_camera_is_rejected_whatever_the_sensors_noise_is_there() {
    let settings = DepthSettings {
        noise: Noise::Sensor {
            constant: 1.0,
            linear: 0.002,
            quadratic: 0.0,
        },
        ..settings()
    };
    let behind = Pose::from_row_major(IDENTITY, [0.0, 0.0, -800.0]).unwrap();
    let report = run(&behind, &Scene::at(0.0, 500.0), true, &settings);
    assert_eq!(report.decision, Decision::Reject(Rejection::BehindCamera));
    assert_eq!(cause(&behind, &report), Cause::BehindCamera);
}

#[test]
fn the_sensors_noise_is_taken_at_the_objects_depth() {
    let sensor = Noise::Sensor {
        constant: 1.0,
        linear: 0.002,
        quadratic: 4e-6,
    };
    assert_eq!(
        sensor.at(80.0, 500.0),
        Ok(1.0 + (0.002 + 4e-6 * 500.0) * 500.0)
    );
    let settings = DepthSettings {
        noise: sensor,
        ..settings()
    };
    let report = run(&pose(0.0), &Scene::at(0.0, 500.0), true, &settings);
    assert!((report.noise - 3.0).abs() < 1e-6);
    // Four millimetres are more than such a sensor is off by.
    let report = run(&pose(0.0), &Scene::at(0.0, 504.0), true, &settings);
    assert!(report.confidence < 0.5, "{report:?}");
    for bad in [
        Noise::Share(0.0),
        Noise::Share(f32::NAN),
        Noise::Share(-1.0),
    ] {
        assert!(matches!(bad.at(80.0, 500.0), Err(DepthError::Noise { .. })));
    }
}
