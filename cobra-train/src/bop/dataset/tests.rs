//! A small data set, whole and damaged in every way that is told apart.

use super::*;
use crate::surface::Geometry;
use nalgebra::{Point3, Vector3};
use png::{BitDepth, ColorType};
use std::fs;

const CAMERAS: &str = r#"{"3": {"cam_K": [50, 0, 2, 0, 50, 1, 0, 0, 1], "depth_scale": 0.5},
    "4": {"cam_K": [50, 0, 2, 0, 50, 1, 0, 0, 1], "cam_model": {"model": "CameraModelType.FISHEYE624"}},
    "5": {"cam_model": {}}, "6": {"cam_K": [50, 0, 2, 0, 50, 1, 0, 0, 1], "depth_scale": 0},
    "7": {"cam_K": [50, 0, 2, 0, 50, 1, 0, 0, 1]}}"#;
const TRUTH: &str = r#"{"3": [
    {"cam_R_m2c": [0.99985, 0, 0, 0, 0.99985, 0, 0, 0, 0.99985], "cam_t_m2c": [1, 2, 300.25], "obj_id": 2},
    {"cam_R_m2c": [0, -1, 0, 1, 0, 0, 0, 0, 1], "cam_t_m2c": [0, 0, 1e3], "obj_id": 1}],
    "000004": [{"cam_R_m2c": [1, 0, 0, 0, 1, 0, 0, 0], "cam_t_m2c": [0, 0, 1], "obj_id": 1}],
    "5": [{"cam_R_m2c": [1, 0, 0, 0, 1, 0, 0, 0, -1], "cam_t_m2c": [0, 0, 1], "obj_id": 1}],
    "6": [{"cam_R_m2c": [1, 0, 0, 0, 1, 0, 0, 0, 1], "cam_t_m2c": [0, 0, "far"], "obj_id": 1}],
    "7": [{"cam_R_m2c": [1, 0, 0, 0, 1, 0, 0, 0, 1], "cam_t_m2c": [0, 0, 1], "obj_id": -1}],
    "8": {}}"#;
const INFO: &str = r#"{"1": {"diameter": 10.5},
    "2": {"diameter": 8, "symmetries_discrete": [[-0.999964, -0.00333777, -0.0077452, 0.232611,
        0.00321462, -0.999869, 0.0158593, 0.694388, -0.00779712, 0.0158338, 0.999844, -0.0792063, 0, 0, 0, 1]],
        "symmetries_continuous": [{"axis": [0, 0, 2], "offset": [1, 2, 3]}]},
    "3": {"diameter": 0}, "4": {},
    "5": {"diameter": 1, "symmetries_discrete": [[1, 0, 0]]},
    "6": {"diameter": 1, "symmetries_discrete": [[1,0,0,0, 0,1,0,0, 0,0,-1,0, 0,0,0,1]]},
    "7": {"diameter": 1, "symmetries_continuous": [{"axis": [0, 0, 0], "offset": [0, 0, 0]}]},
    "8": {"diameter": 1, "symmetries_continuous": [{"axis": [0, 0, 1]}]},
    "9": {"diameter": 1, "symmetries_discrete": 2},
    "10": {"diameter": 1, "symmetries_discrete": [[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,2]]}}"#;
const SIZE: ImageSize = ImageSize {
    width: 4,
    height: 3,
};

fn write_png(path: &Path, size: ImageSize, colour: ColorType, depth: BitDepth, bytes: &[u8]) {
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    let file = fs::File::create(path).unwrap();
    let mut encoder = png::Encoder::new(file, size.width, size.height);
    encoder.set_color(colour);
    encoder.set_depth(depth);
    encoder
        .write_header()
        .unwrap()
        .write_image_data(bytes)
        .unwrap();
}

/// Depths 0, 257, 514, …, and a mask of every other pixel.
fn whole() -> (tempfile::TempDir, Dataset) {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("test/000002");
    let models = folder.path().join("models");
    fs::create_dir_all(&scene).unwrap();
    fs::create_dir_all(&models).unwrap();
    fs::write(scene.join("scene_camera.json"), CAMERAS).unwrap();
    fs::write(scene.join("scene_gt.json"), TRUTH).unwrap();
    fs::write(models.join("models_info.json"), INFO).unwrap();
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
        property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
        0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    for object in [2, 10, 1] {
        fs::write(models.join(format!("obj_{object:06}.ply")), ply).unwrap();
    }
    let depths: Vec<u8> = (0..12).flat_map(|i| [i, i]).collect();
    let grey = ColorType::Grayscale;
    write_png(
        &scene.join("depth/000003.png"),
        SIZE,
        grey,
        BitDepth::Sixteen,
        &depths,
    );
    let mask: Vec<u8> = (0..12).map(|i| 255 * (i % 2)).collect();
    let name = "mask_visib/000003_000001.png";
    write_png(&scene.join(name), SIZE, grey, BitDepth::Eight, &mask);
    let dataset = Dataset::open(folder.path(), "test").unwrap();
    (folder, dataset)
}

/// The one line that the error is.
fn line<T>(result: Result<T, DatasetError>) -> String {
    let error = result.err().expect("an error");
    assert_eq!(error.to_string().lines().count(), 1, "{error}");
    error.to_string()
}

#[track_caller]
fn assert_says<T>(result: Result<T, DatasetError>, expected: &str) {
    let line = line(result);
    assert!(line.contains(expected), "{line}\n{expected}");
}

#[test]
fn cameras_and_true_poses_are_found_by_scene_and_image() {
    let (_folder, dataset) = whole();
    let scene = dataset.scene(2).unwrap();
    assert_eq!((scene.id(), scene.has_truth()), (2, true));
    assert_eq!(scene.images(), [3, 4, 5, 6, 7]);
    let camera = scene.camera(3).unwrap();
    assert_eq!(camera.depth_scale, Some(0.5));
    assert_eq!(camera.camera.to_matrix()[..3], [50.0, 0.0, 2.0]);
    let truth = scene.truth(3).unwrap();
    assert_eq!([truth[0].obj_id, truth[1].obj_id], [2, 1]);
    assert!(truth[0].pose.rotation.angle() < 1e-9);
    assert_eq!(
        truth[0].pose.translation.vector,
        Vector3::new(1.0, 2.0, 300.25)
    );
    let seen = truth[1].pose * Point3::new(5.0, 0.0, 0.0);
    assert!((seen - Point3::new(0.0, 5.0, 1000.0)).norm() < 1e-12);
}

#[test]
fn what_is_wrong_with_one_image_is_its_own_error() {
    let (_folder, dataset) = whole();
    let scene = dataset.scene(2).unwrap();
    assert_says(
        scene.camera(4),
        "scene_camera.json: 4.cam_model: expected a pinhole camera's cam_K alone, lens models are \
         not supported, found cam_K and cam_model, of which either could count",
    );
    assert_says(
        scene.camera(5),
        "scene_camera.json: 5.cam_model: expected a pinhole camera's cam_K instead",
    );
    assert_says(
        scene.camera(6),
        "scene_camera.json: 6.depth_scale: expected a number greater than 0, found 0",
    );
    assert_says(
        scene.depth(7, SIZE),
        "scene_camera.json: 7.depth_scale: expected a number greater than 0, found nothing",
    );
    assert_says(
        scene.camera(99),
        "scene_camera.json: expected an entry for image 99, found none",
    );
    for (image, expected) in [
        (
            4,
            "000004[0].cam_R_m2c: expected 9 numbers, found a list of 8",
        ),
        (5, "5[0]: R mirrors"),
        (6, "6[0].cam_t_m2c[2]: expected a number, found \"far\""),
        (7, "7[0].obj_id: expected a whole number, found -1"),
        (
            8,
            "8: expected a list of poses, found an object with 0 keys",
        ),
        (9, "expected an entry for image 9, found none"),
    ] {
        assert_says(scene.truth(image), &format!("scene_gt.json: {expected}"));
    }
}

#[test]
fn folders_and_files_that_are_missing_are_named() {
    let (folder, dataset) = whole();
    assert_says(Dataset::open(folder.path(), "val"), "val: No such file");
    assert_says(dataset.scene(7), "000007/scene_camera.json: No such file");
    let gt = folder.path().join("test/000002/scene_gt.json");
    fs::write(&gt, "[1]").unwrap();
    assert_says(
        dataset.scene(2),
        "scene_gt.json: the document: expected an object with ids as keys, found a list of 1",
    );
    fs::write(&gt, "{").unwrap();
    assert_says(dataset.scene(2), "scene_gt.json: not valid JSON");
    fs::remove_file(&gt).unwrap();
    let scene = dataset.scene(2).unwrap();
    assert!(!scene.has_truth());
    let error = scene.truth(3).unwrap_err();
    assert!(error.is_io() && error.to_string().contains("scene_gt.json"));
}

#[test]
fn depth_is_scaled_to_millimetres_and_masks_are_sets_of_pixels() {
    let (_folder, dataset) = whole();
    let scene = dataset.scene(2).unwrap();
    let depth = scene.depth(3, SIZE).unwrap();
    assert_eq!(depth.at(0, 0), None);
    assert_eq!(depth.at(1, 0), Some(128.5));
    assert_eq!(depth.at(3, 2), Some(11.0 * 257.0 * 0.5));
    let mask = scene.visible_mask(3, 1, SIZE).unwrap();
    assert_eq!(mask.count(), 6);
    assert!(mask.contains(1, 0) && !mask.contains(2, 0));
}

#[test]
fn another_image_than_expected_is_refused_before_it_is_used() {
    let (folder, dataset) = whole();
    let scene = dataset.scene(2).unwrap();
    let missing = scene.depth(6, SIZE);
    assert_says(missing, "6.depth_scale");
    let path = folder.path().join("test/000002/depth/000003.png");
    let large = ImageSize {
        width: 640,
        height: 480,
    };
    assert_says(
        scene.depth(3, large),
        "depth/000003.png: expected 16-bit grey PNG of 640 x 480 pixels, \
         found 16-bit grey PNG of 4 x 3 pixels",
    );
    for (colour, depth, count, found) in [
        (ColorType::Grayscale, BitDepth::Eight, 12, "8-bit grey PNG"),
        (ColorType::Rgb, BitDepth::Eight, 36, "8-bit RGB PNG"),
        (
            ColorType::GrayscaleAlpha,
            BitDepth::Sixteen,
            48,
            "16-bit grey with alpha PNG",
        ),
    ] {
        write_png(&path, SIZE, colour, depth, &vec![7; count]);
        assert_says(
            scene.depth(3, SIZE),
            &format!("found {found} of 4 x 3 pixels"),
        );
    }
    fs::write(&path, b"P5 4 3 65535").unwrap();
    assert_says(
        scene.depth(3, SIZE),
        "000003.png: expected 16-bit grey PNG of 4 x 3 pixels, found",
    );
    let pixels: Vec<u8> = (0..24).collect();
    write_png(
        &path,
        SIZE,
        ColorType::Grayscale,
        BitDepth::Sixteen,
        &pixels,
    );
    let whole = fs::read(&path).unwrap();
    for length in [0, 20, whole.len() - 20] {
        fs::write(&path, &whole[..length]).unwrap();
        let line = line(scene.depth(3, SIZE));
        assert!(line.contains("expected 16-bit grey PNG"), "{line}");
    }
    fs::remove_file(&path).unwrap();
    let error = scene.depth(3, SIZE).unwrap_err();
    assert!(error.is_io());
    assert!(error.to_string().contains("depth/000003.png: No such file"));
    assert_says(
        scene.visible_mask(3, 0, SIZE),
        "mask_visib/000003_000000.png: No such file",
    );
    assert_says(
        scene.visible_mask(3, 1, large),
        "expected 8-bit grey PNG of 640 x 480 pixels, found 8-bit grey PNG of 4 x 3 pixels",
    );
}

#[test]
fn the_size_is_the_cameras_or_the_images_or_unknown() {
    let (folder, dataset) = whole();
    let scene = dataset.scene(2).unwrap();
    assert_eq!(dataset.image_size(&scene, 3).unwrap(), SIZE);
    assert_says(
        dataset.image_size(&scene, 4),
        "camera.json: expected width and height there or an image 000004 among depth, rgb, gray and",
    );
    let wide = ImageSize {
        width: 16_385,
        height: 1,
    };
    let path = folder.path().join("test/000002/depth/000004.png");
    write_png(
        &path,
        wide,
        ColorType::Grayscale,
        BitDepth::Eight,
        &[0; 16_385],
    );
    assert_says(
        dataset.image_size(&scene, 4),
        "000004.png: expected an image of at most 16384 pixels a side, found one of 16385 x 1 pixels",
    );
    let camera = folder.path().join("camera.json");
    let text = r#"{"fx": 50, "fy": 50, "cx": 2, "cy": 1"#;
    fs::write(&camera, format!("{text}}}")).unwrap();
    assert_eq!(dataset.image_size(&scene, 3).unwrap(), SIZE);
    fs::write(&camera, format!("{text}, \"width\": 64, \"height\": 48}}")).unwrap();
    let stated = ImageSize {
        width: 64,
        height: 48,
    };
    assert_eq!(dataset.image_size(&scene, 4).unwrap(), stated);
    fs::write(&camera, "{").unwrap();
    assert_says(dataset.image_size(&scene, 3), "camera.json: not valid JSON");
}

#[test]
fn models_are_known_by_their_files_and_an_unknown_object_names_them() {
    let (folder, dataset) = whole();
    fs::write(
        folder.path().join("models/obj_7.ply"),
        "not a name of BOP's",
    )
    .unwrap();
    let models = dataset.models("models").unwrap();
    assert_eq!(models.objects().unwrap(), [1, 2, 10]);
    let Geometry::Mesh(mesh) = models.geometry(10).unwrap() else {
        panic!("a mesh has faces");
    };
    assert_eq!(mesh.vertices().len(), 3);
    assert_says(
        models.geometry(7),
        "models: expected a model of object 7, obj_000007.ply, found those of 1, 2, 10",
    );
    fs::write(models.path(10), "ply\n").unwrap();
    assert_says(models.geometry(10), "obj_000010.ply");
    assert_says(dataset.models("models_cad"), "models_cad: No such file");
    let eval = folder.path().join("models_eval");
    fs::create_dir(&eval).unwrap();
    let eval = dataset.models("models_eval").unwrap();
    assert_eq!(eval.info(1).unwrap().diameter, 10.5);
    assert_says(eval.geometry(1), "obj_000001.ply, found those of none");
    fs::remove_file(folder.path().join("models/models_info.json")).unwrap();
    assert_says(
        dataset.models("models_eval").unwrap().info(1),
        "models_eval/models_info.json: entity not found",
    );
}

#[test]
fn diameter_and_symmetries_are_read_and_what_is_wrong_is_named() {
    let (_folder, dataset) = whole();
    let models = dataset.models("models").unwrap();
    assert!(models.info(1).unwrap().symmetries.is_none());
    let info = models.info(2).unwrap();
    let [half] = info.symmetries.discrete[..] else {
        panic!("one discrete symmetry");
    };
    assert!((half.rotation.angle() - std::f64::consts::PI).abs() < 0.01);
    assert_eq!(
        half.translation.vector,
        Vector3::new(0.232611, 0.694388, -0.0792063)
    );
    let [axis] = info.symmetries.continuous[..] else {
        panic!("one axis");
    };
    assert_eq!(axis.direction, Vector3::z_axis());
    assert_eq!(axis.offset, Point3::new(1.0, 2.0, 3.0));
    for (object, expected) in [
        (3, "3.diameter: expected a number greater than 0, found 0"),
        (
            4,
            "4.diameter: expected a number greater than 0, found nothing",
        ),
        (5, "5.symmetries_discrete[0]: expected 16 numbers"),
        (6, "6.symmetries_discrete[0]: R mirrors"),
        (
            7,
            "7.symmetries_continuous[0].axis: expected a direction, found 0 0 0",
        ),
        (
            8,
            "8.symmetries_continuous[0].offset: expected 3 numbers, found nothing",
        ),
        (
            9,
            "9.symmetries_discrete: expected a list of symmetries, found 2",
        ),
        (
            10,
            "10.symmetries_discrete[0]: expected 16 numbers, a 4 x 4 matrix whose last row is",
        ),
        (11, "expected an entry for object 11, found none"),
    ] {
        assert_says(
            models.info(object),
            &format!("models_info.json: {expected}"),
        );
    }
}
