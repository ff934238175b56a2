//! Prints what the example in C prints, by way of `cobra-infer` itself.
//!
//! `cargo run -p cobra-tests --example print-bits -- TEMPLATE CROWDED POINTS SCENE IMAGE`, with the files
//! that `cobra-infer-ffi/examples/score` links in.

use cobra_agreement::depth::{self, Scene};
use cobra_agreement::golden::{decision_name, report_bits};
use cobra_infer::depth::{Cell, DepthSettings, Observed, check_depth};
use cobra_infer::nalgebra::{Point2, Point3};
use cobra_infer::{Camera, Correspondence, Pose, Scorer, Settings, Sigma, Template};
use std::error::Error;
use std::path::Path;

#[path = "../../cobra-infer-ffi/src/status.rs"]
#[allow(
    dead_code,
    unreachable_pub,
    reason = "the module of another crate: what pointers from C can do wrong does not happen here"
)]
mod status;

use status::CobraStatus;

/// As many as the library for C has room for.
const COMPONENTS: usize = 32;

fn main() -> Result<(), Box<dyn Error>> {
    let paths: Vec<String> = std::env::args().skip(1).collect();
    let [template, crowded, points, scene, image] = paths.as_slice() else {
        return Err("expected TEMPLATE CROWDED POINTS SCENE IMAGE".into());
    };
    let points = std::fs::read(Path::new(points))?;
    let mut template = std::fs::read(template)?;
    for only_sound in [false, true] {
        score(&template, &points, only_sound).map_err(text)?;
    }
    let (scene, image) = (std::fs::read(scene)?, std::fs::read(image)?);
    let checked = check(&template, &scene, &image);
    println!("depth: {}", text(checked.err().unwrap_or(CobraStatus::Ok)));
    let middle = template.len() / 2;
    template[middle] ^= 1;
    for (what, bytes) in [("damaged", template), ("crowded", std::fs::read(crowded)?)] {
        match score(&bytes, &points, false) {
            Ok(()) => return Err(format!("{what}: not refused").into()),
            Err(status) => println!("{what}: {}", text(status)),
        }
    }
    Ok(())
}

fn text(status: CobraStatus) -> String {
    status.text().to_string_lossy().into_owned()
}

fn score(template: &[u8], mut points: &[u8], only_sound: bool) -> Result<(), CobraStatus> {
    let template = Template::from_bytes(template)?;
    let camera = Camera::from_matrix(floats(&mut points))?;
    let poses = word(&mut points);
    let pose = Pose::from_row_major(floats(&mut points), floats(&mut points))?;
    for _ in 1..poses {
        floats::<12>(&mut points);
    }
    let settings = Settings {
        sigma: Sigma::Template { noise: 0.5 },
        ..Settings::for_template(&template, 2.0)
    };
    let mut scorer = Scorer::<COMPONENTS>::new(&template, &camera, &pose, &settings)?;
    for _ in 0..word(&mut points) {
        let [u, v, x, y, z, weight] = floats(&mut points);
        let correspondence = Correspondence {
            pixel: Point2::new(u, v),
            point: Point3::new(x, y, z),
            weight,
        };
        if only_sound && !(correspondence.is_finite() && weight >= 0.0) {
            continue;
        }
        let point = scorer.push(&correspondence);
        println!("{:08x}", point.likelihood.to_bits());
    }
    assert!(points.is_empty(), "{} bytes too many", points.len());
    let report = scorer.finish();
    let [confidence, threshold, weight_sum, inlier_share] = report_bits(&report);
    println!(
        "confidence {confidence:08x} threshold {threshold:08x} weight_sum {weight_sum:08x} \
         inlier_share {inlier_share:08x} points {} behind_camera {} decision {}",
        report.points,
        report.behind_camera,
        decision_name(report.decision)
    );
    Ok(())
}

fn check(template: &[u8], scene: &[u8], image: &[u8]) -> Result<(), CobraStatus> {
    let template = Template::from_bytes(template)?;
    let words: Vec<u16> = image
        .as_chunks()
        .0
        .iter()
        .copied()
        .map(u16::from_le_bytes)
        .collect();
    let scene = Scene::read(scene).expect("a scene");
    let camera = scene.camera().expect("a camera");
    let image = scene.image(&words).expect("its image");
    let mut room = [depth::NO_PIXEL; depth::PIXELS];
    let pixels = scene.observed(&image, &mut room);
    let settings = DepthSettings::for_template(&template);
    let mut cells = vec![Cell::EMPTY; settings.cells()];
    for pose in scene.poses() {
        for observed in [Observed::Pixels(pixels), Observed::Silhouette] {
            let report = check_depth::<COMPONENTS>(
                &template, &camera, &pose, &settings, observed, &image, &mut cells,
            )?;
            let words = depth::report_words(&template, &pose, &report);
            let (numbers, rest) = words.split_at(24);
            let numbers: String = numbers.iter().map(|word| format!(" {word:08x}")).collect();
            let counts: String = rest[..7].iter().map(|count| format!(" {count}")).collect();
            let (cause, reason) = (rest[8] + 1, report.decision.reason());
            println!("depth{numbers}{counts} cause {cause}: {reason}");
        }
    }
    Ok(())
}

fn word(bytes: &mut &[u8]) -> u32 {
    let (first, rest) = bytes.split_first_chunk().expect("four more bytes");
    *bytes = rest;
    u32::from_le_bytes(*first)
}

fn floats<const N: usize>(bytes: &mut &[u8]) -> [f32; N] {
    std::array::from_fn(|_| f32::from_bits(word(bytes)))
}
