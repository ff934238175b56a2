//! Every decision and its reason.

use crate::content::Content;
use crate::scene::{EVERY_RULE, at, correspondence, pose, score, settings, stream};
use cobra_infer::{
    Correspondence, Decision, Doubt, Likelihood, Rejection, Report, Settings, Sigma, Template,
};

const ON_SURFACE: [f32; 3] = [0.0, 0.0, -40.0];

fn decide(points: &[Correspondence]) -> Report {
    let content = Content::sphere(40.0, 1.0);
    let settings = Settings::with_delta(2.0);
    score(&content, &pose(0.0), &settings, points)
}

fn undecided(points: &[Correspondence], doubt: Doubt) -> Report {
    let report = decide(points);
    assert_eq!(report.decision, Decision::Undecided(doubt), "{report:?}");
    report
}

fn weighted(weight: f32) -> Correspondence {
    Correspondence {
        weight,
        ..at(ON_SURFACE)
    }
}

#[test]
fn fewer_points_than_the_minimum_leave_it_undecided() {
    for count in 0..10 {
        let report = undecided(&vec![at(ON_SURFACE); count], Doubt::TooFewPoints);
        assert_eq!(report.points, count as u32);
    }
    assert_eq!(decide(&[at(ON_SURFACE); 10]).decision, Decision::Accept);
}

#[test]
fn no_point_at_all_is_too_few_whatever_the_minimum() {
    let content = Content::sphere(40.0, 1.0);
    let settings = Settings {
        minimum_points: 0,
        ..Settings::with_delta(2.0)
    };
    let report = score(&content, &pose(0.0), &settings, &[]);
    assert_eq!(report.decision, Decision::Undecided(Doubt::TooFewPoints));
    assert_eq!((report.confidence, report.threshold), (0.0, 0.0));
    let report = score(&content, &pose(0.0), &settings, &[at(ON_SURFACE)]);
    assert_eq!(report.decision, Decision::Accept);
}

#[test]
fn points_without_weight_do_not_make_up_the_minimum() {
    let mut points = vec![weighted(0.0); 20];
    points.extend([at(ON_SURFACE); 9]);
    let report = undecided(&points, Doubt::TooFewPoints);
    assert_eq!((report.points, report.weight_sum), (29, 9.0));
    points.push(at(ON_SURFACE));
    assert_eq!(decide(&points).decision, Decision::Accept);
}

#[test]
fn a_tolerance_so_large_that_any_pose_would_pass_leaves_it_undecided() {
    let content = Content::sphere(40.0, 1.0);
    let settings = Settings::with_delta(1e30);
    let report = score(&content, &pose(0.0), &settings, &[at(ON_SURFACE); 10]);
    assert_eq!(report.decision, Decision::Undecided(Doubt::NoThreshold));
    assert_eq!(report.threshold, 0.0);
}

#[test]
fn no_weight_leaves_it_undecided() {
    for weight in [0.0, -0.0] {
        let report = undecided(&[weighted(weight); 10], Doubt::NoWeight);
        assert_eq!(report.confidence, 0.0);
    }
}

#[test]
fn weights_too_small_to_multiply_leave_it_undecided() {
    // 1e-45 is the smallest f32: times 0.6 it is itself again, times 0.4 it is 0.
    for weight in [1e-45, 1e-40, 0.9 * f32::MIN_POSITIVE] {
        let report = undecided(&[weighted(weight); 10], Doubt::NoWeight);
        assert_eq!((report.confidence, report.threshold), (0.0, 0.0));
    }
    let report = decide(&[weighted(f32::MIN_POSITIVE); 10]);
    assert_eq!(report.decision, Decision::Accept);
}

#[test]
fn weights_that_overflow_leave_it_undecided() {
    let report = undecided(&[weighted(f32::MAX); 10], Doubt::NonFiniteInput);
    assert_eq!(report.weight_sum, f32::INFINITY);
    assert_eq!(report.confidence, 0.0);
}

#[test]
fn one_number_that_is_not_finite_leaves_it_undecided() {
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for place in 0..6 {
            let mut numbers = [320.0, 240.0, 0.0, 0.0, -40.0, 1.0];
            numbers[place] = value;
            let [u, v, x, y, z, weight] = numbers;
            let mut points = [at(ON_SURFACE); 10];
            points[3] = correspondence([u, v], [x, y, z], weight);
            let report = undecided(&points, Doubt::NonFiniteInput);
            assert_eq!((report.points, report.weight_sum), (10, 9.0));
        }
    }
}

#[test]
fn a_negative_weight_leaves_it_undecided() {
    for weight in [-1.0, -1e-45, f32::MIN] {
        let mut points = [at(ON_SURFACE); 10];
        points[9].weight = weight;
        undecided(&points, Doubt::NegativeWeight);
    }
}

#[test]
fn the_first_fault_is_the_reason() {
    let mut points = [at(ON_SURFACE); 10];
    points[2].weight = -1.0;
    points[4].weight = f32::NAN;
    undecided(&points, Doubt::NegativeWeight);
    points.reverse();
    undecided(&points, Doubt::NonFiniteInput);
    // A fault comes before a count.
    undecided(&points[5..8], Doubt::NonFiniteInput);
}

#[test]
fn a_point_behind_the_camera_has_likelihood_zero() {
    let behind = correspondence([320.0, 240.0], [0.0, 0.0, -540.0], 1.0);
    let content = Content::sphere(40.0, 1.0);
    let bytes = content.encode();
    let template = Template::from_bytes(&bytes).unwrap();
    let mut points = [at(ON_SURFACE); 10];
    points[0] = behind;
    for (assignment, likelihood) in EVERY_RULE {
        let settings = settings(assignment, likelihood, Sigma::Fixed(1.0));
        let (scores, report) = stream(&template, &pose(0.0), &settings, &points);
        assert_eq!((scores[0].likelihood, scores[0].found), (0.0, None));
        assert!(scores[1].likelihood > 0.0);
        assert_eq!(report.behind_camera, 1);
        assert_eq!(report.decision, Decision::Accept);
        if likelihood == Likelihood::Peak {
            assert_eq!(report.confidence, 0.9);
        }
    }
}

#[test]
fn all_points_behind_the_camera_reject() {
    let behind = correspondence([320.0, 240.0], [0.0, 0.0, -540.0], 1.0);
    let report = decide(&[behind; 10]);
    let rejection = Rejection::BehindCamera;
    assert_eq!(report.decision, Decision::Reject(rejection));
    assert_eq!((report.behind_camera, report.confidence), (10, 0.0));
}

#[test]
fn a_depth_that_overflows_is_not_behind_the_camera() {
    let nowhere = correspondence([3e38, 240.0], [3e38, 3e38, 3e38], 1.0);
    let report = decide(&[nowhere; 10]);
    assert_eq!(report.decision, Decision::Reject(Rejection::NoSupport));
    assert_eq!(report.behind_camera, 0);
}

#[test]
fn a_confidence_of_zero_is_never_accepted() {
    // A δ so much larger than σ that the threshold is 0 too.
    let content = Content::sphere(40.0, 1e-30);
    let settings = Settings::with_delta(1e10);
    let points = [at([0.0, 0.0, -90.0]); 10];
    let report = score(&content, &pose(0.0), &settings, &points);
    assert_eq!((report.confidence, report.threshold), (0.0, 0.0));
    assert_eq!(report.decision, Decision::Reject(Rejection::NoSupport));
}

#[test]
fn a_point_on_its_reference_point_supports_nothing() {
    let report = decide(&[at([0.0; 3]); 10]);
    assert_eq!(report.decision, Decision::Reject(Rejection::NoSupport));
    assert_eq!(report.behind_camera, 0);
    // It asks as much as the strictest component does.
    let on_surface = decide(&[at(ON_SURFACE); 10]);
    assert_eq!(report.threshold, on_surface.threshold);
}

#[test]
fn points_that_nothing_explains_never_lower_the_threshold() {
    let mut content = Content::small();
    content.parts[0].sigma_hat = 0.1;
    content.parts[1].sigma_hat = 5.0;
    let settings = Settings::with_delta(2.0);
    let explained = vec![at([9.0, 0.0, -3.0]); 10];
    let mut mixed = explained.clone();
    mixed.extend([correspondence([320.0, 240.0], [0.0, 0.0, -900.0], 1.0); 10]);
    let [explained, mixed] =
        [explained, mixed].map(|points| score(&content, &pose(0.0), &settings, &points));
    assert!(mixed.threshold >= explained.threshold);
    assert!(mixed.confidence <= explained.confidence);
}

#[test]
fn every_decision_has_a_name_and_a_reason_of_its_own() {
    let decisions = [
        Decision::Accept,
        Decision::Reject(Rejection::BelowThreshold),
        Decision::Reject(Rejection::NoSupport),
        Decision::Reject(Rejection::BehindCamera),
        Decision::Undecided(Doubt::TooFewPoints),
        Decision::Undecided(Doubt::NoWeight),
        Decision::Undecided(Doubt::NonFiniteInput),
        Decision::Undecided(Doubt::NegativeWeight),
        Decision::Undecided(Doubt::NoThreshold),
    ];
    let mut reasons: Vec<_> = decisions.iter().map(|decision| decision.reason()).collect();
    reasons.sort_unstable();
    reasons.dedup();
    assert_eq!(reasons.len(), decisions.len());
    let names = decisions.map(Decision::name);
    assert_eq!(names[0], "accept");
    assert!(names[1..4].iter().all(|name| *name == "reject"));
    assert!(names[4..].iter().all(|name| *name == "undecided"));
}
