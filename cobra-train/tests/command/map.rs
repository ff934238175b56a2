//! `cobra train --mean map`.

use crate::run::{command, refuse, succeed};
use crate::scene::Scene;
use cobra_infer::Template;

fn words<'a>(more: &[&'a str]) -> Vec<&'a str> {
    let mut words = vec!["train", "@box.obj", "-o", "@part.cobra"];
    words.extend(["--points", "600", "--test-points", "300", "--mean", "map"]);
    words.extend(more);
    words
}

#[test]
fn maps_keep_to_the_budget_and_say_how_far_they_are_off() {
    let scene = Scene::new();
    let mut lengths = Vec::new();
    for budget in ["2000", "4000"] {
        succeed(scene.arguments(&words(&["--budget", budget])));
        let bytes = std::fs::read(scene.path("part.cobra")).unwrap();
        assert!(bytes.len() <= budget.parse().unwrap(), "{budget}");
        let template = Template::from_bytes(&bytes).unwrap();
        assert!(template.has_maps() && template.has_validity());
        let quality = template.quality().unwrap();
        assert!(quality.deviation_max >= quality.deviation_rms);
        assert!(quality.deviation_rms > 0.0);
        lengths.push(bytes.len());
        let evaluated = scene.arguments(&["eval", "@part.cobra", "--mesh", "@box.obj"]);
        assert!(succeed(evaluated).stdout.contains("wrongly accepted"));
    }
    assert!(lengths[0] < lengths[1], "{lengths:?}");
}

#[test]
fn maps_are_the_same_whatever_the_number_of_threads() {
    let scene = Scene::new();
    let train = |threads: &str| {
        let arguments = scene.arguments(&words(&[]));
        let run = command()
            .args(arguments)
            .env("RAYON_NUM_THREADS", threads)
            .output();
        assert!(run.unwrap().status.success());
        std::fs::read(scene.path("part.cobra")).unwrap()
    };
    assert_eq!(train("1"), train("3"));
}

#[test]
fn maps_cannot_speak_everywhere() {
    let scene = Scene::new();
    let everywhere = scene.arguments(&words(&["--validity", "everywhere"]));
    refuse(&everywhere[..], 2, &["--mean map", "--validity verified"]);
}

#[test]
fn maps_are_told_from_terms() {
    let scene = Scene::new();
    let trained = succeed(scene.arguments(&words(&["--budget", "4000"]))).stdout;
    assert!(
        trained.contains(" nodes, ") && trained.contains("baked: "),
        "{trained}"
    );
    assert!(!trained.contains("terms"), "{trained}");
    let inspected = succeed(scene.arguments(&["inspect", "@part.cobra"])).stdout;
    for words in [
        "map\n",
        "nodes read a point: at most 16",
        "none of cobra-infer",
    ] {
        assert!(inspected.contains(words), "{words}: {inspected}");
    }
    let json = scene.arguments(&["inspect", "@part.cobra", "--json", "-"]);
    let document: serde_json::Value = serde_json::from_str(&succeed(json).stdout).unwrap();
    assert_eq!(document["encoding"], "map");
    assert_eq!(document["features"], serde_json::json!([]));
    assert!(document["quality"]["deviation"]["rms"].as_f64().unwrap() > 0.0);
    let header = scene.arguments(&["export", "@part.cobra", "--format", "c", "-o", "@part.h"]);
    succeed(header);
    let header = std::fs::read_to_string(scene.path("part.h")).unwrap();
    assert!(header.contains("features of cobra-infer: none"), "{header}");
}
