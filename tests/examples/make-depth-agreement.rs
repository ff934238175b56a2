//! Makes the scenes of `tests/golden/agreement`, and the gradients of `tests/golden`, that are empty.
//!
//! `cargo run -p cobra-tests --example make-depth-agreement`. As `make-agreement`: a file with content is
//! never overwritten, and those of a new template have to be created empty.

use cobra_agreement::depth::{self, HEIGHT, PIXELS, WIDTH};
use cobra_agreement::golden::GOLDEN;
use cobra_agreement::{SETS, Set};
use cobra_infer::Template;
use cobra_tests::scene_file::{View, image_file, scene_file};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::error::Error;
use std::path::{Path, PathBuf};

/// A word of the image, in the template's unit: BOP's `depth_scale` for tenths of a millimetre.
const SCALE: f32 = 0.1;

/// Of the sensor, along the ray.
const NOISE: f32 = 0.4;

const VIEW: View = View {
    camera: [150.0, 0.5, 47.0, 0.0, 151.0, 36.0, 0.0, 0.0, 1.0],
    width: WIDTH,
    height: HEIGHT,
};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("golden");
    for golden in GOLDEN.iter().filter(|golden| golden.gradients.is_empty()) {
        let template = Template::from_bytes(golden.template)?;
        let mut bytes = Vec::new();
        depth::gradients(&template, |word| bytes.extend(word.to_le_bytes()));
        let known = GOLDEN.iter().find(|g| g.template == golden.template);
        let name = known.map_or(golden.name, |known| known.name);
        write_new(folder.join(format!("v1-{name}.gradients")), &bytes)?;
    }
    for (seed, set) in (0..).zip(&SETS) {
        let Some(known) = &set.depth else {
            continue;
        };
        let file = |ending: &str| folder.join(format!("agreement/{}.{ending}", set.name));
        let (mut image, mut scene) = (known.image.to_vec(), known.scene.to_vec());
        if scene.is_empty() {
            (image, scene) = made(set, seed)?;
            write_new(file("image"), &image_file(&image))?;
            write_new(file("scene"), &scene)?;
        }
        if known.expected.is_empty() {
            let mut bytes = Vec::new();
            depth::words(set.template, &scene, &image, |word| {
                bytes.extend(word.to_le_bytes());
            })
            .map_err(|unreadable| format!("{unreadable:?}"))?;
            write_new(file("checked"), &bytes)?;
        }
    }
    Ok(())
}

fn write_new(path: PathBuf, bytes: &[u8]) -> Result<(), Box<dyn Error>> {
    if std::fs::metadata(&path)?.len() == 0 {
        std::fs::write(&path, bytes)?;
        println!("made {}", path.display());
    }
    Ok(())
}

/// What the sensor sees of the object at the first of the poses, and the scene.
fn made(set: &Set, seed: u64) -> Result<(Vec<u16>, Vec<u8>), Box<dyn Error>> {
    let template = Template::from_bytes(set.template)?;
    let poses = poses(&template);
    let rendered = VIEW.render(&template, &poses[0])?;
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let away = poses[0][11];
    let mut pixels = Vec::new();
    let mut image = Vec::new();
    for (index, surface) in rendered.into_iter().enumerate() {
        let (column, row) = (index % WIDTH, index / WIDTH);
        // A wall behind it, something in front of its left end, and a hole in the middle.
        let wall = 1.6 * away + 0.5 * row as f32;
        let front = (30..36).contains(&column) && row > 20;
        let hole = (46..50).contains(&column) && (30..36).contains(&row);
        let lost = hole || random.random_range(0..40) == 0;
        let seen = if front { 0.7 * away } else { surface.min(wall) };
        let measured = seen + random.random_range(-2.0 * NOISE..=2.0 * NOISE);
        image.push(if lost {
            0
        } else {
            (measured / SCALE).round() as u16
        });
        // A mask is not exact: some of what is beside the object, and of what is not measured.
        let wrong = random.random_range(0..150) == 0;
        if (surface.is_finite() && !front) != wrong {
            pixels.push([column as u16, row as u16]);
        }
    }
    let every = pixels.len().div_ceil(PIXELS);
    let pixels: Vec<[u16; 2]> = pixels.into_iter().step_by(every).collect();
    Ok((image, scene_file(&VIEW, SCALE, &poses, &pixels)))
}

/// The true pose and what estimators make of it, each of the object's middle.
fn poses(template: &Template<'_>) -> [[f32; 12]; 9] {
    let radius = template.radius();
    let away = 4.8 * radius;
    // Leaning by 53 degrees, as seen by a camera that is upside down.
    let lean = [-1., 0., 0., 0., 0.6, 0.8, 0., 0.8, -0.6];
    let turned = [-0.96, 0.28, 0., 0.168, 0.576, 0.8, 0.224, 0.768, -0.6];
    let other = [0.6, 0., 0.8, 0.64, 0.6, -0.48, -0.48, 0.8, 0.36];
    let at = |r: [f32; 9], middle: [f32; 3]| {
        let c = template.centre();
        let row = |i: usize| r[3 * i] * c[0] + r[3 * i + 1] * c[1] + r[3 * i + 2] * c[2];
        let t = [0, 1, 2].map(|i| middle[i] - row(i));
        let [a, b, c, d, e, f, g, h, i] = r;
        [a, b, c, d, e, f, g, h, i, t[0], t[1], t[2]]
    };
    let near = |share: f32| share * radius;
    [
        at(lean, [0.0, 0.0, away]),
        at(lean, [near(0.06), near(-0.05), away]),
        at(lean, [0.0, 0.0, away + near(0.3)]),
        at(turned, [0.0, 0.0, away]),
        at(other, [near(0.8), near(-0.4), 0.8 * away]),
        // Behind the camera, around it, and of metres taken for millimetres.
        at(lean, [0.0, 0.0, -away]),
        at(lean, [0.0, 0.0, near(0.9)]),
        at(lean, [0.0, 0.0, 1e-3 * away]),
        // Half out of the image.
        at(lean, [near(-1.5), near(0.3), away]),
    ]
}
