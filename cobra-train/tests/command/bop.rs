//! `cobra bop`: a small data set of one box in three images, its results file, and what is wrong with both.

use crate::run::{Outcome, json, run, succeed};
use crate::scene::Scene;
use serde_json::{Value, json};

const IDENTITY: &str = "1 0 0 0 1 0 0 0 1";

/// A row of a results file: image, object, t; the box is turned by nothing.
fn row(image: u32, object: u32, t: &str) -> String {
    format!("2,{image},{object},0.25,{IDENTITY},{t},-1\n")
}

fn results(rows: &[String]) -> String {
    format!("scene_id,im_id,obj_id,score,R,t,time\n{}", rows.concat())
}

/// Where the box is in every image.
const TRUTH: &str = "5.0 -10.0 600.0";

/// A data set `set` with models, templates `t` and a results file `results.csv` of right and wrong
/// estimates.
fn dataset() -> Scene {
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

fn set_cameras(scene: &Scene, camera: impl Fn(u32) -> Value) {
    let cameras = json!({"3": camera(3), "4": camera(4), "5": camera(5)});
    scene.write("set/test/000002/scene_camera.json", cameras.to_string());
}

/// The scene's box as a PLY.
fn ply() -> String {
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

fn words<'a>(more: &[&'a str]) -> Vec<&'a str> {
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

fn simulated<'a>(more: &[&'a str]) -> Vec<&'a str> {
    words(&[&["--depth", "simulated"], more].concat())
}

/// A run that scores what it can: exit code 3, each of the warnings on a line of its own, and `scored` scores
/// other than −1 in the written file.
fn scores_the_rest(scene: &Scene, words: &[&str], said: &[&str], scored: usize) -> Outcome {
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

#[test]
fn scores_replace_the_files_own_and_nothing_else_changes() {
    for masks in [
        &[][..],
        &["--masks", "simulated"],
        &["--masks", "silhouette"],
    ] {
        let scene = dataset();
        succeed(scene.arguments(&simulated(masks)));
        let (before, after) = (scene.read("results.csv"), scene.read("out.csv"));
        let mut scores = Vec::new();
        for (before, after) in before.lines().zip(after.lines()) {
            let fields: Vec<&str> = after.split(',').collect();
            assert_eq!(before.replace(",0.25,", &format!(",{},", fields[3])), after);
            scores.extend(fields[3].parse::<f64>());
        }
        let [right, behind, nearly, beside] = scores[..] else {
            panic!("{after}");
        };
        assert!(right > 0.7 && nearly > 0.7, "{scores:?}");
        assert!(behind < 0.05 && beside < 1e-3, "{scores:?}");
    }
}

#[test]
fn the_report_says_every_number_and_the_truth() {
    let scene = dataset();
    let words = simulated(&["--masks", "simulated", "--report", "-"]);
    let report = json(&succeed(scene.arguments(&words)));
    assert_eq!(report["dataset"]["name"], "set");
    assert_eq!(report["dataset"]["depth"], "simulated");
    assert_eq!(report["dataset"]["depth_noise_mm"], 1.5);
    let estimates = report["estimates"].as_array().unwrap();
    assert_eq!(estimates.len(), 4);
    let [right, behind, _, beside] = &estimates[..] else {
        panic!("{report}");
    };
    assert_eq!(right["row"], 2);
    assert_eq!(right["truth"]["right"], true);
    assert!(right["valid_pixels"].as_u64().unwrap() > 50);
    assert_eq!(behind["truth"]["right"], false);
    for key in ["add_mm", "mssd_mm", "mssd_without_symmetries_mm"] {
        assert!((behind["truth"][key].as_f64().unwrap() - 40.0).abs() < 1e-9);
    }
    assert!((behind["estimated_error_mm"].as_f64().unwrap() - 40.0).abs() < 10.0);
    assert!(behind["along_ray_mm"].as_f64().unwrap() < -25.0, "{behind}");
    assert_eq!(behind["refined_t_mm"].as_array().unwrap().len(), 3);
    let cause = |estimate: &Value| estimate["cause"].as_str().unwrap().to_owned();
    assert!(cause(right).contains("fits"), "{right}");
    assert!(cause(behind).contains("offset along the ray"), "{behind}");
    assert!(!cause(beside).contains("fits"), "{beside}");
    assert_eq!(beside["decision"], "reject");
    assert_eq!(right["decision"], "undecided");
    assert!(
        right["reason"]
            .as_str()
            .unwrap()
            .contains("calibrate first")
    );
}

#[test]
fn a_calibrated_template_decides() {
    let scene = dataset();
    let rows: Vec<String> = (0..450)
        .map(|i| {
            row(
                3 + i % 3,
                1,
                &format!("5 -10 {}", 600.0 + 0.12 * f64::from(i)),
            )
        })
        .collect();
    scene.write("results.csv", results(&rows));
    succeed(scene.arguments(&simulated(&["--report", "@report.json"])));
    let calibrate = [
        "calibrate",
        "@t/obj_000001.cobra",
        "--labelled",
        "@report.json",
    ];
    let aim = ["--false-accept", "0.05"];
    succeed(scene.arguments(&[&calibrate[..], &aim].concat()));
    let report = json(&succeed(scene.arguments(&simulated(&["--report", "-"]))));
    let decisions = report["estimates"].as_array().unwrap();
    let decided = |word: &str| decisions.iter().filter(|e| e["decision"] == word).count();
    assert!(
        decided("accept") > 50 && decided("reject") > 300,
        "{report}"
    );
}

#[test]
fn the_same_seed_gives_the_same_file_and_another_one_other_noise() {
    let scene = dataset();
    let scored = |seed: &str, masks: &str| {
        succeed(scene.arguments(&simulated(&["--seed", seed, "--masks", masks])));
        scene.read("out.csv")
    };
    let first = scored("1", "silhouette");
    assert_eq!(scored("1", "silhouette"), first);
    assert_ne!(scored("2", "silhouette"), first);
}

#[test]
fn measured_depth_and_the_data_sets_own_masks_are_used_unless_told_otherwise() {
    let scene = dataset();
    for folder in ["depth", "mask_visib"] {
        std::fs::create_dir(scene.path(&format!("set/test/000002/{folder}"))).unwrap();
    }
    // A plane at the box's front, and a mask of its middle.
    for image in [3, 4, 5] {
        let depth = png(640, 480, png::BitDepth::Sixteen, |_, _| 605);
        scene.write(&format!("set/test/000002/depth/{image:06}.png"), depth);
        let inside = |x: u32, y: u32| {
            let inside = (340..360).contains(&x) && (230..250).contains(&y);
            if inside { 255 } else { 0 }
        };
        let mask = png(640, 480, png::BitDepth::Eight, inside);
        scene.write(
            &format!("set/test/000002/mask_visib/{image:06}_000000.png"),
            mask,
        );
    }
    let report = json(&succeed(scene.arguments(&words(&["--report", "-"]))));
    let right = &report["estimates"][0];
    assert_eq!(
        (&right["masks"], &right["pixels"]),
        (&json!("mask"), &json!(400))
    );
    assert!(right["forward"].as_f64().unwrap() > 0.99, "{right}");
    assert_eq!(report["dataset"]["depth"], "sensor");
}

/// A grey PNG.
fn png(width: u32, height: u32, depth: png::BitDepth, value: impl Fn(u32, u32) -> u16) -> Vec<u8> {
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

#[test]
fn a_row_that_is_no_estimate_is_named_and_the_others_are_scored() {
    let scene = dataset();
    let eight = format!("2,3,1,0.5,{},{TRUTH},-1\n", &IDENTITY[2..]);
    let mirror = format!("2,3,1,0.5,1 0 0 0 1 0 0 0 -1,{TRUTH},-1\n");
    scene.write(
        "results.csv",
        results(&[row(3, 1, TRUTH), eight, mirror, row(4, 1, TRUTH)]),
    );
    let said = [
        "results.csv: line 3: R: expected 9 numbers, found 8",
        "results.csv: line 4: R mirrors",
    ];
    let outcome = scores_the_rest(&scene, &simulated(&[]), &said, 2);
    assert!(
        outcome.stderr.contains("2 of 4 rows were not scored"),
        "{outcome:?}"
    );
    // What bop_toolkit could not read is not there.
    assert_eq!(scene.read("out.csv").lines().count(), 4);
}

#[test]
fn an_object_without_a_template_is_named_once() {
    let scene = dataset();
    scene.write(
        "results.csv",
        results(&[row(3, 1, TRUTH), row(3, 7, TRUTH), row(4, 7, TRUTH)]),
    );
    let said = ["t/obj_000007.cobra: No such file or directory (os error 2)"];
    scores_the_rest(&scene, &simulated(&[]), &said, 1);
}

#[test]
fn a_depth_image_that_is_missing_or_of_another_size_concerns_its_image_alone() {
    let scene = dataset();
    std::fs::create_dir(scene.path("set/test/000002/depth")).unwrap();
    let write = |image: u32, width: u32| {
        let depth = png(width, 480, png::BitDepth::Sixteen, |_, _| 605);
        scene.write(&format!("set/test/000002/depth/{image:06}.png"), depth);
    };
    write(3, 640);
    write(4, 320);
    let said = [
        "depth/000005.png: No such file",
        "depth/000004.png: expected 16-bit grey PNG of 640 x 480 pixels, found 16-bit grey PNG of 320 x 480",
    ];
    scores_the_rest(&scene, &words(&[]), &said, 2);
}

#[test]
fn a_depth_scale_of_zero_and_two_cameras_for_an_image_are_refused_by_name() {
    let scene = dataset();
    std::fs::create_dir(scene.path("set/test/000002/depth")).unwrap();
    for image in [3, 4, 5] {
        let depth = png(640, 480, png::BitDepth::Sixteen, |_, _| 605);
        scene.write(&format!("set/test/000002/depth/{image:06}.png"), depth);
    }
    let k = json!([500, 0, 320, 0, 500, 240, 0, 0, 1]);
    set_cameras(&scene, |image| match image {
        4 => json!({"cam_K": k, "depth_scale": 0}),
        5 => json!({"cam_K": k, "cam_model": {"fx": 500}, "depth_scale": 1}),
        _ => json!({"cam_K": k, "depth_scale": 1}),
    });
    let said = [
        "scene_camera.json: 4.depth_scale: expected a number greater than 0, found 0",
        "scene_camera.json: 5.cam_model: expected",
    ];
    scores_the_rest(&scene, &words(&[]), &said, 2);
}

#[test]
fn templates_of_all_models_are_trained_and_what_is_no_mesh_is_left_out() {
    let scene = dataset();
    scene.write("set/models/obj_000002.ply", "ply\nnot one\n");
    let words = ["bop", "train", "--models", "@set/models", "-o", "@new"];
    let outcome = run(scene.arguments(&words));
    assert_eq!(outcome.code, Some(3), "{outcome:?}");
    assert!(outcome.stderr.contains("obj_000002.ply"), "{outcome:?}");
    let bytes = std::fs::read(scene.path("new/obj_000001.cobra")).unwrap();
    let template = cobra_infer::Template::from_bytes(&bytes).unwrap();
    assert_eq!(template.name(), "obj_000001");
    assert!(template.depth().is_some());
    assert!(!scene.path("new/obj_000002.cobra").exists());
}

#[test]
fn a_model_in_metres_is_warned_of() {
    let scene = dataset();
    let metres = ply().lines().fold(String::new(), |text, line| {
        let numbers: Vec<f64> = line
            .split(' ')
            .filter_map(|word| word.parse().ok())
            .collect();
        match numbers[..] {
            [x, y, z] => text + &format!("{} {} {}\n", x / 1e3, y / 1e3, z / 1e3),
            _ => text + line + "\n",
        }
    });
    scene.write("set/models/obj_000001.ply", metres);
    let words = ["bop", "train", "--models", "@set/models", "-o", "@new"];
    let outcome = succeed(scene.arguments(&words));
    assert!(
        outcome.stderr.contains("as of one in metres"),
        "{outcome:?}"
    );
}
