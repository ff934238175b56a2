//! `cobra train`: how hyperparameters are learned, and what coverage says of the result.

use crate::run::{json, refuse, succeed};
use crate::scene::{FEW, KMEANS, Scene};

fn words<'a>(more: &[&'a str]) -> Vec<&'a str> {
    let mut words = vec!["train", "@box.obj", "-o", "@part.cobra"];
    words.extend(FEW);
    words.extend(KMEANS);
    words.extend(more);
    words
}

/// Without a word on components.
fn default<'a>(more: &[&'a str]) -> Vec<&'a str> {
    let train = ["train", "@box.obj", "-o", "@part.cobra"];
    [&train[..], &FEW, more].concat()
}

#[test]
fn adam_is_the_papers_recipe_unless_the_subset_says_otherwise() {
    let scene = Scene::new();
    let adam = words(&["--optimiser", "adam", "--json", "-"]);
    let document = json(&succeed(scene.arguments(&adam)));
    assert_eq!(document["optimiser"], "adam");
    assert!(document["subset"].is_null(), "{document}");
    assert_eq!(document["noise_floor"], 1e-4);
    for component in document["components"].as_array().unwrap() {
        assert!(component["noise_variance"].as_f64().unwrap() >= 1e-4);
        assert!(component["iterations"].as_u64().unwrap() <= 250);
    }
    let few = [&adam[..], &["--subset", "20"]].concat();
    let document = json(&succeed(scene.arguments(&few)));
    assert_eq!(document["subset"], 20);
}

#[test]
fn the_default_is_lbfgs_on_300_points_about_the_average() {
    let scene = Scene::new();
    let document = json(&succeed(scene.arguments(&default(&["--json", "-"]))));
    assert_eq!(document["optimiser"], "lbfgs");
    assert_eq!(document["subset"], 300);
    assert_eq!(document["prior_mean"], "average");
    assert_eq!(document["noise_floor"], 1e-5);
    for component in document["components"].as_array().unwrap() {
        assert_ne!(component["prior_mean"], 0.0);
    }
}

#[test]
fn the_papers_prior_mean_is_zero() {
    let scene = Scene::new();
    let zero = words(&["--prior-mean", "zero", "--json", "-"]);
    let document = json(&succeed(scene.arguments(&zero)));
    assert_eq!(document["prior_mean"], "zero");
    for component in document["components"].as_array().unwrap() {
        assert_eq!(component["prior_mean"], 0.0);
    }
}

#[test]
fn a_subset_is_a_count_that_fits_or_all() {
    let scene = Scene::new();
    succeed(scene.arguments(&words(&["--subset", "all"])));
    for wrong in ["0", "12001", "some", "-1"] {
        let subset = format!("--subset={wrong}");
        let outcome = crate::run::run(scene.arguments(&words(&[&subset])));
        assert_eq!(outcome.code, Some(2), "{outcome:?}");
        assert!(outcome.stderr.contains("12000"), "{outcome:?}");
    }
}

#[test]
fn a_component_that_is_too_large_is_refused_before_it_is_learned_on() {
    let scene = Scene::new();
    let arguments = [
        "train",
        "@box.obj",
        "-o",
        "@part.cobra",
        "--points",
        "12500",
        "--test-points",
        "500",
        "--reference-points",
        "kmeans",
        "--components",
        "1",
        "--subset",
        "all",
    ];
    refuse(scene.arguments(&arguments), 3, &["12500", "12000"]);
}

#[test]
fn early_ends_are_noted_once_and_each_search_is_told_on_request() {
    let scene = Scene::new();
    let adam = words(&["--optimiser", "adam", "--subset", "30"]);
    let normal = succeed(scene.arguments(&adam));
    let notes = |stderr: &str| stderr.lines().filter(|l| l.starts_with("note: ")).count();
    assert_eq!(notes(&normal.stderr), 1, "{}", normal.stderr);
    assert!(
        normal
            .stderr
            .contains("of 4 components stopped early: iteration limit (250)"),
        "{}",
        normal.stderr
    );
    assert!(
        !normal.stderr.contains("component 0: "),
        "{}",
        normal.stderr
    );
    let verbose = succeed(scene.arguments(&[&adam[..], &["-v"]].concat()));
    for component in 0..4 {
        let told = format!("component {component}: ");
        assert!(verbose.stderr.contains(&told), "{}", verbose.stderr);
    }
    let quiet = succeed(scene.arguments(&[&adam[..], &["-q"]].concat()));
    assert_eq!(quiet.stderr, "");
    let converged = succeed(scene.arguments(&words(&["-v"])));
    assert_eq!(notes(&converged.stderr), 0, "{}", converged.stderr);
    assert!(
        converged.stderr.contains("converged"),
        "{}",
        converged.stderr
    );
}

#[test]
fn coverage_comes_as_a_table_or_as_json_and_does_not_change_the_template() {
    let scene = Scene::new();
    let plain = succeed(scene.arguments(&words(&[])));
    let bytes = std::fs::read(scene.path("part.cobra")).unwrap();
    assert!(!plain.stdout.contains("sigma"), "{}", plain.stdout);

    let table = succeed(scene.arguments(&words(&["--coverage"]))).stdout;
    assert!(bytes == std::fs::read(scene.path("part.cobra")).unwrap());
    for text in [
        "68.27 %",
        "99 %",
        "GP with noise",
        "sigma-hat",
        "mean sigma, mm",
    ] {
        assert!(table.contains(text), "{text:?} in {table}");
    }

    let document = json(&succeed(scene.arguments(&words(&[
        "--coverage",
        "--json",
        "-",
    ]))));
    let coverage = &document["coverage"];
    assert_eq!(coverage["points"], 30_000);
    assert_eq!(coverage["nominal"].as_array().unwrap().len(), 5);
    let mean = |key: &str| coverage[key]["mean_sigma"].as_f64().unwrap();
    assert!(mean("latent") < mean("observed"), "{coverage}");
    for key in ["latent", "observed", "sigma_hat"] {
        let within: Vec<f64> = coverage[key]["within"]
            .as_array()
            .unwrap()
            .iter()
            .map(|share| share.as_f64().unwrap())
            .collect();
        assert!(
            within.is_sorted() && within[0] > 0.0 && within[4] <= 100.0,
            "{within:?}"
        );
    }
}
