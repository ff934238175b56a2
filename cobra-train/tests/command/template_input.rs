//! Template files that are none, handed to every command that reads one.

use crate::run::refuse;
use crate::scene::Scene;

fn refuse_everywhere(scene: &Scene, code: i32, said: &[&str]) {
    let said = [&["part.cobra"], said].concat();
    refuse(scene.arguments(&["inspect", "@part.cobra"]), code, &said);
    refuse(
        scene.arguments(&[
            "eval",
            "@part.cobra",
            "--mesh",
            "@box.obj",
            "--points-out",
            "@predicted.ply",
        ]),
        code,
        &said,
    );
    refuse(scene.score(&["--json", "@scores.json"]), code, &said);
    for name in ["predicted.ply", "scores.json"] {
        assert!(!scene.path(name).exists(), "{name}");
    }
}

/// `spoil` changes the bytes of a good template.
fn refuse_spoilt(said: &[&str], spoil: impl FnOnce(&mut Vec<u8>)) {
    let scene = Scene::trained();
    let mut bytes = std::fs::read(scene.path("part.cobra")).unwrap();
    spoil(&mut bytes);
    scene.write("part.cobra", bytes);
    refuse_everywhere(&scene, 3, said);
}

#[test]
fn truncated_templates_are_refused() {
    refuse_spoilt(&["found 0 bytes"], Vec::clear);
    refuse_spoilt(&["header of 16 bytes"], |bytes| bytes.truncate(15));
    refuse_spoilt(&["truncated"], |bytes| bytes.truncate(16));
    refuse_spoilt(&["truncated"], |bytes| {
        bytes.pop();
    });
}

#[test]
fn a_flipped_bit_is_found_wherever_it_is() {
    let length = std::fs::metadata(Scene::trained().path("part.cobra"))
        .unwrap()
        .len() as usize;
    for place in [0, 4, 6, 8, 12, 16, 24, length / 2, length - 1] {
        refuse_spoilt(&[], |bytes| bytes[place] ^= 0x10);
    }
}

#[test]
fn another_version_is_named() {
    refuse_spoilt(&["version 7", "version 1"], |bytes| bytes[4] = 7);
}

#[test]
fn oversized_templates_are_refused_by_their_size() {
    refuse_spoilt(&["1 too many"], |bytes| bytes.push(0));
    // A gigabyte that takes no space on the disk and must take none in memory.
    let scene = Scene::trained();
    let file = std::fs::File::options()
        .write(true)
        .open(scene.path("part.cobra"))
        .unwrap();
    file.set_len(1 << 30).unwrap();
    refuse_everywhere(&scene, 3, &["too many"]);
}

#[test]
fn other_files_and_folders_are_no_templates() {
    let scene = Scene::trained();
    scene.write("part.cobra", scene.read("box.obj"));
    refuse_everywhere(&scene, 3, &["not a template"]);
    std::fs::remove_file(scene.path("part.cobra")).unwrap();
    refuse_everywhere(&scene, 4, &["No such file"]);
    std::fs::create_dir(scene.path("part.cobra")).unwrap();
    refuse_everywhere(&scene, 4, &[]);
}

#[cfg(unix)]
#[test]
fn a_pipe_is_refused_rather_than_waited_for() {
    let scene = Scene::new();
    let pipe = scene.path("part.cobra");
    let made = std::process::Command::new("mkfifo")
        .arg(&pipe)
        .status()
        .unwrap();
    assert!(made.success());
    refuse_everywhere(&scene, 4, &["regular file"]);
}
