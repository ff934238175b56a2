//! `cobra train`: where reference points lie, which points are drawn, how far components overlap.

use crate::run::{command, json, refuse, run, succeed};
use crate::scene::{CLUSTERED, FEW, KMEANS, Scene};
use serde_json::{Value, json};

const TRAIN: [&str; 4] = ["train", "@box.obj", "-o", "@part.cobra"];

/// Of clusters; which is for `more` to say.
fn words<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&TRAIN[..], &FEW, &CLUSTERED, more].concat()
}

fn report(scene: &Scene, more: &[&str]) -> Value {
    let all = [more, &["--json", "-"]].concat();
    json(&succeed(scene.arguments(&words(&all))))
}

fn terms(report: &Value) -> u64 {
    let components = report["components"].as_array().unwrap();
    components
        .iter()
        .map(|c| c["terms"].as_u64().unwrap())
        .sum()
}

#[test]
fn the_json_says_how_points_were_placed_and_drawn() {
    let scene = Scene::new();
    let keys = ["reference_points", "sampling", "overlap"];
    let said = |more: &[&str]| {
        let report = report(&scene, more);
        keys.map(|key| report[key].clone())
    };
    let expected = [json!("kmeans"), json!("cameras"), Value::Null];
    assert_eq!(said(&["--reference-points", "kmeans"]), expected);
    let more = [
        "--reference-points",
        "em",
        "--sampling",
        "poisson",
        "--overlap",
        "0.05",
    ];
    assert_eq!(said(&more), [json!("em"), json!("poisson"), json!(0.05)]);
    scene.write("centres.txt", "30 10 25\n30 10 65\n30 10 45\n30 0 45\n");
    let more = [
        "--reference-points",
        "@centres.txt",
        "--sampling",
        "reference-points",
    ];
    let expected = [json!("given"), json!("reference-points"), Value::Null];
    assert_eq!(said(&more), expected);
}

#[test]
fn every_way_trains_as_many_components_on_as_many_points() {
    let scene = Scene::new();
    for placement in ["kmeans", "em"] {
        for sampling in ["cameras", "poisson", "reference-points"] {
            let more = ["--reference-points", placement, "--sampling", sampling];
            let report = report(&scene, &more);
            assert_eq!(report["components"].as_array().unwrap().len(), 4);
            assert_eq!(terms(&report), 300, "{placement} {sampling}");
        }
    }
}

#[test]
fn the_defaults_are_auto_verified_compressed_cameras_and_no_overlap() {
    let scene = Scene::new();
    let bytes = |more: &[&str]| {
        let words = [&TRAIN[..], &FEW, more].concat();
        succeed(scene.arguments(&words));
        std::fs::read(scene.path("part.cobra")).unwrap()
    };
    let spelt = [
        "--reference-points",
        "auto",
        "--max-components",
        "64",
        "--validity",
        "verified",
        "--budget",
        "14336",
        "--exponent",
        "0.5",
        "--sampling",
        "cameras",
        "--overlap",
        "none",
    ];
    assert!(bytes(&[]) == bytes(&spelt));
}

#[test]
fn clusters_are_16_drawn_by_cameras_without_overlap_unless_told_otherwise() {
    let scene = Scene::new();
    let bytes = |more: &[&str]| {
        let words = [&TRAIN[..], &FEW, &["--reference-points", "kmeans"], more].concat();
        succeed(scene.arguments(&words));
        std::fs::read(scene.path("part.cobra")).unwrap()
    };
    let spelt = [
        "--components",
        "16",
        "--sampling",
        "cameras",
        "--overlap",
        "none",
    ];
    assert!(bytes(&[]) == bytes(&spelt));
}

#[test]
fn overlap_trains_components_on_more_points() {
    let scene = Scene::new();
    let with = |share: &str| {
        let more = ["--reference-points", "kmeans", "--overlap", share];
        terms(&report(&scene, &more))
    };
    let (none, some, much) = (with("none"), with("0.05"), with("0.5"));
    assert!(
        none == 300 && none < some && some < much,
        "{none} {some} {much}"
    );
}

#[test]
fn every_way_gives_the_same_bytes_whatever_the_number_of_threads() {
    let scene = Scene::new();
    let kmeans = [&TRAIN[..], &FEW, &KMEANS].concat();
    for words in [
        words(&["--reference-points", "em"]),
        [&kmeans[..], &["--sampling", "poisson"]].concat(),
        [&kmeans[..], &["--sampling", "reference-points"]].concat(),
        [&kmeans[..], &["--overlap", "0.05"]].concat(),
        [&TRAIN[..], &FEW, &["--sampling", "poisson"]].concat(),
    ] {
        let train = |threads: &str| {
            let mut command = command();
            command.args(scene.arguments(&words));
            assert!(
                command
                    .env("RAYON_NUM_THREADS", threads)
                    .status()
                    .unwrap()
                    .success()
            );
            std::fs::read(scene.path("part.cobra")).unwrap()
        };
        assert!(train("1") == train("3"), "{words:?}");
    }
}

#[test]
fn em_with_more_components_than_points_is_refused() {
    let scene = Scene::new();
    let words = [
        "train",
        "@box.obj",
        "-o",
        "@part.cobra",
        "--reference-points",
        "em",
    ];
    let more = ["--points", "5", "--components", "6"];
    refuse(
        scene.arguments(&[&words[..], &more].concat()),
        3,
        &["box.obj", "5", "6"],
    );
    assert!(!scene.path("part.cobra").exists());
}

#[test]
fn reference_points_that_see_nothing_are_refused_by_their_number() {
    let scene = Scene::new();
    scene.write("centres.txt", "30 10 45\n30 10 9000\n");
    let words = ["train", "@box.obj", "-o", "@part.cobra", "--points", "300"];
    let more = [
        "--reference-points",
        "@centres.txt",
        "--sampling",
        "reference-points",
    ];
    let said = ["reference point 1", "150 points"];
    refuse(scene.arguments(&[&words[..], &more].concat()), 3, &said);
}

#[test]
fn shares_and_samplings_that_are_none_are_wrong_usage() {
    for (option, value) in [
        ("--overlap", "-0.1"),
        ("--overlap", "nan"),
        ("--overlap", "inf"),
        ("--overlap", "all"),
        ("--sampling", "rays"),
    ] {
        let value = format!("{option}={value}");
        let outcome = run(["train", "box.obj", "-o", "a.cobra", &value]);
        assert_eq!(outcome.code, Some(2), "{outcome:?}");
        assert!(outcome.stderr.contains(option), "{outcome:?}");
    }
}
