//! Checks against depth: the bits of Rust.

use super::*;
use crate::depth::{cobra_depth_check, cobra_depth_settings_default};
use crate::depth_types::{
    COBRA_DEPTH_CELL_SIZE, CobraCause, CobraDepthObserved, CobraDepthPixel, CobraDepthReport,
    CobraDepthSettings, CobraNoiseKind, cause,
};
use crate::strings::cause_text;
use cobra_infer::depth::{
    Cause, Cell, Correction, DepthImage, DepthPixel, DepthSettings, DepthWords, Noise, Observed,
    check_depth,
};
use cobra_infer::{Camera, Pose, Template};
use std::collections::HashSet;
use std::ffi::CStr;

const CHARTS: &[u8] = include_bytes!("../../../tests/golden/agreement/charts.cobra");
const IMAGE: &[u8] = include_bytes!("../../../tests/golden/agreement/charts.image");
const SCENE: &[u8] = include_bytes!("../../../tests/golden/agreement/charts.scene");

pub(super) type Cells = Memory<{ 32 * 32 * COBRA_DEPTH_CELL_SIZE }>;

/// The scene of the agreement vectors, in C's structures.
pub(super) struct Scene {
    pub(super) camera: CobraCamera,
    pub(super) poses: Vec<CobraPose>,
    pub(super) words: Vec<u16>,
    pub(super) width: u16,
    pub(super) scale: f32,
    pub(super) pixels: Vec<CobraDepthPixel>,
}

pub(super) fn scene() -> Scene {
    let mut words = SCENE.as_chunks::<4>().0.iter().copied();
    let mut next = || words.next().unwrap();
    let camera = std::array::from_fn(|_| f32::from_le_bytes(next()));
    let (width, scale) = (u32::from_le_bytes(next()), f32::from_le_bytes(next()));
    let poses = (0..u32::from_le_bytes(next()))
        .map(|_| CobraPose {
            rotation: std::array::from_fn(|_| f32::from_le_bytes(next())),
            translation: std::array::from_fn(|_| f32::from_le_bytes(next())),
        })
        .collect();
    let image = IMAGE.as_chunks().0.iter().copied();
    let image: Vec<u16> = image.map(u16::from_le_bytes).collect();
    let depths = DepthWords::new(&image, width as u16, scale).unwrap();
    let pixels = (0..u32::from_le_bytes(next()))
        .map(|_| {
            let [c0, c1, r0, r1] = next();
            let (column, row) = (u16::from_le_bytes([c0, c1]), u16::from_le_bytes([r0, r1]));
            let depth = depths.depth(column, row).unwrap_or(0.0);
            CobraDepthPixel { column, row, depth }
        })
        .collect();
    Scene {
        camera: CobraCamera { matrix: camera },
        poses,
        words: image,
        width: width as u16,
        scale,
        pixels,
    }
}

impl Scene {
    pub(super) fn observed(&self, mask: bool) -> CobraDepthObserved {
        CobraDepthObserved {
            pixels: if mask {
                self.pixels.as_ptr()
            } else {
                ptr::null()
            },
            pixel_count: if mask { self.pixels.len() } else { 0 },
            words: self.words.as_ptr(),
            width: self.width,
            height: (self.words.len() / usize::from(self.width)) as u16,
            scale: self.scale,
            alive: None,
            context: ptr::null_mut(),
        }
    }
}

pub(super) fn defaults(template: *const CobraTemplate) -> CobraDepthSettings {
    let mut settings = core::mem::MaybeUninit::uninit();
    let status = unsafe { cobra_depth_settings_default(template, settings.as_mut_ptr()) };
    assert_eq!(status, CobraStatus::Ok);
    unsafe { settings.assume_init() }
}

pub(super) fn charts(memory: &mut TemplateMemory) -> *mut CobraTemplate {
    let (status, template) = load(memory, CHARTS);
    assert_eq!(status, CobraStatus::Ok);
    template
}

/// Every number of a report, for a comparison of bits.
pub(super) fn numbers(report: &CobraDepthReport) -> Vec<u32> {
    let lengths = [
        report.confidence,
        report.forward,
        report.reverse,
        report.estimated_error,
        report.displacement,
        report.residual,
        report.noise,
        report.depth_ratio,
        report.cause_value,
        report.moved_along_ray,
        report.moved_sideways,
        report.turned,
    ];
    let pose = report
        .refined
        .rotation
        .iter()
        .chain(&report.refined.translation);
    let counts = [
        report.pixels,
        report.silent,
        report.visible,
        report.judged,
        report.hidden,
        report.unmeasured,
        report.seen_through,
        report.decision as u32,
        report.reason as u32,
        report.cause as u32,
    ];
    let lengths = lengths.iter().chain(pose).map(|number| number.to_bits());
    lengths.chain(counts).collect()
}

#[test]
fn every_pose_is_checked_to_the_bits_of_rust() {
    let scene = scene();
    let (mut memory, mut cells) = (TemplateMemory::new(), Cells::new());
    let handle = charts(&mut memory);
    let template = Template::from_bytes(CHARTS).unwrap();
    let camera = Camera::from_matrix(scene.camera.matrix).unwrap();
    let image = DepthWords::new(&scene.words, scene.width, scene.scale).unwrap();
    let pixels: Vec<DepthPixel> = scene
        .pixels
        .iter()
        .map(|pixel| DepthPixel {
            column: pixel.column,
            row: pixel.row,
            depth: pixel.depth,
        })
        .collect();
    let mut sensor = defaults(handle);
    sensor.noise_kind = CobraNoiseKind::Sensor as u32;
    (
        sensor.noise_constant,
        sensor.noise_linear,
        sensor.noise_quadratic,
    ) = (0.5, 2e-3, 1e-5);
    (sensor.has_thresholds, sensor.accept, sensor.reject) = (1, 0.5, 0.1);
    let mut decisions = HashSet::new();
    for settings in [defaults(handle), sensor] {
        for given in &scene.poses {
            for mask in [true, false] {
                let mut report = CobraDepthReport::NOT_CHECKED;
                let observed = scene.observed(mask);
                let status = unsafe {
                    cobra_depth_check(
                        cells.start(),
                        size_of::<Cells>(),
                        handle,
                        &scene.camera,
                        given,
                        &settings,
                        &observed,
                        &raw mut report,
                    )
                };
                assert_eq!(status, CobraStatus::Ok);
                let pose = Pose::from_row_major(given.rotation, given.translation).unwrap();
                let observed = if mask {
                    Observed::Pixels(&pixels)
                } else {
                    Observed::Silhouette
                };
                let expected = check_depth::<8>(
                    &template,
                    &camera,
                    &pose,
                    &settings.to_rust().unwrap(),
                    observed,
                    &image,
                    &mut [Cell::EMPTY; 32 * 32],
                )
                .unwrap();
                let moved = Correction::between(&pose, &expected.refined, template.centre());
                let expected = CobraDepthReport::from_rust(&expected, &moved);
                assert_eq!(numbers(&report), numbers(&expected));
                decisions.insert(report.decision as u32);
            }
        }
    }
    assert_eq!(decisions.len(), 3, "{decisions:?}");
}

#[test]
fn the_default_settings_are_those_of_the_template_and_none_is_lost() {
    let mut memory = TemplateMemory::new();
    let settings = defaults(charts(&mut memory));
    let template = Template::from_bytes(CHARTS).unwrap();
    let expected = DepthSettings::for_template(&template);
    assert_eq!(settings.to_rust(), Ok(expected));
    let sensor = DepthSettings {
        noise: Noise::Sensor {
            constant: 1.0,
            linear: 2.0,
            quadratic: 3.0,
        },
        ..expected
    };
    assert_eq!(CobraDepthSettings::from_rust(&sensor).to_rust(), Ok(sensor));
}

#[test]
fn a_watchdog_is_fed_with_its_context() {
    extern "C" fn feed(context: *mut c_void) {
        let count = context.cast::<u32>();
        unsafe { *count += 1 };
    }
    let scene = scene();
    let (mut memory, mut cells) = (TemplateMemory::new(), Cells::new());
    let handle = charts(&mut memory);
    let mut count = 0_u32;
    let observed = CobraDepthObserved {
        alive: Some(feed),
        context: (&raw mut count).cast(),
        ..scene.observed(true)
    };
    let mut report = CobraDepthReport::NOT_CHECKED;
    let status = unsafe {
        cobra_depth_check(
            cells.start(),
            size_of::<Cells>(),
            handle,
            &scene.camera,
            &scene.poses[0],
            &defaults(handle),
            &observed,
            &raw mut report,
        )
    };
    assert_eq!(status, CobraStatus::Ok);
    assert!(count > 10, "{count}");
}

#[test]
fn every_cause_has_a_number_and_a_text_of_its_own() {
    let causes = [
        Cause::Fits,
        Cause::BehindCamera,
        Cause::Scale { factor: 10.0 },
        Cause::InFront,
        Cause::SeenThrough,
        Cause::AlongRay { distance: -2.0 },
        Cause::Sideways { distance: 3.0 },
        Cause::Turned { angle: 0.5 },
        Cause::Elsewhere,
        Cause::Hidden,
        Cause::Unmeasured,
    ];
    let mut texts = HashSet::from([cause_text(CobraCause::NotChecked as u32)]);
    for (number, rust) in (1..).zip(causes) {
        let (found, _) = cause(rust);
        assert_eq!(found as u32, number);
        assert!(texts.insert(cause_text(number)));
        let text = unsafe { CStr::from_ptr(crate::strings::cobra_cause_string(number)) };
        assert_eq!(text, cause_text(number));
    }
    assert!(texts.insert(cause_text(12)));
    assert_eq!(cause(Cause::AlongRay { distance: -2.0 }).1, -2.0);
}
