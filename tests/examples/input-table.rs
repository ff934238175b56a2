//! Trains every mesh and cloud below a folder with 16 k-means components and prints the table of
//! `docs/INPUTS.md`: what each file holds, how well it comes out, or why it is refused.
//!
//! `cargo run --release -p cobra-tests --example input-table -- FOLDER`.

use cobra_infer::{Settings, Template};
use cobra_tests::data::files_below;
use cobra_train::evaluate::{evaluate, evaluation_points};
use cobra_train::progress::Silent;
use cobra_train::surface::{Geometry, read_geometry};
use cobra_train::train::{TrainOptions, train};
use std::error::Error;
use std::path::{Path, PathBuf};

const FORMATS: [&str; 7] = ["glb", "gltf", "obj", "off", "ply", "stl", "xyz"];

/// Points that a template is measured on.
const POINTS: usize = 30_000;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args_os().nth(1).ok_or("a folder is needed")?;
    let folder = PathBuf::from(folder);
    println!("| file | holds | F | chamfer × 10³ |\n|---|---|---|---|");
    for path in files_below(&folder, &FORMATS) {
        let name = path.strip_prefix(&folder)?.display().to_string();
        match row(&path) {
            Ok(row) => println!("| `{name}` | {row} |"),
            Err(error) => println!("| `{name}` | refused: {error} | | |"),
        }
    }
    Ok(())
}

fn row(path: &Path) -> Result<String, Box<dyn Error>> {
    let object = read_geometry(path)?.geometry;
    let holds = match &object {
        Geometry::Mesh(mesh) => format!("{} triangles", mesh.triangles().len()),
        Geometry::Cloud(cloud) => format!("{} points", cloud.points().len()),
    };
    let trained = train(&object, &TrainOptions::clustered("object", 16), &Silent)?;
    let template = Template::from_bytes(&trained.bytes)?;
    let chosen = Settings::for_template(&template, 1.0).assignment;
    let points = evaluation_points(&object, POINTS, 0)?;
    let shape = evaluate(&template, chosen, &points)?.shape;
    Ok(format!(
        "{holds} | {:.1} | {:.3}",
        shape.f_score, shape.chamfer
    ))
}
