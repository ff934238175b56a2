//! What is wrong with a results file or a data set, and that it concerns nothing else.

use crate::bop_scene::{
    IDENTITY, TRUTH, dataset, png, results, row, scores_the_rest, set_cameras, simulated, words,
};
use crate::run::{refuse, run};
use crate::scene::Scene;
use serde_json::{Value, json};

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
    let said = ["t: expected obj_000007.cobra for poses of object 7, found templates of 1 ("];
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

/// What a run with a report says of the truth: its exit code, its warnings, and of each estimate whether it is
/// right and what keeps one from knowing it.
struct Told {
    code: Option<i32>,
    warnings: Vec<String>,
    last: String,
    right: Vec<Option<bool>>,
    problems: Vec<bool>,
}

fn told(scene: &Scene, more: &[&str]) -> Told {
    let report = ["--report", "@report.json"];
    let outcome = run(scene.arguments(&words(&[&report[..], more].concat())));
    let report: Value = serde_json::from_str(&scene.read("report.json")).unwrap();
    let estimates = report["estimates"].as_array().unwrap();
    let warnings = outcome.stderr.lines();
    let warnings = warnings.filter(|line| line.starts_with("warning: "));
    Told {
        code: outcome.code,
        warnings: warnings.map(str::to_owned).collect(),
        last: outcome.stderr.lines().last().unwrap_or("").to_owned(),
        right: estimates
            .iter()
            .map(|estimate| estimate["truth"]["right"].as_bool())
            .collect(),
        problems: estimates
            .iter()
            .map(|estimate| estimate.get("truth_problem").is_some())
            .collect(),
    }
}

const RIGHT: [Option<bool>; 4] = [Some(true), Some(false), Some(true), Some(false)];

#[test]
fn a_truth_that_cannot_be_used_is_told_once_and_the_exit_code_says_so() {
    let info = "set/models/models_info.json";
    let cases: [(&str, &str, &str, [Option<bool>; 4]); 5] = [
        (
            info,
            "{",
            "models/models_info.json: not valid JSON",
            [None; 4],
        ),
        (
            info,
            r#"{"1": {"diameter": -1}}"#,
            "models/models_info.json: 1.diameter: expected a number greater than 0, found -1",
            [None; 4],
        ),
        (
            info,
            r#"{"2": {"diameter": 80}}"#,
            "models/models_info.json: expected an entry for object 1, found none",
            [None; 4],
        ),
        (
            "set/models_eval/obj_000001.ply",
            "no mesh",
            "models_eval/obj_000001.ply",
            [None; 4],
        ),
        (
            "set/test/000002/scene_gt.json",
            r#"{"3": [{"cam_R_m2c": [1, 0, 0, 0, 1, 0, 0, 0, 1], "cam_t_m2c": [5, -10, 600], "obj_id": 1}],
                "4": [{"cam_R_m2c": [1, 0, 0], "cam_t_m2c": [5, -10, 600], "obj_id": 1}], "5": []}"#,
            "scene_gt.json: 4[0].cam_R_m2c: expected 9 numbers",
            [Some(true), Some(false), None, Some(false)],
        ),
    ];
    for (file, content, said, right) in cases {
        let scene = measured();
        std::fs::create_dir_all(scene.path(file).parent().unwrap()).unwrap();
        scene.write(file, content);
        let told = told(&scene, &[]);
        assert_eq!(told.code, Some(3), "{said}");
        assert_eq!(told.warnings.len(), 1, "{:?}", told.warnings);
        assert!(told.warnings[0].contains(said), "{:?}", told.warnings);
        assert!(told.warnings[0].contains("results.csv without truth: "));
        let unknown = right.iter().filter(|right| right.is_none()).count();
        let last = format!("results.csv: the truth of {unknown} of 4 rows is not known");
        assert!(told.last.ends_with(&last), "{}", told.last);
        assert_eq!((told.right, scored(&scene)), (right.to_vec(), 4), "{said}");
        assert_eq!(told.problems, right.map(|right| right.is_none()));
    }
}

#[test]
fn a_truth_that_is_not_published_is_no_problem() {
    let scene = measured();
    std::fs::remove_file(scene.path("set/test/000002/scene_gt.json")).unwrap();
    std::fs::remove_dir_all(scene.path("set/models")).unwrap();
    let told = told(&scene, &[]);
    assert_eq!((told.code, told.warnings.len()), (Some(0), 0));
    assert_eq!((told.right, scored(&scene)), (vec![None; 4], 4));
}

#[test]
fn without_models_info_diameters_are_the_models_own_and_a_line_says_that_symmetries_are_not_known()
{
    let scene = measured();
    std::fs::remove_file(scene.path("set/models/models_info.json")).unwrap();
    let told = told(&scene, &[]);
    assert_eq!((told.code, told.warnings.len()), (Some(0), 1));
    let said = "models/models_info.json: expected diameters and symmetries of the objects, found no such file";
    assert!(told.warnings[0].contains(said), "{:?}", told.warnings);
    assert_eq!(told.right, RIGHT);
    let report: Value = serde_json::from_str(&scene.read("report.json")).unwrap();
    let diameter = report["estimates"][0]["truth"]["diameter_mm"]
        .as_f64()
        .unwrap();
    assert!((diameter - 107.703_296).abs() < 1e-5, "{diameter}");
}

/// The data set with measured depth, so that nothing but errors asks for the truth.
fn measured() -> Scene {
    let scene = dataset();
    std::fs::create_dir(scene.path("set/test/000002/depth")).unwrap();
    for image in [3, 4, 5] {
        let depth = png(640, 480, png::BitDepth::Sixteen, |_, _| 605);
        scene.write(&format!("set/test/000002/depth/{image:06}.png"), depth);
    }
    scene
}

/// How many rows of the written file have a score.
fn scored(scene: &Scene) -> usize {
    let text = scene.read("out.csv");
    let scores = text.lines().skip(1).map(|line| line.split(',').nth(3));
    scores.filter(|score| *score != Some("-1")).count()
}

#[test]
fn noise_on_measured_depth_is_refused() {
    let scene = measured();
    refuse(
        scene.arguments(&words(&["--depth-noise", "2"])),
        2,
        &["--depth-noise goes with --depth simulated"],
    );
}
