//! Writes what the firmware's program `object` reads: a template, points of its surface as a camera
//! sees them, and the bits that this machine scores.
//!
//! `cargo run --release -p cobra-tests --example object-points -- TEMPLATE MESH FOLDER`.

use cobra_agreement::object::{NOISES, score};
use cobra_agreement::vectors::Points;
use cobra_infer::Template;
use cobra_tests::points_file::points_file;
use cobra_train::evaluate::evaluation_points;
use cobra_train::surface::read_geometry;
use std::error::Error;
use std::path::Path;

const POINTS: usize = 1000;

const FOCAL_LENGTH: f32 = 900.0;
const MIDDLE: [f32; 2] = [640.0, 480.0];

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [template, mesh, folder] = &arguments[..] else {
        return Err("usage: object-points TEMPLATE MESH FOLDER".into());
    };
    let folder = Path::new(folder);
    let bytes = std::fs::read(template)?;
    let template = Template::from_bytes(&bytes)?;
    let object = read_geometry(Path::new(mesh))?.geometry;
    // Upright before the camera, so far away that all of it is seen.
    let [x, y, z] = template.centre();
    let away = 4.0 * template.radius();
    let pose = [1., 0., 0., 0., 1., 0., 0., 0., 1., -x, -y, away - z];
    let rows: Vec<[f32; 6]> = evaluation_points(&object, POINTS, 0)?
        .iter()
        .map(|point| {
            let [a, b, c]: [f32; 3] = point.cast::<f32>().into();
            let [u, v, depth] = [a - x, b - y, c - z + away];
            let [cx, cy] = MIDDLE;
            let pixel = [FOCAL_LENGTH * u / depth + cx, FOCAL_LENGTH * v / depth + cy];
            [pixel[0], pixel[1], a, b, c, 1.0]
        })
        .collect();
    let [cx, cy] = MIDDLE;
    let camera = [FOCAL_LENGTH, 0., cx, 0., FOCAL_LENGTH, cy, 0., 0., 1.];
    let points = points_file(&camera, &[pose], &rows);
    let read = Points::read(&points).ok_or("the points do not read")?;
    let mut expected: Vec<u8> = Vec::new();
    for noise in NOISES {
        let each = |word: u32| expected.extend(word.to_le_bytes());
        score(&template, &read, noise, usize::MAX, each)
            .map_err(|unreadable| format!("{unreadable:?}"))?;
    }
    std::fs::create_dir_all(folder)?;
    std::fs::write(folder.join("object.cobra"), &bytes)?;
    std::fs::write(folder.join("object.points"), &points)?;
    std::fs::write(folder.join("object.expected"), &expected)?;
    Ok(())
}
