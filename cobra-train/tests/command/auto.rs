//! `cobra train` with reference points that place themselves, in a budget: its default.

use crate::run::{json, refuse, succeed};
use crate::scene::{FEW, MORE, Scene};
use serde_json::Value;

const TRAIN: [&str; 4] = ["train", "@box.obj", "-o", "@part.cobra"];

fn report(scene: &Scene, more: &[&str]) -> Value {
    let words = [&TRAIN[..], &FEW, more, &["--json", "-"]].concat();
    json(&succeed(scene.arguments(&words)))
}

fn size(scene: &Scene) -> u64 {
    std::fs::metadata(scene.path("part.cobra")).unwrap().len()
}

fn inspected(scene: &Scene) -> Value {
    let words = ["inspect", "@part.cobra", "--json", "-"];
    json(&succeed(scene.arguments(&words)))
}

fn evaluated(scene: &Scene, object: &str) -> Value {
    let words = ["eval", "@part.cobra", "--mesh", object, "--json", "-"];
    json(&succeed(scene.arguments(&words)))
}

#[test]
fn options_that_do_not_go_together_are_wrong_usage() {
    let scene = Scene::new();
    scene.write("centres.txt", "30 10 25\n30 10 65\n");
    let max_components = "--max-components goes with --reference-points auto";
    for (more, said) in [
        (
            &["--components", "4"][..],
            "--components goes with --reference-points kmeans or em",
        ),
        (
            &["--reference-points", "kmeans", "--max-components", "9"],
            max_components,
        ),
        (
            &["--reference-points", "em", "--max-components", "9"],
            max_components,
        ),
        (
            &[
                "--reference-points",
                "@centres.txt",
                "--max-components",
                "9",
            ],
            max_components,
        ),
        (&["--overlap", "0.05"], "--overlap goes with"),
        (
            &["--budget", "14336", "--metric", "angles"],
            "--budget goes with --metric chord alone",
        ),
        (
            &["--exponent", "0.5", "--kernel", "rbf"],
            "--exponent is the rational quadratic's",
        ),
    ] {
        refuse(scene.arguments(&[&TRAIN[..], more].concat()), 2, &[said]);
    }
    assert!(!scene.path("part.cobra").exists());
}

#[test]
fn numbers_that_make_no_sense_are_wrong_usage() {
    for (option, value, said) in [
        ("--budget", "abc", "expected `none` or a number of bytes"),
        ("--budget", "0", "expected `none` or a number of bytes"),
        ("--budget", "-1", "expected `none` or a number of bytes"),
        ("--budget", "1e4", "expected `none` or a number of bytes"),
        ("--max-components", "0", "--max-components"),
        ("--max-components", "1025", "--max-components"),
        ("--validity", "perhaps", "--validity"),
    ] {
        let value = format!("{option}={value}");
        let outcome = crate::run::run(["train", "box.obj", "-o", "a.cobra", &value]);
        assert_eq!(outcome.code, Some(2), "{outcome:?}");
        assert!(outcome.stderr.contains(said), "{said}: {outcome:?}");
        assert_eq!(outcome.stdout, "");
    }
}

#[test]
fn rays_cannot_come_from_points_that_are_yet_to_be_placed() {
    let scene = Scene::new();
    let words = [&TRAIN[..], &FEW, &["--sampling", "reference-points"]].concat();
    let said = "reference points that place themselves cannot be what points are drawn from";
    refuse(scene.arguments(&words), 3, &["box.obj", said]);
    assert!(!scene.path("part.cobra").exists());
}

#[test]
fn a_budget_that_holds_no_component_is_refused_with_what_is_needed() {
    let scene = Scene::new();
    let words = [&TRAIN[..], &FEW, &["--budget", "10"]].concat();
    let said = ["box.obj", "10 bytes are too few for a template", "needed"];
    refuse(scene.arguments(&words), 3, &said);
    assert!(!scene.path("part.cobra").exists());
}

#[test]
fn a_template_has_no_more_bytes_than_its_budget() {
    let scene = Scene::new();
    for (budget, most) in [
        (&[][..], 14_336),
        (&["--budget", "8704"], 8704),
        (&["--budget", "3000"], 3000),
    ] {
        let report = report(&scene, budget);
        assert!(size(&scene) <= most, "{} of {most}", size(&scene));
        assert_eq!(report["bytes"], size(&scene));
        assert_eq!(inspected(&scene)["encoding"], "compact");
    }
}

#[test]
fn without_a_budget_terms_are_exact() {
    let scene = Scene::new();
    report(&scene, &["--budget", "none"]);
    let document = inspected(&scene);
    assert_eq!(document["encoding"], "exact");
    assert_eq!(document["validity"], true);
    // Angles are not compressed, so that there is no budget unless one is asked for.
    report(&scene, &["--metric", "angles"]);
    let document = inspected(&scene);
    assert_eq!(document["encoding"], "exact");
    assert_eq!(document["metric"], "angles");
}

#[test]
fn components_may_be_limited() {
    let scene = Scene::new();
    let count = |more: &[&str]| report(&scene, more)["components"].as_array().unwrap().len();
    assert!(count(&[]) <= 64);
    for most in [1, 3] {
        assert!(count(&["--max-components", &most.to_string()]) <= most);
    }
}

#[test]
fn where_little_is_covered_it_is_said_what_covers_more() {
    let scene = Scene::new();
    let told = |more: &[&str]| {
        let words = [&TRAIN[..], &FEW, &["--max-components", "1"], more].concat();
        succeed(scene.arguments(&words)).stdout
    };
    let hint = "more may be covered with --budget none";
    assert!(told(&[]).contains(hint));
    assert!(!told(&["--budget", "none"]).contains(hint));
}

#[test]
fn every_kernel_is_compressed() {
    let scene = Scene::new();
    for kernel in [
        "rbf",
        "matern12",
        "matern32",
        "matern52",
        "linear",
        "polynomial",
        "periodic",
    ] {
        let words = [&TRAIN[..], &FEW, &["--kernel", kernel]].concat();
        succeed(scene.arguments(&words));
        assert_eq!(inspected(&scene)["encoding"], "compact", "{kernel}");
    }
}

#[test]
fn eval_tells_what_the_choice_of_a_component_hides() {
    let scene = Scene::charted();
    let words = ["eval", "@part.cobra", "--mesh", "@box.obj"];
    let table = succeed(scene.arguments(&words)).stdout;
    let document = evaluated(&scene, "@box.obj");
    let wrong = &document["wrongly_accepted"];
    assert!(wrong["points"].as_u64().unwrap() > 1000, "{wrong}");
    let percent = wrong["percent"].as_f64().unwrap();
    assert!((0.0..20.0).contains(&percent), "{wrong}");
    assert!(
        table.contains(&format!("wrongly accepted: {percent:.2} %")),
        "{table}"
    );
    let own = &document["own_cloud"];
    let figure = |key: &str| own[key].as_f64().unwrap();
    for key in ["self_f_score", "self_precision", "self_recall"] {
        assert!((80.0..=100.0).contains(&figure(key)), "{own}");
    }
    let said = format!("self F: {:.2} %", figure("self_f_score"));
    assert!(table.contains(&said), "{said}: {table}");
    assert_eq!(document["assignment"], "max");

    scene.train_charts(&["--validity", "everywhere"]);
    let document = evaluated(&scene, "@box.obj");
    assert!(document["own_cloud"].is_null(), "{document}");
    assert!(document["wrongly_accepted"]["percent"].is_number());
    let table = succeed(scene.arguments(&words)).stdout;
    assert!(!table.contains("self F"), "{table}");
    assert_eq!(document["assignment"], "nearest");
}

/// A ball of radius 40.
fn ball(count: u32) -> Vec<[f64; 3]> {
    (0..count)
        .map(f64::from)
        .map(|i| {
            let (turn, z) = (2.4 * i, 2.0 * (i + 0.5) / f64::from(count) - 1.0);
            let side = 40.0 * (1.0 - z * z).sqrt();
            [side * turn.cos(), side * turn.sin(), 40.0 * z]
        })
        .collect()
}

#[test]
fn points_without_faces_and_without_normals_are_covered() {
    let scene = Scene::new();
    let lines: String = ball(6000)
        .iter()
        .map(|[x, y, z]| format!("{x} {y} {z}\n"))
        .collect();
    scene.write("ball.xyz", &lines);
    let header = "ply\nformat ascii 1.0\nelement vertex 6000\nproperty float x\n\
                  property float y\nproperty float z\nend_header\n";
    scene.write("ball.ply", format!("{header}{lines}"));
    for file in ["@ball.xyz", "@ball.ply"] {
        let said = succeed(scene.arguments(&["train", file, "-o", "@part.cobra"])).stderr;
        let split = "4500 points for training, 1500 to measure sigma-hat";
        assert!(said.contains(split), "{said}");
        let document = evaluated(&scene, file);
        assert_eq!(document["points"], 1500);
        assert!(document["f_score"].as_f64().unwrap() > 75.0, "{document}");
        assert!(document["covered"].as_f64().unwrap() > 75.0, "{document}");
    }
}

#[test]
fn an_open_mesh_is_covered_inside_and_outside() {
    let scene = Scene::new();
    // Without the face at x = 50.
    let open: String = scene
        .read("box.obj")
        .lines()
        .filter(|line| *line != "f 2 4 8 6")
        .map(|line| format!("{line}\n"))
        .collect();
    scene.write("open.obj", &open);
    assert_eq!(open.lines().count(), 8 + 5);
    let words = [&["train", "@open.obj", "-o", "@part.cobra"][..], &MORE].concat();
    succeed(scene.arguments(&words));
    let document = evaluated(&scene, "@open.obj");
    assert!(document["covered"].as_f64().unwrap() > 80.0, "{document}");
}

#[test]
fn it_does_not_matter_how_triangles_are_wound() {
    let scene = Scene::new();
    // Every face as two triangles, one of them the other way round.
    let mixed: String = scene
        .read("box.obj")
        .lines()
        .map(|line| match line.strip_prefix("f ") {
            None => format!("{line}\n"),
            Some(corners) => {
                let corners: Vec<&str> = corners.split(' ').collect();
                let [a, b, c, d] = corners[..] else {
                    panic!("{line}");
                };
                format!("f {a} {b} {c}\nf {d} {c} {a}\n")
            }
        })
        .collect();
    scene.write("mixed.obj", mixed);
    let covered = |file: &str| {
        let words = [&["train", file, "-o", "@part.cobra"][..], &MORE].concat();
        succeed(scene.arguments(&words));
        evaluated(&scene, file)["covered"].as_f64().unwrap()
    };
    let (plain, mixed) = (covered("@box.obj"), covered("@mixed.obj"));
    assert!(plain > 80.0 && mixed > 80.0, "{plain} {mixed}");
}
