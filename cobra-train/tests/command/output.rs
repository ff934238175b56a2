//! Where results go: files that are whole or not there, and pipes that may close.

use crate::run::{command, refuse, succeed};
use crate::scene::{FEW, Scene};
use std::process::Stdio;

/// Paths that nobody can write to, not even root.
const UNWRITABLE: [&str; 4] = ["@K.txt/out", "@none/out", "@correspondences", "/proc/out"];

fn train<'a>(output: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let mut words = vec!["train", "@box.obj", "-o", output];
    words.extend(FEW);
    words.extend(more);
    words
}

#[test]
fn an_output_that_cannot_be_written_is_named_and_leaves_nothing() {
    let scene = Scene::trained();
    let before = scene.names();
    for path in UNWRITABLE {
        let name = path.trim_start_matches('@');
        let said = &["cannot write", name][..];
        refuse(scene.arguments(&train(path, &[])), 4, said);
        refuse(scene.score(&["--json", path]), 4, said);
        let inspect = ["inspect", "@part.cobra", "--json", path];
        refuse(scene.arguments(&inspect), 4, said);
        for format in ["bin", "rust", "c"] {
            let export = ["export", "@part.cobra", "--format", format, "-o", path];
            refuse(scene.arguments(&export), 4, said);
        }
        for option in ["--json", "--points-out"] {
            let eval = ["eval", "@part.cobra", "--mesh", "@box.obj", option, path];
            refuse(scene.arguments(&eval), 4, said);
        }
    }
    assert_eq!(scene.names(), before);
}

#[test]
fn one_output_that_cannot_be_written_stops_the_others() {
    let scene = Scene::new();
    let before = scene.names();
    let words = train("@part.cobra", &["--json", "@none/report.json"]);
    refuse(scene.arguments(&words), 4, &["none/report.json"]);
    assert_eq!(scene.names(), before);
}

#[test]
fn a_name_too_long_is_found_before_the_work() {
    let scene = Scene::new();
    let path = format!("@{}.cobra", "x".repeat(300));
    let outcome = crate::run::run(scene.arguments(&train(&path, &[])));
    assert_eq!(outcome.code, Some(4), "{outcome:?}");
    assert!(!outcome.stderr.contains("mesh:"), "{outcome:?}");
}

#[test]
fn an_input_is_never_overwritten() {
    let scene = Scene::trained();
    let mesh = scene.read("box.obj");
    let template = std::fs::read(scene.path("part.cobra")).unwrap();
    refuse(
        scene.arguments(&train("@box.obj", &[])),
        2,
        &["box.obj is both"],
    );
    refuse(
        scene.arguments(&train("@new.cobra", &["--json", "@box.obj"])),
        2,
        &["box.obj is both"],
    );
    refuse(
        scene.arguments(&train("@new.cobra", &["--json", "@new.cobra"])),
        2,
        &["new.cobra is both"],
    );
    for path in ["@part.cobra", "@K.txt", "@poses.json"] {
        let name = path.trim_start_matches('@');
        refuse(scene.score(&["--json", path]), 2, &[name, "is both"]);
    }
    let inspect = ["inspect", "@part.cobra", "--json", "@part.cobra"];
    refuse(scene.arguments(&inspect), 2, &["part.cobra is both"]);
    for format in ["bin", "rust", "c"] {
        let export = [
            "export",
            "@part.cobra",
            "--format",
            format,
            "-o",
            "@part.cobra",
        ];
        refuse(scene.arguments(&export), 2, &["part.cobra is both"]);
    }
    for path in ["@part.cobra", "@box.obj"] {
        for option in ["--json", "--points-out"] {
            let eval = ["eval", "@part.cobra", "--mesh", "@box.obj", option, path];
            refuse(scene.arguments(&eval), 2, &["is both"]);
        }
    }
    assert_eq!(scene.read("box.obj"), mesh);
    assert!(std::fs::read(scene.path("part.cobra")).unwrap() == template);
}

#[test]
fn an_old_template_stays_when_training_fails() {
    let scene = Scene::trained();
    let before = std::fs::read(scene.path("part.cobra")).unwrap();
    scene.write("box.obj", "v 0 0 0\n");
    refuse(scene.arguments(&train("@part.cobra", &[])), 3, &["box.obj"]);
    assert!(std::fs::read(scene.path("part.cobra")).unwrap() == before);
}

#[cfg(unix)]
#[test]
fn a_link_as_output_stays_a_link() {
    let scene = Scene::new();
    scene.write("target.cobra", "old");
    let link = scene.path("link.cobra");
    std::os::unix::fs::symlink("target.cobra", &link).unwrap();
    succeed(scene.arguments(&train("@link.cobra", &[])));
    assert!(link.symlink_metadata().unwrap().is_symlink());
    let written = std::fs::read(scene.path("target.cobra")).unwrap();
    assert!(written.starts_with(b"CBRA"));
}

#[cfg(unix)]
#[test]
fn names_with_spaces_and_other_bytes_are_names() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let scene = Scene::new();
    for name in [&b"a part.obj"[..], b"-part.obj", b"\xff\xfe.obj"] {
        let mesh = scene.folder().join(OsStr::from_bytes(name));
        std::fs::copy(scene.path("box.obj"), &mesh).unwrap();
        let output = mesh.with_extension("cobra");
        let mut arguments = vec![OsStr::new("train"), mesh.as_os_str(), OsStr::new("-o")];
        arguments.push(output.as_os_str());
        arguments.extend(FEW.map(OsStr::new));
        succeed(&arguments);
        succeed([OsStr::new("inspect"), output.as_os_str()]);
    }
}

#[cfg(unix)]
#[test]
fn a_reader_that_leaves_is_no_error() {
    let scene = Scene::trained();
    let commands = [
        scene.score(&[]),
        scene.score(&["--json", "-"]),
        scene.arguments(&["inspect", "@part.cobra"]),
        scene.arguments(&["export", "@part.cobra", "--format", "bin"]),
        scene.arguments(&["export", "@part.cobra", "--format", "c", "-o", "-"]),
        scene.arguments(&["completions", "bash"]),
        scene.arguments(&["--help"]),
    ];
    for arguments in commands {
        let mut child = command()
            .args(&arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{arguments:?} {output:?}");
        assert_eq!(output.stderr, b"", "{arguments:?}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error() {
    let scene = Scene::trained();
    let full = std::fs::File::options()
        .write(true)
        .open("/dev/full")
        .unwrap();
    let output = command()
        .args(scene.score(&["-q"]))
        .stdout(full)
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(4), "{output:?}");
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("standard output"), "{said}");
}
