//! Errors of 4,390 real estimates against the values that were published of them: LM-O, three
//! estimators, github.com/EricCJoyce/Consensus-Driven-Uncertainty. What these were computed of:
//! docs/BOP.md.

use cobra_infer::Camera;
use cobra_tests::data::real_data;
use cobra_tests::tolerance;
use cobra_train::bop::dataset::{Dataset, Scene};
use cobra_train::bop::results::{PoseEstimate, read_results};
use cobra_train::pose::{ModelPoints, add, add_s, mspd, mssd};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::Path;

const ESTIMATORS: [&str; 3] = ["epos", "gdrnpp", "zebrapose"];
/// The objects whose ADD is published as ADD-S.
const SYMMETRIC: [u32; 2] = [10, 11];

/// What was published of an estimate, in millimetres and pixels.
struct Published {
    mssd: f64,
    mspd: f64,
    add: f64,
}

/// By scene, image and object: each estimator has one estimate of an object in an image.
fn published(path: &Path) -> BTreeMap<(u32, u32, u32), Published> {
    let text = std::fs::read_to_string(path).unwrap();
    let rows = text.lines().filter(|line| !line.starts_with('#'));
    rows.map(|line| {
        let fields: Vec<&str> = line.split('\t').collect();
        let [scene, image, object] = [0, 1, 2].map(|i| fields[i].parse().unwrap());
        let number = |i: usize| -> f64 { fields[i].parse().unwrap() };
        let published = Published {
            mssd: 1000.0 * number(15),
            mspd: number(16),
            add: 1000.0 * number(17),
        };
        ((scene, image, object), published)
    })
    .collect()
}

/// Deviations of ADD, ADD-S, MSSD and MSPD, relative to the published value; 0 where not published.
fn deviations(
    estimate: &PoseEstimate,
    published: &Published,
    scene: &Scene,
    model: &ModelPoints,
    camera: &Camera,
) -> [f64; 4] {
    let annotations = scene.truth(estimate.im_id).unwrap();
    let mut same = annotations.iter().filter(|a| a.obj_id == estimate.obj_id);
    let truth = same.next().unwrap().pose;
    let pose = estimate.isometry().unwrap();
    let off = |computed: f64, published: f64| (computed - published).abs() / published;
    let points = model.points();
    let symmetric = SYMMETRIC.contains(&estimate.obj_id);
    [
        if symmetric {
            0.0
        } else {
            off(add(points, &truth, &pose), published.add)
        },
        if symmetric {
            off(add_s(model, &truth, &pose), published.add)
        } else {
            0.0
        },
        off(mssd(points, &truth, &pose, &[]), published.mssd),
        off(mspd(points, camera, &truth, &pose, &[]), published.mspd),
    ]
}

#[test]
fn errors_of_all_real_estimates_agree_with_the_published_ones() {
    let Some(data) = real_data("published errors of real estimates") else {
        return;
    };
    let folder = data.join("lmo");
    let dataset = Dataset::open(&folder, "test").unwrap();
    let scene = dataset.scene(2).unwrap();
    let models = dataset.models("models_eval").unwrap();
    let points: BTreeMap<u32, ModelPoints> = models
        .objects()
        .unwrap()
        .into_iter()
        .map(|object| (object, ModelPoints::of(&models.geometry(object).unwrap())))
        .collect();
    let mut rows = 0;
    let mut largest = [0.0_f64; 4];
    for name in ESTIMATORS {
        let results = read_results(&folder.join(format!("estimates/{name}_lmo-test.csv"))).unwrap();
        let published = published(&folder.join(format!("cdu_bop_metrics/lmo-{name}.txt")));
        let found: Vec<[f64; 4]> = results
            .rows
            .par_iter()
            .map(|row| {
                let estimate = row.estimate.as_ref().unwrap();
                let id = (estimate.scene_id, estimate.im_id, estimate.obj_id);
                let camera = scene.camera(estimate.im_id).unwrap().camera;
                let model = &points[&estimate.obj_id];
                deviations(estimate, &published[&id], &scene, model, &camera)
            })
            .collect();
        rows += found.len();
        for row in found {
            largest = std::array::from_fn(|i| largest[i].max(row[i]));
        }
    }
    assert_eq!(rows, 4390);
    let [add, add_s, mssd, mspd] = largest;
    assert!(
        largest.iter().all(|off| *off <= tolerance::PUBLISHED_ERROR),
        "largest relative deviation: ADD {add:e}, ADD-S {add_s:e}, MSSD {mssd:e}, MSPD {mspd:e}"
    );
}
