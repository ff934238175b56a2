//! What `cobra export` refuses.

use crate::run::{refuse, run};
use crate::scene::Scene;

const FORMATS: [&str; 3] = ["bin", "rust", "c"];

/// Refused in every format, to a file and to standard output, and nothing is written.
fn refuse_everywhere(scene: &Scene, code: i32, said: &[&str]) {
    let said = [&["part.cobra"], said].concat();
    let before = scene.names();
    for format in FORMATS {
        let export = ["export", "@part.cobra", "--format", format];
        refuse(scene.arguments(&export), code, &said);
        let to_file = [&export[..], &["-o", "@out"]].concat();
        refuse(scene.arguments(&to_file), code, &said);
    }
    assert_eq!(scene.names(), before);
}

#[test]
fn what_is_no_template_is_refused_as_by_the_other_commands() {
    let scene = Scene::trained();
    let good = std::fs::read(scene.path("part.cobra")).unwrap();
    let mut damaged = good.clone();
    damaged[good.len() / 2] ^= 1;
    let mut other = good.clone();
    other[4] = 7;
    for (bytes, said) in [
        (&damaged[..], "damaged"),
        (&other, "version 7"),
        (&good[..good.len() - 1], "truncated"),
        (&good[..15], "header of 16 bytes"),
        (&[0xff; 64], "blank flash"),
        (b"v 0 0 0\nv 1 0 0\n", "not a template"),
    ] {
        scene.write("part.cobra", bytes);
        refuse_everywhere(&scene, 3, &[said]);
    }
    let dump = [&damaged[..], &[0xff; 100]].concat();
    scene.write("part.cobra", dump);
    refuse_everywhere(&scene, 3, &["damaged"]);
    std::fs::remove_file(scene.path("part.cobra")).unwrap();
    refuse_everywhere(&scene, 4, &["No such file"]);
    std::fs::create_dir(scene.path("part.cobra")).unwrap();
    refuse_everywhere(&scene, 4, &["regular file"]);
}

#[test]
fn an_old_file_stays_when_the_template_is_refused() {
    let scene = Scene::new();
    scene.write("part.cobra", "no template, but longer than a header");
    scene.write("part.rs", "old");
    let words = [
        "export",
        "@part.cobra",
        "--format",
        "rust",
        "-o",
        "@part.rs",
    ];
    refuse(scene.arguments(&words), 3, &["not a template"]);
    assert_eq!(scene.read("part.rs"), "old");
}

#[test]
fn a_format_that_is_none_and_a_missing_one_are_code_2() {
    let scene = Scene::trained();
    for (more, said) in [
        (&["--format", "hex"][..], "bin, rust, c"),
        (&["--format", "Rust"], "bin, rust, c"),
        (&[], "--format"),
    ] {
        let words = [&["export", "@part.cobra"][..], more].concat();
        let outcome = run(scene.arguments(&words));
        assert_eq!(outcome.code, Some(2), "{outcome:?}");
        assert!(outcome.stderr.contains(said), "{outcome:?}");
        assert_eq!(outcome.stdout, "");
    }
}

#[test]
fn a_name_that_a_language_does_not_have_is_code_2_and_says_why() {
    let scene = Scene::trained();
    for (name, said) in [
        ("", "found nothing"),
        ("7up", "a letter"),
        ("_", "a letter"),
        ("größe", "'ö'"),
        ("a b", "' '"),
        ("a__b", "underscores"),
        ("while", "word of C"),
        ("template", "word of C"),
        ("x;int y", "';'"),
    ] {
        for format in ["rust", "c"] {
            let name = format!("--name={name}");
            let words = ["export", "@part.cobra", "--format", format, &name];
            let outcome = run(scene.arguments(&words));
            assert_eq!(outcome.code, Some(2), "{outcome:?}");
            assert!(outcome.stderr.contains(said), "{said}: {outcome:?}");
            assert_eq!(outcome.stdout, "");
        }
    }
}

#[test]
fn a_name_for_bin_is_refused_rather_than_ignored() {
    let scene = Scene::trained();
    let words = ["export", "@part.cobra", "--format", "bin", "--name", "part"];
    refuse(scene.arguments(&words), 2, &["--name"]);
}
