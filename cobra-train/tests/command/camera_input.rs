//! Cameras as BOP writes them, for `cobra score`.

use crate::run::{json, refuse, succeed};
use crate::scene::Scene;
use serde_json::Value;

const ONE: &str = r#"{"fx": 500.0, "fy": 500.0, "cx": 320.0, "cy": 240.0, "depth_scale": 1.0,
    "width": 640, "height": 480}"#;

fn entry(fx: f64) -> String {
    format!("{{\"cam_K\": [{fx}, 0, 320, 0, 500, 240, 0, 0, 1], \"depth_scale\": 1.0}}")
}

fn score(scene: &Scene, camera: &str) -> Value {
    let camera = format!("@{camera}");
    let mut arguments = scene.score(&["--json", "-"]);
    arguments[3] = scene.arguments(&[&camera]).remove(0);
    json(&succeed(arguments))
}

#[test]
fn all_three_kinds_of_camera_file_give_the_same_scores() {
    let scene = Scene::trained();
    scene.write("camera.json", ONE);
    let images = format!("{{\"000003\": {}, \"8\": {}}}", entry(500.0), entry(500.0));
    scene.write("scene_camera.json", images);
    let matrix = score(&scene, "K.txt");
    assert_eq!(score(&scene, "camera.json"), matrix);
    assert_eq!(score(&scene, "scene_camera.json"), matrix);
}

#[test]
fn each_image_is_scored_with_its_own_camera() {
    let scene = Scene::trained();
    let images = format!("{{\"8\": {}, \"3\": {}}}", entry(500.0), entry(900.0));
    scene.write("scene_camera.json", images);
    let (one, own) = (score(&scene, "K.txt"), score(&scene, "scene_camera.json"));
    assert_ne!(one["poses"][0]["confidence"], own["poses"][0]["confidence"]);
    assert_eq!(one["poses"][1], own["poses"][1]);
}

#[test]
fn a_pose_of_an_image_without_a_camera_is_refused() {
    let scene = Scene::trained();
    scene.write("scene_camera.json", format!("{{\"3\": {}}}", entry(500.0)));
    let mut arguments = scene.score(&[]);
    arguments[3] = scene.arguments(&["@scene_camera.json"]).remove(0);
    let said = ["scene_camera.json", "no camera of image 8"];
    refuse(arguments, 3, &said);
}

#[test]
fn camera_documents_that_are_none_are_refused_with_file_and_key() {
    let no_cy = ONE.replace("\"cy\"", "\"cz\"");
    let short = entry(500.0).replace(", 1]", "]");
    for (content, said) in [
        ("", "JSON"),
        ("{", "JSON"),
        ("{}", "image ids"),
        ("[]", "image ids"),
        (&no_cy, "cy: expected a number, found nothing"),
        (&ONE.replace("500.0", "0"), "fx"),
        (&ONE.replace("640", "-640"), "width"),
        (
            &format!("{{\"3\": {short}}}"),
            "3.cam_K: expected 9 numbers",
        ),
        (&format!("{{\"3\": {}}}", entry(-1.0)), "3.cam_K: "),
    ] {
        let scene = Scene::trained();
        scene.write("camera.json", content);
        let mut arguments = scene.score(&[]);
        arguments[3] = scene.arguments(&["@camera.json"]).remove(0);
        refuse(arguments, 3, &["camera.json", said]);
    }
}
