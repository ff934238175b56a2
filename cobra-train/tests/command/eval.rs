//! `cobra eval`.

use crate::run::{json, succeed};
use crate::scene::Scene;

fn words<'a>(more: &[&'a str]) -> Vec<&'a str> {
    let mut words = vec![
        "eval",
        "@part.cobra",
        "--mesh",
        "@box.obj",
        "--points",
        "400",
    ];
    words.extend(more);
    words
}

#[test]
fn the_json_has_the_documented_figures() {
    let scene = Scene::trained();
    let document = json(&succeed(scene.arguments(&words(&["--json", "-"]))));
    assert_eq!(document["schema"], 2);
    for key in ["chamfer", "precision", "recall", "f_score"] {
        assert!(document[key].as_f64().unwrap() > 0.0, "{key}: {document}");
        for other in 0..2 {
            assert!(
                document["other_rules"][other][key].is_number(),
                "{key}: {document}"
            );
        }
    }
    let residual = |key: &str| document["residual"][key].as_f64().unwrap();
    assert!(residual("median") <= residual("p95"));
    let ratio = document["residual_mm"]["rms"].as_f64().unwrap() / residual("rms");
    // The bounding sphere's radius in mm.
    assert!((ratio - 53.85).abs() < 0.01, "{ratio}");
}

#[test]
fn the_predicted_points_are_a_ply_cloud_near_the_box() {
    let scene = Scene::trained();
    succeed(scene.arguments(&words(&["--points-out", "@predicted.ply"])));
    let text = scene.read("predicted.ply");
    let (header, body) = text.split_once("end_header\n").unwrap();
    assert!(header.contains("element vertex 400"), "{header}");
    assert_eq!(body.lines().count(), 400);
    for line in body.lines() {
        let fields: Vec<f64> = line.split(' ').map(|word| word.parse().unwrap()).collect();
        let &[x, y, z, residual, component] = &fields[..] else {
            panic!("{line}");
        };
        assert!(x > 0.0 && x < 60.0 && y > -30.0 && y < 50.0 && z > -5.0 && z < 95.0);
        assert!(residual.abs() < 20.0 && component < 4.0, "{line}");
    }
}

#[test]
fn another_objects_mesh_is_measured_with_a_warning() {
    let scene = Scene::trained();
    let metres = Scene::scaled(0.001);
    std::fs::copy(metres.path("box.obj"), scene.path("box.obj")).unwrap();
    let outcome = succeed(scene.arguments(&words(&[])));
    assert!(outcome.stderr.contains("another unit"), "{outcome:?}");
}

#[test]
fn the_seed_decides_the_test_points() {
    let scene = Scene::trained();
    let figures = |seed| succeed(scene.arguments(&words(&["--seed", seed, "--json", "-"]))).stdout;
    assert_eq!(figures("1"), figures("1"));
    assert_ne!(figures("1"), figures("2"));
}
