//! Makes the templates and the points of `tests/golden/budget`, on which instructions are counted.
//!
//! `cargo run -p cobra-tests --example make-budget`. They are no objects: every component is much
//! the same sphere of 40 mm around a point near the origin, so that templates differ in one thing
//! each, and the differences of what they cost are the cost of that thing.

use cobra_infer::gp::{Hyperparameters, UnitDirection};
use cobra_infer::template::{
    ComponentSource, Precision, TemplateSource, TermsSource, encode, encoded_len,
};
use cobra_infer::{Exponent, Kernel, Model, Unit};
use cobra_tests::points_file::points_file;
use nalgebra::Vector3;
use std::error::Error;
use std::path::Path;

/// File, exponent, components, terms of each, and whether there are precisions.
const TEMPLATES: [(&str, Exponent, usize, usize, bool); 7] = [
    ("one-1x32", Exponent::One, 1, 32, false),
    ("one-1x192", Exponent::One, 1, 192, false),
    ("one-9x32", Exponent::One, 9, 32, false),
    ("one-9x32-precisions", Exponent::One, 9, 32, true),
    ("half-1x32", Exponent::Half, 1, 32, false),
    ("half-1x192", Exponent::Half, 1, 192, false),
    ("half-9x32", Exponent::Half, 9, 32, false),
];

fn main() -> Result<(), Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("golden/budget");
    std::fs::create_dir_all(&folder)?;
    for (name, exponent, components, terms, with_precisions) in TEMPLATES {
        let directions: Vec<UnitDirection> = (0..terms).map(|i| on_spiral(i, terms)).collect();
        let weights: Vec<f32> = (0..terms).map(|i| 0.1 * (i % 7) as f32 - 0.3).collect();
        let precision = Precision::from_factor([0.02, 0.001, 0.02, -0.002, 0.003, 0.03]);
        let components: Vec<ComponentSource<'_>> = (0..components)
            .map(|index| ComponentSource {
                // In an order that makes some points change their mind often, some never.
                centre: [
                    (index * 5 % 9) as f32 - 4.0,
                    (index * 7 % 9) as f32 - 4.0,
                    1.0,
                ],
                sigma_hat: 20.0,
                precision: precision.filter(|_| with_precisions),
                hyperparameters: Hyperparameters {
                    length_scale: 0.4,
                    parameter: exponent.fixed().unwrap_or(1.0),
                    prior_mean: 40.0,
                },
                terms: TermsSource::Exact {
                    directions: &directions,
                    weights: &weights,
                },
                validity: None,
            })
            .collect();
        let source = TemplateSource {
            name,
            unit: Unit::Millimetre,
            centre: [0.0; 3],
            radius: 45.0,
            diameter: 90.0,
            model: Model::chord(Kernel::RationalQuadratic(exponent)),
            components: &components,
            quality: None,
            depth: None,
        };
        let mut bytes = vec![0; encoded_len(&source)];
        let length = encode(&source, &mut bytes)?;
        std::fs::write(folder.join(format!("{name}.cobra")), &bytes[..length])?;
    }
    let points = points_file(&CAMERA, &[POSE], &on_the_sphere());
    std::fs::write(folder.join("sphere.points"), points)?;
    Ok(())
}

const CAMERA: [f32; 9] = [900.0, 0.0, 640.0, 0.0, 900.0, 480.0, 0.0, 0.0, 1.0];

const POSE: [f32; 12] = [0.6, -0.8, 0., 0.8, 0.6, 0., 0., 0., 1., 8., -16., 512.];

/// How many points.
const POINTS: usize = 64;

/// What is seen of the sphere: points that an estimator could deliver, so that each goes all the way.
fn on_the_sphere() -> Vec<[f32; 6]> {
    let [fx, _, cx, _, fy, cy, ..] = CAMERA;
    let [r0, r1, r2, r3, r4, r5, r6, r7, r8, tx, ty, tz] = POSE;
    (0..POINTS)
        .map(|index| {
            let [x, y, z] = (40.0 * on_spiral(index, POINTS).into_inner()).into();
            let depth = r6 * x + r7 * y + r8 * z + tz;
            let a = (r0 * x + r1 * y + r2 * z + tx) / depth;
            let b = (r3 * x + r4 * y + r5 * z + ty) / depth;
            let off = 0.5 * (index % 5) as f32 - 1.0;
            [fx * a + cx + off, fy * b + cy - off, x, y, z, 0.75]
        })
        .collect()
}

/// Direction `index` of `count` on a spiral from pole to pole.
fn on_spiral(index: usize, count: usize) -> UnitDirection {
    let z = 1.0 - (2 * index + 1) as f32 / count as f32;
    let angle = 2.4 * index as f32;
    let side = (1.0 - z * z).sqrt();
    UnitDirection::new_normalize(Vector3::new(side * angle.cos(), side * angle.sin(), z))
}
