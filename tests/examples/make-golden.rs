//! Makes the golden templates and vectors of `tests/golden` that are missing.
//!
//! `cargo run -p cobra-tests --example make-golden`. A file that is there is never overwritten: the
//! files record what was released, and training again would hide that something changed.
//! `tests/tests/golden.rs` says when one may be replaced.

use cobra_agreement::golden::{COMPONENTS, case, decision_name, report_bits, score};
use cobra_infer::{Exponent, Kernel, Metric, Model, Smoothness, Template, UnitDirection};
use cobra_tests::directions::known_directions;
use cobra_train::demo::mechanical_part;
use cobra_train::progress::Silent;
use cobra_train::train::{MeanForm, ReferencePoints, TrainOptions, train};
use std::error::Error;
use std::fmt::Write;
use std::path::Path;

const fn chord(kernel: Kernel) -> Model {
    Model::chord(kernel)
}

const fn angles(kernel: Kernel) -> Model {
    Model {
        metric: Metric::Angles,
        kernel,
    }
}

const ONE: Kernel = Kernel::RationalQuadratic(Exponent::One);

/// What to train.
struct Golden {
    name: &'static str,
    model: Model,
    place: fn(usize) -> ReferencePoints,
    components: usize,
    points: usize,
}

const fn golden(name: &'static str, model: Model, components: usize, points: usize) -> Golden {
    Golden {
        name,
        model,
        place: |components| ReferencePoints::KMeans { components },
        components,
        points,
    }
}

const TEMPLATES: [Golden; 14] = [
    golden("v1-exponent-one", chord(ONE), 4, 200),
    golden(
        "v1-exponent-half",
        chord(Kernel::RationalQuadratic(Exponent::Half)),
        3,
        150,
    ),
    golden(
        "v1-exponent-free",
        chord(Kernel::RationalQuadratic(Exponent::Free)),
        2,
        101,
    ),
    golden("v1-radial-basis", chord(Kernel::RadialBasis), 3, 90),
    golden(
        "v1-matern-half",
        chord(Kernel::Matern(Smoothness::Half)),
        3,
        90,
    ),
    golden(
        "v1-matern-three-halves",
        chord(Kernel::Matern(Smoothness::ThreeHalves)),
        2,
        61,
    ),
    golden(
        "v1-matern-five-halves",
        chord(Kernel::Matern(Smoothness::FiveHalves)),
        2,
        61,
    ),
    golden("v1-linear", chord(Kernel::Linear), 4, 60),
    golden("v1-polynomial", chord(Kernel::Polynomial), 4, 60),
    golden("v1-periodic", chord(Kernel::Periodic), 3, 90),
    golden("v1-angles", angles(ONE), 3, 90),
    golden(
        "v1-angles-matern-three-halves",
        angles(Kernel::Matern(Smoothness::ThreeHalves)),
        2,
        61,
    ),
    golden("v1-angles-periodic", angles(Kernel::Periodic), 2, 61),
    Golden {
        place: |components| ReferencePoints::Em { components },
        ..golden("v1-precisions", chord(ONE), 4, 120)
    },
];

/// The defaults, in so few bytes that a file stays small: validity with compact terms, and with maps.
const CHARTS: [(&str, MeanForm, usize); 2] = [
    ("v1-validity-compact", MeanForm::Process, 2048),
    ("v1-map", MeanForm::Map, 4096),
];

/// Those that were recorded before there was a soft assignment or another threshold than the
/// paper's: these stand in files of their own.
const FIRST: usize = 3;

/// What a file of vectors goes through.
struct Rules {
    assignments: &'static [&'static str],
    /// σ's kind and value, pose, which of the counts, threshold.
    settings: &'static [(&'static str, f32, usize, usize, &'static str)],
}

const FIRST_RULES: Rules = Rules {
    assignments: &["nearest", "maximum"],
    settings: &[
        ("template", 0.0, 0, 0, ""),
        ("template", 1.5, 0, 1, ""),
        ("template", 1.5, 1, 1, ""),
        ("fixed", 2.5, 1, 0, ""),
        ("fixed", 1e-3, 1, 1, ""),
        ("template", 0.0, 2, 1, ""),
        ("template", 1.5, 0, 2, ""),
        ("template", 1.5, 0, 3, ""),
    ],
};

const SOFT_RULES: Rules = Rules {
    assignments: &["soft"],
    settings: FIRST_RULES.settings,
};

const THRESHOLD_RULES: Rules = Rules {
    assignments: &["nearest", "maximum", "soft"],
    settings: &[
        ("template", 1.5, 1, 1, " mean"),
        ("fixed", 2.5, 1, 0, " worst"),
    ],
};

const ALL_RULES: Rules = Rules {
    assignments: &["nearest", "maximum", "soft"],
    settings: &[
        ("template", 0.0, 0, 0, ""),
        ("template", 1.5, 1, 1, " mean"),
        ("fixed", 2.5, 1, 1, " worst"),
        ("template", 1.5, 0, 3, ""),
    ],
};

const CAMERA: [f32; 9] = [900.0, 0.5, 639.5, 0.0, 905.0, 479.5, 0.0, 0.0, 1.0];

/// A turn by 0.6 and 0.8 about the camera's axis: right, off by 6 mm, with the object behind the
/// camera.
const POSES: [[f32; 12]; 3] = [
    [0.6, -0.8, 0., 0.8, 0.6, 0., 0., 0., 1., 10., -20., 500.],
    [0.6, -0.8, 0., 0.8, 0.6, 0., 0., 0., 1., 14., -24., 502.],
    [0.6, -0.8, 0., 0.8, 0.6, 0., 0., 0., 1., 10., -20., -500.],
];

/// Points on the part, whose correspondences come first.
const ON_PART: usize = 24;

fn main() -> Result<(), Box<dyn Error>> {
    for (index, golden) in TEMPLATES.iter().enumerate() {
        let files: &[(&str, &[Rules])] = if index < FIRST {
            &[
                ("", &[FIRST_RULES]),
                ("-soft", &[SOFT_RULES, THRESHOLD_RULES]),
            ]
        } else {
            &[("", &[ALL_RULES])]
        };
        make(golden.name, &options(golden), files)?;
    }
    for (name, mean, budget) in CHARTS {
        let options = TrainOptions {
            reference_points: ReferencePoints::Auto { most: COMPONENTS },
            mean,
            budget: Some(budget),
            ..TrainOptions::new("bracket")
        };
        make(name, &options, &[("", &[ALL_RULES])])?;
    }
    Ok(())
}

/// Trains and records what is missing of a template and its vectors, each a suffix and its rules.
fn make(
    name: &str,
    options: &TrainOptions,
    files: &[(&str, &[Rules])],
) -> Result<(), Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("golden");
    let template = folder.join(format!("{name}.cobra"));
    if !template.exists() {
        let bytes = train(&mechanical_part().into(), options, &Silent)?.bytes;
        std::fs::write(&template, bytes)?;
        println!("made {}", template.display());
    }
    for (suffix, rules) in files {
        let vectors = folder.join(format!("{name}{suffix}.txt"));
        if !vectors.exists() {
            std::fs::write(&vectors, recorded(&std::fs::read(&template)?, rules)?)?;
            println!("made {}", vectors.display());
        }
    }
    Ok(())
}

fn options(golden: &Golden) -> TrainOptions {
    let mut options = TrainOptions::clustered("bracket", 16);
    options.points = golden.points;
    options.test_points = 2000;
    options.reference_points = (golden.place)(golden.components);
    options.fit.model = golden.model;
    options
}

fn recorded(bytes: &[u8], rules: &[Rules]) -> Result<String, Box<dyn Error>> {
    let template = Template::from_bytes(bytes)?;
    let mut text = String::from("# The format is that of `cobra_agreement::golden`.\n");
    line(&mut text, "camera", &CAMERA)?;
    for pose in &POSES {
        line(&mut text, "pose", pose)?;
    }
    let sound = sound_correspondences(&template);
    for correspondence in sound.iter().chain(&BROKEN) {
        line(&mut text, "correspondence", correspondence)?;
    }
    let counts = [sound.len(), ON_PART, 3, sound.len() + BROKEN.len()];
    for Rules {
        assignments,
        settings,
    } in rules
    {
        for assignment in *assignments {
            for likelihood in ["peak", "density"] {
                for (kind, value, pose, count, threshold) in *settings {
                    let (value, delta) = (f32::to_bits(*value), 2.0_f32.to_bits());
                    let count = counts[*count];
                    record(
                        &template,
                        &mut text,
                        &format!(
                            "{assignment} {likelihood} {kind} {value:08x} {delta:08x} 10 {pose} \
                             {count}{threshold}"
                        ),
                    )?;
                }
            }
        }
    }
    Ok(text)
}

/// Appends one case and what it comes to.
fn record(template: &Template<'_>, text: &mut String, words: &str) -> Result<(), Box<dyn Error>> {
    let case = case(&mut words.split_ascii_whitespace()).ok_or("case")?;
    let mut likelihoods = String::new();
    let report = score(template, text, &case, |likelihood| {
        likelihoods += &format!(" {:08x}", likelihood.to_bits());
    })
    .ok_or("vectors")?;
    let [confidence, threshold, weight_sum, inliers] = report_bits(&report);
    writeln!(text, "case {words}\nlikelihoods{likelihoods}")?;
    writeln!(
        text,
        "report {confidence:08x} {threshold:08x} {weight_sum:08x} {inliers:08x} {} {} {}",
        report.points,
        report.behind_camera,
        decision_name(report.decision)
    )?;
    Ok(())
}

fn line(text: &mut String, kind: &str, numbers: &[f32]) -> std::fmt::Result {
    write!(text, "{kind}")?;
    for number in numbers {
        write!(text, " {:08x}", number.to_bits())?;
    }
    writeln!(text)
}

/// Pixel, point and weight of what is finite: points that the template predicts, seen at the first
/// pose, then the awkward ones.
fn sound_correspondences(template: &Template<'_>) -> Vec<[f32; 6]> {
    let components: Vec<_> = template.components().collect();
    let mut all: Vec<[f32; 6]> = (0..ON_PART)
        .map(|i| {
            let component = &components[i % components.len()];
            let known = known_directions(component);
            let direction = known[match component.validity {
                None => 7 * i % known.len(),
                // Cells come row by row, where terms come in any order.
                Some(_) => i * known.len() / ON_PART,
            }];
            let u = UnitDirection::new_unchecked(unit_vector(template, direction).into());
            let d = component.posterior_mean(template.model(), &u);
            let [x, y, z] = component.centre;
            seen(
                [x + d * u.x, y + d * u.y, z + d * u.z],
                0.5 + 0.25 * (i % 4) as f32,
            )
        })
        .collect();
    let [x, y, z] = components[0].centre;
    all.extend([
        seen([x, y, z], 1.0),
        seen([x + 1e-3, y, z], 1.0),
        seen([1e-42, -1e-42, 0.0], 1.0),
        seen([3e4, -2e4, 1e5], 0.125),
        [0.0, 0.0, 0.0, 0.0, -900.0, 1.0],
        [1e-42, 1e-45, 5.0, 5.0, 5.0, 1e-42],
        [639.5, 479.5, 1e30, -1e30, 1e25, 0.25],
        [3e38, 3e38, 1.0, 2.0, 3.0, 0.25],
        [700.0, 500.0, 20.0, 20.0, 20.0, 0.0],
    ]);
    all
}

/// The unit vector of a direction in the metric's coordinates.
fn unit_vector(template: &Template<'_>, direction: [f32; 3]) -> [f32; 3] {
    match template.metric() {
        Metric::Chord => direction,
        Metric::Angles => {
            let [phi, theta, _] = direction;
            let side = phi.sin();
            [side * theta.cos(), side * theta.sin(), phi.cos()]
        }
    }
}

const BROKEN: [[f32; 6]; 4] = [
    [f32::NAN, 480.0, 1.0, 2.0, 3.0, 1.0],
    [640.0, 480.0, f32::INFINITY, 2.0, 3.0, 1.0],
    [640.0, 480.0, 1.0, 2.0, 3.0, f32::NEG_INFINITY],
    [640.0, 480.0, 1.0, 2.0, 3.0, -1.0],
];

fn seen(point: [f32; 3], weight: f32) -> [f32; 6] {
    let [fx, skew, cx, _, fy, cy, ..] = CAMERA;
    let [x, y, z] = point;
    let [r0, r1, r2, r3, r4, r5, r6, r7, r8, tx, ty, tz] = POSES[0];
    let depth = r6 * x + r7 * y + r8 * z + tz;
    let (a, b) = (
        (r0 * x + r1 * y + r2 * z + tx) / depth,
        (r3 * x + r4 * y + r5 * z + ty) / depth,
    );
    [fx * a + skew * b + cx, fy * b + cy, x, y, z, weight]
}
