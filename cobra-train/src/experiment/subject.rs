//! The objects that experiments are made on.
//!
//! Owns where a folder's meshes are looked for, what classes they make, and their order. Reading a mesh is
//! `surface`'s work.

use super::error::ExperimentError;
use super::paper;
use crate::demo::mechanical_part;
use crate::random::Purpose;
use crate::surface::{BoundingSphere, Mesh, RayCaster, SampleError, read_mesh, sample_visible};
use crc::{CRC_32_ISO_HDLC, Crc};
use nalgebra::Point3;
use std::path::{Path, PathBuf};

const CHECKSUM: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// The files that are taken for meshes.
const EXTENSIONS: [&str; 6] = ["ply", "obj", "stl", "off", "glb", "gltf"];

/// The folder of the paper's own industrial object, beside `meshes`, and the class that it belongs to.
const OWN: (&str, &str) = ("screwdriver", "screwdrivers");

/// An object that experiments are made on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Subject {
    /// The class that it is averaged in: its folder's name.
    pub class: String,
    /// Its own name: its file's.
    pub name: String,
    /// Its file; none for the demonstration's part.
    path: Option<PathBuf>,
    /// CRC-32 of the file, so that results of another file are not taken for this one's.
    checksum: u32,
}

impl Subject {
    /// What the object's results are kept under.
    #[must_use]
    pub fn key(&self) -> String {
        format!("{}/{}/{:08x}", self.class, self.name, self.checksum)
    }

    /// The object in the unit sphere.
    ///
    /// # Errors
    /// [`ExperimentError::Mesh`].
    pub fn mesh(&self) -> Result<Mesh, ExperimentError> {
        let mesh = match &self.path {
            Some(path) => read_mesh(path)?,
            None => mechanical_part(),
        };
        let sphere: BoundingSphere = mesh.bounding_sphere();
        Ok(mesh.normalised(&sphere).rounded())
    }

    /// `count` points of a mesh in the unit sphere as cameras see them.
    pub(super) fn sample(
        &self,
        mesh: &Mesh,
        caster: &RayCaster,
        count: usize,
        seed: u64,
        purpose: Purpose,
    ) -> Result<Vec<Point3<f64>>, ExperimentError> {
        let sampled = sample_visible(mesh, caster, count, seed, purpose);
        let sampled = sampled.map_err(|source: SampleError| ExperimentError::Sample {
            object: self.name.clone(),
            source,
        })?;
        Ok(sampled.iter().map(|point| point.position).collect())
    }
}

/// What a folder has for experiments.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Data {
    subjects: Vec<Subject>,
}

impl Data {
    /// The demonstration's part alone, for whoever has no data.
    #[must_use]
    pub fn part() -> Self {
        Self {
            subjects: vec![Subject {
                class: "parts".to_owned(),
                name: "bracket".to_owned(),
                path: None,
                checksum: 0,
            }],
        }
    }

    /// The meshes of a folder: of `meshes/CLASS`, else of folders `CLASS`, else those that lie in it, of the
    /// class of its name; below a class also in folders of objects, as ShapeNetCore keeps them. `screwdriver/model.ply` beside `meshes` is the paper's own object, of the
    /// class `screwdrivers`. Classes of the paper come first, in its order; others by name.
    ///
    /// # Errors
    /// [`ExperimentError::Folder`], [`ExperimentError::NoMeshes`].
    pub fn read(folder: &Path) -> Result<Self, ExperimentError> {
        let meshes = folder.join("meshes");
        let root = if meshes.is_dir() { &meshes } else { folder };
        let mut subjects = Vec::new();
        for class in entries(root)?.iter().filter(|entry| entry.is_dir()) {
            subjects.extend(of_class(class, &file_name(class))?);
        }
        if root == meshes {
            let own = folder.join(OWN.0);
            if own.is_dir() {
                for path in entries(&own)?.into_iter().filter(|path| is_mesh(path)) {
                    subjects.push(subject(OWN.1, OWN.0.to_owned(), path)?);
                }
            }
        }
        if subjects.is_empty() {
            let absolute = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
            subjects = of_class(root, &file_name(&absolute))?;
        }
        if subjects.is_empty() {
            return Err(ExperimentError::NoMeshes {
                path: folder.to_owned(),
            });
        }
        let rank = |class: &str| paper::CLASSES.iter().position(|known| *known == class);
        subjects.sort_by(|a, b| {
            let key = |s: &Subject| (rank(&s.class).unwrap_or(usize::MAX), s.class.clone());
            key(a).cmp(&key(b)).then_with(|| a.name.cmp(&b.name))
        });
        Ok(Self { subjects })
    }

    /// How many objects of which classes there are, in words.
    #[must_use]
    pub fn words(&self) -> String {
        let groups = self.subjects.chunk_by(|a, b| a.class == b.class);
        let words = groups.map(|group| format!("{} {}", group[0].class, group.len()));
        words.collect::<Vec<_>>().join(", ")
    }

    /// All objects.
    #[must_use]
    pub fn all(&self) -> &[Subject] {
        &self.subjects
    }

    /// The objects of the paper's four classes; all where there is none of these.
    #[must_use]
    pub fn of_the_paper(&self) -> Vec<&Subject> {
        self.of_classes(&paper::CLASSES, usize::MAX)
    }

    /// At most `most` objects of each of `classes`; of each class where there is none of these.
    pub(super) fn of_classes(&self, classes: &[&str], most: usize) -> Vec<&Subject> {
        let known = |subject: &&Subject| classes.contains(&subject.class.as_str());
        let mut chosen: Vec<&Subject> = self.subjects.iter().filter(known).collect();
        if chosen.is_empty() {
            chosen = self.subjects.iter().collect();
        }
        let groups = chosen.chunk_by(|a, b| a.class == b.class);
        groups
            .flat_map(|group| group.iter().take(most).copied())
            .collect()
    }

    /// The object that the paper shows single results of, its screwdriver; the first where it is not there.
    pub(super) fn shown(&self) -> &Subject {
        self.named(OWN.0).unwrap_or(&self.subjects[0])
    }

    pub(super) fn named(&self, name: &str) -> Option<&Subject> {
        self.subjects.iter().find(|subject| subject.name == name)
    }
}

/// The classes of subjects that lie together, in their order.
pub(super) fn classes<'s>(subjects: &[&'s Subject]) -> Vec<&'s str> {
    let groups = subjects.chunk_by(|a, b| a.class == b.class);
    groups.map(|group| group[0].class.as_str()).collect()
}

/// Meshes in folders of folders, as ShapeNetCore keeps them, are found so deep below their class.
const DEPTH: usize = 3;

/// The meshes of a class: those in its folder, by their file's name, and those in folders below, by that of the
/// first.
fn of_class(folder: &Path, class: &str) -> Result<Vec<Subject>, ExperimentError> {
    let mut subjects = Vec::new();
    for entry in entries(folder)? {
        if entry.is_dir() {
            for path in meshes_below(&entry, DEPTH)? {
                subjects.push(subject(class, file_name(&entry), path)?);
            }
        } else if is_mesh(&entry) {
            let name = entry.file_stem().unwrap_or_default();
            subjects.push(subject(
                class,
                name.to_string_lossy().into_owned(),
                entry.clone(),
            )?);
        }
    }
    Ok(subjects)
}

fn meshes_below(folder: &Path, depth: usize) -> Result<Vec<PathBuf>, ExperimentError> {
    let mut found = Vec::new();
    for entry in entries(folder)? {
        if entry.is_dir() && depth > 1 {
            found.extend(meshes_below(&entry, depth - 1)?);
        } else if is_mesh(&entry) {
            found.push(entry);
        }
    }
    Ok(found)
}

fn is_mesh(path: &Path) -> bool {
    let extension = path.extension().and_then(|extension| extension.to_str());
    let extension = extension.map(str::to_ascii_lowercase);
    path.is_file() && extension.is_some_and(|e| EXTENSIONS.contains(&e.as_str()))
}

fn subject(class: &str, name: String, path: PathBuf) -> Result<Subject, ExperimentError> {
    let bytes = std::fs::read(&path).map_err(|source| ExperimentError::Folder {
        path: path.clone(),
        source,
    })?;
    Ok(Subject {
        class: class.to_owned(),
        name,
        checksum: CHECKSUM.checksum(&bytes),
        path: Some(path),
    })
}

/// What lies in a folder, by name.
fn entries(folder: &Path) -> Result<Vec<PathBuf>, ExperimentError> {
    let failed = |source| ExperimentError::Folder {
        path: folder.to_owned(),
        source,
    };
    let entries = std::fs::read_dir(folder).map_err(failed)?;
    let mut paths = entries
        .map(|entry| entry.map(|entry| entry.path()).map_err(failed))
        .collect::<Result<Vec<_>, _>>()?;
    paths.sort();
    Ok(paths)
}

fn file_name(path: &Path) -> String {
    path.file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn names(data: &Data) -> Vec<(&str, &str)> {
        let all = data.all().iter();
        all.map(|subject| (subject.class.as_str(), subject.name.as_str()))
            .collect()
    }

    #[test]
    fn classes_of_the_paper_come_first_and_its_screwdriver_joins_its_class() {
        let folder = tempfile::tempdir().unwrap();
        for file in [
            "meshes/bolts/a.STL",
            "meshes/sofas/b.obj",
            "meshes/sofas/notes.txt",
            "meshes/planes/c.glb",
            "screwdriver/model.ply",
            "clouds/d.ply",
        ] {
            let path = folder.path().join(file);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, file).unwrap();
        }
        let data = Data::read(folder.path()).unwrap();
        let expected = [
            ("planes", "c"),
            ("sofas", "b"),
            ("screwdrivers", "screwdriver"),
            ("bolts", "a"),
        ];
        assert_eq!(names(&data), expected);
        assert_eq!(data.shown().name, "screwdriver");
        assert_eq!(data.of_the_paper().len(), 3);
    }

    #[test]
    fn folders_of_objects_below_a_class_and_loose_meshes_are_found() {
        let folder = tempfile::tempdir().unwrap();
        let deep = folder.path().join("02691156/1a04/models");
        fs::create_dir_all(&deep).unwrap();
        fs::write(deep.join("model_normalized.obj"), "x").unwrap();
        let data = Data::read(folder.path()).unwrap();
        assert_eq!(names(&data), [("02691156", "1a04")]);
        fs::write(deep.join("loose.stl"), "x").unwrap();
        let data = Data::read(&deep).unwrap();
        assert_eq!(
            names(&data),
            [("models", "loose"), ("models", "model_normalized")]
        );
        assert_eq!(data.words(), "models 2");
    }

    #[test]
    fn another_content_is_another_key() {
        let folder = tempfile::tempdir().unwrap();
        let key = |content: &str| {
            fs::write(folder.path().join("a.stl"), content).unwrap();
            Data::read(folder.path()).unwrap().all()[0].key()
        };
        assert_ne!(key("one"), key("two"));
        assert_eq!(key("one"), key("one"));
    }
}
