//! A folder of object models: `obj_000001.ply`, …, and what `models_info.json` says of them.

use super::document::{Document, Entry};
use super::{DatasetError, place_of};
use crate::bop::objects::{listed, objects_in};
use crate::bop::symmetry::{Axis, Symmetries};
use crate::input::json::{Misfit, exact_numbers};
use crate::pose::nearest_pose;
use crate::surface::{Geometry, read_geometry};
use nalgebra::{Isometry3, Point3, Unit, Vector3};
use serde_json::Value;
use std::path::{Path, PathBuf};

const INFO: &str = "models_info.json";

/// The models of a data set, read when they are asked for. Keeping them is the caller's business.
#[derive(Clone, Debug)]
pub struct Models {
    folder: PathBuf,
    info: Option<Document>,
}

/// What `models_info.json` says of an object.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelInfo {
    /// The largest distance between two of the model's vertices, in millimetres; greater than 0.
    pub diameter: f64,
    /// The motions that the data set does not tell apart.
    pub symmetries: Symmetries,
}

impl Models {
    /// A folder of models, `models` or `models_eval`. Where `models_eval` has no
    /// `models_info.json`, that of `models` beside it counts.
    ///
    /// # Errors
    /// [`DatasetError`]: no such folder, or a `models_info.json` that is no JSON object.
    pub fn open(folder: &Path) -> Result<Self, DatasetError> {
        std::fs::read_dir(folder).map_err(|source| DatasetError::io(folder, source))?;
        let mut info = Document::read_if_there(folder.join(INFO))?;
        let name = folder.file_name().and_then(|name| name.to_str());
        if let (None, Some(whole)) = (&info, name.and_then(|name| name.strip_suffix("_eval"))) {
            info = Document::read_if_there(folder.with_file_name(whole).join(INFO))?;
        }
        Ok(Self {
            folder: folder.to_owned(),
            info,
        })
    }

    /// The objects that have a model, in rising order.
    ///
    /// # Errors
    /// [`DatasetError::Io`] if the folder cannot be listed any more.
    pub fn objects(&self) -> Result<Vec<u32>, DatasetError> {
        objects_in(&self.folder, "ply").map_err(|source| DatasetError::io(&self.folder, source))
    }

    /// The file of an object's model.
    #[must_use]
    pub fn path(&self, object: u32) -> PathBuf {
        self.folder.join(format!("obj_{object:06}.ply"))
    }

    /// An object's model, in millimetres.
    ///
    /// # Errors
    /// [`DatasetError::UnknownObject`] where there is no file of it, [`DatasetError::Model`] where
    /// what it holds cannot be used.
    pub fn geometry(&self, object: u32) -> Result<Geometry, DatasetError> {
        let path = self.path(object);
        if !path.exists() {
            return Err(DatasetError::UnknownObject {
                folder: self.folder.clone(),
                object,
                known: listed(&self.objects()?),
            });
        }
        Ok(read_geometry(&path)?.geometry)
    }

    /// Diameter and symmetries of an object.
    ///
    /// # Errors
    /// [`DatasetError`] names the file, the object and the key.
    pub fn info(&self, object: u32) -> Result<ModelInfo, DatasetError> {
        let Some(info) = &self.info else {
            let missing = std::io::ErrorKind::NotFound.into();
            return Err(DatasetError::io(&self.info_path(), missing));
        };
        info_of(info, object)
    }

    /// Whether there is a `models_info.json`, in the folder or where another counts for it.
    #[must_use]
    pub fn has_info(&self) -> bool {
        self.info.is_some()
    }

    /// The folder's own `models_info.json`, whether or not it is there.
    #[must_use]
    pub fn info_path(&self) -> PathBuf {
        self.folder.join(INFO)
    }
}

/// Diameter and symmetries of an object in a `models_info.json` of any name.
///
/// # Errors
/// [`DatasetError`] names the file, the object and the key.
pub fn read_model_info(path: &Path, object: u32) -> Result<ModelInfo, DatasetError> {
    info_of(&Document::read(path.to_owned())?, object)
}

fn info_of(info: &Document, object: u32) -> Result<ModelInfo, DatasetError> {
    let entry = info.entry("object", object)?;
    Ok(ModelInfo {
        diameter: diameter(&entry)?,
        symmetries: Symmetries {
            discrete: list(&entry, "symmetries_discrete", discrete)?,
            continuous: list(&entry, "symmetries_continuous", continuous)?,
        },
    })
}

fn diameter(entry: &Entry<'_>) -> Result<f64, DatasetError> {
    let value = entry.value.get("diameter").unwrap_or(&Value::Null);
    let diameter = value.as_f64().filter(|diameter| *diameter > 0.0);
    diameter.ok_or_else(|| {
        let place = place_of(entry.key, "diameter");
        let misfit = Misfit::new(place, "a number greater than 0", value);
        DatasetError::form(entry.path, misfit)
    })
}

/// What `read` makes of each element under `key`; nothing where there is no such key. `read` is told
/// the list and the element's place in it.
fn list<T>(
    entry: &Entry<'_>,
    key: &'static str,
    read: impl Fn(&Path, &str, &Value) -> Result<T, DatasetError>,
) -> Result<Vec<T>, DatasetError> {
    let Some(value) = entry.value.get(key) else {
        return Ok(Vec::new());
    };
    let place = place_of(entry.key, key);
    let elements = value.as_array().ok_or_else(|| {
        DatasetError::form(
            entry.path,
            Misfit::new(&place, "a list of symmetries", value),
        )
    })?;
    let elements = elements.iter().enumerate();
    elements
        .map(|(index, element)| read(entry.path, &format!("{place}[{index}]"), element))
        .collect()
}

/// A 4×4 matrix, row-major, its rotation replaced by the nearest: the files round it to six digits.
fn discrete(path: &Path, place: &str, element: &Value) -> Result<Isometry3<f64>, DatasetError> {
    let expected = "16 numbers, a 4 x 4 matrix whose last row is 0 0 0 1";
    let wrong = || DatasetError::form(path, Misfit::new(place, expected, element));
    let numbers: Option<Vec<f64>> = element
        .as_array()
        .and_then(|list| list.iter().map(Value::as_f64).collect());
    let numbers: [f64; 16] = numbers
        .and_then(|numbers| numbers.try_into().ok())
        .ok_or_else(wrong)?;
    let [a, b, c, x, d, e, f, y, g, h, i, z, last @ ..] = numbers;
    if last != [0.0, 0.0, 0.0, 1.0] {
        return Err(wrong());
    }
    nearest_pose([a, b, c, d, e, f, g, h, i], [x, y, z]).map_err(|source| DatasetError::Pose {
        path: path.to_owned(),
        place: place.to_owned(),
        source,
    })
}

fn continuous(path: &Path, place: &str, element: &Value) -> Result<Axis, DatasetError> {
    let vector = |key| {
        exact_numbers::<3>(place, element, key, "3 numbers")
            .map_err(|misfit| DatasetError::form(path, misfit))
    };
    let direction = Unit::try_new(Vector3::from(vector("axis")?), 0.0).ok_or_else(|| {
        let misfit = Misfit {
            place: place_of(place, "axis"),
            expected: "a direction",
            found: "0 0 0".to_owned(),
        };
        DatasetError::form(path, misfit)
    })?;
    Ok(Axis {
        direction,
        offset: Point3::from(vector("offset")?),
    })
}
