//! `cobra ambiguity`: a box of three different sides, which three half-turns map onto itself.

use crate::run::{json, refuse, succeed};
use crate::scene::Scene;
use serde_json::{Value, json};

/// Enough for a box, and quick.
const FEW: [&str; 4] = ["--views", "3", "--candidates", "150"];

fn words<'a>(more: &[&'a str]) -> Vec<&'a str> {
    let words = ["ambiguity", "@part.cobra", "--mesh", "@box.obj"];
    [&words[..], &FEW, more].concat()
}

/// States the half-turn about the upright axis through the box's middle, and a third of a turn that changes
/// its sides.
fn info() -> String {
    let half = [-1, 0, 0, 60, 0, -1, 0, 20, 0, 0, 1, 0, 0, 0, 0, 1];
    let third = [0, 0, 1, -15, 1, 0, 0, -20, 0, 1, 0, 35, 0, 0, 0, 1];
    let object = json!({"diameter": 107.7, "symmetries_discrete": [half, third]});
    json!({"1": {"diameter": 107.7}, "4": object}).to_string()
}

#[test]
fn the_half_turns_of_a_box_are_found_and_the_stated_one_recognised() {
    let scene = Scene::charted();
    scene.write("models_info.json", info());
    let stated = ["--models-info", "@models_info.json", "--object", "4"];
    let told = json(&succeed(
        scene.arguments(&words(&[&stated[..], &["--json", "-"]].concat())),
    ));
    // Where the view hides one of the sides, more fits nearly.
    let all = told["ambiguities"].as_array().unwrap().iter();
    let all: Vec<&Value> = all.filter(|found| found["views"] == 3).collect();
    assert_eq!(all.len(), 3, "{told:#}");
    for found in all {
        assert_eq!(found["kind"], "motion");
        let angle = found["angle_degrees"].as_f64().unwrap();
        assert!((angle - 180.0).abs() < 3.0, "{told:#}");
        let upright = found["axis"][2].as_f64().unwrap() > 0.99;
        assert_eq!(found["stated"], upright, "{told:#}");
        let [add, add_s] = ["add_mm", "add_s_mm"].map(|key| found[key].as_f64().unwrap());
        assert!(add > 50.0 && add_s < 10.0, "{told:#}");
    }
    assert_eq!(told["stated"]["found"], json!([true, false]));

    let table = succeed(scene.arguments(&words(&stated))).stdout;
    assert!(
        table.contains("Shape cannot tell these apart: ADD up to"),
        "{table}"
    );
    assert!(table.contains("not stated in models_info"), "{table}");
    assert!(
        table.contains("1 of 2 that models_info states not found"),
        "{table}"
    );
}

#[test]
fn the_same_seed_gives_the_same_bytes_on_any_number_of_threads() {
    let scene = Scene::charted();
    let run = |threads: &str, more: &[&str]| {
        let mut command = crate::run::command();
        let words = words(&[&["--depth-noise", "1", "--json", "-"], more].concat());
        command
            .args(scene.arguments(&words))
            .env("RAYON_NUM_THREADS", threads);
        command.output().unwrap().stdout
    };
    let one = run("1", &[]);
    assert!(!one.is_empty());
    assert_eq!(run("3", &[]), one);
    assert_ne!(run("3", &["--seed", "1"]), one);
}

#[test]
fn what_does_not_fit_together_is_refused() {
    let scene = Scene::charted();
    scene.write("models_info.json", info());
    let arguments = |more: &[&str]| scene.arguments(&words(more));
    refuse(
        arguments(&["--models-info", "@none.json", "--object", "4"]),
        4,
        &["none.json"],
    );
    let unknown = ["--models-info", "@models_info.json", "--object", "7"];
    refuse(arguments(&unknown), 3, &["models_info.json", "object 7"]);
    refuse(
        arguments(&["--json", "@box.obj"]),
        2,
        &["box.obj is both an input and an output"],
    );

    let other = Scene::scaled(10.0);
    other.write(
        "part.cobra",
        std::fs::read(scene.path("part.cobra")).unwrap(),
    );
    refuse(
        other.arguments(&words(&[])),
        3,
        &["the true pose has a mean confidence", "another unit"],
    );

    let everywhere = Scene::trained();
    refuse(
        everywhere.arguments(&words(&[])),
        3,
        &["train it with verified validity"],
    );
    let written: Value = json!({});
    scene.write("models_info.json", written.to_string());
    refuse(arguments(&unknown), 3, &["models_info.json"]);
}
