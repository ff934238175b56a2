//! `cobra train` on a mesh that is all right.

use crate::run::{command, json, succeed};
use crate::scene::{FEW, Scene};

fn words<'a>(more: &[&'a str]) -> Vec<&'a str> {
    let mut words = vec!["train", "@box.obj", "-o", "@part.cobra"];
    words.extend(FEW);
    words.extend(more);
    words
}

#[test]
fn the_json_has_the_documented_keys() {
    let scene = Scene::new();
    let document = json(&succeed(scene.arguments(&words(&["--json", "-"]))));
    assert_eq!(document["schema"], 2);
    assert_eq!(document["name"], "box");
    assert_eq!(document["unit"], "mm");
    assert_eq!(document["points"], 300);
    assert_eq!(document["reference_points"], "auto");
    let size = std::fs::metadata(scene.path("part.cobra")).unwrap().len();
    assert_eq!(document["bytes"], size);
    let components = document["components"].as_array().unwrap();
    assert!(!components.is_empty());
    for component in components {
        for key in ["sigma_hat", "terms", "length_scale", "likelihood_per_point"] {
            assert!(component[key].is_number(), "{key}: {component}");
        }
    }
}

#[test]
fn a_json_file_comes_beside_the_template_and_nothing_else_does() {
    let scene = Scene::new();
    let before = scene.names();
    let outcome = succeed(scene.arguments(&words(&["--json", "@report.json"])));
    let report: serde_json::Value = serde_json::from_str(&scene.read("report.json")).unwrap();
    let components = report["components"].as_array().unwrap();
    let terms: u64 = components
        .iter()
        .map(|component| component["terms"].as_u64().unwrap())
        .sum();
    let said = format!("{} components, {terms} terms", components.len());
    assert!(outcome.stdout.contains(&said), "{said}: {outcome:?}");
    let mut after = before;
    after.extend(["part.cobra".to_owned(), "report.json".to_owned()]);
    after.sort();
    assert_eq!(scene.names(), after);
}

#[test]
fn the_same_seed_gives_the_same_bytes_whatever_the_number_of_threads() {
    let scene = Scene::new();
    let train = |threads: &str, seed: &str| {
        let arguments = scene.arguments(&words(&["-q", "--seed", seed]));
        let status = command()
            .args(arguments)
            .env("RAYON_NUM_THREADS", threads)
            .output()
            .unwrap()
            .status;
        assert!(status.success());
        std::fs::read(scene.path("part.cobra")).unwrap()
    };
    let largest = u64::MAX.to_string();
    for seed in ["0", &largest] {
        assert!(train("1", seed) == train("3", seed), "seed {seed}");
    }
    assert!(train("3", "0") != train("3", "1"));
}

#[test]
fn quiet_leaves_the_result_and_verbose_adds_to_the_remarks() {
    let scene = Scene::new();
    let quiet = succeed(scene.arguments(&words(&["-q"])));
    assert_eq!(quiet.stderr, "");
    let template = scene.path("part.cobra");
    assert!(quiet.stdout.starts_with(template.to_str().unwrap()));

    // Twice the same vertex: a face without area.
    let flat = format!("{}f 1 1 2\n", scene.read("box.obj"));
    scene.write("box.obj", flat);
    let normal = succeed(scene.arguments(&words(&[])));
    assert!(
        normal.stderr.contains("mesh: 12 triangles"),
        "{}",
        normal.stderr
    );
    assert!(!normal.stderr.contains("without area"), "{}", normal.stderr);
    let verbose = succeed(scene.arguments(&words(&["-v"])));
    assert!(
        verbose.stderr.contains("without area"),
        "{}",
        verbose.stderr
    );
    assert_eq!(quiet.stdout, normal.stdout);
    assert_eq!(normal.stdout, verbose.stdout);
}

#[test]
fn reference_points_come_from_a_file_with_as_many_components() {
    let scene = Scene::new();
    scene.write("centres.txt", "# two\n30 10 25\n30, 10, 65\n");
    let arguments = [
        "train",
        "@box.obj",
        "-o",
        "@part.cobra",
        "--points",
        "300",
        "--test-points",
        "500",
        "--reference-points",
        "@centres.txt",
        "--validity",
        "everywhere",
        "--json",
        "-",
    ];
    let document = json(&succeed(scene.arguments(&arguments)));
    let centres: Vec<_> = document["components"]
        .as_array()
        .unwrap()
        .iter()
        .map(|component| component["centre"].to_string())
        .collect();
    assert_eq!(centres, ["[30.0,10.0,25.0]", "[30.0,10.0,65.0]"]);
}

#[test]
fn a_mesh_in_metres_taken_for_millimetres_is_doubted() {
    let scene = Scene::scaled(0.001);
    let doubted = succeed(scene.arguments(&words(&[])));
    assert!(
        doubted.stderr.contains("warning: ") && doubted.stderr.contains("--unit"),
        "{}",
        doubted.stderr
    );
    let right = succeed(scene.arguments(&words(&["--unit", "m"])));
    assert!(!right.stderr.contains("warning"), "{}", right.stderr);
}

#[test]
fn a_name_fits_or_is_refused() {
    let scene = Scene::new();
    let document = json(&succeed(
        scene.arguments(&words(&["--name", "pièce", "--json", "-"])),
    ));
    assert_eq!(document["name"], "pièce");
    let long = "x".repeat(33);
    crate::run::refuse(
        scene.arguments(&words(&["--name", &long])),
        2,
        &["33", "32"],
    );
    // The file's own name is nobody's choice and is cut instead.
    let file = format!("{}.obj", "é".repeat(40));
    std::fs::rename(scene.path("box.obj"), scene.path(&file)).unwrap();
    let mesh = format!("@{file}");
    let mut arguments = words(&["--json", "-"]);
    arguments[1] = &mesh;
    let document = json(&succeed(scene.arguments(&arguments)));
    assert_eq!(document["name"], "é".repeat(16));
}
