//! `cobra export`: what is written holds the template's bytes, and compiles.

use crate::run::{command, json, succeed};
use crate::scene::Scene;
use std::path::{Path, PathBuf};
use std::process::Command;

fn bytes(path: &Path) -> Vec<u8> {
    std::fs::read(path).unwrap()
}

/// What a command that must succeed prints.
fn printed(command: &mut Command) -> Vec<u8> {
    let output = command.output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}: {said}");
    output.stdout
}

/// Exports the scene's template and returns what was written.
fn exported(scene: &Scene, format: &str, name: &str, more: &[&str]) -> PathBuf {
    let output = format!("@{name}");
    let words = ["export", "@part.cobra", "--format", format, "-o", &output];
    succeed(scene.arguments(&[&words[..], more].concat()));
    scene.path(name)
}

/// The scene with a template of this name.
fn named(name: &str) -> Scene {
    let scene = Scene::new();
    scene.train(&["--name", name]);
    scene
}

/// The Rust compiler, which treats every warning as an error.
fn rustc(scene: &Scene, edition: &str) -> Command {
    let mut rustc = Command::new("rustc");
    rustc.current_dir(scene.folder()).args([
        "--edition",
        edition,
        "-Dwarnings",
        "-Dunsafe-code",
        "-Dmissing-docs",
    ]);
    rustc
}

#[test]
fn bin_is_the_template_byte_by_byte_in_a_file_and_in_a_pipe() {
    for scene in [Scene::trained(), Scene::charted()] {
        let template = bytes(&scene.path("part.cobra"));
        let written = exported(&scene, "bin", "copy.cobra", &[]);
        assert!(bytes(&written) == template);
        for more in [&[][..], &["-o", "-"]] {
            let words = [&["export", "@part.cobra", "--format", "bin"][..], more].concat();
            assert!(printed(command().args(scene.arguments(&words))) == template);
        }
    }
}

#[test]
fn a_dump_of_flash_is_cut_to_the_template_it_starts_with_and_the_command_says_so() {
    let scene = Scene::trained();
    let template = bytes(&scene.path("part.cobra"));
    let source = exported(&scene, "rust", "part.rs", &[]);
    for fill in [0x00, 0xff, 0x43] {
        scene.write("flash.bin", [&template[..], &[fill; 1000]].concat());
        let words = [
            "export",
            "@flash.bin",
            "-o",
            "@cut.cobra",
            "--format",
            "bin",
        ];
        let outcome = succeed(scene.arguments(&words));
        assert!(outcome.stderr.contains("1000 behind it"), "{outcome:?}");
        assert!(bytes(&scene.path("cut.cobra")) == template);
        succeed(scene.arguments(&["inspect", "@cut.cobra"]));
        let words = ["export", "@flash.bin", "--format", "rust"];
        let text = succeed(scene.arguments(&words)).stdout;
        assert_eq!(text.as_bytes(), bytes(&source));
    }
}

#[test]
fn the_rust_constant_holds_the_bytes_in_one_aligned_place() {
    let scene = Scene::trained();
    exported(&scene, "rust", "part.rs", &[]);
    exported(&scene, "rust", "second.rs", &["--name", "second"]);
    scene.write(
        "main.rs",
        "//! Prints the template.\n\
         use std::io::Write;\n\
         mod part;\n\
         mod both { include!(\"part.rs\"); include!(\"second.rs\"); }\n\
         fn main() {\n\
             let bytes: &'static [u8] = part::BOX_TEMPLATE;\n\
             assert_eq!(bytes.as_ptr() as usize % 4, 0);\n\
             assert_eq!(bytes.as_ptr(), part::BOX_TEMPLATE.as_ptr());\n\
             assert_eq!(bytes, both::BOX_TEMPLATE);\n\
             assert_eq!(bytes, both::SECOND);\n\
             std::io::stdout().write_all(bytes).unwrap();\n\
         }\n",
    );
    for edition in ["2021", "2024"] {
        printed(rustc(&scene, edition).arg("main.rs"));
        let program = scene.path(&format!("main{}", std::env::consts::EXE_SUFFIX));
        let found = printed(&mut Command::new(program));
        assert!(found == bytes(&scene.path("part.cobra")), "{edition}");
    }
}

#[test]
fn the_rust_source_needs_no_std_and_makes_no_warning() {
    for name in ["plain", "*/ ``` [odd] \\ <name>", "\u{202e}дрель"] {
        let scene = named(name);
        exported(&scene, "rust", "part.rs", &["--name", "part"]);
        let include = "//! A template.\n#![no_std]\ninclude!(\"part.rs\");\n";
        scene.write("included.rs", include);
        let module = "//! A template.\n#![no_std]\n/// It.\npub mod part;\n";
        scene.write("module.rs", module);
        for edition in ["2021", "2024"] {
            for source in ["included.rs", "module.rs"] {
                let mut rustc = rustc(&scene, edition);
                printed(rustc.args(["--crate-type=lib", "--emit=metadata", source]));
            }
        }
    }
}

#[test]
fn the_c_header_holds_the_bytes_in_every_standard_without_a_warning() {
    let compilers = [
        ("cc", "c", &["c99", "c11", "gnu17"]),
        ("c++", "c++", &["c++98", "c++11", "c++17"]),
    ];
    for name in ["plain", "*/ ??/ \\", "\u{202e}дрель"] {
        let scene = named(name);
        exported(&scene, "c", "part.h", &["--name", "part"]);
        scene.write(
            "main.c",
            "#include <stdio.h>\n#include \"part.h\"\n#include \"part.h\"\n\
             int main(void) {\n\
                 if (sizeof part != PART_SIZE || (uintptr_t)part % 4 != 0) return 1;\n\
                 return fwrite(part, 1, PART_SIZE, stdout) != PART_SIZE;\n\
             }\n",
        );
        for (compiler, language, standards) in compilers {
            if Command::new(compiler).arg("--version").output().is_err() {
                eprintln!("skipped: {compiler} is not installed");
                continue;
            }
            for standard in standards {
                let warnings = ["-Wall", "-Wextra", "-Werror", "-o", "main", "-x", language];
                let standard = format!("-std={standard}");
                let mut compile = Command::new(compiler);
                compile.current_dir(scene.folder()).args(warnings);
                printed(compile.args([&standard, "main.c"]));
                let found = printed(&mut Command::new(scene.path("main")));
                assert!(found == bytes(&scene.path("part.cobra")), "{standard}");
            }
        }
    }
}

#[test]
fn source_says_what_inspect_says() {
    for scene in [Scene::trained(), Scene::charted()] {
        says_what_inspect_says(&scene);
    }
}

fn says_what_inspect_says(scene: &Scene) {
    let words = ["inspect", "@part.cobra", "--json", "-"];
    let document = json(&succeed(scene.arguments(&words)));
    let components = document["components"].as_array().unwrap().len();
    let table = succeed(scene.arguments(&["inspect", "@part.cobra"])).stdout;
    let size = bytes(&scene.path("part.cobra")).len();
    for format in ["rust", "c"] {
        let words = ["export", "@part.cobra", "--format", format];
        let text = succeed(scene.arguments(&words)).stdout;
        let evaluations = text.split("at most ").nth(1).unwrap();
        let (nearest, rest) = evaluations.split_once(" (nearest), ").unwrap();
        let (all, _) = rest.split_once(' ').unwrap();
        let cost = format!("at most {nearest} (nearest), {all} (max, soft)");
        assert!(table.contains(&cost), "{cost} in {table}");
        for fact in [
            &format!("bytes: {size}"),
            "unit of length: mm",
            &format!("components: {components}"),
        ] {
            assert!(text.contains(fact), "{fact}: {format}");
        }
        assert!(text.contains("rational-quadratic"));
    }
}

#[test]
fn source_depends_on_the_template_alone_and_has_no_long_lines() {
    let scene = Scene::trained();
    let long = "x".repeat(63);
    for format in ["rust", "c"] {
        let first = exported(&scene, format, "a", &["--name", &long]);
        let second = exported(&scene, format, "b", &["--name", &long]);
        assert_eq!(bytes(&first), bytes(&second));
        let text = scene.read("a");
        assert!(text.lines().all(|line| line.len() <= 100), "{format}");
        assert!(!text.contains(scene.folder().to_str().unwrap()));
    }
}

#[test]
fn names_come_from_the_object_unless_one_is_given() {
    for (object, rust, c) in [
        ("6d", "OBJECT_6D_TEMPLATE:", "object_6d_template["),
        (
            "Ölkännchen 2",
            "LK_NNCHEN_2_TEMPLATE:",
            "lk_nnchen_2_template[",
        ),
        ("int", "INT_TEMPLATE:", "int_template["),
        ("", "OBJECT_TEMPLATE:", "object_template["),
    ] {
        let scene = named(object);
        for (format, name) in [("rust", rust), ("c", c)] {
            let words = ["export", "@part.cobra", "--format", format];
            let text = succeed(scene.arguments(&words)).stdout;
            assert!(text.contains(&format!(" {name}")), "{object:?} {format}");
        }
    }
    let scene = Scene::trained();
    for (format, name) in [("rust", " PARTONE:"), ("c", " partOne[")] {
        let words = [
            "export",
            "@part.cobra",
            "--name",
            "partOne",
            "--format",
            format,
        ];
        let text = succeed(scene.arguments(&words)).stdout;
        assert!(text.contains(name), "{format}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn bin_is_not_written_to_a_terminal() {
    let scene = Scene::trained();
    let line = format!(
        "{} export {} --format bin",
        env!("CARGO_BIN_EXE_cobra"),
        scene.path("part.cobra").display()
    );
    let mut script = Command::new("script");
    script.args(["--quiet", "--return", "--command", &line, "/dev/null"]);
    match script.output() {
        Ok(output) => {
            let shown = String::from_utf8(output.stdout).unwrap();
            assert_eq!(output.status.code(), Some(2), "{shown}");
            assert!(shown.contains("pipe") && !shown.contains("CBRA"), "{shown}");
        }
        Err(_) => eprintln!("skipped: `script`, which makes a terminal, is not installed"),
    }
}
