//! Why a pose does not fit: the reasons, and what each pixel and each point of the surface says.

use crate::depth_scene::{SIGMA, Scene, cause, run, settings, sphere};
use crate::scene::{IDENTITY, camera, pose};
use cobra_infer::depth::{
    Cause, Cell, DepthCheck, DepthError, DepthPixel, Observed, Seen, TemplateSurface,
};
use cobra_infer::{Pose, Template, Unit};

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
    assert!(
        text.ends_with("1/10 of what the pose says, as of millimetres taken for centimetres"),
        "{text}"
    );
    for (factor, said) in [
        (
            1000.0,
            "about 1000 times what the pose says, as of metres taken for millimetres",
        ),
        (
            1.0 / 1000.0,
            "about 1/1000 of what the pose says, as of millimetres taken for metres",
        ),
        (
            25.4,
            "about 25.4 times what the pose says, as of inches taken for millimetres",
        ),
    ] {
        let text = Cause::Scale { factor }.to_string();
        assert!(text.ends_with(said), "{text}");
    }
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
