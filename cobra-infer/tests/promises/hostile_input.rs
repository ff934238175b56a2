//! Scores of any input at all: never NaN, a confidence between 0 and 1, the same bits streamed and
//! in a batch, and nothing that depends on the order or the scale of what it should not.
#![expect(
    clippy::disallowed_methods,
    reason = "weights are drawn here, not computed on the controller"
)]

use crate::content::{Content, content};
use crate::scene::{
    COMPONENTS, EVERY_RULE, IDENTITY, THRESHOLDS, camera, correspondence, has_nan, pose, settings,
    stream,
};
use crate::template_mutations::SPECIAL;
use crate::tolerance::CONFIDENCE;
use cobra_infer::{
    Camera, Correspondence, Decision, Likelihood, Pose, Report, Scorer, Settings, Sigma, Template,
    score,
};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;

/// Any bits, numbers at which arithmetic goes wrong, and plausible numbers, in equal shares.
fn number() -> impl Strategy<Value = f32> {
    prop_oneof![
        any::<u32>().prop_map(f32::from_bits),
        select(&SPECIAL[..]),
        -700.0_f32..700.0,
    ]
}

fn any_correspondence() -> impl Strategy<Value = Correspondence> {
    prop::array::uniform6(number())
        .prop_map(|[u, v, x, y, z, w]| correspondence([u, v], [x, y, z], w))
}

fn finite_correspondence() -> impl Strategy<Value = Correspondence> {
    any_correspondence().prop_map(|mut c| {
        let finite = |x: &mut f32| {
            if !x.is_finite() {
                *x = 0.5;
            }
        };
        c.pixel.iter_mut().for_each(finite);
        c.point.iter_mut().for_each(finite);
        finite(&mut c.weight);
        c.weight = cobra_infer::math::abs(c.weight);
        c
    })
}

/// Points near the template, with weights between 1/4 and 4.
fn near_correspondence() -> impl Strategy<Value = Correspondence> {
    (
        [300.0_f32..340.0, 220.0_f32..260.0],
        [-20.0_f32..20.0, -20.0_f32..20.0, -20.0_f32..20.0],
        0.25_f32..4.0,
    )
        .prop_map(|(pixel, point, weight)| correspondence(pixel, point, weight))
}

fn sigma() -> impl Strategy<Value = Sigma> {
    prop_oneof![
        (0.0_f32..5.0).prop_map(|noise| Sigma::Template { noise }),
        (0.1_f32..5.0).prop_map(Sigma::Fixed),
    ]
}

fn hostile_sigma() -> impl Strategy<Value = Sigma> {
    prop_oneof![
        number().prop_map(|noise| Sigma::Template { noise }),
        number().prop_map(Sigma::Fixed),
        sigma(),
    ]
}

fn close(a: f32, b: f32) -> bool {
    (f64::from(a) - f64::from(b)).abs() <= CONFIDENCE
}

fn same_bits(a: &Report, b: &Report) -> bool {
    let bits =
        |r: &Report| [r.confidence, r.threshold, r.weight_sum, r.inlier_share].map(f32::to_bits);
    bits(a) == bits(b) && a == b
}

proptest! {
    #![proptest_config(crate::seed::config())]

    #[test]
    fn nothing_is_ever_nan_and_the_peak_confidence_is_between_0_and_1(
        content in content(),
        threshold in select(&THRESHOLDS[..]),
        rule in select(&EVERY_RULE[..]),
        sigma in hostile_sigma(),
        delta in number(),
        intrinsics in prop::array::uniform4(number()),
        t in prop::array::uniform3(number()),
        correspondences in prop_oneof![
            vec(any_correspondence(), 0..14),
            vec(finite_correspondence(), 0..14),
        ],
    ) {
        let bytes = content.encode();
        let template = Template::from_bytes(&bytes).unwrap();
        let [fx, fy, cx, cy] = intrinsics;
        let camera = Camera::new(fx, fy, cx, cy).unwrap_or(camera());
        let pose = Pose::from_row_major(IDENTITY, t).unwrap_or(pose(0.0));
        let (assignment, likelihood) = rule;
        let settings = Settings {
            delta,
            threshold,
            minimum_points: 1,
            ..settings(assignment, likelihood, sigma)
        };
        let Ok(mut scorer) = Scorer::<COMPONENTS>::new(&template, &camera, &pose, &settings)
        else {
            return Ok(());
        };
        let mut points = Vec::new();
        for c in &correspondences {
            points.push(scorer.push(c));
            // A report can be asked for at any time.
            prop_assert!(!has_nan(&points, &scorer.finish()));
        }
        let report = scorer.finish();
        prop_assert!(!has_nan(&points, &report), "{points:?} {report:?}");
        prop_assert!(report.confidence >= 0.0 && report.threshold >= 0.0);
        prop_assert!(report.behind_camera <= report.points);
        prop_assert!(report.uncovered <= report.points - report.behind_camera);
        prop_assert!((0.0..=1.0).contains(&report.inlier_share));
        if likelihood == Likelihood::Peak {
            prop_assert!(report.confidence <= 1.0 && report.threshold <= 1.0, "{report:?}");
        }
        if report.decision == Decision::Accept {
            prop_assert!(report.confidence > 0.0 && report.confidence >= report.threshold);
        }
        let broken = |c: &Correspondence| !c.is_finite() || c.weight < 0.0;
        if correspondences.iter().any(broken) {
            prop_assert!(matches!(report.decision, Decision::Undecided(_)));
        }
    }

    #[test]
    fn streaming_and_batch_give_the_same_bits(
        content in content(),
        rule in select(&EVERY_RULE[..]),
        sigma in sigma(),
        correspondences in vec(prop_oneof![any_correspondence(), near_correspondence()], 0..30),
    ) {
        let bytes = content.encode();
        let template = Template::from_bytes(&bytes).unwrap();
        let settings = settings(rule.0, rule.1, sigma);
        let (_, streamed) = stream(&template, &pose(0.0), &settings, &correspondences);
        let batch = score::<COMPONENTS>(
            &template,
            &camera(),
            &pose(0.0),
            &settings,
            &correspondences,
        )
        .unwrap();
        prop_assert!(same_bits(&streamed, &batch));
    }

    #[test]
    fn the_order_of_points_does_not_matter(
        content in content(),
        sigma in sigma(),
        (ordered, shuffled) in vec(near_correspondence(), 10..60)
            .prop_flat_map(|points| (Just(points.clone()), Just(points).prop_shuffle())),
    ) {
        let bytes = content.encode();
        let template = Template::from_bytes(&bytes).unwrap();
        for (assignment, likelihood) in EVERY_RULE.into_iter().step_by(2) {
            let settings = settings(assignment, likelihood, sigma);
            let [a, b] = [&ordered, &shuffled]
                .map(|points| stream(&template, &pose(0.0), &settings, points).1);
            prop_assert!(close(a.confidence, b.confidence), "{a:?} {b:?}");
            prop_assert!(close(a.threshold, b.threshold), "{a:?} {b:?}");
        }
    }

    #[test]
    fn any_constant_weight_gives_the_same_confidence(
        content in content(),
        sigma in sigma(),
        exponent in -37.9_f64..36.0,
        correspondences in vec(near_correspondence(), 10..60),
    ) {
        let bytes = content.encode();
        let template = Template::from_bytes(&bytes).unwrap();
        let constant = 10_f64.powf(exponent) as f32;
        let weighted = |weight| -> Vec<_> {
            correspondences
                .iter()
                .map(|c| Correspondence { weight, ..*c })
                .collect()
        };
        for (assignment, likelihood) in EVERY_RULE.into_iter().step_by(2) {
            let settings = settings(assignment, likelihood, sigma);
            let [a, b] = [1.0, constant]
                .map(|weight| stream(&template, &pose(0.0), &settings, &weighted(weight)).1);
            prop_assert!(close(a.confidence, b.confidence), "{constant:e}: {a:?} {b:?}");
            prop_assert!(close(a.threshold, b.threshold), "{constant:e}: {a:?} {b:?}");
        }
    }

    #[test]
    fn a_power_of_two_as_weight_changes_no_bit(
        power in -20_i32..20,
        correspondences in vec(near_correspondence(), 10..30),
    ) {
        let bytes = Content::small().encode();
        let template = Template::from_bytes(&bytes).unwrap();
        let scale = 2_f32.powi(power);
        let mut scaled = correspondences.clone();
        scaled.iter_mut().for_each(|c| c.weight *= scale);
        for (assignment, likelihood) in EVERY_RULE {
            let settings = settings(assignment, likelihood, Sigma::Fixed(5.0));
            let [a, b] = [&correspondences, &scaled]
                .map(|points| stream(&template, &pose(0.0), &settings, points).1);
            prop_assert_eq!(a.confidence.to_bits(), b.confidence.to_bits());
            prop_assert_eq!(a.threshold.to_bits(), b.threshold.to_bits());
        }
    }
}
