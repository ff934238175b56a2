//! `cobra overlay`: pictures of estimates, and what it refuses.

use crate::run::{refuse, run, succeed};
use crate::scene::Scene;
use std::path::Path;

/// A template of the box, and a data set of one image that is 505 mm away everywhere.
fn scene() -> Scene {
    let scene = Scene::charted();
    for path in ["templates", "data/test/000002/depth"] {
        std::fs::create_dir_all(scene.path(path)).unwrap();
    }
    let template = std::fs::read(scene.path("part.cobra")).unwrap();
    scene.write("templates/obj_000001.cobra", template);
    scene.write("K.txt", "60 0 31.5\n0 60 23.5\n0 0 1\n");
    let pose = r#"{"cam_R_m2c": [1,0,0,0,1,0,0,0,1], "cam_t_m2c": [-30,-10,500], "obj_id": 1}"#;
    scene.write("pose.json", format!("{{\"3\": [{pose}]}}"));
    scene.write(
        "data/test/000002/scene_camera.json",
        r#"{"3": {"cam_K": [60,0,31.5,0,60,23.5,0,0,1], "depth_scale": 0.5}}"#,
    );
    let row = "1 0 0 0 1 0 0 0 1,-30 -10 500,-1";
    scene.write(
        "results.csv",
        format!(
            "scene_id,im_id,obj_id,score,R,t,time\n2,3,1,0.5,{row}\n2,3,7,0.5,{row}\n\
             2,3,1,0.5,1 0 0,-30 -10 500,-1\n"
        ),
    );
    scene.write("data/test/000002/depth/000003.png", grey16((64, 48), 1010));
    scene.write("small.png", grey16((32, 24), 1010));
    scene.write("torn.png", "no picture");
    scene
}

fn grey16((width, height): (u32, u32), value: u16) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Sixteen);
    let pixels = value.to_be_bytes().repeat((width * height) as usize);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&pixels).unwrap();
    writer.finish().unwrap();
    bytes
}

fn words(scene: &Scene, line: &str) -> Vec<String> {
    scene.arguments(&line.split(' ').collect::<Vec<_>>())
}

const BOP: &str =
    "overlay --dataset @data --templates @templates --results @results.csv -o @out.png";
const PLAIN: &str =
    "overlay @templates/obj_000001.cobra --camera @K.txt --pose @pose.json -o @out.png";

fn size(path: &Path) -> (u32, u32) {
    let file = std::io::BufReader::new(std::fs::File::open(path).unwrap());
    let reader = png::Decoder::new(file).read_info().unwrap();
    (reader.info().width, reader.info().height)
}

#[test]
fn a_row_and_the_same_pose_in_a_file_of_its_own_are_said_the_same_of() {
    let scene = scene();
    let row = succeed(words(&scene, &format!("{BOP} --row 2 --residuals @r.csv")));
    assert!(row.stdout.contains("object 1"), "{row:?}");
    assert_eq!(size(&scene.path("out.png")).0, 1600);
    let residuals = std::fs::read_to_string(scene.path("r.csv")).unwrap();
    assert!(residuals.starts_with("kind,column,row,depth,seen,residual\n"));
    let depth = "--depth-image @data/test/000002/depth/000003.png --depth-scale 0.5";
    let plain = succeed(words(
        &scene,
        &format!("{PLAIN} {depth} --residuals @plain.csv"),
    ));
    let figures = |text: &str| {
        text.lines()
            .nth(1)
            .unwrap()
            .split_whitespace()
            .rev()
            .take(5)
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    assert_eq!(figures(&row.stdout), figures(&plain.stdout));
    assert_eq!(
        residuals,
        std::fs::read_to_string(scene.path("plain.csv")).unwrap()
    );
}

#[test]
fn what_does_not_fit_is_one_line_that_names_the_file() {
    let scene = scene();
    for (line, code, said) in [
        (
            format!("{BOP} --row 9"),
            3,
            ["results.csv: expected a row on line 9", "lines 2 to 4"],
        ),
        (
            format!("{BOP} --row 4"),
            3,
            ["results.csv: line 4: R: expected 9 numbers", "found 3"],
        ),
        (
            format!("{BOP} --row 3"),
            3,
            [
                "results.csv: line 3: ",
                "templates: expected obj_000007.cobra",
            ],
        ),
        (
            format!("{BOP} --scene 2 --image 3 --object 5"),
            3,
            ["results.csv: expected a pose of object 5", "found none"],
        ),
        (
            format!("{BOP} --scene 2 --image 4 --object 1"),
            3,
            ["results.csv: expected a pose", "found none"],
        ),
        (
            format!("{BOP} --row 2 --scene 2 --image 8"),
            3,
            [
                "line 2: expected an estimate of scene 2 and image 8",
                "image 3",
            ],
        ),
        (BOP.to_owned(), 2, ["--scene and --image", "--row"]),
        (
            format!("{PLAIN} --depth-image @missing.png"),
            4,
            ["missing.png", "No such file"],
        ),
        (
            format!("{PLAIN} --depth-image @torn.png"),
            3,
            ["torn.png: expected a PNG image", "found"],
        ),
        (
            format!("{PLAIN} --depth-image @small.png --mask @small.png"),
            3,
            [
                "small.png: expected 8-bit grey PNG of 32 x 24",
                "found 16-bit",
            ],
        ),
        (
            format!("{PLAIN} --depth-image @small.png --photo @data/test/000002/depth/000003.png"),
            3,
            [
                "000003.png: expected PNG of 32 x 24 pixels",
                "found PNG of 64 x 48",
            ],
        ),
    ] {
        refuse(words(&scene, &line), code, &said);
    }
}

#[test]
fn options_of_the_one_kind_of_image_are_refused_beside_the_other() {
    let scene = scene();
    let of_files = "--depth-image @small.png";
    for option in [
        "--depth simulated",
        "--depth-noise 1",
        "--masks silhouette",
        "--seed 1",
        "--object 1",
        "--row 2",
        "--scene 2 --image 3",
        "--split train",
        "--truth",
        "--templates @templates",
        "--results @results.csv",
    ] {
        refused_together(words(&scene, &format!("{PLAIN} {of_files} {option}")));
    }
    for option in [
        of_files,
        "--depth-scale 0.5",
        "--photo @small.png",
        "--camera @K.txt",
        "--pose @pose.json",
        "--mask @small.png",
    ] {
        refused_together(words(&scene, &format!("{BOP} --row 2 {option}")));
    }
}

#[test]
fn a_row_is_of_results_and_not_of_the_truth() {
    let scene = scene();
    let truth =
        "overlay --dataset @data --templates @templates --scene 2 --image 3 --truth --row 2";
    refused_together(words(&scene, &format!("{truth} -o @out.png")));
}

fn refused_together(arguments: Vec<String>) {
    let outcome = run(arguments);
    assert_eq!(outcome.code, Some(2), "{outcome:?}");
    assert!(
        outcome.stderr.contains("cannot be used with"),
        "{outcome:?}"
    );
}

#[test]
fn noise_on_measured_depth_is_refused_as_by_bop_score() {
    let scene = scene();
    for options in ["", "--depth sensor"] {
        refuse(
            words(
                &scene,
                format!("{BOP} --row 2 --depth-noise 2 {options}").trim_end(),
            ),
            2,
            &["--depth-noise goes with --depth simulated"],
        );
    }
}
