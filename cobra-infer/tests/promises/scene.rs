//! A camera, poses, and settings that most tests share.

use crate::content::Content;
use cobra_infer::mixture::Match;
use cobra_infer::score::PointScore;
use cobra_infer::{
    Assignment, Camera, Correspondence, Likelihood, Pose, Report, Scorer, Settings, Sigma,
    Template, Threshold,
};
use nalgebra::{Point2, Point3};

pub(crate) const COMPONENTS: usize = 8;

pub(crate) const EVERY_RULE: [(Assignment, Likelihood); 6] = [
    (Assignment::Nearest, Likelihood::Peak),
    (Assignment::Nearest, Likelihood::Density),
    (Assignment::Maximum, Likelihood::Peak),
    (Assignment::Maximum, Likelihood::Density),
    (Assignment::Soft, Likelihood::Peak),
    (Assignment::Soft, Likelihood::Density),
];

pub(crate) const THRESHOLDS: [Threshold; 3] = [Threshold::Paper, Threshold::Mean, Threshold::Worst];

pub(crate) const IDENTITY: [f32; 9] = [1., 0., 0., 0., 1., 0., 0., 0., 1.];

pub(crate) fn camera() -> Camera {
    Camera::new(400.0, 420.0, 320.0, 240.0).unwrap()
}

/// Straight ahead, shifted by `x` to the right, 500 away.
pub(crate) fn pose(x: f32) -> Pose {
    Pose::from_row_major(IDENTITY, [x, 0.0, 500.0]).unwrap()
}

pub(crate) fn settings(assignment: Assignment, likelihood: Likelihood, sigma: Sigma) -> Settings {
    Settings {
        assignment,
        likelihood,
        sigma,
        ..Settings::with_delta(2.0)
    }
}

/// What the camera sees of `point` when the object stands at `pose`.
pub(crate) fn observed(pose: &Pose, point: [f32; 3]) -> Correspondence {
    let point = Point3::from(point);
    let pixel = camera().project(&pose.to_camera(&point)).unwrap();
    Correspondence::new(pixel, point)
}

/// A correspondence whose back-projection at [`pose`]`(0)` is `point`, within rounding.
pub(crate) fn at(point: [f32; 3]) -> Correspondence {
    observed(&pose(0.0), point)
}

pub(crate) fn correspondence(pixel: [f32; 2], point: [f32; 3], weight: f32) -> Correspondence {
    Correspondence {
        pixel: Point2::from(pixel),
        point: Point3::from(point),
        weight,
    }
}

/// Scores in a stream and returns what every point came to as well.
pub(crate) fn stream(
    template: &Template<'_>,
    pose: &Pose,
    settings: &Settings,
    correspondences: &[Correspondence],
) -> (Vec<PointScore>, Report) {
    let mut scorer = Scorer::<COMPONENTS>::new(template, &camera(), pose, settings).unwrap();
    let points = correspondences.iter().map(|c| scorer.push(c)).collect();
    (points, scorer.finish())
}

pub(crate) fn score(
    content: &Content,
    pose: &Pose,
    settings: &Settings,
    correspondences: &[Correspondence],
) -> Report {
    let bytes = content.encode();
    let template = Template::from_bytes(&bytes).unwrap();
    stream(&template, pose, settings, correspondences).1
}

pub(crate) fn has_nan(points: &[PointScore], report: &Report) -> bool {
    let of_match = |found: &Match| {
        [
            found.distance,
            found.predicted,
            found.likelihood,
            found.threshold,
            found.residual(),
        ]
        .iter()
        .any(|number| number.is_nan())
    };
    let of_point = |point: &PointScore| {
        point.likelihood.is_nan() || point.found.as_ref().is_some_and(of_match)
    };
    let numbers = [
        report.confidence,
        report.threshold,
        report.weight_sum,
        report.inlier_share,
    ];
    points.iter().any(of_point) || numbers.iter().any(|number| number.is_nan())
}
