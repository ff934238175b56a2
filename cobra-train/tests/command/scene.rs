//! A folder with everything that the command reads: a box, a camera, a right and a wrong pose.

use crate::run::succeed;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use tempfile::TempDir;

/// Few points: enough for a box, and quick.
pub(crate) const FEW: [&str; 4] = ["--points", "300", "--test-points", "500"];

/// More of them: enough for charts to cover a box.
pub(crate) const MORE: [&str; 4] = ["--points", "2000", "--test-points", "1500"];

/// Components that cluster the points and speak everywhere, as the paper's, and how many of them;
/// reference points are to be asked for besides.
pub(crate) const CLUSTERED: [&str; 8] = [
    "--validity",
    "everywhere",
    "--budget",
    "none",
    "--exponent",
    "1",
    "--components",
    "4",
];

/// [`CLUSTERED`] by k-means.
pub(crate) const KMEANS: [&str; 10] = [
    "--reference-points",
    "kmeans",
    "--validity",
    "everywhere",
    "--budget",
    "none",
    "--exponent",
    "1",
    "--components",
    "4",
];

const LOW: [f64; 3] = [10.0, -20.0, 5.0];
const HIGH: [f64; 3] = [50.0, 40.0, 85.0];

/// R of both poses, row-major: a quarter turn about x.
const R: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0];
const T: [f64; 3] = [5.0, -10.0, 600.0];

/// How far the wrong pose is beside the right one, in mm.
const WRONG: f64 = 25.0;

const FOCAL: f64 = 500.0;

pub(crate) struct Scene {
    folder: TempDir,
}

impl Scene {
    /// `box.obj`, `K.txt`, `poses.json` and a folder `correspondences`, in millimetres.
    pub(crate) fn new() -> Self {
        Self::scaled(1.0)
    }

    /// The same with all lengths times `scale`.
    pub(crate) fn scaled(scale: f64) -> Self {
        let scene = Self {
            folder: tempfile::tempdir().unwrap(),
        };
        scene.write("box.obj", box_obj(scale));
        scene.write("K.txt", "500,0,320\n0,500,240\n0,0,1\n");
        scene.write("poses.json", poses(scale));
        std::fs::create_dir(scene.path("correspondences")).unwrap();
        for id in ["3", "8"] {
            scene.write(
                &format!("correspondences/{id}_corr.txt"),
                correspondences(scale),
            );
        }
        scene
    }

    /// The scene with a template `part.cobra` of k-means components, trained once for all tests.
    pub(crate) fn trained() -> Self {
        static TEMPLATE: OnceLock<Vec<u8>> = OnceLock::new();
        Self::with(&TEMPLATE, |scene| scene.train(&[]))
    }

    /// The same with a template as training makes it unless told otherwise.
    pub(crate) fn charted() -> Self {
        static TEMPLATE: OnceLock<Vec<u8>> = OnceLock::new();
        Self::with(&TEMPLATE, |scene| scene.train_charts(&[]))
    }

    fn with(template: &OnceLock<Vec<u8>>, train: impl FnOnce(&Self)) -> Self {
        let scene = Self::new();
        let bytes = template.get_or_init(|| {
            train(&scene);
            std::fs::read(scene.path("part.cobra")).unwrap()
        });
        scene.write("part.cobra", bytes);
        scene
    }

    /// Trains `part.cobra` from `box.obj`, by k-means.
    pub(crate) fn train(&self, more: &[&str]) {
        let train = ["train", "@box.obj", "-o", "@part.cobra"];
        succeed(self.arguments(&[&train[..], &FEW, &KMEANS, more].concat()));
    }

    /// Trains `part.cobra` from `box.obj`, with the options that stand unless told otherwise.
    pub(crate) fn train_charts(&self, more: &[&str]) {
        let train = ["train", "@box.obj", "-o", "@part.cobra"];
        succeed(self.arguments(&[&train[..], &MORE, more].concat()));
    }

    pub(crate) fn folder(&self) -> &Path {
        self.folder.path()
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), content).unwrap();
    }

    pub(crate) fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }

    /// Words for the command line; `@name` is a file of the scene.
    pub(crate) fn arguments(&self, words: &[&str]) -> Vec<String> {
        words
            .iter()
            .map(|word| match word.strip_prefix('@') {
                Some(name) => self.path(name).to_str().unwrap().to_owned(),
                None => (*word).to_owned(),
            })
            .collect()
    }

    /// The words of `cobra score` on the scene's own files, and `more`.
    pub(crate) fn score(&self, more: &[&str]) -> Vec<String> {
        let mut arguments = self.arguments(&[
            "score",
            "@part.cobra",
            "--camera",
            "@K.txt",
            "--poses",
            "@poses.json",
            "--correspondences",
            "@correspondences",
        ]);
        arguments.extend(self.arguments(more));
        arguments
    }

    /// The names in the scene's folder, hidden ones included, in order.
    pub(crate) fn names(&self) -> Vec<String> {
        let mut names: Vec<String> = std::fs::read_dir(self.folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }
}

fn corner(index: usize) -> [f64; 3] {
    [0, 1, 2].map(|axis| {
        if index >> axis & 1 == 0 {
            LOW[axis]
        } else {
            HIGH[axis]
        }
    })
}

fn box_obj(scale: f64) -> String {
    let mut text = String::new();
    for index in 0..8 {
        let [x, y, z] = corner(index).map(|c| c * scale);
        text += &format!("v {x} {y} {z}\n");
    }
    for face in [
        "1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6",
    ] {
        text += &format!("f {face}\n");
    }
    text
}

fn poses(scale: f64) -> String {
    let pose = |t: [f64; 3]| {
        let t = t.map(|c| c * scale);
        format!("[{{\"cam_R_m2c\": {R:?}, \"cam_t_m2c\": {t:?}}}]")
    };
    let wrong = [T[0] + WRONG, T[1], T[2]];
    format!("{{\"3\": {}, \"8\": {}}}\n", pose(T), pose(wrong))
}

/// Points on all six faces, seen without noise from the right pose; every tenth is no inlier.
fn correspondences(scale: f64) -> String {
    let mut text = String::from("inlier,x,y,X,Y,Z,conf\n");
    let shares = [0.15, 0.4, 0.65, 0.9];
    let mut row = 0;
    for axis in 0..3 {
        for side in [LOW[axis], HIGH[axis]] {
            for (a, b) in shares
                .iter()
                .flat_map(|a| shares.iter().map(move |b| (a, b)))
            {
                let mut point = [0.0; 3];
                point[axis] = side;
                for (other, share) in [((axis + 1) % 3, a), ((axis + 2) % 3, b)] {
                    point[other] = LOW[other] + share * (HIGH[other] - LOW[other]);
                }
                let seen: [f64; 3] = std::array::from_fn(|i| {
                    (0..3).map(|j| R[3 * i + j] * point[j]).sum::<f64>() + T[i]
                });
                let pixel = [
                    FOCAL * seen[0] / seen[2] + 320.0,
                    FOCAL * seen[1] / seen[2] + 240.0,
                ];
                let [x, y, z] = point.map(|c| c * scale);
                let inlier = f64::from(row % 10 != 0);
                row += 1;
                text += &format!(
                    "{inlier:.1},{},{},{x},{y},{z},0.{row:03}\n",
                    pixel[0], pixel[1]
                );
            }
        }
    }
    text
}
