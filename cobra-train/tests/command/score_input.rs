//! Cameras, poses and correspondences that `cobra score` must refuse, doubt or understand.

use crate::run::{json, refuse, succeed};
use crate::scene::Scene;

/// The scene with one file's content replaced must be refused, and no JSON be written.
fn refuse_file(name: &str, content: impl AsRef<[u8]>, code: i32, said: &[&str]) {
    let scene = Scene::trained();
    scene.write(name, content);
    let before = scene.names();
    let file = name.rsplit('/').next().unwrap();
    refuse(
        scene.score(&["--json", "@scores.json", "--weights", "conf"]),
        code,
        &[&[file], said].concat(),
    );
    assert_eq!(scene.names(), before);
}

fn one_pose(r: &str, t: &str) -> String {
    format!("{{\"3\": [{{\"cam_R_m2c\": [{r}], \"cam_t_m2c\": [{t}]}}]}}")
}

const TURN: &str = "1,0,0, 0,0,-1, 0,1,0";
const CSV: &str = "inlier,x,y,X,Y,Z,conf\n1,320,240,30,10,45,0.5\n";

#[test]
fn cameras_that_are_none_are_refused() {
    for (content, said) in [
        ("", "three rows"),
        ("500,0,320\n0,500,240\n", "three rows"),
        ("500,0\n0,500,240\n0,0,1\n", "row 1"),
        ("500,0,320\n0,wide,240\n0,0,1\n", "row 2"),
        ("0,0,320\n0,500,240\n0,0,1\n", "fx"),
        ("500,0,320\n0,-500,240\n0,0,1\n", "fy"),
        ("nan,0,320\n0,500,240\n0,0,1\n", "not finite"),
        ("500,0,inf\n0,500,240\n0,0,1\n", "not finite"),
        ("500,0,320\n0,500,240\n0,0,2\n", "2"),
        ("500,0,320\n0,500,240\n0,0,1\n0.1,0,0,0\n", "undistort"),
    ] {
        refuse_file("K.txt", content, 3, &[said]);
    }
    refuse_file("K.txt", b"\xff\xfe5\x000\x00", 3, &["UTF-8"]);
}

#[test]
fn poses_that_are_none_are_refused() {
    for (content, said) in [
        (String::new(), "JSON"),
        ("{\"3\": [".to_owned(), "JSON"),
        ("[]".to_owned(), "image ids"),
        ("{}".to_owned(), "at least one pose"),
        (one_pose(TURN, "0,600"), "3 numbers"),
        (one_pose("1,0,0,0", "0,0,600"), "9 numbers"),
        (one_pose(TURN, "0,\"far\",600"), "far"),
        (one_pose(TURN, "0,NaN,600"), "JSON"),
        (one_pose(TURN, "0,null,600"), "cam_t_m2c[1]"),
        (one_pose(TURN, "0,1e39,600"), "not finite"),
        (one_pose("1,0,0, 0,0,1, 0,1,0", "0,0,600"), "det R = -1"),
        (one_pose("1,0,0, 0,0,-2, 0,1,0", "0,0,600"), "no rotation"),
        (one_pose("0,0,0, 0,0,0, 0,0,0", "0,0,600"), "R"),
    ] {
        refuse_file("poses.json", content, 3, &[said]);
    }
    refuse_file("poses.json", b"{\"3\xff\": []}", 3, &["UTF-8"]);
}

#[test]
fn correspondences_that_are_none_are_refused_with_row_and_column() {
    for (content, said) in [
        ("", "row 1"),
        ("inlier,x,y,X,Y,conf\n1,1,1,1,1,1\n", "\"Z\""),
        ("inlier,x,y,X,Y,Z\n1,1,1,1,1,1\n", "\"conf\""),
        (&CSV.replace("30", "wide"), "row 2, column \"X\""),
        (&CSV.replace(",0.5", ""), "row 2"),
        (&CSV.replace("240", ""), "row 2, column \"y\""),
        (&CSV.replace(',', ";"), "row 1"),
    ] {
        refuse_file("correspondences/3_corr.txt", content, 3, &[said]);
    }
    let wide = vec!["column"; 20_000].join(",");
    refuse_file("correspondences/3_corr.txt", wide, 3, &["\"x\" is missing"]);
    let latin = b"x,y,X,Y,Z,conf\n1,2,3,4,5,\xe9\n";
    refuse_file("correspondences/3_corr.txt", latin, 3, &["row 2"]);
}

#[test]
fn missing_files_are_named() {
    for name in ["K.txt", "poses.json", "part.cobra"] {
        let scene = Scene::trained();
        std::fs::remove_file(scene.path(name)).unwrap();
        refuse(scene.score(&[]), 4, &[name, "No such file"]);
    }
    let scene = Scene::trained();
    std::fs::remove_file(scene.path("correspondences/8_corr.txt")).unwrap();
    refuse(scene.score(&[]), 3, &["correspondences", "pose 8"]);
    std::fs::remove_dir_all(scene.path("correspondences")).unwrap();
    refuse(scene.score(&[]), 4, &["correspondences", "No such file"]);
}

#[test]
fn a_file_named_after_no_pose_is_refused() {
    let scene = Scene::trained();
    let mut arguments = scene.score(&[]);
    arguments.pop();
    scene.write("12_corr.txt", CSV);
    arguments.extend(scene.arguments(&["@12_corr.txt"]));
    refuse(arguments, 3, &["12_corr.txt", "\"12\""]);
}

#[test]
fn rows_without_an_answer_leave_the_pose_undecided() {
    let nan = CSV.replace("30", "nan");
    let negative = CSV.replace("0.5", "-0.5");
    for (content, reason) in [
        ("inlier,x,y,X,Y,Z,conf\n", "too few points"),
        (CSV, "too few points"),
        (&nan, "not finite"),
        (&negative, "negative"),
    ] {
        let scene = Scene::trained();
        scene.write("correspondences/3_corr.txt", content);
        let outcome = succeed(scene.score(&["--weights", "conf", "--json", "-"]));
        let document = json(&outcome);
        let pose = &document["poses"][0];
        assert_eq!(pose["decision"], "undecided", "{document}");
        assert!(
            pose["reason"].as_str().unwrap().contains(reason),
            "{document}"
        );
        assert!(pose["confidence"].is_number(), "{document}");
    }
}

#[test]
fn metres_beside_millimetres_are_warned_of() {
    let scene = Scene::trained();
    let metres = Scene::scaled(0.001);
    for name in ["poses.json", "correspondences/3_corr.txt"] {
        let kept = scene.read(name);
        scene.write(name, metres.read(name));
        let outcome = succeed(scene.score(&[]));
        assert!(
            outcome
                .stderr
                .contains("the numbers look like m, the template is in mm"),
            "{name}: {outcome:?}"
        );
        scene.write(name, kept);
    }
    let right = succeed(scene.score(&[]));
    assert_eq!(right.stderr, "");
}

#[test]
fn a_matrix_that_is_not_quite_a_rotation_is_scored_with_a_warning() {
    let scene = Scene::trained();
    let text = scene.read("poses.json").replacen("-1.0", "-1.02", 1);
    scene.write("poses.json", text);
    let outcome = succeed(scene.score(&["-q"]));
    assert!(
        outcome.stderr.starts_with("warning: pose 3: R is no"),
        "{outcome:?}"
    );
    assert_eq!(outcome.stderr.lines().count(), 1);
}

#[test]
fn line_endings_and_byte_order_marks_of_other_systems_change_nothing() {
    let scene = Scene::trained();
    let expected = succeed(scene.score(&["--json", "-"])).stdout;
    for name in [
        "K.txt",
        "poses.json",
        "correspondences/3_corr.txt",
        "correspondences/8_corr.txt",
    ] {
        let text = scene.read(name).replace('\n', "\r\n");
        scene.write(name, format!("\u{feff}{text}"));
    }
    assert_eq!(succeed(scene.score(&["--json", "-"])).stdout, expected);
}

#[test]
fn ids_with_leading_zeros_find_their_files_in_a_folder_too() {
    let scene = Scene::trained();
    let text = scene.read("poses.json").replace("\"3\"", "\"000003\"");
    scene.write("poses.json", text);
    let document = json(&succeed(scene.score(&["--json", "-"])));
    assert_eq!(document["poses"][0]["decision"], "accept");
}

#[test]
fn ids_from_a_file_cannot_steer_the_terminal() {
    let scene = Scene::trained();
    let hostile = "\"3\\u001b[31m\\n\"";
    let one = one_pose(TURN, "0,0,600").replace("\"3\"", hostile);
    scene.write("poses.json", one);
    let mut arguments = scene.score(&[]);
    arguments.pop();
    arguments.extend(scene.arguments(&["@correspondences/3_corr.txt"]));
    // A single pose takes a single file, whatever its id; `run` looks for escape sequences.
    let table = succeed(arguments).stdout;
    assert_eq!(table.lines().count(), 2, "{table}");
}
