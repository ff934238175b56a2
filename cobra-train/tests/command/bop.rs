//! `cobra bop`: scores for a results file, and templates of a data set's objects.

use crate::bop_scene::{dataset, ply, png, results, row, simulated, words};
use crate::run::{json, run, succeed};
use serde_json::{Value, json};

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
    assert_eq!(right["minimum_points"], 10);
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
    assert!(cause(behind).ends_with(" mm"), "{behind}");
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

    // Thresholds of another object do not get into it.
    scene.write("report.json", r#"{"estimates": []}"#);
    let words =
        "calibrate @new/obj_000001.cobra --labelled @report.json --false-accept 0.1 --object 5";
    let words: Vec<&str> = words.split(' ').collect();
    let said = ["is of object 1, and --object says 5"];
    crate::run::refuse(scene.arguments(&words), 2, &said);
}

#[test]
fn nothing_that_is_read_is_replaced_and_folders_that_are_none_are_told_once() {
    let scene = dataset();
    let words = |more: &[&str]| {
        let words = "bop score --dataset @set --results @results.csv --depth simulated";
        let words: Vec<&str> = words.split(' ').chain(more.iter().copied()).collect();
        scene.arguments(&words)
    };
    for output in [
        "@set/test/000002/scene_gt.json",
        "@set/camera.json",
        "@set/models/obj_000001.ply",
        "@t/obj_000001.cobra",
    ] {
        for option in ["-o", "--report"] {
            let mut more = vec!["--templates", "@t", option, output];
            if option != "-o" {
                more.extend(["-o", "@new.csv"]);
            }
            let said = ["would be replaced", "which is an input"];
            crate::run::refuse(words(&more), 2, &said);
        }
    }
    let more = ["--templates", "@t", "-o", "@set/rescored.csv"];
    for _ in 0..2 {
        succeed(words(&more));
    }
    let more = ["--templates", "@none", "-o", "@new.csv"];
    crate::run::refuse(words(&more), 4, &["none", "No such file"]);
    let more = [
        "--templates",
        "@t",
        "-o",
        "@new.csv",
        "--masks",
        "Simulated",
    ];
    crate::run::refuse(
        words(&more),
        2,
        &["expected simulated, silhouette or a folder"],
    );
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
