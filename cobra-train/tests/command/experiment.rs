//! `cobra experiment`.

use crate::run::{command, refuse, run, succeed};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A folder of meshes: a wedge, and beside it a file that is none.
fn wedge_and_rubbish() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let class = folder.path().join("meshes/wedges");
    fs::create_dir_all(&class).unwrap();
    let wedge = "v 0 0 0\nv 60 0 0\nv 0 40 0\nv 0 0 25\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    fs::write(class.join("wedge.obj"), wedge).unwrap();
    fs::write(class.join("rubbish.ply"), "not a mesh").unwrap();
    folder
}

fn scatter(out: &Path, more: &[&str]) -> String {
    let mut words = vec!["experiment", "scatter", "--out", out.to_str().unwrap()];
    words.extend(more);
    succeed(words).stdout
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn without_data_the_part_is_measured_and_what_is_done_is_not_done_again() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("new/results");
    let shown = scatter(&out, &[]);
    assert!(
        shown.contains("Spearman") && shown.contains("scatter.svg"),
        "{shown}"
    );
    let expected = [
        "scatter.csv",
        "scatter.jsonl",
        "scatter.md",
        "scatter.svg",
        "templates",
    ];
    assert_eq!(names(&out), expected);
    let csv = fs::read_to_string(out.join("scatter.csv")).unwrap();
    assert_eq!(csv.lines().count(), 1 + 936);
    let figure = fs::read_to_string(out.join("scatter.svg")).unwrap();
    assert!(figure.starts_with("<svg") && figure.contains("bracket"));

    // A confidence that only the journal says.
    let journal = out.join("scatter.jsonl");
    let kept = fs::read_to_string(&journal).unwrap();
    let first = kept.find("\"confidence\":").unwrap();
    let end = first + kept[first..].find(',').unwrap();
    let changed = format!("{}\"confidence\":0.123456{}", &kept[..first], &kept[end..]);
    fs::write(&journal, changed).unwrap();
    scatter(&out, &[]);
    let again = fs::read_to_string(out.join("scatter.csv")).unwrap();
    assert!(
        again.lines().nth(1).unwrap().contains(",0.1235,"),
        "{again:.200}"
    );
    scatter(&out, &["--fresh"]);
    assert_eq!(fs::read_to_string(out.join("scatter.csv")).unwrap(), csv);
}

#[test]
fn the_number_of_threads_changes_no_byte() {
    let folder = tempfile::tempdir().unwrap();
    let of_threads = ["1", "3"].map(|threads| {
        let out = folder.path().join(threads);
        let words = ["experiment", "scatter", "--out", out.to_str().unwrap()];
        let done = command()
            .args(words)
            .env("RAYON_NUM_THREADS", threads)
            .output()
            .unwrap();
        assert!(done.status.success());
        ["scatter.csv", "scatter.svg"].map(|name| fs::read(out.join(name)).unwrap())
    });
    assert!(of_threads[0] == of_threads[1]);
}

#[test]
fn an_object_that_fails_is_named_and_the_others_are_measured() {
    let data = wedge_and_rubbish();
    let out = data.path().join("results");
    let [data, out] = [data.path(), &out].map(|path| path.to_str().unwrap());
    let outcome = run(["experiment", "correlation", "--data", data, "--out", out]);
    assert_eq!(outcome.code, Some(3), "{outcome:?}");
    assert!(outcome.stderr.contains("rubbish.ply"), "{outcome:?}");
    assert!(outcome.stderr.contains("1 result failed"), "{outcome:?}");
    let csv = fs::read_to_string(Path::new(out).join("correlation.csv")).unwrap();
    assert_eq!(csv.lines().count(), 2, "{csv}");
    assert!(csv.contains("wedges,wedge,936,"), "{csv}");
    // A class that the paper does not have has no number of its.
    assert!(outcome.stdout.contains('–'), "{outcome:?}");

    // Of single objects the next one takes its place.
    let outcome = run(["experiment", "scatter", "--data", data, "--out", out]);
    assert_eq!(outcome.code, Some(3), "{outcome:?}");
    assert!(outcome.stderr.contains("rubbish.ply"), "{outcome:?}");
    let said = fs::read_to_string(Path::new(out).join("scatter.md")).unwrap();
    for words in ["`wedge`", "500 surface points", "seed 0", "wedges 2"] {
        assert!(said.contains(words), "{words}: {said}");
    }
}

#[test]
fn folders_that_are_none_and_folders_without_meshes_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "x").unwrap();
    let [empty, file, missing] = [
        folder.path().to_owned(),
        file,
        folder.path().join("missing"),
    ]
    .map(|path| path.to_str().unwrap().to_owned());
    refuse(
        ["experiment", "shape", "--data", &empty, "--out", &empty],
        3,
        &["found none", "meshes/CLASS"],
    );
    refuse(
        ["experiment", "shape", "--data", &missing, "--out", &empty],
        4,
        &["missing"],
    );
    refuse(["experiment", "shape", "--out", &file], 4, &["file"]);
    let outcome = run(["experiment", "shapes"]);
    assert_eq!(outcome.code, Some(2), "{outcome:?}");
    assert!(outcome.stderr.contains("reference-points"), "{outcome:?}");
}
