//! Makes the agreement vectors of `tests/golden/agreement` that are empty.
//!
//! `cargo run -p cobra-tests --example make-agreement`. A file with content is never overwritten:
//! what was recorded on one machine is what every other must reproduce. A new set's files have to
//! be created empty, because the library includes them.

use cobra_agreement::vectors;
use cobra_infer::template::{Component, HEADER_LENGTH};
use cobra_infer::validity::{BoxGrid, Cell, direction};
use cobra_infer::{Exponent, Kernel, Model, Template, UnitDirection, tolerance};
use cobra_tests::directions::known_directions;
use cobra_tests::points_file::points_file;
use cobra_train::demo::mechanical_part;
use cobra_train::progress::Silent;
use cobra_train::train::{MeanForm, ReferencePoints, TrainOptions, train};
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::error::Error;
use std::path::Path;

const CAMERA: [f32; 9] = [900.0, 0.0, 640.0, 0.0, 900.0, 480.0, 0.0, 0.0, 1.0];

/// Half a turn about the camera's y axis, so that points at reference points come back exactly;
/// another that leans by 53 degrees; turned oddly and damaged as published pose files are, by up to 0.1.
const POSES: [[f32; 12]; 3] = [
    [-1., 0., 0., 0., 1., 0., 0., 0., -1., 8., -16., 512.],
    [-1., 0., 0., 0., 0.6, 0.8, 0., 0.8, -0.6, 8., -16., 512.],
    [
        -0.953, 0.024, -0.0113, 0.017, 1.037, 0.0092, 0.0079, -0.0134, -1.041, 8.7, -15.3, 511.2,
    ],
];

const CORRESPONDENCES: usize = 2000;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("golden/agreement");
    for (index, (name, options)) in trainings().into_iter().enumerate() {
        let file = |ending: &str| folder.join(format!("{name}.{ending}"));
        let write_new = |ending: &str, make: &dyn Fn() -> Result<Vec<u8>, Box<dyn Error>>| {
            let path = file(ending);
            let mut bytes = std::fs::read(&path)?;
            if bytes.is_empty() {
                bytes = make()?;
                std::fs::write(&path, &bytes)?;
                println!("made {}", path.display());
            }
            Ok::<_, Box<dyn Error>>(bytes)
        };
        let template = write_new("cobra", &|| {
            let bytes = train(&mechanical_part().into(), &options, &Silent)?.bytes;
            narrowed(bytes)
        })?;
        let points = write_new("points", &|| {
            let template = Template::from_bytes(&template)?;
            let rows = correspondences(&template, index as u64);
            Ok(points_file(&CAMERA, &POSES, &rows))
        })?;
        write_new("expected", &|| {
            let mut bytes = Vec::new();
            vectors::score(&template, &points, |word| {
                bytes.extend(word.to_le_bytes());
            })
            .map_err(|unreadable| format!("{unreadable:?}"))?;
            Ok(bytes)
        })?;
    }
    Ok(())
}

/// The sets by name, and how their templates are trained.
fn trainings() -> [(&'static str, TrainOptions); 5] {
    let em = ReferencePoints::Em { components: 3 };
    // Where a pixel comes back to it exactly.
    let given = ReferencePoints::Given(vec![[2.0, -4.0, 8.0].into()]);
    let k_means = ReferencePoints::KMeans { components: 4 };
    [
        ("k-means", everywhere(Exponent::Half, k_means, 240)),
        ("em", everywhere(Exponent::One, em, 200)),
        ("tiny", everywhere(Exponent::One, given, 20)),
        ("charts", where_verified(MeanForm::Process, 4096)),
        ("map", where_verified(MeanForm::Map, 8192)),
    ]
}

/// Components that speak everywhere, of terms in `f32`.
fn everywhere(
    exponent: Exponent,
    reference_points: ReferencePoints,
    points: usize,
) -> TrainOptions {
    let mut options = TrainOptions::clustered("bracket", 16);
    options.points = points;
    options.test_points = 2000;
    options.reference_points = reference_points;
    options.fit.model = Model::chord(Kernel::RationalQuadratic(exponent));
    options
}

/// Charts with validity, and compact terms or maps: the defaults, but of few bytes, so that a set fits
/// into the smallest board's flash.
fn where_verified(mean: MeanForm, budget: usize) -> TrainOptions {
    TrainOptions {
        reference_points: ReferencePoints::Auto {
            most: vectors::COMPONENTS,
        },
        mean,
        budget: Some(budget),
        ..TrainOptions::new("bracket")
    }
}

/// The template with every other component's box narrower along each axis: a trained box holds all
/// that its component says, and this has some of it silenced.
fn narrowed(mut bytes: Vec<u8>) -> Result<Vec<u8>, Box<dyn Error>> {
    let boxes: Vec<([u8; 3], [u8; 3])> = Template::from_bytes(&bytes)?
        .components()
        .filter_map(|component| Some((component.validity?.low(), component.validity?.high())))
        .step_by(2)
        .collect();
    for (low, high) in boxes {
        let same = |record: &[u8]| record[..3] == low && record[4..] == high;
        let place = bytes.windows(7).position(same).ok_or("no such box")?;
        for axis in 0..3 {
            let by = (high[axis] - low[axis]) / 8;
            bytes[place + axis] += by;
            bytes[place + 4 + axis] -= by;
        }
    }
    let checksum = checksum(&bytes[HEADER_LENGTH..]);
    bytes[12..HEADER_LENGTH].copy_from_slice(&checksum.to_le_bytes());
    Ok(bytes)
}

/// The format's, CRC-32/ISO-HDLC.
fn checksum(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |sum, byte| {
        (0..8).fold(sum ^ u32::from(*byte), |sum, _| {
            (sum >> 1) ^ (0xedb8_8320 & 0_u32.wrapping_sub(sum & 1))
        })
    })
}

/// Points on and off the predicted surface, mixed with everything awkward.
fn correspondences(template: &Template<'_>, seed: u64) -> Vec<[f32; 6]> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let components: Vec<_> = template.components().collect();
    let mut all = awkward(template);
    if template.has_validity() {
        all.extend(at_edges(template));
        all.extend(in_silence(template, &mut random));
    }
    let known: Vec<_> = components.iter().map(known_directions).collect();
    while all.len() < CORRESPONDENCES {
        let component = &components[all.len() % components.len()];
        let known = &known[all.len() % components.len()];
        let direction = known[random.random_range(0..known.len())];
        let mut jitter = |size: f32| random.random_range(-size..=size);
        let [x, y, z] = direction.map(|c| c + jitter(0.05));
        let u = UnitDirection::new_normalize([x, y, z].into());
        let off = match all.len() % 8 {
            0 => jitter(40.0),
            1 | 2 => jitter(6.0),
            _ => jitter(1.0),
        };
        let distance = component.posterior_mean(template.model(), &u) + off;
        let [cx, cy, cz] = component.centre;
        let point = [
            cx + distance * u.x,
            cy + distance * u.y,
            cz + distance * u.z,
        ];
        let mut row = seen(point, 1.0);
        let pixels = if all.len() % 10 == 3 { 30.0 } else { 1.0 };
        row[0] += jitter(pixels);
        row[1] += jitter(pixels);
        row[5] = match all.len() % 5 {
            0 => 1.0,
            1 => 0.0625,
            _ => jitter(0.5) + 0.5,
        };
        all.push(row);
    }
    // Among the others, not before them: a sum that starts odd would hide less.
    let stride = 389;
    (0..CORRESPONDENCES)
        .map(|i| all[i * stride % CORRESPONDENCES])
        .collect()
}

fn awkward(template: &Template<'_>) -> Vec<[f32; 6]> {
    let mut all = Vec::new();
    for component in template.components() {
        let [x, y, z] = component.centre;
        // On the reference point, next to it, and at its poles.
        for (dx, dz) in [(0.0, 0.0), (1e-3, 0.0), (1e-5, 1e-5)] {
            all.push(seen([x + dx, y, z + dz], 1.0));
        }
        for u in [[0., 0., 1.], [0., 0., -1.], [1., 0., 0.], [0., -1., 0.]] {
            let direction = UnitDirection::new_unchecked(u.into());
            let d = component.posterior_mean(template.model(), &direction);
            let point = [x + d * u[0], y + d * u[1], z + d * u[2]];
            all.push(seen(point, 1.0));
        }
    }
    all.extend(on_the_axis(template));
    let sound = seen([20.0, 30.0, 5.0], 1.0);
    for place in 0..6 {
        for value in [
            f32::NAN,
            f32::INFINITY,
            f32::NEG_INFINITY,
            f32::from_bits(0x7f80_0001),
            f32::from_bits(1),
            -f32::from_bits(0x007f_ffff),
            f32::MAX,
            f32::MIN_POSITIVE,
            0.0,
            -0.0,
        ] {
            // One weight of that size would silence all the others.
            if place == 5 && value == f32::MAX {
                continue;
            }
            let mut row = sound;
            row[place] = value;
            all.push(row);
        }
    }
    for (point, weight) in [
        ([3e4, -2e4, 100.0], 0.125),
        ([1e18, 1e18, -1e18], 0.5),
        ([1e25, -1e25, -1e30], 0.5),
        ([1e-42, -1e-42, 1e-40], 1.0),
        ([10.0, 10.0, 900.0], 1.0),
        ([10.0, 10.0, 512.0], 1.0),
        ([20.0, 20.0, 20.0], 0.0),
        ([20.0, 20.0, 20.0], 1e-42),
        ([20.0, 20.0, 20.0], -1.0),
    ] {
        all.push(seen(point, weight));
    }
    all
}

/// Points that come back to where a reference point has no direction to them: pixels around where it
/// is seen are tried until one does through the first pose.
fn on_the_axis(template: &Template<'_>) -> Vec<[f32; 6]> {
    let camera = cobra_infer::Camera::from_matrix(CAMERA).expect("a camera");
    let numbers = POSES[0];
    let (r, t) = numbers.split_first_chunk::<9>().expect("nine numbers");
    let pose = cobra_infer::Pose::from_row_major(*r, *t.first_chunk().expect("three")).expect("R");
    let mut found = Vec::new();
    for component in template.components() {
        let row = seen(component.centre, 1.0);
        let step = |value: f32, by: i32| f32::from_bits(value.to_bits().wrapping_add_signed(by));
        'search: for du in -20..20 {
            for dv in -20..20 {
                for dz in -6..6 {
                    let tried = [
                        step(row[0], du),
                        step(row[1], dv),
                        row[2],
                        row[3],
                        step(row[4], dz),
                        1.0,
                    ];
                    let back = camera.back_project(
                        &pose,
                        &[tried[0], tried[1]].into(),
                        &[tried[2], tried[3], tried[4]].into(),
                    );
                    let away = back.point.coords - Vector3::from(component.centre);
                    if away.norm() < 0.5 * tolerance::NO_DIRECTION * template.radius() {
                        found.push(tried);
                        break 'search;
                    }
                }
            }
        }
    }
    assert!(
        !found.is_empty(),
        "no pixel comes back to a reference point"
    );
    found
}

/// What the component predicts in this direction.
fn predicted(template: &Template<'_>, component: &Component<'_>, u: [f32; 3]) -> [f32; 3] {
    let d = component.posterior_mean(template.model(), &UnitDirection::new_unchecked(u.into()));
    let ([x, y, z], [a, b, c]) = (component.centre, u);
    [x + d * a, y + d * b, z + d * c]
}

/// Where validity changes its mind: on the borders of cells beside which the component is silent, and
/// where what it predicts lies closest to each side of its box, within and without.
fn at_edges(template: &Template<'_>) -> Vec<[f32; 6]> {
    let boxes = BoxGrid::new(template.centre(), template.radius());
    let step = template.radius() / 64.0;
    let mut all = Vec::new();
    for component in template.components() {
        let Some(valid) = component.validity else {
            continue;
        };
        let at = |cell, place| {
            let u = direction(valid.pole(), valid.side(), cell, place);
            predicted(template, &component, u)
        };
        let borders = valid.cells().filter_map(|cell| {
            let column = cell.column + 1;
            let beside = Cell { column, ..cell };
            let silent = column < valid.side() && !valid.contains(beside);
            silent.then(|| at(cell, [1.0, 0.5]))
        });
        all.extend(borders.step_by(5).take(8).map(|point| seen(point, 1.0)));
        let places = [0.0, 0.25, 0.5, 0.75, 1.0];
        let points: Vec<[f32; 3]> = valid
            .cells()
            .flat_map(|cell| places.map(|a| places.map(|b| at(cell, [a, b]))))
            .flatten()
            .collect();
        for axis in 0..3 {
            let corner = template.centre()[axis] - template.radius();
            let (low, high) = (valid.low()[axis], valid.high()[axis]);
            for edge in [f32::from(low), f32::from(high) + 1.0] {
                let edge = corner + edge * step;
                let inside =
                    |point: &&[f32; 3]| (low..=high).contains(&boxes.position(**point)[axis]);
                let away = |a: &&[f32; 3], b: &&[f32; 3]| {
                    let [a, b] = [a, b].map(|point| (point[axis] - edge).abs());
                    a.total_cmp(&b)
                };
                let (within, without): (Vec<_>, Vec<_>) = points.iter().partition(inside);
                let closest = [within, without].map(|of| of.into_iter().min_by(away));
                all.extend(closest.into_iter().flatten().map(|point| seen(*point, 1.0)));
            }
        }
    }
    all
}

/// Places in the bounding sphere that no component has a valid direction to.
fn in_silence(template: &Template<'_>, random: &mut ChaCha8Rng) -> Vec<[f32; 6]> {
    let (centre, radius) = (template.centre(), template.radius());
    let silent = |point: &[f32; 3]| {
        template.components().all(|component| {
            let [x, y, z] = component.centre;
            let offset = [point[0] - x, point[1] - y, point[2] - z];
            !component
                .validity
                .is_some_and(|valid| valid.contains_direction(offset))
        })
    };
    let anywhere =
        std::iter::repeat_with(|| centre.map(|c| c + radius * random.random_range(-1.0..=1.0)));
    let places = anywhere.take(100_000).filter(silent).take(60);
    places.map(|point| seen(point, 0.5)).collect()
}

/// The row whose pixel is where `point` is seen at the first pose.
fn seen(point: [f32; 3], weight: f32) -> [f32; 6] {
    let [fx, _, cx, _, fy, cy, ..] = CAMERA;
    let [x, y, z] = point;
    let [r0, r1, r2, r3, r4, r5, r6, r7, r8, tx, ty, tz] = POSES[0];
    let depth = r6 * x + r7 * y + r8 * z + tz;
    let a = (r0 * x + r1 * y + r2 * z + tx) / depth;
    let b = (r3 * x + r4 * y + r5 * z + ty) / depth;
    [fx * a + cx, fy * b + cy, x, y, z, weight]
}
