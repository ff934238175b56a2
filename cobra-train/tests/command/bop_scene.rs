//! A small data set of one box in three images, and a results file of it.

use crate::run::{Outcome, run};
use crate::scene::Scene;
use serde_json::{Value, json};

pub(crate) const IDENTITY: &str = "1 0 0 0 1 0 0 0 1";

/// A row of a results file: image, object, t; the box is turned by nothing.
pub(crate) fn row(image: u32, object: u32, t: &str) -> String {
    format!("2,{image},{object},0.25,{IDENTITY},{t},-1\n")
}

pub(crate) fn results(rows: &[String]) -> String {
    format!("scene_id,im_id,obj_id,score,R,t,time\n{}", rows.concat())
}

/// Where the box is in every image.
pub(crate) const TRUTH: &str = "5.0 -10.0 600.0";

/// A data set `set` with models, templates `t` and a results file `results.csv` of right and wrong
/// estimates.
pub(crate) fn dataset() -> Scene {
    let scene = Scene::charted();
    for folder in ["set/models", "set/test/000002", "t"] {
        std::fs::create_dir_all(scene.path(folder)).unwrap();
    }
    let template = std::fs::read(scene.path("part.cobra")).unwrap();
    scene.write("t/obj_000001.cobra", template);
    scene.write("set/models/obj_000001.ply", ply());
    let info = json!({"1": {"diameter": 107.7}});
    scene.write("set/models/models_info.json", info.to_string());
    let size = json!({"fx": 500, "fy": 500, "cx": 320, "cy": 240, "width": 640, "height": 480});
    scene.write("set/camera.json", size.to_string());
    let camera = json!({"cam_K": [500, 0, 320, 0, 500, 240, 0, 0, 1], "depth_scale": 1.0});
    set_cameras(&scene, |_| camera.clone());
    let pose = json!([{
        "cam_R_m2c": [1, 0, 0, 0, 1, 0, 0, 0, 1], "cam_t_m2c": [5, -10, 600], "obj_id": 1
    }]);
    let truth = json!({"3": pose, "4": pose, "5": pose});
    scene.write("set/test/000002/scene_gt.json", truth.to_string());
    let rows = [
        row(3, 1, TRUTH),
        row(3, 1, "5.0 -10.0 640.0"),
        row(4, 1, "6.0 -10.0 601.0"),
        row(5, 1, "205.0 -10.0 600.0"),
    ];
    scene.write("results.csv", results(&rows));
    scene
}

pub(crate) fn set_cameras(scene: &Scene, camera: impl Fn(u32) -> Value) {
    let cameras = json!({"3": camera(3), "4": camera(4), "5": camera(5)});
    scene.write("set/test/000002/scene_camera.json", cameras.to_string());
}

/// The scene's box as a PLY.
pub(crate) fn ply() -> String {
    let corners: Vec<String> = (0..8)
        .map(|i| {
            let pick = |axis: usize| [[10, 50], [-20, 40], [5, 85]][axis][i >> axis & 1];
            format!("{} {} {}\n", pick(0), pick(1), pick(2))
        })
        .collect();
    let faces = [
        [0, 1, 3, 2],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 3, 7, 6],
        [0, 2, 6, 4],
        [1, 3, 7, 5],
    ];
    let faces = faces.map(|[a, b, c, d]| format!("4 {a} {b} {c} {d}\n"));
    format!(
        "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float \
         z\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n{}{}",
        corners.concat(),
        faces.concat()
    )
}

pub(crate) fn words<'a>(more: &[&'a str]) -> Vec<&'a str> {
    let words = [
        "bop",
        "score",
        "--dataset",
        "@set",
        "--results",
        "@results.csv",
        "--templates",
        "@t",
        "-o",
        "@out.csv",
    ];
    [&words[..], more].concat()
}

pub(crate) fn simulated<'a>(more: &[&'a str]) -> Vec<&'a str> {
    words(&[&["--depth", "simulated"], more].concat())
}

/// A run that scores what it can: exit code 3, each of the warnings on a line of its own, and `scored` scores
/// other than −1 in the written file.
pub(crate) fn scores_the_rest(
    scene: &Scene,
    words: &[&str],
    said: &[&str],
    scored: usize,
) -> Outcome {
    let outcome = run(scene.arguments(words));
    assert_eq!(outcome.code, Some(3), "{outcome:?}");
    for words in said {
        let lines = outcome.stderr.lines();
        let warnings = lines.filter(|line| line.starts_with("warning: ") && line.contains(words));
        assert_eq!(warnings.count(), 1, "{words:?} in {outcome:?}");
    }
    let text = scene.read("out.csv");
    let scores = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').nth(3).unwrap());
    assert_eq!(
        scores.filter(|score| *score != "-1").count(),
        scored,
        "{text}"
    );
    outcome
}

/// A grey PNG.
pub(crate) fn png(
    width: u32,
    height: u32,
    depth: png::BitDepth,
    value: impl Fn(u32, u32) -> u16,
) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(depth);
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let values = pixels.map(|(x, y)| value(x, y));
    let data: Vec<u8> = match depth {
        png::BitDepth::Sixteen => values.flat_map(u16::to_be_bytes).collect(),
        _ => values.map(|value| value as u8).collect(),
    };
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&data).unwrap();
    writer.finish().unwrap();
    bytes
}
