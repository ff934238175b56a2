//! `cobra demo`.

use crate::run::{refuse, succeed};
use crate::scene::Scene;

const FILES: [&str; 3] = ["bracket.cobra", "poses.csv", "poses.png"];

#[test]
fn a_second_demonstration_writes_the_same_three_files() {
    let folder = tempfile::tempdir().unwrap();
    let runs = ["first", "second"].map(|name| {
        // The folder above is missing too: the demonstration makes both.
        let output = folder.path().join("new").join(name);
        let outcome = succeed(["demo", "--poses", "10", "-o", output.to_str().unwrap()]);
        assert!(outcome.stdout.contains("10 of 10 estimates shown"));
        let mut names: Vec<_> = std::fs::read_dir(&output)
            .unwrap()
            .map(|entry| entry.unwrap().file_name())
            .collect();
        names.sort();
        assert_eq!(names, FILES);
        FILES.map(|file| std::fs::read(output.join(file)).unwrap())
    });
    assert!(runs[0] == runs[1]);

    let [_, table, picture] = &runs[0];
    let table = String::from_utf8(table.clone()).unwrap();
    assert_eq!(table.lines().count(), 1 + 10);
    let mut reader = png::Decoder::new(std::io::Cursor::new(picture))
        .read_info()
        .unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let frame = reader.next_frame(&mut pixels).unwrap();
    assert!(frame.width > 600 && frame.height > 400);
}

#[test]
fn a_folder_that_cannot_be_made_is_named() {
    let scene = Scene::new();
    refuse(
        scene.arguments(&["demo", "-o", "@K.txt/demo"]),
        4,
        &["K.txt/demo"],
    );
}
