//! Tracking is lost and regained when it should be, and not by a single frame.

use crate::content::Content;
use cobra_infer::Template;
use cobra_infer::template::{Calibration, CalibrationSource, DepthSource, MeasuredShare};
use cobra_infer::tracking::{Loss, Tracker, TrackerError, TrackerSettings, TrackingState};
use proptest::collection::vec;
use proptest::prelude::*;

const SETTINGS: TrackerSettings = TrackerSettings::with_thresholds(0.3, 0.6);

fn tracking() -> Tracker {
    let mut tracker = Tracker::new(SETTINGS).unwrap();
    for _ in 0..20 {
        tracker.update(Some(0.9));
    }
    assert_eq!(tracker.state(), TrackingState::Tracking);
    tracker
}

/// How many frames until the state changes, if it does within a hundred.
fn frames_until_change(tracker: &mut Tracker, confidence: Option<f32>) -> Option<usize> {
    let before = tracker.state();
    (1..=100).find(|_| tracker.update(confidence) != before)
}

#[test]
fn it_is_found_after_as_many_good_frames_as_settings_say() {
    let mut tracker = Tracker::new(SETTINGS).unwrap();
    assert_eq!(tracker.state(), TrackingState::Acquiring);
    assert_eq!(frames_until_change(&mut tracker, Some(0.9)), Some(3));
    assert_eq!(tracker.state(), TrackingState::Tracking);
}

#[test]
fn what_was_never_found_is_never_lost() {
    for confidence in [Some(0.0), Some(0.2), None] {
        let mut tracker = Tracker::new(SETTINGS).unwrap();
        assert_eq!(frames_until_change(&mut tracker, confidence), None);
    }
}

#[test]
fn a_single_bad_frame_does_not_lose_it() {
    for bad in [f32::MIN_POSITIVE, 0.01, 0.29] {
        let mut tracker = tracking();
        assert_eq!(tracker.update(Some(bad)), TrackingState::Tracking);
        assert_eq!(frames_until_change(&mut tracker, Some(0.9)), None);
    }
}

#[test]
fn a_step_loses_it_within_seven_frames() {
    let mut tracker = tracking();
    assert_eq!(frames_until_change(&mut tracker, Some(0.1)), Some(7));
    assert_eq!(tracker.state(), TrackingState::Lost(Loss::LowConfidence));
    assert_eq!(tracker.smoothed(), None);
}

#[test]
fn a_frame_without_support_loses_it_at_once() {
    for nothing in [0.0, -0.0] {
        let mut tracker = tracking();
        let state = tracker.update(Some(nothing));
        assert_eq!(state, TrackingState::Lost(Loss::NoSupport));
    }
}

#[test]
fn it_is_regained_by_new_evidence_alone() {
    let mut tracker = tracking();
    tracker.update(Some(0.0));
    assert_eq!(frames_until_change(&mut tracker, Some(0.59)), None);
    let frames = frames_until_change(&mut tracker, Some(0.9));
    assert!(matches!(frames, Some(3..=5)), "{frames:?}");
}

#[test]
fn flicker_around_either_threshold_toggles_nothing() {
    for middle in [0.3, 0.6] {
        let mut tracker = tracking();
        let mut lost = tracking();
        lost.update(Some(0.0));
        let (mut changes, mut changes_of_lost) = (0, 0);
        for frame in 0..1000 {
            let confidence = if frame % 2 == 0 { 0.05 } else { -0.05 } + middle;
            let before = (tracker.state(), lost.state());
            changes += usize::from(tracker.update(Some(confidence)) != before.0);
            changes_of_lost += usize::from(lost.update(Some(confidence)) != before.1);
        }
        assert!(changes <= 1 && changes_of_lost <= 1, "{middle}");
    }
}

#[test]
fn a_gap_that_is_short_changes_nothing_and_one_that_is_long_is_stale() {
    let mut tracker = tracking();
    for _ in 0..50 {
        for _ in 1..TrackerSettings::STALE_AFTER {
            assert_eq!(tracker.update(None), TrackingState::Tracking);
        }
        assert_eq!(tracker.update(Some(0.9)), TrackingState::Tracking);
    }
    let frames = frames_until_change(&mut tracker, None);
    assert_eq!(frames, Some(usize::from(TrackerSettings::STALE_AFTER)));
    assert_eq!(tracker.state(), TrackingState::Lost(Loss::Stale));
}

#[test]
fn good_frames_on_both_sides_of_a_long_gap_do_not_add_up() {
    let mut tracker = Tracker::new(SETTINGS).unwrap();
    for _ in 0..20 {
        tracker.update(Some(0.9));
        tracker.update(Some(0.9));
        for _ in 0..TrackerSettings::STALE_AFTER {
            assert_eq!(tracker.update(None), TrackingState::Acquiring);
        }
    }
}

#[test]
fn what_is_no_confidence_is_no_evidence() {
    for nonsense in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -0.5, 1.5] {
        let (mut told, mut missed) = (tracking(), tracking());
        for _ in 0..12 {
            assert_eq!(told.update(Some(nonsense)), missed.update(None));
            assert_eq!(told, missed);
        }
    }
}

#[test]
fn without_smoothing_the_last_confidence_stands() {
    for time_constant in [0.0, -0.0] {
        let settings = TrackerSettings {
            time_constant,
            ..SETTINGS
        };
        let mut tracker = Tracker::new(settings).unwrap();
        for confidence in [0.9, 0.2, 1.0, 0.7] {
            tracker.update(Some(confidence));
            let smoothed = tracker.smoothed().unwrap();
            assert!((smoothed - confidence).abs() < 1e-6);
        }
    }
}

#[test]
fn after_the_time_constant_an_eth_of_a_step_is_left() {
    let settings = TrackerSettings {
        time_constant: 8.0,
        ..SETTINGS
    };
    let mut tracker = Tracker::new(settings).unwrap();
    tracker.update(Some(1.0));
    for _ in 0..8 {
        tracker.update(Some(0.5));
    }
    let left = (tracker.smoothed().unwrap() - 0.5) / 0.5;
    assert!((left - cobra_infer::math::exp(-1.0)).abs() < 1e-5, "{left}");
}

#[test]
fn settings_that_make_no_sense_are_refused_by_what_is_wrong() {
    let thresholds = |lower, upper| Tracker::new(TrackerSettings::with_thresholds(lower, upper));
    for (lower, upper) in [(0.6, 0.3), (-0.1, 0.5), (0.1, 1.1), (f32::NAN, 0.5)] {
        let error = thresholds(lower, upper).unwrap_err();
        assert!(matches!(error, TrackerError::Thresholds { .. }));
        assert!(error.to_string().contains("0 <= lower <= upper <= 1"));
    }
    assert!(thresholds(0.5, 0.5).is_ok());
    for found in [-1.0, f32::INFINITY, f32::NAN] {
        let error = Tracker::new(TrackerSettings {
            time_constant: found,
            ..SETTINGS
        });
        assert!(matches!(error, Err(TrackerError::TimeConstant { .. })));
    }
    for change in [
        |settings: &mut TrackerSettings| settings.lost_after = 0,
        |settings: &mut TrackerSettings| settings.regained_after = 0,
        |settings: &mut TrackerSettings| settings.stale_after = 0,
    ] {
        let mut settings = SETTINGS;
        change(&mut settings);
        assert_eq!(Tracker::new(settings), Err(TrackerError::Frames));
    }
}

#[test]
fn the_thresholds_are_those_of_the_templates_calibration() {
    let mut content = Content::small();
    let bytes = content.encode();
    let template = Template::from_bytes(&bytes).unwrap();
    assert_eq!(TrackerSettings::for_template(&template), None);
    let zero = MeasuredShare {
        share: 0.0,
        low: 0.0,
        high: 0.01,
    };
    content.depth = Some(DepthSource {
        noise_share: 0.04,
        calibration: Some(Calibration {
            accept: 0.75,
            reject: 0.25,
            minimum_points: 10,
            target: 0.01,
            false_accepts: zero,
            wrong: 400,
            right: 400,
            source: CalibrationSource::Labelled,
        }),
        provenance: "",
    });
    let bytes = content.encode();
    let template = Template::from_bytes(&bytes).unwrap();
    assert_eq!(
        TrackerSettings::for_template(&template),
        Some(TrackerSettings::with_thresholds(0.25, 0.75))
    );
}

#[test]
fn a_tracker_is_a_few_words() {
    assert!(size_of::<Tracker>() <= 40, "{}", size_of::<Tracker>());
}

proptest! {
    #![proptest_config(crate::seed::config())]

    #[test]
    fn whatever_comes_the_smoothed_confidence_is_one(
        bits in vec(any::<u32>(), 0..200),
        shares in vec(0.0_f32..=1.0, 0..200),
        time_constant in 0.0_f32..20.0,
    ) {
        let settings = TrackerSettings { time_constant, ..SETTINGS };
        let mut tracker = Tracker::new(settings).unwrap();
        for confidence in bits.into_iter().map(f32::from_bits).chain(shares) {
            tracker.update(Some(confidence));
            if let Some(smoothed) = tracker.smoothed() {
                prop_assert!((0.0..=1.0).contains(&smoothed));
            }
        }
    }
}
