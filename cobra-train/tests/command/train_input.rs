//! Meshes and reference points that `cobra train` must refuse: a line, a code, and no file.

use crate::run::refuse;
use crate::scene::{FEW, Scene};

fn refuse_mesh(name: &str, content: &[u8], code: i32, said: &[&str]) {
    let scene = Scene::new();
    scene.write(name, content);
    let before = scene.names();
    let mesh = format!("@{name}");
    let mut words = vec!["train", &mesh, "-o", "@part.cobra"];
    words.extend(FEW);
    let mut said = said.to_vec();
    said.push(name);
    refuse(scene.arguments(&words), code, &said);
    assert_eq!(scene.names(), before);
}

const VERTICES: &str = "v 0 0 0\nv 10 0 0\nv 0 10 0\n";

#[test]
fn empty_files_are_refused_in_every_format() {
    for name in [
        "a.ply", "a.obj", "a.stl", "a.off", "a.glb", "a.gltf", "a.xyz",
    ] {
        refuse_mesh(name, b"", 3, &[]);
        refuse_mesh(name, b"\n \n", 3, &[]);
        refuse_mesh(name, &[0; 84], 3, &[]);
    }
}

#[test]
fn meshes_without_a_surface_are_refused() {
    refuse_mesh("points.obj", VERTICES.as_bytes(), 3, &["face"]);
    refuse_mesh("one.obj", b"v 1 2 3\n", 3, &["face"]);
    let point = "v 1 2 3\nf 1 1 1\n";
    refuse_mesh("point.obj", point.as_bytes(), 3, &["zero area"]);
    let line = "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n";
    refuse_mesh("line.obj", line.as_bytes(), 3, &["zero area"]);
}

#[test]
fn numbers_that_are_none_are_refused_with_their_place() {
    for (word, said) in [
        ("nan", "not finite"),
        ("inf", "not finite"),
        ("1e300", "1e300"),
        ("wide", "line 2"),
    ] {
        let text = format!("v 0 0 0\nv {word} 0 0\nv 0 10 0\nf 1 2 3\n");
        refuse_mesh("a.obj", text.as_bytes(), 3, &[said]);
    }
    let missing = format!("{VERTICES}f 1 2 9\n");
    refuse_mesh("a.obj", missing.as_bytes(), 3, &[]);
}

#[test]
fn files_cut_short_or_boasting_are_refused() {
    let header = "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\n\
                  property float y\nproperty float z\nelement face 4000000000\n\
                  property list uchar int vertex_indices\nend_header\n0 0 0\n";
    refuse_mesh("a.ply", header.as_bytes(), 3, &[]);
    let binary = header.replace("ascii", "binary_little_endian");
    refuse_mesh("a.ply", binary.as_bytes(), 3, &[]);
    let mut stl = vec![b' '; 80];
    stl.extend(u32::MAX.to_le_bytes());
    stl.extend([0; 50]);
    refuse_mesh("a.stl", &stl, 3, &[]);
}

#[test]
fn what_cannot_be_read_is_told_apart_from_what_cannot_be_used() {
    let scene = Scene::new();
    let train = |mesh: &str| scene.arguments(&["train", mesh, "-o", "@part.cobra"]);
    refuse(train("@none.ply"), 4, &["none.ply"]);
    std::fs::create_dir(scene.path("folder.stl")).unwrap();
    refuse(train("@folder.stl"), 4, &["folder.stl"]);
    refuse(
        train("@K.txt"),
        3,
        &["K.txt", ".ply, .obj, .stl, .off, .glb"],
    );
    assert!(!scene.path("part.cobra").exists());
}

#[test]
fn more_components_than_points_are_refused() {
    let scene = Scene::new();
    let words = [
        "train",
        "@box.obj",
        "-o",
        "@part.cobra",
        "--points",
        "5",
        "--reference-points",
        "kmeans",
        "--components",
        "6",
    ];
    refuse(scene.arguments(&words), 3, &["box.obj", "5", "6"]);
    assert!(!scene.path("part.cobra").exists());
}

#[test]
fn reference_points_of_no_use_are_refused() {
    let scene = Scene::new();
    for (content, code, said) in [
        (&b""[..], 3, "no reference points"),
        (b"1 2\n", 3, "line 1"),
        (b"1 2 3\n4 5 nan\n", 3, "line 2"),
        (b"1 2 3\n4 5 six\n", 3, "six"),
        (b"\xff\xfe1 2 3\n", 3, "UTF-8"),
    ] {
        scene.write("centres.txt", content);
        let words = ["train", "@box.obj", "-o", "@part.cobra"];
        let more = ["--reference-points", "@centres.txt"];
        refuse(
            scene.arguments(&[&words[..], &more].concat()),
            code,
            &["centres.txt", said],
        );
    }
    scene.write("centres.txt", "30 10 25\n30 10 65\n");
    let words = ["train", "@box.obj", "-o", "@part.cobra"];
    let three = ["--reference-points", "@centres.txt", "--components", "3"];
    refuse(
        scene.arguments(&[&words[..], &three].concat()),
        2,
        &["centres.txt", "3", "2 reference points"],
    );
    // Metres beside a mesh in millimetres: all points are nearer to one of them.
    scene.write("centres.txt", "0.03 0.01 0.025\n0.03 0.01 0.065\n");
    let more = ["--reference-points", "@centres.txt"];
    refuse(
        scene.arguments(&[&words[..], &more].concat()),
        3,
        &["unit and frame"],
    );
    refuse(
        scene.arguments(&[&words[..], &["--reference-points", "@none.txt"]].concat()),
        4,
        &["none.txt"],
    );
    assert!(!scene.path("part.cobra").exists());
}
