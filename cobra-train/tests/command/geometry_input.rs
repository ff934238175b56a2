//! Objects in the formats that `cobra train` and `cobra eval` read, their units, and the unit
//! sphere.

use crate::run::{Outcome, json, refuse, succeed};
use crate::scene::{FEW, Scene};
use serde_json::json as object;

fn train(scene: &Scene, file: &str, more: &[&str]) -> Outcome {
    let file = format!("@{file}");
    let mut words = vec!["train", &file, "-o", "@part.cobra", "--name", "box"];
    words.extend(FEW);
    words.extend(more);
    succeed(scene.arguments(&words))
}

fn template(scene: &Scene, file: &str) -> Vec<u8> {
    train(scene, file, &[]);
    std::fs::read(scene.path("part.cobra")).unwrap()
}

/// The scene's box: its vertices, and the corners of its faces counted from 0.
fn box_of(scene: &Scene) -> (Vec<[f64; 3]>, Vec<[usize; 4]>) {
    let text = scene.read("box.obj");
    let rows = |letter: &str| -> Vec<Vec<f64>> {
        text.lines()
            .filter_map(|line| line.strip_prefix(letter))
            .map(|line| {
                line.split_whitespace()
                    .map(|w| w.parse().unwrap())
                    .collect()
            })
            .collect()
    };
    let vertices = rows("v ").iter().map(|v| [v[0], v[1], v[2]]).collect();
    let faces = rows("f ");
    let faces = faces
        .iter()
        .map(|f| [0, 1, 2, 3].map(|i| f[i] as usize - 1));
    (vertices, faces.collect())
}

fn off(scene: &Scene) -> String {
    let (vertices, faces) = box_of(scene);
    let mut text = format!("OFF{} {} 0\n", vertices.len(), faces.len());
    for [x, y, z] in vertices {
        text += &format!("{x} {y} {z}\n");
    }
    for [a, b, c, d] in faces {
        text += &format!("4 {a} {b} {c} {d}\n");
    }
    text
}

/// Writes the box, in metres, as `box.gltf` and `box.bin`, scaled by the node.
fn write_gltf(scene: &Scene) {
    let (vertices, faces) = box_of(scene);
    let mut data: Vec<u8> = vertices
        .iter()
        .flatten()
        .flat_map(|c| (*c as f32).to_le_bytes())
        .collect();
    for [a, b, c, d] in faces {
        for corner in [a, b, c, a, c, d] {
            data.extend((corner as u16).to_le_bytes());
        }
    }
    scene.write("box.bin", &data);
    let document = object!({
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "scale": [0.001, 0.001, 0.001]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"}
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": 96},
            {"buffer": 0, "byteOffset": 96, "byteLength": 72}
        ],
        "buffers": [{"byteLength": 168, "uri": "box.bin"}]
    });
    scene.write("box.gltf", document.to_string());
}

#[test]
fn the_same_box_in_another_format_gives_the_same_template() {
    let scene = Scene::new();
    scene.write("box.off", off(&scene));
    assert!(template(&scene, "box.off") == template(&scene, "box.obj"));
}

#[test]
fn gltf_lengths_are_metres_unless_told_otherwise() {
    let scene = Scene::new();
    write_gltf(&scene);
    let outcome = train(&scene, "box.gltf", &["--json", "-"]);
    let document = json(&outcome);
    assert_eq!(document["unit"], "m");
    let diameter = document["diameter"].as_f64().unwrap();
    assert!((diameter - 0.1077).abs() < 1e-4, "{diameter}");
    assert!(outcome.stderr.contains("note: glTF lengths are metres\n"));
    assert!(!outcome.stderr.contains("warning"), "{outcome:?}");

    let same = train(&scene, "box.gltf", &["--json", "-", "--unit", "m"]);
    assert_eq!(json(&same), document);
    assert!(!same.stderr.contains("glTF"), "{same:?}");
    let other = train(&scene, "box.gltf", &["--json", "-", "--unit", "cm"]);
    assert_eq!(json(&other)["unit"], "cm");
    assert!(other.stderr.contains("warning: glTF lengths are metres"));
}

#[test]
fn other_formats_are_in_millimetres_without_a_word() {
    let scene = Scene::new();
    let outcome = train(&scene, "box.obj", &["--json", "-"]);
    assert_eq!(json(&outcome)["unit"], "mm");
    assert!(!outcome.stderr.contains("glTF"), "{outcome:?}");
}

#[test]
fn the_unit_sphere_is_told_with_centre_and_scale() {
    let scene = Scene::new();
    let outcome = train(&scene, "box.obj", &["--unit-sphere", "--json", "-"]);
    assert!(
        outcome
            .stderr
            .contains("unit sphere: centre (30, 10, 45), scale 0.0185")
    );
    assert!(!outcome.stderr.contains("warning"), "{outcome:?}");
    let document = json(&outcome);
    assert_eq!(
        document["unit_sphere"]["centre"],
        object!([30.0, 10.0, 45.0])
    );
    let scale = document["unit_sphere"]["scale"].as_f64().unwrap();
    assert!((scale * 2900_f64.sqrt() - 1.0).abs() < 1e-12);
    assert!((document["radius"].as_f64().unwrap() - 1.0).abs() < 1e-6);
    let plain = json(&train(&scene, "box.obj", &["--json", "-"]));
    assert!(plain["unit_sphere"].is_null());
}

#[test]
fn a_template_of_the_unit_sphere_is_measured_in_the_unit_sphere() {
    let scene = Scene::new();
    train(&scene, "box.obj", &["--unit-sphere"]);
    let eval = [
        "eval",
        "@part.cobra",
        "--mesh",
        "@box.obj",
        "--points",
        "400",
        "--json",
        "-",
    ];
    let apart = succeed(scene.arguments(&eval));
    assert!(apart.stderr.contains("another unit"), "{apart:?}");
    let together = succeed(scene.arguments(&[&eval[..], &["--unit-sphere"]].concat()));
    assert!(!together.stderr.contains("warning"), "{together:?}");

    train(&scene, "box.obj", &[]);
    let whole = json(&succeed(scene.arguments(&eval)));
    let chamfer = |document: &serde_json::Value| document["chamfer"].as_f64().unwrap();
    let ratio = chamfer(&json(&together)) / chamfer(&whole);
    assert!((ratio - 1.0).abs() < 0.01, "{ratio}");
}

#[test]
fn points_without_faces_are_split_into_training_and_test() {
    let scene = Scene::new();
    let points: String = (0..400)
        .map(f64::from)
        .map(|i| {
            let (turn, z) = (2.4 * i, i / 200.0 - 1.0);
            let side = 40.0 * (1.0 - z * z).sqrt();
            format!("{} {} {}\n", side * turn.cos(), side * turn.sin(), 40.0 * z)
        })
        .collect();
    scene.write("ball.xyz", points);
    let words = [
        "train",
        "@ball.xyz",
        "-o",
        "@ball.cobra",
        "--reference-points",
        "kmeans",
        "--validity",
        "everywhere",
        "--budget",
        "none",
        "--exponent",
        "1",
        "--components",
        "2",
    ];
    let said = succeed(scene.arguments(&words)).stderr;
    assert!(said.contains("cloud: 400 points"), "{said}");
    let split = "300 points for training, 100 to measure sigma-hat";
    assert!(said.contains(split), "{said}");
    let words = ["eval", "@ball.cobra", "--mesh", "@ball.xyz", "--json", "-"];
    let evaluated = json(&succeed(scene.arguments(&words)));
    assert_eq!(evaluated["points"], 100);
    assert!(evaluated["f_score"].as_f64().unwrap() > 95.0, "{evaluated}");
    for sampling in ["poisson", "reference-points"] {
        let words = [
            "train",
            "@ball.xyz",
            "-o",
            "@b.cobra",
            "--sampling",
            sampling,
        ];
        refuse(
            scene.arguments(&words),
            3,
            &["ball.xyz", sampling, "has none"],
        );
    }
}

#[test]
fn gltf_that_cannot_be_read_is_refused_in_a_sentence() {
    let scene = Scene::new();
    write_gltf(&scene);
    let good = scene.read("box.gltf");
    let with = |from: &str, to: &str| {
        assert!(good.contains(from), "{good}");
        good.replacen(from, to, 1)
    };
    for (content, said) in [
        (with("box.bin", "other.bin"), "`other.bin`: "),
        (with("box.bin", "../box.bin"), "own folder"),
        (with("168", "169"), "169 bytes in buffer 0"),
        (
            with(
                "{",
                "{\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],",
            ),
            "KHR_draco_mesh_compression",
        ),
        (with("{", "["), "line 1"),
    ] {
        scene.write("bad.gltf", content);
        let words = ["train", "@bad.gltf", "-o", "@part.cobra"];
        refuse(scene.arguments(&words), 3, &["bad.gltf", said]);
    }
    scene.write("version.glb", b"glTF\x01\0\0\0\x14\0\0\0aaaabbbb");
    let words = ["train", "@version.glb", "-o", "@part.cobra"];
    refuse(scene.arguments(&words), 3, &["version.glb", "version 1"]);
}
