//! What arrives at a logger of the crate `log`.

use cobra_infer::depth::{Cell, DepthCheck, DepthSettings, DepthWords, Observed, TemplateSurface};
use cobra_infer::{Camera, Pose, Scorer, Settings, Template, TemplateError};
use log::{Level, LevelFilter, Log, Metadata, Record};
use std::cell::RefCell;
use std::sync::Once;

const TEMPLATE: &[u8] = include_bytes!("../../tests/golden/v1-exponent-one.cobra");

const CHARTS: &[u8] = include_bytes!("../../tests/golden/v1-validity-compact.cobra");

thread_local! {
    static EVENTS: RefCell<Vec<(Level, String)>> = const { RefCell::new(Vec::new()) };
}

struct Capture;

impl Log for Capture {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        metadata.target() == "cobra_infer"
    }

    fn log(&self, record: &Record<'_>) {
        if self.enabled(record.metadata()) {
            EVENTS.with_borrow_mut(|events| {
                events.push((record.level(), record.args().to_string()));
            });
        }
    }

    fn flush(&self) {}
}

/// What `act` tells the logger on this thread.
fn events_of(act: impl FnOnce()) -> Vec<(Level, String)> {
    static INSTALLED: Once = Once::new();
    INSTALLED.call_once(|| {
        log::set_logger(&Capture).unwrap();
        log::set_max_level(LevelFilter::Trace);
    });
    act();
    EVENTS.take()
}

#[test]
fn a_loaded_template_is_told_by_its_name_components_and_terms() {
    let mut expected = String::new();
    let events = events_of(|| {
        let template = Template::from_bytes(TEMPLATE).unwrap();
        expected = format!(
            "template {:?} loaded: components {}, terms {}",
            template.name(),
            template.component_count(),
            template.term_count()
        );
    });
    assert_eq!(events, [(Level::Info, expected)]);
}

#[test]
fn a_refused_template_is_told_with_its_error() {
    let mut damaged = TEMPLATE.to_vec();
    *damaged.last_mut().unwrap() ^= 1;
    for bytes in [&damaged[..], &TEMPLATE[..100], &[0xff; 64], &[]] {
        let mut error: Option<TemplateError> = None;
        let events = events_of(|| error = Template::from_bytes(bytes).err());
        let expected = format!("template refused: {}", error.unwrap());
        assert_eq!(events, [(Level::Warn, expected)]);
    }
}

#[test]
fn a_poses_report_is_told_once_when_it_is_finished() {
    let template = Template::from_bytes(TEMPLATE).unwrap();
    let camera = Camera::new(400.0, 420.0, 320.0, 240.0).unwrap();
    let identity = [1., 0., 0., 0., 1., 0., 0., 0., 1.];
    let pose = Pose::from_row_major(identity, [0., 0., 500.]).unwrap();
    let settings = Settings::for_template(&template, 2.0);
    let scorer = Scorer::<64>::new(&template, &camera, &pose, &settings).unwrap();
    EVENTS.take();
    let events = events_of(|| {
        let _ = scorer.finish();
    });
    let [(Level::Debug, text)] = &events[..] else {
        panic!("{events:?}");
    };
    assert!(
        text.starts_with("pose: undecided, too few points; confidence 0, "),
        "{text}"
    );
}

#[test]
fn a_check_against_depth_is_told_once_with_its_answer() {
    let template = Template::from_bytes(CHARTS).unwrap();
    let camera = Camera::new(400.0, 420.0, 320.0, 240.0).unwrap();
    let identity = [1., 0., 0., 0., 1., 0., 0., 0., 1.];
    let settings = DepthSettings::for_template(&template);
    let surface = TemplateSurface::<64>::new(&template, 1.0).unwrap();
    let check = DepthCheck::new(&surface, &camera, &settings).unwrap();
    let words = [0; 64];
    let image = DepthWords::new(&words, 8, 1.0).unwrap();
    let mut cells = vec![Cell::EMPTY; settings.cells()];
    for (z, said) in [
        (
            500.0,
            "pose against depth: undecided, too few points; confidence 0, ",
        ),
        (
            -500.0,
            "pose against depth: reject, every point lies behind the camera; ",
        ),
    ] {
        let pose = Pose::from_row_major(identity, [0., 0., z]).unwrap();
        EVENTS.take();
        let events = events_of(|| {
            let silhouette = Observed::Silhouette;
            let report = check.run(&pose, silhouette, &image, &mut cells, &mut || {});
            report.unwrap();
        });
        let [(Level::Debug, text)] = &events[..] else {
            panic!("{events:?}");
        };
        assert!(text.starts_with(said), "{text}");
    }
}
