//! What a score must not depend on: the unit, the object's frame, the order of points and of
//! components.
#![expect(
    clippy::disallowed_methods,
    reason = "the factors are made independently of the crate's own functions"
)]

use crate::content::{Content, content};
use crate::scene::{COMPONENTS, EVERY_RULE, camera, observed};
use crate::tolerance::{MOVED, REORDERED};
use cobra_infer::template::Precision;
use cobra_infer::{
    Correspondence, Kernel, Metric, Pose, Report, Scorer, Settings, Sigma, Template,
};
use nalgebra::{Matrix3, Point3, Rotation3, Unit, UnitVector3, Vector3};
use proptest::collection::vec;
use proptest::prelude::*;

/// A pose by its parts: what moves an object's point into the camera's frame.
#[derive(Clone, Debug)]
struct Placed {
    rotation: Rotation3<f32>,
    translation: Vector3<f32>,
}

impl Placed {
    fn pose(&self) -> Pose {
        let m = self.rotation.matrix().transpose();
        let rows: [f32; 9] = core::array::from_fn(|i| m[i]);
        Pose::from_row_major(rows, self.translation.into()).unwrap()
    }
}

fn axis_angle() -> impl Strategy<Value = Rotation3<f32>> {
    [-3.0_f32..3.0, -3.0_f32..3.0, -3.0_f32..3.0]
        .prop_map(|v| Rotation3::from_scaled_axis(Vector3::from(v)))
}

fn placed() -> impl Strategy<Value = Placed> {
    (
        axis_angle(),
        [-20.0_f32..20.0, -20.0_f32..20.0, 80.0_f32..150.0],
    )
        .prop_map(|(rotation, translation)| Placed {
            rotation,
            translation: translation.into(),
        })
}

/// Points near the object, as they are seen at a pose and assigned to points a little off.
fn seen() -> impl Strategy<Value = Vec<([f32; 3], [f32; 3])>> {
    let near = || [-12.0_f32..12.0, -12.0_f32..12.0, -12.0_f32..12.0];
    vec((near(), near()), 12..20)
}

fn correspondences(placed: &Placed, seen: &[([f32; 3], [f32; 3])]) -> Vec<Correspondence> {
    seen.iter()
        .map(|(on, assigned)| Correspondence {
            point: Point3::from(*assigned),
            ..observed(&placed.pose(), *on)
        })
        .collect()
}

fn scored(
    content: &Content,
    placed: &Placed,
    settings: &Settings,
    points: &[Correspondence],
) -> Report {
    let bytes = content.encode();
    let template = Template::from_bytes(&bytes).unwrap();
    let mut scorer =
        Scorer::<COMPONENTS>::new(&template, &camera(), &placed.pose(), settings).unwrap();
    for point in points {
        scorer.push(point);
    }
    scorer.finish()
}

fn settings() -> impl Strategy<Value = Settings> {
    (prop::sample::select(&EVERY_RULE[..]), 0.1_f32..4.0).prop_map(
        |((assignment, likelihood), noise)| Settings {
            assignment,
            likelihood,
            sigma: Sigma::Template { noise },
            ..Settings::with_delta(2.0)
        },
    )
}

/// The object in another unit, of which 1 of the old is `factor`.
fn in_unit(content: &Content, factor: f32) -> Content {
    let mut content = content.clone();
    let scale = |x: &mut f32| *x *= factor;
    content.centre.iter_mut().for_each(scale);
    scale(&mut content.radius);
    scale(&mut content.diameter);
    for part in &mut content.parts {
        part.centre.iter_mut().for_each(scale);
        scale(&mut part.sigma_hat);
        scale(&mut part.hyperparameters.prior_mean);
        part.weights.iter_mut().for_each(scale);
        part.precision = part.precision.and_then(|precision| {
            Precision::from_factor(precision.factor().map(|entry| entry / factor))
        });
    }
    content
}

/// The object in another frame: p ↦ R p + t.
fn in_frame(content: &Content, rotation: &Rotation3<f32>, shift: &Vector3<f32>) -> Content {
    let moved = |p: [f32; 3]| (rotation * Point3::from(p) + shift).coords.into();
    let mut content = content.clone();
    content.centre = moved(content.centre);
    for part in &mut content.parts {
        part.centre = moved(part.centre);
        part.precision = part.precision.map(|precision| turned(&precision, rotation));
        for u in &mut part.directions {
            let turned: UnitVector3<f32> = Unit::new_normalize(rotation * u.into_inner());
            *u = turned;
        }
    }
    content
}

/// R Q Rᵀ by its factor.
fn turned(precision: &Precision, rotation: &Rotation3<f32>) -> Precision {
    let [xx, yx, yy, zx, zy, zz] = precision.factor().map(f64::from);
    let lower = Matrix3::new(xx, 0., 0., yx, yy, 0., zx, zy, zz);
    let turned = rotation.matrix().cast::<f64>() * lower;
    let lower = (turned * turned.transpose()).cholesky().unwrap().l();
    let entries = [(0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2)];
    Precision::from_factor(entries.map(|entry| lower[entry] as f32)).unwrap()
}

/// Kernels of the chord or of the inner product: those that a rotation leaves alone.
fn turns_with_the_object(content: &Content) -> bool {
    content.model.metric == Metric::Chord && content.model.kernel != Kernel::Periodic
}

proptest! {
    #![proptest_config(crate::seed::config())]

    #[test]
    fn another_unit_changes_no_bit_of_a_peak_score_where_the_factor_is_a_power_of_two(
        content in content(),
        placed in placed(),
        seen in seen(),
        settings in settings(),
        power in -6..7,
    ) {
        let factor = 2.0_f32.powi(power);
        let points = correspondences(&placed, &seen);
        let before = scored(&content, &placed, &settings, &points);
        let scaled: Vec<_> = points
            .iter()
            .map(|c| Correspondence { point: c.point * factor, ..*c })
            .collect();
        let there = Placed { translation: factor * placed.translation, ..placed };
        let Sigma::Template { noise } = settings.sigma else { unreachable!() };
        let settings = Settings {
            sigma: Sigma::Template { noise: factor * noise },
            delta: factor * settings.delta,
            ..settings
        };
        let after = scored(&in_unit(&content, factor), &there, &settings, &scaled);
        if settings.likelihood == cobra_infer::Likelihood::Peak {
            prop_assert_eq!(before, after);
        } else {
            // A density is in 1/length; which component is the likeliest may turn on ln σ.
            let (a, b) = (before.confidence, factor * after.confidence);
            prop_assert!((a - b).abs() <= MOVED as f32 * (1.0 + a), "{a} {b}");
        }
    }

    #[test]
    fn another_frame_of_the_object_changes_no_score(
        content in content(),
        placed in placed(),
        seen in seen(),
        settings in settings(),
        rotation in axis_angle(),
        shift in [-10.0_f32..10.0, -10.0_f32..10.0, -10.0_f32..10.0],
    ) {
        prop_assume!(turns_with_the_object(&content));
        let shift = Vector3::from(shift);
        let points = correspondences(&placed, &seen);
        let before = scored(&content, &placed, &settings, &points);
        let moved: Vec<_> = points
            .iter()
            .map(|c| Correspondence { point: rotation * c.point + shift, ..*c })
            .collect();
        let back = placed.rotation * rotation.inverse();
        let there = Placed {
            rotation: back,
            translation: placed.translation - back * shift,
        };
        let after = scored(&in_frame(&content, &rotation, &shift), &there, &settings, &moved);
        let (a, b) = (f64::from(before.confidence), f64::from(after.confidence));
        prop_assert!((a - b).abs() <= MOVED, "{a} {b}");
    }

    #[test]
    fn the_order_of_components_changes_no_score(
        content in content(),
        placed in placed(),
        seen in seen(),
        settings in settings(),
    ) {
        let points = correspondences(&placed, &seen);
        let before = scored(&content, &placed, &settings, &points);
        let mut turned = content;
        turned.parts.reverse();
        let after = scored(&turned, &placed, &settings, &points);
        let (a, b) = (f64::from(before.confidence), f64::from(after.confidence));
        prop_assert!((a - b).abs() <= REORDERED * (1.0 + a), "{a} {b}");
    }

    #[test]
    fn the_order_of_points_changes_no_score(
        content in content(),
        placed in placed(),
        seen in seen(),
        settings in settings(),
    ) {
        let mut points = correspondences(&placed, &seen);
        let before = scored(&content, &placed, &settings, &points);
        points.reverse();
        let after = scored(&content, &placed, &settings, &points);
        for (a, b) in [(before.confidence, after.confidence), (before.threshold, after.threshold)] {
            let (a, b) = (f64::from(a), f64::from(b));
            prop_assert!((a - b).abs() <= REORDERED * (1.0 + a), "{a} {b}");
        }
    }
}
