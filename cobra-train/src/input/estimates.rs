//! Pose files: JSON with an image's poses under its id, as BOP's `scene_gt.json`.

use super::json::{Misfit, numbers};
use super::read_text;
use cobra_infer::{Pose, PoseError};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// One estimated pose.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// The image's id; `ID#N` for the N-th pose of an image with several.
    pub id: String,
    /// The image's id alone.
    pub image: String,
    /// The pose.
    pub pose: Pose,
    /// How far the file's matrix was from a rotation, where it had to be replaced by the nearest:
    /// the largest entry of RᵀR − I in magnitude.
    pub repaired: Option<f32>,
}

/// Why a file holds no poses.
#[derive(Debug, thiserror::Error)]
pub enum ReadEstimatesError {
    /// The file could not be read.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The file is not JSON; the message holds line and column.
    #[error("{}: not valid JSON: {source}", path.display())]
    Json {
        /// The file.
        path: PathBuf,
        /// What is wrong, and where.
        source: serde_json::Error,
    },
    /// The JSON does not have the form of a pose file.
    #[error("{}: {place}: expected {expected}, found {found}", path.display())]
    Form {
        /// The file.
        path: PathBuf,
        /// Where in the document.
        place: String,
        /// What should stand there.
        expected: &'static str,
        /// What does.
        found: String,
    },
    /// The numbers are no pose.
    #[error("{}: pose {id}: {source}", path.display())]
    Pose {
        /// The file.
        path: PathBuf,
        /// Which pose.
        id: String,
        /// What is wrong with it.
        source: PoseError,
    },
}

/// Reads `{"IMAGE": [{"cam_R_m2c": [9 numbers], "cam_t_m2c": [3 numbers]}, …], …}`, R row-major,
/// object to camera; other keys are ignored. Poses come in the file's order. A matrix that is not
/// quite a rotation is replaced by the nearest one, and the estimate says so.
///
/// # Errors
/// [`ReadEstimatesError`] names the file and the place in it.
pub fn read_estimates(path: &Path) -> Result<Vec<Estimate>, ReadEstimatesError> {
    let text = read_text(path).map_err(|source| ReadEstimatesError::Io {
        path: path.to_owned(),
        source,
    })?;
    let document: Value =
        serde_json::from_str(&text).map_err(|source| ReadEstimatesError::Json {
            path: path.to_owned(),
            source,
        })?;
    let form = |misfit| form(path, misfit);
    let whole = |expected| form(Misfit::new("the document", expected, &document));
    let images = document
        .as_object()
        .ok_or_else(|| whole("an object with image ids as keys"))?;
    let mut estimates = Vec::new();
    for (image, poses) in images {
        let list = poses
            .as_array()
            .ok_or_else(|| form(Misfit::new(image, "a list of poses", poses)))?;
        for (index, entry) in list.iter().enumerate() {
            let place = format!("{image}[{index}]");
            let rotation = numbers::<9>(&place, entry, "cam_R_m2c", "9 numbers").map_err(form)?;
            let translation =
                numbers::<3>(&place, entry, "cam_t_m2c", "3 numbers").map_err(form)?;
            let id = match list.len() {
                1 => image.clone(),
                _ => format!("{image}#{index}"),
            };
            let (pose, repaired) =
                to_pose(rotation, translation).map_err(|source| ReadEstimatesError::Pose {
                    path: path.to_owned(),
                    id: id.clone(),
                    source,
                })?;
            estimates.push(Estimate {
                id,
                image: image.clone(),
                pose,
                repaired,
            });
        }
    }
    if estimates.is_empty() {
        return Err(whole("at least one pose"));
    }
    Ok(estimates)
}

fn to_pose(r: [f32; 9], t: [f32; 3]) -> Result<(Pose, Option<f32>), PoseError> {
    match Pose::from_row_major(r, t) {
        Ok(pose) => Ok((pose, None)),
        Err(PoseError::NotARotation { deviation, .. }) => {
            Ok((Pose::from_row_major_orthonormalised(r, t)?, Some(deviation)))
        }
        Err(error) => Err(error),
    }
}

fn form(path: &Path, misfit: Misfit) -> ReadEstimatesError {
    ReadEstimatesError::Form {
        path: path.to_owned(),
        place: misfit.place,
        expected: misfit.expected,
        found: misfit.found,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = r#"{"7": [{"cam_R_m2c": [1,0,0,0,1,0,0,0,1], "cam_t_m2c": [0,0,500]}],
        "3": [{"cam_R_m2c": [1,0,0,0,1,0,0,0,1], "cam_t_m2c": [0,0,1]},
              {"cam_R_m2c": [1,0,0,0,1,0,0,0,1], "cam_t_m2c": [0,0,2]}]}"#;

    fn read(text: &str) -> Result<Vec<Estimate>, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("poses.json");
        std::fs::write(&path, text).unwrap();
        read_estimates(&path).map_err(|error| error.to_string())
    }

    #[test]
    fn poses_come_in_the_files_order_with_ids_of_their_own() {
        let ids: Vec<String> = read(GOOD).unwrap().into_iter().map(|e| e.id).collect();
        assert_eq!(ids, ["7", "3#0", "3#1"]);
    }

    #[test]
    fn a_matrix_that_is_nearly_a_rotation_is_replaced_and_reported() {
        let text = GOOD.replacen("[1,0,0,0,1,0,0,0,1]", "[1,0,0,0,1,0,0,0,0.9997]", 1);
        let estimates = read(&text).unwrap();
        assert!((estimates[0].repaired.unwrap() - 6e-4).abs() < 1e-6);
        assert!((estimates[0].pose.rotation().matrix().m33 - 1.0).abs() < 1e-6);
        assert_eq!(estimates[1].repaired, None);
    }

    #[test]
    fn what_is_missing_or_wrong_is_named_with_its_place() {
        for (from, to, expected) in [
            (
                "0,0,500]",
                "0,500]",
                "7[0].cam_t_m2c: expected 3 numbers, found a list of 2",
            ),
            (
                "cam_t_m2c\": [0,0,1]",
                "t\": [0,0,1]",
                "3[0].cam_t_m2c: expected 3 numbers, found nothing",
            ),
            (
                "0,0,500]",
                "0,\"far\",500]",
                "7[0].cam_t_m2c[1]: expected a number, found \"far\"",
            ),
            (
                "[1,0,0,0,1,0,0,0,1]",
                "[1,0,0,0,1,0,0,0,-1]",
                "pose 7: R mirrors",
            ),
            (
                "[1,0,0,0,1,0,0,0,1]",
                "[1,0,0,0,1,0,0,0,1.2]",
                "R is no rotation",
            ),
            (
                "[1,0,0,0,1,0,0,0,1]",
                "[1,0,0,0,1,0,0,0,1e39]",
                "not finite",
            ),
            ("{\"7\"", "{7", "not valid JSON"),
        ] {
            let error = read(&GOOD.replacen(from, to, 1)).unwrap_err();
            assert!(error.contains(expected), "{error}");
            assert!(
                error.contains("poses.json") && !error.contains('\n'),
                "{error}"
            );
        }
        assert!(read("[]").unwrap_err().contains("an object with image ids"));
        assert!(read("{}").unwrap_err().contains("at least one pose"));
    }
}
