//! What the check refuses, and what does not disturb it.

use crate::charts::charts;
use crate::content::Content;
use crate::depth_scene::{RADIUS, SIGMA, Scene, cause, settings, sphere};
use crate::scene::{IDENTITY, camera, pose};
use crate::seed;
use cobra_infer::depth::{
    Cell, DepthCheck, DepthError, DepthImage, DepthPixel, DepthSettings, DepthWords, Noise,
    Observed, TemplateSurface, Thresholds, check_depth,
};
use cobra_infer::{Pose, ScoreError, Template};
use proptest::prelude::*;

#[test]
fn what_the_memory_holds_beforehand_and_how_much_more_there_is_do_not_matter() {
    let bytes = sphere().encode();
    let template = Template::from_bytes(&bytes).unwrap();
    let scene = Scene::at(3.0, 505.0);
    let surface = TemplateSurface::<1>::new(&template, SIGMA).unwrap();
    let settings = settings();
    let check = DepthCheck::new(&surface, &camera(), &settings).unwrap();
    let mut clean = vec![Cell::EMPTY; settings.cells()];
    let observed = Observed::Silhouette;
    let first = check.run(&pose(0.0), observed, &scene, &mut clean, &mut || {});
    // What another pose has left behind.
    let mut used = vec![Cell::EMPTY; settings.cells() + 500];
    let _ = check.run(&pose(9.0), observed, &scene, &mut used, &mut || {});
    let second = check.run(&pose(0.0), observed, &scene, &mut used, &mut || {});
    assert_eq!(first, second);
    let found = settings.cells() - 1;
    assert_eq!(
        check.run(&pose(0.0), observed, &scene, &mut used[..found], &mut || {}),
        Err(DepthError::Cells {
            expected: settings.cells(),
            found
        })
    );
}

/// An image that counts what is looked up since the watchdog was fed.
struct Starving<'a> {
    scene: Scene,
    since: &'a std::cell::Cell<u32>,
    longest: &'a std::cell::Cell<u32>,
}

impl DepthImage for Starving<'_> {
    fn width(&self) -> u16 {
        self.scene.width()
    }

    fn height(&self) -> u16 {
        self.scene.height()
    }

    fn depth(&self, column: u16, row: u16) -> Option<f32> {
        self.since.set(self.since.get() + 1);
        self.longest.set(self.longest.get().max(self.since.get()));
        self.scene.depth(column, row)
    }
}

#[test]
fn a_watchdog_is_fed_once_every_64_pixels_cells_or_places() {
    let bytes = sphere().encode();
    let template = Template::from_bytes(&bytes).unwrap();
    let surface = TemplateSurface::<1>::new(&template, SIGMA).unwrap();
    let (since, longest) = (std::cell::Cell::new(0), std::cell::Cell::new(0));
    let image = Starving {
        scene: Scene::at(0.0, 500.0),
        since: &since,
        longest: &longest,
    };
    let nothing_measured = [DepthPixel {
        column: 0,
        row: 0,
        depth: 0.0,
    }; 6400];
    for side in [8, 32, 256] {
        let settings = DepthSettings { side, ..settings() };
        let check = DepthCheck::new(&surface, &camera(), &settings).unwrap();
        let mut cells = vec![Cell::EMPTY; settings.cells()];
        let mut run = |observed| {
            let mut calls = 0;
            let mut alive = || {
                since.set(0);
                calls += 1;
            };
            let run = check.run(&pose(0.0), observed, &image, &mut cells, &mut alive);
            run.unwrap();
            calls
        };
        run(Observed::Silhouette);
        assert!(longest.get() <= 64, "{side}: {}", longest.get());
        // Nothing comes of these pixels, and looking at them takes time all the same.
        let more = run(Observed::Pixels(&nothing_measured)) - run(Observed::Pixels(&[]));
        assert!(more >= 3 * 6400 / 64, "{side}: {more}");
    }
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
    let silent = TemplateSurface::<1>::new(&template, 0.0).unwrap();
    assert_eq!(
        DepthCheck::new(&silent, &camera(), &default).unwrap_err(),
        DepthError::Noise { found: 0.0 }
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
