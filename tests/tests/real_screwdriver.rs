//! The paper's industrial case: its decisions on four real poses, its shape metrics.

use cobra_infer::{Assignment, Decision, Report, Settings, Sigma, Template, Threshold, score};
use cobra_tests::data::real_data;
use cobra_tests::tolerance;
use cobra_train::evaluate::evaluate;
use cobra_train::input::{
    CorrespondenceOptions, Estimate, Weighting, read_camera, read_correspondences, read_estimates,
};
use cobra_train::progress::Silent;
use cobra_train::random::Purpose;
use cobra_train::surface::{Mesh, RayCaster, read_mesh, sample_visible};
use cobra_train::train::{LARGEST_TEMPLATE, ReferencePoints, TrainOptions, train};
use nalgebra::{Matrix3, Point3, Vector3};
use std::path::Path;

/// The standard deviation that the authors' own code scores these poses with, in millimetres.
const SIGMA: f32 = 1.93;
const DELTA: f32 = 2.0;

/// Image, the confidence with exact distances to the mesh, and whether the authors accepted it.
const PUBLISHED: [(&str, f64, bool); 4] = [
    ("61", 0.844, true),
    ("433", 0.731, true),
    ("292", 0.319, false),
    ("74", 0.064, false),
];

const ALL_ROWS: CorrespondenceOptions = CorrespondenceOptions {
    weighting: Weighting::Uniform,
    inliers_only: false,
};

/// A pose in double precision, its matrix as it comes.
struct Raw {
    r: Matrix3<f64>,
    t: Vector3<f64>,
}

impl Raw {
    /// As the file has it, whether it is a rotation or not.
    fn of_file(folder: &Path, image: &str) -> Self {
        let text = std::fs::read_to_string(folder.join("est_poses.json")).unwrap();
        let document: serde_json::Value = serde_json::from_str(&text).unwrap();
        let numbers = |key: &str| -> Vec<f64> {
            let list = document[image][0][key].as_array().unwrap();
            list.iter().map(|number| number.as_f64().unwrap()).collect()
        };
        Self {
            r: Matrix3::from_row_slice(&numbers("cam_R_m2c")),
            t: Vector3::from_column_slice(&numbers("cam_t_m2c")),
        }
    }

    /// As the scorer has it: the nearest rotation.
    fn of_estimate(estimate: &Estimate) -> Self {
        Self {
            r: estimate.pose.rotation().matrix().cast(),
            t: estimate.pose.translation().cast(),
        }
    }
}

fn camera_matrix(folder: &Path) -> Matrix3<f64> {
    let text = std::fs::read_to_string(folder.join("K.txt")).unwrap();
    let numbers = text
        .split(|c: char| c == ',' || c.is_whitespace())
        .filter(|word| !word.is_empty())
        .map(|word| word.parse().unwrap());
    Matrix3::from_row_iterator(numbers)
}

/// Eq. 10 with the mesh itself in the template's place.
fn exact_confidence(folder: &Path, image: &str, caster: &RayCaster, pose: &Raw) -> f64 {
    let inverse = camera_matrix(folder).try_inverse().unwrap();
    let file = folder.join(format!("correspondences/{image}_corr.txt"));
    let rows = read_correspondences(&file, ALL_ROWS).unwrap();
    let sum: f64 = rows
        .iter()
        .map(|row| {
            let pixel = row.pixel.cast::<f64>();
            let ray = inverse * Vector3::new(pixel.x, pixel.y, 1.0);
            let seen = pose.r * row.point.coords.cast::<f64>() + pose.t;
            let depth = ray.dot(&seen) / ray.norm_squared();
            let back = Point3::from(pose.r.transpose() * (ray * depth - pose.t));
            (-0.5 * (caster.distance(&back) / f64::from(SIGMA)).powi(2)).exp()
        })
        .sum();
    sum / rows.len() as f64
}

fn trained(mesh: &Mesh, components: usize, seed: u64) -> Vec<u8> {
    trained_around(mesh, ReferencePoints::KMeans { components }, seed)
}

fn trained_around(mesh: &Mesh, reference_points: ReferencePoints, seed: u64) -> Vec<u8> {
    let options = TrainOptions {
        reference_points,
        seed,
        ..TrainOptions::clustered("screwdriver", 16)
    };
    train(&mesh.clone().into(), &options, &Silent)
        .unwrap()
        .bytes
}

fn settings() -> Settings {
    Settings {
        sigma: Sigma::Fixed(SIGMA),
        ..Settings::with_delta(DELTA)
    }
}

fn report(
    folder: &Path,
    template: &Template<'_>,
    settings: &Settings,
    estimate: &Estimate,
) -> Report {
    let cameras = read_camera(&folder.join("K.txt")).unwrap();
    let camera = cameras.for_image(&estimate.image).unwrap().camera;
    let file = folder.join(format!("correspondences/{}_corr.txt", estimate.image));
    let rows = read_correspondences(&file, ALL_ROWS).unwrap();
    score::<LARGEST_TEMPLATE>(template, &camera, &estimate.pose, settings, &rows).unwrap()
}

#[test]
fn the_four_real_poses_are_decided_as_the_paper_decides_them() {
    let Some(data) = real_data("the screwdriver") else {
        return;
    };
    let folder = data.join("screwdriver");
    let mesh = read_mesh(&folder.join("model.ply")).unwrap();
    let caster = RayCaster::new(&mesh);
    let estimates = read_estimates(&folder.join("est_poses.json")).unwrap();
    for seed in 0..3 {
        let bytes = trained(&mesh, 10, seed);
        let template = Template::from_bytes(&bytes).unwrap();
        for (image, published, accepted) in PUBLISHED {
            let estimate = estimates.iter().find(|e| e.id == image).unwrap();
            let raw = exact_confidence(&folder, image, &caster, &Raw::of_file(&folder, image));
            assert!(
                (raw - published).abs() < tolerance::EXACT_CONFIDENCE,
                "{image}: {raw}"
            );
            let exact = exact_confidence(&folder, image, &caster, &Raw::of_estimate(estimate));

            let report = report(&folder, &template, &settings(), estimate);
            let confidence = f64::from(report.confidence);
            println!(
                "seed {seed}, pose {image}: {confidence:.3}, exact {exact:.3} (as in the file \
                 {raw:.3}), threshold {:.3}, {}",
                report.threshold,
                report.decision.name()
            );
            let decision = if accepted { "accept" } else { "reject" };
            assert_eq!(
                report.decision.name(),
                decision,
                "seed {seed}, pose {image}"
            );
            for exact in [exact, raw, published] {
                let off = (confidence - exact).abs();
                assert!(off < tolerance::REAL_CONFIDENCE, "{image}: off by {off}");
            }
        }
    }
}

#[test]
fn with_ems_precisions_a_mixture_decides_the_four_real_poses_as_single_components_do() {
    let Some(data) = real_data("the screwdriver") else {
        return;
    };
    let folder = data.join("screwdriver");
    let mesh = read_mesh(&folder.join("model.ply")).unwrap();
    let estimates = read_estimates(&folder.join("est_poses.json")).unwrap();
    let bytes = trained_around(&mesh, ReferencePoints::Em { components: 10 }, 0);
    let template = Template::from_bytes(&bytes).unwrap();
    for (assignment, threshold) in [
        (Assignment::Nearest, Threshold::Paper),
        (Assignment::Maximum, Threshold::Paper),
        (Assignment::Soft, Threshold::Paper),
        // A mixture lies below its best component: under the worst case it would lose pose 433.
        (Assignment::Nearest, Threshold::Worst),
        (Assignment::Maximum, Threshold::Worst),
    ] {
        let settings = Settings {
            assignment,
            threshold,
            ..settings()
        };
        for (image, _, accepted) in PUBLISHED {
            let estimate = estimates.iter().find(|e| e.id == image).unwrap();
            let report = report(&folder, &template, &settings, estimate);
            let name = format!("{assignment:?}, {threshold:?}, pose {image}: {report:?}");
            println!("{name}");
            assert_eq!(report.decision == Decision::Accept, accepted, "{name}");
        }
    }
}

#[test]
fn sixteen_components_reproduce_the_screwdriver() {
    let Some(data) = real_data("the screwdriver") else {
        return;
    };
    let mesh = read_mesh(&data.join("screwdriver/model.ply")).unwrap();
    let sphere = mesh.bounding_sphere();
    let unit = mesh.normalised(&sphere);
    let caster = RayCaster::new(&unit);
    for seed in 0..3 {
        let points: Vec<Point3<f64>> =
            sample_visible(&unit, &caster, 30_000, seed, Purpose::Evaluation)
                .unwrap()
                .iter()
                .map(|point| sphere.denormalise(&point.position))
                .collect();
        let bytes = trained(&mesh, 16, seed);
        let template = Template::from_bytes(&bytes).unwrap();
        let shape = evaluate(&template, Assignment::Nearest, &points)
            .unwrap()
            .shape;
        println!("seed {seed}: {shape:?}");
        assert!(shape.f_score >= 95.0, "seed {seed}: {shape:?}");
        assert!(shape.chamfer <= 0.05, "seed {seed}: {shape:?}");
    }
}
