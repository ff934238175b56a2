//! BOP's cameras in JSON: `camera.json` for a whole data set, `scene_camera.json` image by image.
//!
//! Owns their keys. Which pixels and lengths they speak of is said in the data set's documents.

use super::super::json::{Misfit, numbers, to_f32};
use super::{CameraFile, ImageCamera, ImageSize, ReadCameraError};
use cobra_infer::{Camera, CameraError};
use serde_json::{Map, Value};
use std::path::Path;

/// The keys of which `camera.json` has all and `scene_camera.json` none.
const INTRINSICS: [&str; 4] = ["fx", "fy", "cx", "cy"];

pub(super) fn parse(text: &str, path: &Path) -> Result<CameraFile, ReadCameraError> {
    let document: Value = serde_json::from_str(text).map_err(|source| ReadCameraError::Json {
        path: path.to_owned(),
        source,
    })?;
    let form = |misfit| ReadCameraError::form(path, misfit);
    let expected = "fx, fy, cx and cy, or image ids as keys";
    let keys = document
        .as_object()
        .filter(|keys| !keys.is_empty())
        .ok_or_else(|| form(Misfit::new("the document", expected, &document)))?;
    if INTRINSICS.iter().any(|key| keys.contains_key(*key)) {
        let mut k = [0.0; 4];
        for (number, key) in k.iter_mut().zip(INTRINSICS) {
            let value = keys.get(key).unwrap_or(&Value::Null);
            *number = to_f32(value).ok_or_else(|| form(Misfit::new(key, "a number", value)))?;
        }
        let [fx, fy, cx, cy] = k;
        let camera = Camera::new(fx, fy, cx, cy)
            .and_then(|camera| undistorted(camera, keys))
            .map_err(|source| no_camera(path, None, source))?;
        return Ok(CameraFile::One(ImageCamera {
            camera,
            depth_scale: depth_scale(keys, "").map_err(form)?,
            size: size(keys).map_err(form)?,
        }));
    }
    let cameras = keys
        .iter()
        .map(|(image, entry)| Ok((image.clone(), image_camera(path, image, entry)?)));
    Ok(CameraFile::PerImage(cameras.collect::<Result<_, _>>()?))
}

/// The camera of one image: its `entry` in the `scene_camera.json` at `path`.
///
/// # Errors
/// [`ReadCameraError`] names the file, the image and the key.
pub(crate) fn image_camera(
    path: &Path,
    image: &str,
    entry: &Value,
) -> Result<ImageCamera, ReadCameraError> {
    let form = |misfit| ReadCameraError::form(path, misfit);
    let fields = entry
        .as_object()
        .ok_or_else(|| form(Misfit::new(image, "an object with cam_K", entry)))?;
    if let Some(model) = fields.get("cam_model") {
        let place = format!("{image}.cam_model");
        return Err(form(if fields.contains_key("cam_K") {
            Misfit {
                place,
                expected: "a pinhole camera's cam_K alone, lens models are not supported",
                found: "cam_K and cam_model, of which either could count".to_owned(),
            }
        } else {
            let expected = "a pinhole camera's cam_K instead, lens models are not supported";
            Misfit::new(place, expected, model)
        }));
    }
    let k = numbers::<9>(image, entry, "cam_K", "9 numbers").map_err(form)?;
    let camera = Camera::from_matrix(k)
        .and_then(|camera| undistorted(camera, fields))
        .map_err(|source| no_camera(path, Some(format!("{image}.cam_K")), source))?;
    Ok(ImageCamera {
        camera,
        depth_scale: depth_scale(fields, &format!("{image}.")).map_err(form)?,
        size: None,
    })
}

/// What other tools call the coefficients of lens distortion; BOP has none.
const DISTORTION: [&str; 13] = [
    "dist_coeffs",
    "dist",
    "distortion",
    "distortion_coefficients",
    "distortion_parameters",
    "D",
    "k1",
    "k2",
    "k3",
    "k4",
    "p1",
    "p2",
    "cam_dist",
];

/// The camera, unless a key holds a coefficient that is not 0.
fn undistorted(camera: Camera, keys: &Map<String, Value>) -> Result<Camera, CameraError> {
    let coefficients: Vec<f32> = DISTORTION
        .iter()
        .filter_map(|key| keys.get(*key))
        .flat_map(|value| match value {
            Value::Array(values) => values.iter().filter_map(to_f32).collect(),
            value => to_f32(value).into_iter().collect::<Vec<_>>(),
        })
        .collect();
    camera.with_distortion(&coefficients)
}

fn no_camera(path: &Path, place: Option<String>, source: CameraError) -> ReadCameraError {
    ReadCameraError::Camera {
        path: path.to_owned(),
        place,
        source,
    }
}

fn depth_scale(keys: &Map<String, Value>, before: &str) -> Result<Option<f32>, Misfit> {
    let Some(value) = keys.get("depth_scale") else {
        return Ok(None);
    };
    match to_f32(value) {
        Some(scale) if scale > 0.0 && scale.is_finite() => Ok(Some(scale)),
        _ => Err(Misfit::new(
            format!("{before}depth_scale"),
            "a number greater than 0",
            value,
        )),
    }
}

/// Both, or neither.
fn size(keys: &Map<String, Value>) -> Result<Option<ImageSize>, Misfit> {
    if !keys.contains_key("width") && !keys.contains_key("height") {
        return Ok(None);
    }
    let pixels = |key: &str| {
        let value = keys.get(key).unwrap_or(&Value::Null);
        let number = value.as_u64().and_then(|number| u32::try_from(number).ok());
        number
            .filter(|number| (1..=ImageSize::LARGEST_SIDE).contains(number))
            .ok_or_else(|| Misfit::new(key, "a whole number of pixels up to 16384", value))
    };
    Ok(Some(ImageSize {
        width: pixels("width")?,
        height: pixels("height")?,
    }))
}

#[cfg(test)]
mod tests {
    use super::super::read_as;
    use super::*;

    const ONE: &str = r#"{"cx": 325.2611, "cy": 242.04899, "depth_scale": 0.1, "fx": 572.4114,
        "fy": 573.57043, "height": 480, "width": 640, "lens": "none"}"#;
    const PER_IMAGE: &str = r#"{"3": {"cam_K": [572.4114, 0.5, 325.2611, 0.0, 573.57043, 242.04899,
        0.0, 0.0, 1.0], "depth_scale": 1.0, "cam_t_w2c": [1, 2, 3]},
        "8": {"cam_K": [500, 0, 320, 0, 500, 240, 0, 0, 1]}}"#;

    #[test]
    fn distortion_is_refused_under_any_of_its_names() {
        for (key, refused) in [
            (r#""dist_coeffs": [0, 0.1, 0, 0]"#, true),
            (r#""k1": -0.2"#, true),
            (r#""D": [0, 0, 0, 0, 0], "k1": 0"#, false),
        ] {
            let one = ONE.replace(r#""lens": "none""#, key);
            let each = PER_IMAGE.replace(r#""depth_scale": 1.0"#, key);
            for (name, text) in [("camera.json", one), ("scene_camera.json", each)] {
                match read_as(name, &text) {
                    Ok(_) => assert!(!refused, "{text}"),
                    Err(error) => assert!(refused && error.to_string().contains("undistort")),
                }
            }
        }
    }

    #[test]
    fn camera_json_is_one_camera_with_size_and_depth_scale() {
        let CameraFile::One(one) = read_as("camera.json", ONE).unwrap() else {
            panic!("per image");
        };
        let camera = Camera::new(572.4114, 573.57043, 325.2611, 242.049).unwrap();
        assert_eq!(one.camera, camera);
        assert_eq!(one.depth_scale, Some(0.1));
        let (width, height) = (640, 480);
        assert_eq!(one.size, Some(ImageSize { width, height }));
    }

    #[test]
    fn scene_camera_json_has_a_camera_for_each_image() {
        let CameraFile::PerImage(cameras) = read_as("scene_camera.json", PER_IMAGE).unwrap() else {
            panic!("one");
        };
        let ids: Vec<&str> = cameras.keys().map(String::as_str).collect();
        assert_eq!(ids, ["3", "8"]);
        let k = [
            572.4114, 0.5, 325.2611, 0.0, 573.57043, 242.049, 0.0, 0.0, 1.0,
        ];
        assert_eq!(cameras["3"].camera, Camera::from_matrix(k).unwrap());
        assert_eq!(cameras["3"].depth_scale, Some(1.0));
        assert_eq!((cameras["8"].depth_scale, cameras["8"].size), (None, None));
    }

    #[test]
    fn what_is_missing_or_wrong_in_camera_json_is_named_with_its_key() {
        for (from, to, expected) in [
            (
                "\"fy\": 573.57043,",
                "",
                "fy: expected a number, found nothing",
            ),
            (
                "572.4114",
                "\"wide\"",
                "fx: expected a number, found \"wide\"",
            ),
            ("572.4114", "-5", "fx must be positive"),
            ("325.2611", "1e39", "not finite"),
            (
                "0.1",
                "0",
                "depth_scale: expected a number greater than 0, found 0",
            ),
            (
                "0.1",
                "[]",
                "depth_scale: expected a number greater than 0, found a list of 0",
            ),
            (
                "480",
                "0",
                "height: expected a whole number of pixels up to 16384, found 0",
            ),
            (
                "480",
                "4.5",
                "height: expected a whole number of pixels up to 16384, found 4.5",
            ),
            (
                ", \"width\": 640",
                "",
                "width: expected a whole number of pixels up to 16384, found nothing",
            ),
            (
                "640",
                "16385",
                "width: expected a whole number of pixels up to 16384, found 16385",
            ),
            ("\"fx\"", "fx", "not valid JSON"),
        ] {
            let error = read_as("camera.json", &ONE.replace(from, to)).unwrap_err();
            assert!(error.contains(expected), "{error}");
        }
        for text in ["{}", "[]", "7"] {
            let error = read_as("camera.json", text).unwrap_err();
            assert!(error.contains("fx, fy, cx and cy, or image ids"), "{error}");
        }
    }

    #[test]
    fn what_is_missing_or_wrong_in_scene_camera_json_is_named_with_its_image() {
        for (from, to, expected) in [
            (
                "240, 0, 0, 1]",
                "240, 0, 0]",
                "8.cam_K: expected 9 numbers, found a list of 8",
            ),
            (
                "[500, ",
                "[null, ",
                "8.cam_K[0]: expected a number, found nothing",
            ),
            (
                "[500, ",
                "[-500, ",
                "8.cam_K: the camera's fx must be positive",
            ),
            (
                "cam_t_w2c",
                "cam_model",
                "3.cam_model: expected a pinhole camera's cam_K alone, lens models are not \
                 supported, found cam_K and cam_model",
            ),
            (
                "\"cam_K\": [500",
                "\"cam_model\": [500",
                "8.cam_model: expected a pinhole camera's cam_K instead, lens models",
            ),
            (
                "cam_t_w2c",
                "cam_K",
                "3.cam_K: expected 9 numbers, found a list of 3",
            ),
            (
                "\"8\": {\"cam_K\"",
                "\"8\": {\"K\"",
                "8.cam_K: expected 9 numbers, found nothing",
            ),
            (
                "1.0, \"cam_t",
                "-1.0, \"cam_t",
                "3.depth_scale: expected a number greater than 0",
            ),
            (
                "\"8\": {",
                "\"9\": 7, \"8\": {",
                "9: expected an object with cam_K, found 7",
            ),
        ] {
            let error = read_as("scene_camera.json", &PER_IMAGE.replace(from, to)).unwrap_err();
            assert!(error.contains(expected), "{error}");
        }
    }
}
