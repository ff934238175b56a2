//! ARCHITECTURE.md's table of equations names functions and tests that exist, and the workspace has one
//! program that `cargo run` can mean.

use std::path::{Path, PathBuf};
use std::process::Command;

const PAGE: &str = include_str!("../../ARCHITECTURE.md");

fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The rows of the table: function column and test column.
fn rows() -> Vec<(&'static str, &'static str)> {
    let start = PAGE.find("## Equations").expect("the table's section");
    let table = &PAGE[start..];
    let end = table[2..].find("\n## ").expect("the next section");
    table[..end]
        .lines()
        .filter_map(|line| {
            let cells: Vec<&str> = line.split('|').map(str::trim).collect();
            match cells[..] {
                ["", _, _, functions, tests, ""] => Some((functions, tests)),
                _ => None,
            }
        })
        .skip(2)
        .collect()
}

fn quoted(cell: &str) -> impl Iterator<Item = &str> {
    cell.split('`').skip(1).step_by(2)
}

fn sources(folder: &Path, text: &mut String) {
    for entry in std::fs::read_dir(folder).unwrap().flatten() {
        let path = entry.path();
        if path.is_dir() {
            sources(&path, text);
        } else if path.extension().is_some_and(|e| e == "rs") {
            text.push_str(&std::fs::read_to_string(path).unwrap());
        }
    }
}

#[test]
fn the_functions_of_the_equations_exist() {
    let mut text = String::new();
    for package in ["cobra-infer/src", "cobra-train/src"] {
        sources(&workspace().join(package), &mut text);
    }
    assert!(rows().len() > 20);
    for (functions, _) in rows() {
        assert!(quoted(functions).next().is_some(), "{functions}");
        for path in quoted(functions) {
            let name = path.rsplit("::").next().unwrap();
            let defined = [
                format!("pub fn {name}("),
                format!("pub fn {name}<"),
                format!("pub(super) fn {name}("),
                format!("pub struct {name}"),
                format!("pub enum {name} {{"),
                format!("pub mod {name};"),
                // A variant, at the start of its line.
                format!("\n    {name},\n"),
            ]
            .iter()
            .any(|definition| text.contains(definition));
            assert!(defined, "{path}");
        }
    }
}

#[test]
fn the_files_that_the_page_names_exist() {
    for line in PAGE.lines().filter(|line| line.starts_with('|')) {
        for word in quoted(line) {
            let is_path = word.contains(".rs") || word.ends_with('/');
            if is_path && word.contains("/src/") && !word.contains('{') {
                assert!(workspace().join(word).exists(), "{word}");
            }
        }
    }
}

#[test]
fn the_tests_of_the_equations_exist() {
    for (_, tests) in rows() {
        let mut file = None;
        let mut named = 0;
        for word in quoted(tests) {
            if word.contains('/') {
                let path = workspace().join(word);
                let content = std::fs::read_to_string(&path);
                file = Some(content.unwrap_or_else(|error| panic!("{word}: {error}")));
            } else {
                let content = file.as_ref().expect("a file before its tests");
                assert!(content.contains(&format!("fn {word}(")), "{word}");
                named += 1;
            }
        }
        assert!(named > 0, "{tests}");
    }
}

#[test]
fn cargo_run_knows_that_the_command_is_meant() {
    let metadata = Command::new(env!("CARGO"))
        .args([
            "metadata",
            "--no-deps",
            "--offline",
            "--format-version",
            "1",
        ])
        .current_dir(workspace())
        .output()
        .unwrap();
    assert!(metadata.status.success());
    let metadata: serde_json::Value = serde_json::from_slice(&metadata.stdout).unwrap();
    let list = |value: &serde_json::Value| value.as_array().unwrap().clone();
    let members = list(&metadata["workspace_default_members"]);
    let programs: Vec<String> = list(&metadata["packages"])
        .iter()
        .filter(|package| members.contains(&package["id"]))
        .flat_map(|package| list(&package["targets"]))
        .filter(|target| target["kind"] == serde_json::json!(["bin"]))
        .map(|target| target["name"].as_str().unwrap().to_owned())
        .collect();
    assert_eq!(programs, ["cobra"]);
}
