//! Draws `docs/overlay.png`: the demonstration's bracket, a pose that is off, and the depth that a camera would
//! measure of the bracket at its true pose beside a plate that stands in front of it.
//!
//! `cargo run --release -p cobra-tests --example make-overlay -- docs/overlay.png`

use cobra_infer::depth::{DepthSettings, TemplateSurface, Thresholds};
use cobra_infer::{Pose, Template};
use cobra_train::bop::render::{DepthNoise, PlacedModel, RenderModel, render};
use cobra_train::demo::{VIEW, encode_png, mechanical_part, scorer_camera, simulate};
use cobra_train::depth::observed;
use cobra_train::input::ImageSize;
use cobra_train::output::write_whole;
use cobra_train::overlay::{Evidence, Overlay, OverlayEstimate, draw, grey_depth};
use cobra_train::progress::Silent;
use cobra_train::surface::Mesh;
use cobra_train::train::{LARGEST_TEMPLATE, TrainOptions, train};
use nalgebra::{Isometry3, Point3, Translation3};
use std::error::Error;
use std::path::Path;

/// How far the pose is off, in millimetres: across the ray, and towards the camera.
const OFF: [f64; 3] = [30.0, 4.0, -8.0];

fn main() -> Result<(), Box<dyn Error>> {
    draw_to(&std::env::args().nth(1).ok_or("which file to write")?)
}

fn draw_to(path: &str) -> Result<(), Box<dyn Error>> {
    let mesh = mechanical_part();
    let bytes = train(&mesh.clone().into(), &TrainOptions::new("bracket"), &Silent)?.bytes;
    let template = Template::from_bytes(&bytes)?;
    let truth = simulate(&mesh, 10, 0)?[0].truth;
    let camera = scorer_camera();
    let size = ImageSize {
        width: VIEW.width,
        height: VIEW.height,
    };
    let (part, plate) = (RenderModel::new(&mesh), RenderModel::new(&plate()?));
    let middle = truth * mesh.bounding_sphere().centre;
    let placed = [
        PlacedModel {
            model: &part,
            pose: truth,
        },
        PlacedModel {
            model: &plate,
            pose: Isometry3::translation(0.8 * middle.x - 75.0, 0.8 * middle.y, 0.8 * middle.z),
        },
    ];
    let frame = render(&camera, size, &placed).with_noise(&DepthNoise {
        standard_deviation: 0.5,
        seed: 0,
        scene: 0,
        image: 0,
    });
    let pose = Translation3::from(OFF) * truth;
    let rows = pose.rotation.to_rotation_matrix().matrix().transpose();
    let mut r = [0.0; 9];
    r.copy_from_slice(rows.cast::<f32>().as_slice());
    let pose = Pose::from_row_major(r, pose.translation.vector.cast::<f32>().into())?;
    let settings = DepthSettings {
        thresholds: Some(Thresholds {
            accept: 0.75,
            reject: 0.55,
        }),
        ..DepthSettings::for_template(&template)
    };
    let noise = settings.noise.at(template.diameter(), middle.z as f32)?;
    let surface = TemplateSurface::<LARGEST_TEMPLATE>::new(&template, noise)?;
    let pixels = observed(&frame.visible(0), frame.depth());
    let evidence = Evidence {
        camera: &camera,
        depth: frame.depth(),
        pixels: Some(&pixels),
        most: 500,
    };
    let name = template.name().to_owned();
    let unit = template.unit();
    let estimate = OverlayEstimate::of(name, &surface, unit, &pose, &settings, &evidence)?;
    let image = draw(&Overlay {
        photo: &grey_depth(frame.depth()),
        estimates: &[estimate],
        subtitle: "The demonstration's bracket behind a plate   ·   simulated depth, noise 0.5 mm   ·   \
                   the pose is 31 mm off",
        limit: None,
    })?;
    write_whole(Path::new(path), &encode_png(&image)?)?;
    Ok(())
}

/// A plate of 60 by 240 mm that faces the camera.
fn plate() -> Result<Mesh, Box<dyn Error>> {
    let corners = [
        [-30.0, -120.0],
        [30.0, -120.0],
        [30.0, 120.0],
        [-30.0, 120.0],
    ];
    let vertices = corners.map(|[x, y]| Point3::new(x, y, 0.0)).to_vec();
    Ok(Mesh::new(vertices, vec![[0, 1, 2], [0, 2, 3]])?)
}
