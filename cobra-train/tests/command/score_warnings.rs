//! What `cobra score` says on standard error although it goes on.

use crate::run::{Outcome, json, succeed};
use crate::scene::Scene;

fn warnings(outcome: &Outcome) -> Vec<&str> {
    outcome
        .stderr
        .lines()
        .filter(|line| line.starts_with("warning: "))
        .collect()
}

#[test]
fn a_sound_scene_gives_no_warning() {
    let scene = Scene::trained();
    let outcome = succeed(scene.score(&["--sigma-hat", "1", "--delta", "1"]));
    assert!(warnings(&outcome).is_empty(), "{outcome:?}");
}

#[test]
fn a_threshold_that_any_pose_reaches_is_warned_of() {
    let scene = Scene::trained();
    for likelihood in ["peak", "density"] {
        for rule in ["paper", "mean", "worst"] {
            let rules = ["--likelihood", likelihood, "--threshold", rule];
            let with = |delta| [&["--sigma-hat", "2", "--delta", delta][..], &rules].concat();
            let outcome = succeed(scene.score(&with("8")));
            let [warning] = warnings(&outcome)[..] else {
                panic!("{outcome:?}");
            };
            assert!(warning.contains("--noise"), "{warning}");
            let outcome = succeed(scene.score(&with("5")));
            assert!(warnings(&outcome).is_empty(), "{outcome:?}");
        }
    }
}

#[test]
fn a_threshold_of_zero_leaves_poses_undecided() {
    let scene = Scene::trained();
    let outcome = succeed(scene.score(&["--sigma-hat", "1", "--delta", "1e25", "--json", "-"]));
    let pose = &json(&outcome)["poses"][0];
    assert_eq!(pose["decision"], "undecided", "{pose}");
    assert!(pose["reason"].as_str().unwrap().contains("threshold"));
}

#[test]
fn noise_without_effect_is_warned_of() {
    let scene = Scene::trained();
    let outcome = succeed(scene.score(&["--sigma-hat", "1", "--delta", "1", "--noise", "2"]));
    let [warning] = warnings(&outcome)[..] else {
        panic!("{outcome:?}");
    };
    assert!(warning.contains("--noise has no effect"), "{warning}");
}

#[test]
fn a_file_in_which_no_row_counts_is_named() {
    let scene = Scene::trained();
    scene.write("correspondences/8_corr.txt", "x,y,X,Y,Z\n");
    let outcome = succeed(scene.score(&[]));
    assert!(
        warnings(&outcome)
            .iter()
            .any(|line| line.contains("8_corr.txt: no row counts")),
        "{outcome:?}"
    );
}

#[test]
fn a_matrix_that_is_nearly_a_rotation_is_replaced_warned_of_and_reported() {
    let scene = Scene::trained();
    let sound = scene.read("poses.json");
    let scaled = sound
        .replacen("-1.0", "-0.9985", 1)
        .replacen("-1,", "-0.9985,", 1);
    assert_ne!(scaled, sound);
    scene.write("poses.json", scaled);
    let outcome = succeed(scene.score(&["--json", "-"]));
    assert!(
        warnings(&outcome)
            .iter()
            .any(|line| line.contains("nearest rotation")),
        "{outcome:?}"
    );
    let poses = &json(&outcome)["poses"];
    let repaired = poses[0]["repaired"].as_f64().unwrap();
    assert!(repaired > 1e-3 && repaired < 1e-2, "{repaired}");
    assert!(poses[1]["repaired"].is_null());
}

#[test]
fn the_json_says_which_sigma_was_used() {
    let scene = Scene::trained();
    let document = json(&succeed(scene.score(&["--noise", "2", "--json", "-"])));
    assert_eq!(document["noise"], 2.0);
    assert!(document["sigma"].is_null());
    let document = json(&succeed(scene.score(&["--sigma-hat", "3", "--json", "-"])));
    assert_eq!(document["sigma"], 3.0);
    assert!(document["noise"].is_null());
}
