//! `cobra inspect`.

use crate::run::{json, succeed};
use crate::scene::Scene;

#[test]
fn the_table_and_the_json_tell_the_same_template() {
    let scene = Scene::trained();
    let table = succeed(scene.arguments(&["inspect", "@part.cobra"])).stdout;
    let document = json(&succeed(scene.arguments(&[
        "inspect",
        "@part.cobra",
        "--json",
        "-",
    ])));
    assert_eq!(document["schema"], 2);
    assert_eq!(document["name"], "box");
    assert_eq!(document["unit"], "mm");
    assert_eq!(document["terms"], 300);
    let components = document["components"].as_array().unwrap();
    assert_eq!(components.len(), 4);
    for component in components {
        assert!(component["sigma_hat"].as_f64().unwrap() > 0.0);
        let sigma_hat = format!("{:.4}", component["sigma_hat"].as_f64().unwrap());
        assert!(table.contains(&sigma_hat), "{table}");
    }
    let size = std::fs::metadata(scene.path("part.cobra")).unwrap().len();
    assert_eq!(document["bytes"]["total"], size);
    assert!(table.contains(&format!("{size} bytes")), "{table}");
}

#[test]
fn a_json_file_comes_beside_the_table() {
    let scene = Scene::trained();
    let outcome = succeed(scene.arguments(&["inspect", "@part.cobra", "--json", "@part.json"]));
    assert!(outcome.stdout.contains("diameter"), "{outcome:?}");
    let document: serde_json::Value = serde_json::from_str(&scene.read("part.json")).unwrap();
    let sum: f64 = ["terms", "components", "other"]
        .iter()
        .map(|part| document["bytes"][part].as_f64().unwrap())
        .sum();
    assert_eq!(sum, document["bytes"]["total"].as_f64().unwrap());
}
