//! `cobra inspect`.

use crate::run::{json, succeed};
use crate::scene::Scene;
use serde_json::Value;

fn inspected(scene: &Scene) -> (String, Value) {
    let table = succeed(scene.arguments(&["inspect", "@part.cobra"])).stdout;
    let words = ["inspect", "@part.cobra", "--json", "-"];
    (table, json(&succeed(scene.arguments(&words))))
}

#[test]
fn the_table_and_the_json_tell_the_same_template() {
    for (scene, terms, components) in [
        (Scene::charted(), None, None),
        (Scene::trained(), Some(300), Some(4)),
    ] {
        let (table, document) = inspected(&scene);
        assert_eq!(document["schema"], 2);
        assert_eq!(document["name"], "box");
        assert_eq!(document["unit"], "mm");
        let of_components = document["components"].as_array().unwrap();
        let sum: u64 = of_components
            .iter()
            .map(|component| component["terms"].as_u64().unwrap())
            .sum();
        assert_eq!(document["terms"], sum);
        assert_eq!(sum, terms.unwrap_or(sum));
        assert_eq!(
            of_components.len(),
            components.unwrap_or(of_components.len())
        );
        for component in of_components {
            assert!(component["sigma_hat"].as_f64().unwrap() > 0.0);
            let sigma_hat = format!("{:.4}", component["sigma_hat"].as_f64().unwrap());
            assert!(table.contains(&sigma_hat), "{table}");
        }
        let size = std::fs::metadata(scene.path("part.cobra")).unwrap().len();
        assert_eq!(document["bytes"]["total"], size);
        assert!(table.contains(&format!("{size} bytes")), "{table}");
    }
}

#[test]
fn a_json_file_comes_beside_the_table() {
    let scene = Scene::charted();
    let outcome = succeed(scene.arguments(&["inspect", "@part.cobra", "--json", "@part.json"]));
    assert!(outcome.stdout.contains("diameter"), "{outcome:?}");
    serde_json::from_str::<Value>(&scene.read("part.json")).unwrap();
}

#[test]
fn the_parts_of_the_size_add_up_to_it() {
    let check = |scene: &Scene, compact: bool, validity: bool| {
        let (table, document) = inspected(scene);
        let bytes = |part: &str| document["bytes"][part].as_u64().unwrap();
        let parts = ["terms", "components", "validity", "other"].map(bytes);
        assert_eq!(parts.iter().sum::<u64>(), bytes("total"));
        let terms = document["terms"].as_u64().unwrap();
        let components = document["components"].as_array().unwrap().len() as u64;
        let expected = if compact {
            5 * terms + 4 * components
        } else {
            16 * terms
        };
        assert_eq!(bytes("terms"), expected);
        assert_eq!(bytes("components"), 36 * components);
        // A component's record is 16 bytes; of its cells there is at least a row.
        assert_eq!(bytes("validity") >= 21 * components, validity);
        assert_eq!(bytes("validity") == 0, !validity);
        // Headers, the object, the model, and what was measured.
        assert!((50..400).contains(&bytes("other")), "{document}");
        assert_eq!(
            document["encoding"],
            if compact { "compact" } else { "exact" }
        );
        assert_eq!(document["validity"], validity);
        let line = format!("{}, {}", terms, if compact { "compact" } else { "exact" });
        assert!(table.contains(&line), "{table}");
        let line = if validity {
            "where they were verified"
        } else {
            "everywhere"
        };
        assert!(table.contains(line), "{table}");
    };
    check(&Scene::charted(), true, true);
    check(&Scene::trained(), false, false);
    let scene = Scene::new();
    scene.train_charts(&["--budget", "none"]);
    check(&scene, false, true);
    scene.train_charts(&["--validity", "everywhere"]);
    check(&scene, true, false);
}

#[test]
fn what_was_measured_is_told_where_the_template_says_it() {
    let (table, document) = inspected(&Scene::charted());
    let quality = &document["quality"];
    let covered = quality["covered"].as_f64().unwrap();
    assert!((50.0..=100.0).contains(&covered), "{quality}");
    assert!(
        table.contains(&format!("{covered:.2} % of the points")),
        "{table}"
    );
    let deviation = |key: &str| quality["deviation"][key].as_f64().unwrap();
    assert!(deviation("rms") <= deviation("max"), "{quality}");
    let rms = format!("{:.3} sigma-hat rms", deviation("rms"));
    assert!(table.contains(&rms), "{table}");
    assert!(table.contains("unexplained %"), "{table}");
    for component in document["components"].as_array().unwrap() {
        let unexplained = component["unexplained"].as_f64().unwrap();
        assert!((0.0..=100.0).contains(&unexplained), "{component}");
    }

    let scene = Scene::new();
    scene.train_charts(&["--budget", "none"]);
    let (table, document) = inspected(&scene);
    assert!(document["quality"]["covered"].is_number(), "{document}");
    assert!(document["quality"]["deviation"].is_null(), "{document}");
    assert!(!table.contains("compression"), "{table}");

    let (table, document) = inspected(&Scene::trained());
    assert!(document["quality"].is_null(), "{document}");
    assert!(document["components"][0]["unexplained"].is_null());
    assert!(table.contains("not told") && !table.contains("unexplained"));
}
