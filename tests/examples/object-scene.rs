//! Writes what the firmware's program `object-depth` reads: a template, what a depth camera would see of it,
//! and the bits that this machine computes.
//!
//! `cargo run --release -p cobra-tests --example object-scene -- TEMPLATE FOLDER`.

use cobra_agreement::depth::{Memory, NO_PIXEL, check};
use cobra_agreement::object::{CHECKED, COMPONENTS, PIXELS};
use cobra_infer::Template;
use cobra_infer::depth::Cell;
use cobra_tests::scene_file::{View, image_file, scene_file};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::error::Error;
use std::path::Path;

/// A word of the image is a tenth of the template's unit.
const SCALE: f32 = 0.1;

/// Of the sensor, as a share of the diameter.
const NOISE: f32 = 0.005;

const VIEW: View = View {
    camera: [450.0, 0.0, 160.0, 0.0, 450.0, 120.0, 0.0, 0.0, 1.0],
    width: 320,
    height: 240,
};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [template, folder] = &arguments[..] else {
        return Err("usage: object-scene TEMPLATE FOLDER".into());
    };
    let bytes = std::fs::read(template)?;
    let template = Template::from_bytes(&bytes)?;
    // Upright before the camera, all of it in the image; then a twentieth of the diameter aside and turned by
    // a tenth.
    let [x, y, z] = template.centre();
    let away = 4.5 * template.radius();
    let (c, s) = (0.995, 0.099_874_92);
    let aside = 0.05 * template.diameter();
    let poses = [
        [1., 0., 0., 0., 1., 0., 0., 0., 1., -x, -y, away - z],
        [
            c,
            0.,
            s,
            0.,
            1.,
            0.,
            -s,
            0.,
            c,
            aside - (c * x + s * z),
            -y,
            away - (c * z - s * x),
        ],
    ];
    let rendered = VIEW.render(&template, &poses[0])?;
    let mut random = ChaCha8Rng::seed_from_u64(0);
    let noise = NOISE * template.diameter();
    let (mut image, mut pixels) = (Vec::new(), Vec::new());
    for (index, surface) in rendered.into_iter().enumerate() {
        let measured = surface.min(2.0 * away) + random.random_range(-noise..=noise);
        image.push((measured / SCALE).round() as u16);
        if surface.is_finite() {
            pixels.push([(index % VIEW.width) as u16, (index / VIEW.width) as u16]);
        }
    }
    if pixels.len() < PIXELS {
        return Err(format!("{} pixels show the object, not {PIXELS}", pixels.len()).into());
    }
    let all = pixels.len();
    let pixels: Vec<_> = (0..PIXELS).map(|i| pixels[i * all / PIXELS]).collect();
    let scene = scene_file(&VIEW, SCALE, &poses, &pixels);
    let mut expected: Vec<u8> = Vec::new();
    let memory = Memory {
        pixels: &mut [NO_PIXEL; PIXELS],
        cells: &mut [Cell::EMPTY; CHECKED.cells()],
    };
    check::<COMPONENTS>(&template, &scene, &image, &[CHECKED], memory, |word| {
        expected.extend(word.to_le_bytes());
    })
    .map_err(|unreadable| format!("{unreadable:?}"))?;
    let folder = Path::new(folder);
    std::fs::create_dir_all(folder)?;
    std::fs::write(folder.join("object.cobra"), &bytes)?;
    std::fs::write(folder.join("object.image"), image_file(&image))?;
    std::fs::write(folder.join("object.scene"), &scene)?;
    std::fs::write(folder.join("object.checked"), &expected)?;
    Ok(())
}
