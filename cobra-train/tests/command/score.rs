//! `cobra score` on input that is all right.

use crate::run::{json, run, succeed};
use crate::scene::{FEW, Scene};
use serde_json::Value;

fn poses(scene: &Scene, more: &[&str]) -> Vec<Value> {
    let mut words = vec!["--json", "-"];
    words.extend(more);
    let document = json(&succeed(scene.score(&words)));
    document["poses"].as_array().unwrap().clone()
}

fn confidences(scene: &Scene, more: &[&str]) -> Vec<f64> {
    poses(scene, more)
        .iter()
        .map(|pose| pose["confidence"].as_f64().unwrap())
        .collect()
}

#[test]
fn the_right_pose_is_accepted_and_the_wrong_one_rejected() {
    let scene = Scene::trained();
    let outcome = succeed(scene.score(&[]));
    let line = |id: &str| {
        let found = outcome
            .stdout
            .lines()
            .find(|line| line.split_whitespace().next() == Some(id));
        found.unwrap_or_else(|| panic!("{}", outcome.stdout))
    };
    assert!(line("3").contains("accept"), "{}", outcome.stdout);
    assert!(line("8").contains("reject"), "{}", outcome.stdout);
}

#[test]
fn the_json_has_the_documented_keys() {
    let scene = Scene::trained();
    let document = json(&succeed(scene.score(&["--json", "-"])));
    assert_eq!(document["schema"], 1);
    assert_eq!(document["template"], "box");
    assert_eq!(document["likelihood"], "peak");
    assert_eq!(document["assignment"], "nearest");
    // 1 % of the diameter.
    assert!((document["delta"].as_f64().unwrap() - 1.077).abs() < 1e-3);
    let poses = document["poses"].as_array().unwrap();
    let ids: Vec<_> = poses.iter().map(|pose| pose["id"].clone()).collect();
    assert_eq!(ids, ["3", "8"]);
    for pose in poses {
        assert_eq!(pose["points"], 96);
        assert!(pose["confidence"].is_number() && pose["threshold"].is_number());
        assert!(pose["reason"].as_str().unwrap().contains(' '), "{pose}");
    }
    assert_eq!(poses[0]["decision"], "accept");
    assert_eq!(poses[1]["decision"], "reject");
}

#[test]
fn where_components_have_validity_the_likeliest_speaks() {
    let scene = Scene::charted();
    // The box is reproduced so well that 1 % of its diameter alone would be far above the residuals.
    let noise = ["--noise", "1"];
    let document = json(&succeed(
        scene.score(&[&["--json", "-"][..], &noise].concat()),
    ));
    assert_eq!(document["assignment"], "max");
    assert_eq!(document["poses"][0]["decision"], "accept");
    assert_eq!(document["poses"][1]["decision"], "reject");
    assert_eq!(
        poses(&scene, &[&["--assignment", "max"][..], &noise].concat()),
        document["poses"].as_array().unwrap()[..]
    );
    let [nearest, most] =
        [&["--assignment", "nearest"][..], &[]].map(|more| confidences(&scene, more));
    for (a, b) in nearest.iter().zip(&most) {
        assert!(a <= b, "the maximum is the most generous: {a} {b}");
    }
}

#[test]
fn a_json_file_comes_beside_the_table() {
    let scene = Scene::trained();
    let outcome = succeed(scene.score(&["--json", "@scores.json"]));
    assert!(outcome.stdout.contains("confidence"), "{outcome:?}");
    let document: Value = serde_json::from_str(&scene.read("scores.json")).unwrap();
    assert_eq!(document["poses"].as_array().unwrap().len(), 2);
}

#[test]
fn a_rejected_pose_is_a_failure_only_when_asked() {
    let scene = Scene::trained();
    let strict = run(scene.score(&["--fail-on-reject"]));
    assert_eq!(strict.code, Some(1), "{strict:?}");
    assert!(strict.stdout.contains("reject"), "{strict:?}");
    assert_eq!(strict.stderr, "error: 1 pose was not accepted\n");

    let only_right = scene.arguments(&["@correspondences/3_corr.txt"]);
    let mut arguments = scene.score(&["--fail-on-reject"]);
    let place = arguments
        .iter()
        .position(|word| word.ends_with("correspondences") && !word.starts_with("--"))
        .unwrap();
    arguments[place].clone_from(&only_right[0]);
    let right = succeed(arguments);
    assert!(right.stderr.contains("1 pose without"), "{right:?}");
}

#[test]
fn every_option_has_its_effect() {
    let scene = Scene::trained();
    let plain = poses(&scene, &[]);
    let inliers = poses(&scene, &["--inliers-only"]);
    assert_eq!(inliers[0]["points"], 86);
    let weighted = poses(&scene, &["--weights", "conf"]);
    assert_ne!(weighted[0]["weight_sum"], plain[0]["weight_sum"]);
    let wide = poses(&scene, &["--delta", "5"]);
    assert_eq!(wide[0]["confidence"], plain[0]["confidence"]);
    assert!(wide[0]["threshold"].as_f64() < plain[0]["threshold"].as_f64());
    let density = poses(&scene, &["--likelihood", "density"]);
    assert_ne!(density[0]["confidence"], plain[0]["confidence"]);

    let [plain, noisy, most] = [&[][..], &["--noise", "4"], &["--assignment", "max"]]
        .map(|more| confidences(&scene, more));
    for (a, b) in plain.iter().zip(&noisy) {
        assert!(a < b, "noise forgives: {a} {b}");
    }
    for (a, b) in plain.iter().zip(&most) {
        assert!(a <= b, "the maximum is the most generous: {a} {b}");
    }
    // A sigma that is given replaces the template's, and so every component has the same.
    let [narrow, broad] = ["1", "10"].map(|s| confidences(&scene, &["--sigma-hat", s]));
    assert!(narrow[0] < broad[0]);
}

#[test]
fn sigma_hat_stands_in_for_the_noise_too() {
    let scene = Scene::trained();
    let alone = poses(&scene, &["--sigma-hat", "1"]);
    assert_eq!(poses(&scene, &["--sigma-hat", "1", "--noise", "5"]), alone);
}

#[test]
fn extreme_lengths_give_numbers_all_the_same() {
    let scene = Scene::trained();
    for more in [
        ["--delta", "3e38"],
        ["--delta", "1e-30"],
        ["--sigma-hat", "3e38"],
        ["--sigma-hat", "1e-30"],
        ["--noise", "3e38"],
        ["--min-points", "4294967295"],
    ] {
        for likelihood in ["peak", "density"] {
            let more = [&more[..], &["--likelihood", likelihood]].concat();
            for pose in poses(&scene, &more) {
                assert!(pose["confidence"].is_number(), "{more:?}: {pose}");
                assert!(pose["threshold"].is_number(), "{more:?}: {pose}");
            }
        }
    }
}

#[test]
fn an_object_in_metres_scores_as_in_millimetres() {
    scores_as_in_millimetres(Scene::train, 2e-3);
    scores_as_in_millimetres(Scene::train_charts, 2e-2);
}

fn scores_as_in_millimetres(train: fn(&Scene, &[&str]), tolerance: f64) {
    let options = [
        &[][..],
        &["--delta", "2"],
        &["--noise", "1.5"],
        &["--sigma-hat", "1.93", "--delta", "2"],
    ];
    let [millimetres, metres] = [(1.0, "mm"), (0.001, "m")].map(|(scale, unit)| {
        let scene = Scene::scaled(scale);
        train(&scene, &["--unit", unit]);
        options.map(|more| {
            let poses = poses(&scene, more);
            assert_eq!(poses[0]["decision"], "accept", "{unit} {more:?}: {poses:?}");
            poses
                .iter()
                .flat_map(|pose| ["confidence", "threshold"].map(|key| pose[key].clone()))
                .map(|number| number.as_f64().unwrap())
                .collect::<Vec<_>>()
        })
    });
    for (a, b) in millimetres.iter().flatten().zip(metres.iter().flatten()) {
        assert!((a - b).abs() < tolerance, "{a} in mm, {b} in m");
    }
}

#[test]
fn several_poses_of_an_image_share_its_correspondences() {
    let scene = Scene::trained();
    let document: Value = serde_json::from_str(&scene.read("poses.json")).unwrap();
    let both = [&document["3"][0], &document["8"][0]];
    scene.write("poses.json", serde_json::json!({ "3": both }).to_string());
    let found = poses(&scene, &[]);
    let ids: Vec<_> = found.iter().map(|pose| pose["id"].clone()).collect();
    assert_eq!(ids, ["3#0", "3#1"]);
    assert_eq!(found[0]["decision"], "accept");
    assert_eq!(found[1]["decision"], "reject");
}

#[test]
fn every_exponent_scores() {
    for exponent in ["1", "0.5", "free"] {
        let scene = Scene::new();
        let mut words = vec!["train", "@box.obj", "-o", "@part.cobra"];
        words.extend(FEW);
        words.extend(["--reference-points", "kmeans", "--components", "4"]);
        words.extend(["--validity", "everywhere", "--budget", "none"]);
        words.extend(["--exponent", exponent]);
        succeed(scene.arguments(&words));
        let clustered = poses(&scene, &[]);
        scene.train_charts(&["--exponent", exponent]);
        for found in [clustered, poses(&scene, &["--noise", "1"])] {
            assert_eq!(found[0]["decision"], "accept", "{exponent}");
            assert_eq!(found[1]["decision"], "reject", "{exponent}");
        }
    }
}
