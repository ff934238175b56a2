//! A sphere of radius 40 seen from 500 away: scores that can be computed by hand.
//!
//! Shifted sideways by 9, its foremost point comes back at distance √(40² + 9²) = 41 from the
//! centre: a residual of 1.

use crate::content::Content;
use crate::scene::{at, pose, score, settings};
use crate::tolerance::BY_HAND;
use cobra_infer::{Assignment, Decision, Likelihood, Rejection, Settings, Sigma};

const FOREMOST: [f32; 3] = [0.0, 0.0, -40.0];

fn close(found: f32, expected: f64) -> bool {
    (f64::from(found) / expected - 1.0).abs() <= BY_HAND
}

#[test]
fn a_perfectly_placed_sphere_scores_one() {
    let content = Content::sphere(40.0, 1.0);
    let points: Vec<_> = (0..100)
        .map(|i| {
            let z = -(i as f32) / 99.0;
            let side = cobra_infer::math::Real::square_root(1.0 - z * z);
            let turned = [[side, 0.0], [0.0, side], [-0.6 * side, 0.8 * side]][i % 3];
            at([40.0 * turned[0], 40.0 * turned[1], 40.0 * z])
        })
        .collect();
    for assignment in [Assignment::Nearest, Assignment::Maximum, Assignment::Soft] {
        let settings = Settings {
            assignment,
            ..Settings::with_delta(2.0)
        };
        let report = score(&content, &pose(0.0), &settings, &points);
        assert_eq!(report.confidence, 1.0);
        assert_eq!(report.inlier_share, 1.0);
        assert_eq!(report.decision, Decision::Accept);
    }
}

#[test]
fn a_shifted_sphere_scores_what_one_computes_by_hand() {
    let content = Content::sphere(40.0, 1.0);
    let points = [at(FOREMOST); 10];
    let report = score(&content, &pose(9.0), &Settings::with_delta(2.0), &points);
    // e^(−1/2), and (1 − e^−2)/4.
    assert!(close(report.confidence, 0.606_530_66), "{report:?}");
    assert!(close(report.threshold, 0.216_166_18), "{report:?}");
    assert_eq!(report.decision, Decision::Accept);
    assert_eq!(report.inlier_share, 1.0);
}

#[test]
fn the_density_of_a_shifted_sphere_is_that_of_the_normal_distribution() {
    let content = Content::sphere(40.0, 1.0);
    let points = [at(FOREMOST); 10];
    let template = Sigma::Template { noise: 0.0 };
    let settings = settings(Assignment::Nearest, Likelihood::Density, template);
    let report = score(&content, &pose(9.0), &settings, &points);
    assert!(close(report.confidence, 0.241_970_72), "{report:?}");
    assert!(close(report.threshold, 0.086_237_35), "{report:?}");
}

#[test]
fn a_fixed_sigma_replaces_the_templates() {
    let content = Content::sphere(40.0, 0.001);
    let points = [at(FOREMOST); 10];
    let settings = settings(Assignment::Nearest, Likelihood::Peak, Sigma::Fixed(2.0));
    let report = score(&content, &pose(9.0), &settings, &points);
    // e^(−1/8), and 1 − e^(−1/2) with δ = σ = 2.
    assert!(close(report.confidence, 0.882_496_9), "{report:?}");
    assert!(close(report.threshold, 0.393_469_34), "{report:?}");
}

#[test]
fn noise_widens_the_templates_sigma() {
    let content = Content::sphere(40.0, 0.6);
    let points = [at(FOREMOST); 10];
    let noise = Sigma::Template { noise: 0.8 };
    let settings = settings(Assignment::Nearest, Likelihood::Peak, noise);
    let report = score(&content, &pose(9.0), &settings, &points);
    // 0.6² + 0.8² = 1.
    assert!(close(report.confidence, 0.606_530_66), "{report:?}");
}

#[test]
fn a_sphere_shifted_beyond_the_tolerance_is_rejected() {
    // √(20² + 21²) = 29: a residual of 9.
    let content = Content::sphere(20.0, 5.0);
    let points = [at([0.0, 0.0, -20.0]); 10];
    let settings = Settings::with_delta(2.0);
    let report = score(&content, &pose(21.0), &settings, &points);
    // e^(−81/50), against (1 − e^−0.08)/0.16.
    assert!(close(report.confidence, 0.197_898_7), "{report:?}");
    assert!(close(report.threshold, 0.480_522_8), "{report:?}");
    let below = Rejection::BelowThreshold;
    assert_eq!(report.decision, Decision::Reject(below));
    assert_eq!(report.inlier_share, 0.0);
}

#[test]
fn weights_move_the_mean_between_the_points() {
    let content = Content::sphere(40.0, 1.0);
    let mut points = [at(FOREMOST); 10];
    // A sideways shift of 9 moves the rim's residual by 9, where the peak is e^(−40).
    points[0] = at([-40.0, 0.0, 0.0]);
    points[0].weight = 27.0;
    let report = score(&content, &pose(9.0), &Settings::with_delta(2.0), &points);
    assert!(close(report.confidence, 0.25 * 0.606_530_66), "{report:?}");
    assert_eq!(report.weight_sum, 36.0);
    assert_eq!(report.inlier_share, 0.9);
}
