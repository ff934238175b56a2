//! The check against depth, on a sphere of radius 40 before a camera 500 away: what comes of it can be
//! computed by hand.

use crate::charts::charts;
use crate::content::{Content, Valid};
use crate::scene::{IDENTITY, camera, pose};
use crate::seed;
use cobra_infer::depth::{
    Cause, Cell, Correction, DepthCheck, DepthError, DepthImage, DepthPixel, DepthReport,
    DepthSettings, DepthWords, Noise, Observed, Seen, TemplateSurface, Thresholds, check_depth,
};
use cobra_infer::{Decision, Doubt, Pose, Rejection, ScoreError, Template, Unit};
use nalgebra::Point2;
use proptest::prelude::*;

const RADIUS: f32 = 40.0;

/// σ_m: 8 % of 80.
const SIGMA: f32 = 6.4;

/// A sphere that speaks in every direction, its template's own σ next to nothing.
fn sphere() -> Content {
    let mut content = Content::sphere(RADIUS, 1e-3);
    for part in &mut content.parts {
        part.validity = Some(Valid {
            side: 32,
            cells: vec![true; 32 * 32],
            ..Valid::everywhere()
        });
    }
    content
}

/// What a depth camera sees of a sphere before a background, and of a wall that ends at a column.
#[derive(Clone, Copy)]
struct Scene {
    centre: [f32; 3],
    background: Option<f32>,
    wall: Option<(u16, f32)>,
}

impl Scene {
    fn at(x: f32, z: f32) -> Self {
        Self {
            centre: [x, 0.0, z],
            background: Some(f32::INFINITY),
            wall: None,
        }
    }

    fn sphere_depth(&self, column: u16, row: u16) -> Option<f32> {
        let ray = camera().ray(&Point2::new(f32::from(column), f32::from(row)));
        let centre = nalgebra::Vector3::from(self.centre);
        let (a, b) = (ray.norm_squared(), ray.dot(&centre));
        let rest = b * b - a * (centre.norm_squared() - RADIUS * RADIUS);
        (rest > 0.0).then(|| (b - cobra_infer::math::Real::square_root(rest)) / a)
    }

    /// The pixels that show the sphere.
    fn mask(&self) -> Vec<DepthPixel> {
        let all = (0..480_u16).flat_map(|row| (0..640_u16).map(move |column| (column, row)));
        all.step_by(7)
            .filter_map(|(column, row)| {
                let depth = self.sphere_depth(column, row)?;
                (self.depth(column, row) == Some(depth)).then_some(DepthPixel {
                    column,
                    row,
                    depth,
                })
            })
            .collect()
    }
}

impl DepthImage for Scene {
    fn width(&self) -> u16 {
        640
    }

    fn height(&self) -> u16 {
        480
    }

    fn depth(&self, column: u16, row: u16) -> Option<f32> {
        match self.wall {
            Some((end, depth)) if column < end => Some(depth),
            _ => self.sphere_depth(column, row).or(self.background),
        }
    }
}

fn settings() -> DepthSettings {
    DepthSettings {
        noise: Noise::Share(0.08),
        thresholds: Some(Thresholds {
            accept: 0.6,
            reject: 0.3,
        }),
        ..DepthSettings::DEFAULT
    }
}

fn run(pose: &Pose, scene: &Scene, masked: bool, settings: &DepthSettings) -> DepthReport {
    let bytes = sphere().encode();
    let template = Template::from_bytes(&bytes).unwrap();
    let mask = scene.mask();
    let observed = if masked {
        Observed::Pixels(&mask)
    } else {
        Observed::Silhouette
    };
    let mut cells = vec![Cell::EMPTY; settings.cells()];
    check_depth::<8>(
        &template,
        &camera(),
        pose,
        settings,
        observed,
        scene,
        &mut cells,
    )
    .unwrap()
}

fn cause(pose: &Pose, report: &DepthReport) -> Cause {
    report.cause(&Correction::between(pose, &report.refined, [0.0; 3]))
}

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
fn metres_taken_for_millimetres_are_told_from_other_errors() {
    let metres = Pose::from_row_major(IDENTITY, [0.0, 0.0, 0.5]).unwrap();
    let report = run(&metres, &Scene::at(0.0, 500.0), true, &settings());
    let factor = 1000.0;
    assert_eq!(cause(&metres, &report), Cause::Scale { factor });
    let far = Pose::from_row_major(IDENTITY, [0.0, 0.0, 5000.0]).unwrap();
    let report = run(&far, &Scene::at(0.0, 500.0), false, &settings());
    assert_eq!(cause(&far, &report), Cause::Scale { factor: 0.1 });
    let text = cause(&far, &report).to_string();
    assert!(text.starts_with("wrong scale"), "{text}");
}

#[test]
fn every_pixel_says_how_far_behind_or_in_front_of_the_surface_it_was_seen() {
    let bytes = sphere().encode();
    let template = Template::from_bytes(&bytes).unwrap();
    let surface = TemplateSurface::<1>::new(&template, SIGMA).unwrap();
    let settings = settings();
    let check = DepthCheck::new(&surface, &camera(), &settings).unwrap();
    for offset in [-9.0_f32, 0.0, 6.0] {
        let scene = Scene::at(0.0, 500.0 + offset);
        let mut mask = scene.mask();
        let unmeasured = DepthPixel {
            depth: 0.0,
            ..mask[0]
        };
        mask.push(unmeasured);
        let (mut count, mut sum, mut largest) = (0_u32, 0.0_f32, 0.0_f32);
        check.pixel_residuals(&pose(0.0), &mask, &mut |pixel, residual| {
            let residual = residual.unwrap();
            assert!(pixel.depth > 0.0);
            let scaled = residual.distance / SIGMA;
            assert!(
                (residual.likelihood - cobra_infer::math::exp(-0.5 * scaled * scaled)).abs() < 1e-3
            );
            count += 1;
            sum += residual.distance;
            if residual.distance.abs() > largest.abs() {
                largest = residual.distance;
            }
        });
        assert_eq!(count as usize, mask.len() - 1);
        // Along the normal: all of the offset in the sphere's middle, less towards its rim.
        assert!((largest - offset).abs() < 0.2, "{offset}: {largest}");
        assert!((sum / count as f32) * offset >= 0.0);
    }
}

#[test]
fn the_points_of_the_visible_surface_are_those_of_the_report() {
    let bytes = sphere().encode();
    let template = Template::from_bytes(&bytes).unwrap();
    let surface = TemplateSurface::<1>::new(&template, SIGMA).unwrap();
    let settings = settings();
    let check = DepthCheck::new(&surface, &camera(), &settings).unwrap();
    let scene = Scene {
        wall: Some((300, 300.0)),
        ..Scene::at(14.0, 500.0)
    };
    let mut cells = vec![Cell::EMPTY; settings.cells()];
    let report = check
        .run(
            &pose(0.0),
            Observed::Silhouette,
            &scene,
            &mut cells,
            &mut || {},
        )
        .unwrap();
    let (mut visible, mut hidden, mut judged, mut through) = (0, 0, 0, 0);
    check
        .visible_surface(&pose(0.0), &scene, &mut cells, &mut || {}, &mut |point| {
            visible += 1;
            match point.seen {
                Seen::Unmeasured => {}
                Seen::Hidden { in_front } => {
                    assert!(in_front > 3.0 * SIGMA);
                    hidden += 1;
                }
                Seen::Surface { behind } => {
                    assert!(behind.abs() <= 3.0 * SIGMA);
                    judged += 1;
                }
                Seen::Through { behind } => {
                    assert!(behind > 3.0 * SIGMA);
                    judged += 1;
                    through += 1;
                }
            }
        })
        .unwrap();
    let found = [visible, hidden, judged, through];
    let expected = [
        report.visible,
        report.hidden,
        report.judged,
        report.seen_through,
    ];
    assert_eq!(found, expected);
    assert!(hidden > 0 && through > 0);
    let behind = Pose::from_row_major(IDENTITY, [0.0, 0.0, -500.0]).unwrap();
    let none = check.visible_surface(&behind, &scene, &mut cells, &mut || {}, &mut |_| {
        panic!("nothing is visible");
    });
    assert_eq!(none, Ok(()));
    let found = settings.cells() - 1;
    let small = check.visible_surface(
        &pose(0.0),
        &scene,
        &mut cells[..found],
        &mut || {},
        &mut |_| {},
    );
    let expected = settings.cells();
    assert_eq!(small, Err(DepthError::Cells { expected, found }));
}

#[test]
fn a_surface_that_lies_deeper_as_a_whole_has_a_common_offset_and_a_shifted_one_has_not() {
    for offset in [-20.0, 15.0] {
        for masked in [true, false] {
            let scene = Scene::at(0.0, 500.0 + offset);
            let report = run(&pose(0.0), &scene, masked, &settings());
            assert!((report.common_offset - offset).abs() < 2.0, "{report:?}");
            let Cause::AlongRay { distance } = cause(&pose(0.0), &report) else {
                panic!("{report:?}");
            };
            assert_eq!(distance, report.common_offset);
        }
    }
    let report = run(&pose(0.0), &Scene::at(30.0, 500.0), true, &settings());
    assert_eq!(report.common_offset, 0.0, "{report:?}");
}

#[test]
fn a_reason_names_its_unit_on_request() {
    let cause = Cause::Sideways { distance: 12.34 };
    assert_eq!(cause.to_string(), "offset across the ray by about 12.3");
    let text = cause.in_unit(Unit::Millimetre).to_string();
    assert_eq!(text, "offset across the ray by about 12.3 mm");
    let plain = Cause::Fits.in_unit(Unit::Metre).to_string();
    assert_eq!(plain, Cause::Fits.to_string());
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

#[test]
fn what_the_memory_holds_beforehand_and_how_much_more_there_is_do_not_matter() {
    let bytes = sphere().encode();
    let template = Template::from_bytes(&bytes).unwrap();
    let scene = Scene::at(3.0, 505.0);
    let surface = TemplateSurface::<1>::new(&template, SIGMA).unwrap();
    let settings = settings();
    let check = DepthCheck::new(&surface, &camera(), &settings).unwrap();
    let mut clean = vec![Cell::EMPTY; settings.cells()];
    let mut calls = 0;
    let mut alive = || calls += 1;
    let observed = Observed::Silhouette;
    let first = check.run(&pose(0.0), observed, &scene, &mut clean, &mut alive);
    // What another pose has left behind.
    let mut used = vec![Cell::EMPTY; settings.cells() + 500];
    let _ = check.run(&pose(9.0), observed, &scene, &mut used, &mut || {});
    let second = check.run(&pose(0.0), observed, &scene, &mut used, &mut || {});
    assert_eq!(first, second);
    assert!(calls > 20, "a watchdog would have starved: {calls}");
    let found = settings.cells() - 1;
    assert_eq!(
        check.run(&pose(0.0), observed, &scene, &mut used[..found], &mut || {}),
        Err(DepthError::Cells {
            expected: settings.cells(),
            found
        })
    );
}

#[test]
fn settings_out_of_range_and_templates_that_speak_everywhere_are_refused() {
    let bytes = sphere().encode();
    let template = Template::from_bytes(&bytes).unwrap();
    let surface = TemplateSurface::<1>::new(&template, SIGMA).unwrap();
    let refused = |settings: DepthSettings| {
        DepthCheck::new(&surface, &camera(), &settings)
            .map(|_| ())
            .unwrap_err()
    };
    let default = DepthSettings::DEFAULT;
    for side in [0, 7, 257] {
        let found = refused(DepthSettings { side, ..default });
        assert_eq!(found, DepthError::Side { found: side });
    }
    let none = DepthSettings {
        step_pixels: 0,
        ..default
    };
    assert_eq!(refused(none), DepthError::StepPixels);
    for (accept, reject) in [(0.5, 0.6), (1.1, 0.2), (0.5, -0.1), (f32::NAN, 0.1)] {
        let thresholds = Some(Thresholds { accept, reject });
        let found = refused(DepthSettings {
            thresholds,
            ..default
        });
        assert!(matches!(found, DepthError::Thresholds { .. }), "{found}");
    }
    assert_eq!(
        TemplateSurface::<0>::new(&template, SIGMA).unwrap_err(),
        DepthError::Score(ScoreError::TooManyComponents {
            capacity: 0,
            found: 1
        })
    );
    let everywhere = Content::sphere(RADIUS, 1.0).encode();
    let everywhere = Template::from_bytes(&everywhere).unwrap();
    let found = TemplateSurface::<8>::new(&everywhere, SIGMA).unwrap_err();
    assert_eq!(found, DepthError::NoValidity);
}

#[test]
fn words_of_a_sensor_are_lengths_and_zero_is_no_measurement() {
    let words = [0, 10, 20, 30, 40, 65_535];
    let image = DepthWords::new(&words, 3, 0.5).unwrap();
    assert_eq!((image.width(), image.height()), (3, 2));
    assert_eq!(image.depth(0, 0), None);
    assert_eq!(image.depth(2, 0), Some(10.0));
    assert_eq!(image.depth(2, 1), Some(32_767.5));
    assert_eq!(image.depth(3, 0), None);
    assert_eq!(image.depth(0, 2), None);
    assert!(DepthWords::new(&words, 4, 0.5).is_none());
    assert!(DepthWords::new(&words, 0, 0.5).is_none());
    for scale in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        assert!(DepthWords::new(&words, 3, scale).is_none());
    }
}

fn anything() -> impl Strategy<Value = f32> {
    prop_oneof![
        -1000.0_f32..1000.0,
        any::<f32>(),
        Just(f32::NAN),
        Just(f32::INFINITY),
        Just(0.0)
    ]
}

proptest! {
    #![proptest_config(seed::config())]

    #[test]
    fn no_template_pose_or_depth_makes_a_number_nan(
        content in charts(),
        translation in [anything(), anything(), anything()],
        pixels in prop::collection::vec((0_u16..640, 0_u16..480, anything()), 0..40),
        words in prop::collection::vec(any::<u16>(), 16 * 12),
        share in 1e-6_f32..10.0,
        masked in any::<bool>(),
    ) {
        let Ok(bytes) = content.try_encode() else {
            return Ok(());
        };
        let Ok(pose) = Pose::from_row_major(IDENTITY, translation) else {
            return Ok(());
        };
        let template = Template::from_bytes(&bytes).unwrap();
        let settings = DepthSettings {
            noise: Noise::Share(share),
            side: 8,
            ..settings()
        };
        let pixels: Vec<_> = pixels
            .into_iter()
            .map(|(column, row, depth)| DepthPixel { column, row, depth })
            .collect();
        let observed = if masked { Observed::Pixels(&pixels) } else { Observed::Silhouette };
        let image = DepthWords::new(&words, 16, 0.1).unwrap();
        let mut cells = [Cell::EMPTY; 64];
        let report = check_depth::<8>(
            &template, &camera(), &pose, &settings, observed, &image, &mut cells,
        );
        let Ok(report) = report else {
            return Ok(());
        };
        let numbers = [
            report.confidence, report.forward, report.reverse, report.estimated_error,
            report.displacement, report.residual, report.noise, report.depth_ratio,
            report.common_offset,
        ];
        prop_assert!(numbers.iter().all(|number| !number.is_nan()), "{report:?}");
        prop_assert!((0.0..=1.0).contains(&report.confidence), "{report:?}");
        let _ = cause(&pose, &report).to_string();
    }
}
