//! Writes points of a mesh for other programs to train and score on, and measures training a template
//! of the same mesh on as many points and scoring the same ones here: `benches/peers/run`.
//!
//! The template is the default one, and its map beside it; its charts choose as many training points
//! from four times as many, so that these are not one by one those that are written.
//!
//! `cargo run --release -p cobra-train --example same-points -- MESH FOLDER`: `training.csv` and
//! `test.csv` in the unit sphere, `x,y,z` a line; the measurements as JSON on standard output.

use cobra_infer::template::DecodedTerm;
use cobra_infer::{Mixture, ScoreError, Settings, Template};
use cobra_train::evaluate::{Evaluation, evaluate, evaluation_points};
use cobra_train::output::write_whole;
use cobra_train::progress::Silent;
use cobra_train::random::Purpose;
use cobra_train::surface::{Geometry, RayCaster, read_mesh, sample_visible};
use cobra_train::train::{LARGEST_TEMPLATE, MAP_BUDGET, MeanForm, TrainOptions, train};
use kiddo::{ImmutableKdTree, SquaredEuclidean};
use nalgebra::Point3;
use serde_json::json;
use std::error::Error;
use std::hint::black_box;
use std::path::PathBuf;
use std::time::Instant;

/// As many as `cobra eval` measures on.
const TEST_POINTS: usize = 30_000;

/// The first so many of the test points are scored.
const QUERIES: usize = 1_000;

/// How often training and scoring are measured; medians are told.
const TRAININGS: usize = 5;
const SCORINGS: usize = 200;

fn main() -> Result<(), Box<dyn Error>> {
    let paths: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let [mesh, folder] = paths.as_slice() else {
        return Err("usage: same-points MESH FOLDER".into());
    };
    let (object, _) = Geometry::from(read_mesh(mesh)?).into_unit_sphere();
    let Geometry::Mesh(surface) = &object else {
        return Err("expected a mesh".into());
    };
    let caster = RayCaster::new(surface);
    let options = TrainOptions::new("same points");
    let baked = TrainOptions {
        mean: MeanForm::Map,
        budget: Some(MAP_BUDGET),
        ..options.clone()
    };

    let drawn = options.points + options.test_points;
    let training: Vec<Point3<f64>> =
        sample_visible(surface, &caster, drawn, options.seed, Purpose::Training)?
            .iter()
            .take(options.points)
            .map(|point| point.position)
            .collect();
    let test = evaluation_points(&object, TEST_POINTS, options.seed)?;
    write_whole(&folder.join("training.csv"), table(&training).as_bytes())?;
    write_whole(&folder.join("test.csv"), table(&test).as_bytes())?;

    let trained = train(&object, &options, &Silent)?;
    let training_seconds = median(TRAININGS, || train(&object, &options, &Silent));

    let map = train(&object, &baked, &Silent)?;

    let template = Template::from_bytes(&trained.bytes)?;
    let map = Template::from_bytes(&map.bytes)?;
    let queries = &test[..QUERIES];
    let single: Vec<Point3<f32>> = queries.iter().map(|point| point.cast()).collect();
    let scoring_seconds = scoring(&template, &single)?;
    let map_scoring_seconds = scoring(&map, &single)?;
    let cloud: Vec<[f32; 3]> = training.iter().map(|p| p.cast::<f32>().into()).collect();
    let tree = ImmutableKdTree::<f32, 3>::new_from_slice(&cloud)
        .map_err(|error| format!("k-d tree: {error:?}"))?;
    let nearest_point_seconds = median(SCORINGS, || {
        let squared = single.iter().map(|point| {
            tree.query(&<[f32; 3]>::from(*point))
                .nearest_one::<SquaredEuclidean<f32>>()
                .execute()
                .distance
        });
        squared.sum::<f32>()
    });
    let mesh_seconds = median(SCORINGS, || {
        let distances = queries.iter().map(|point| caster.distance(point));
        distances.sum::<f64>()
    });

    let Evaluation {
        shape, residual, ..
    } = evaluate(&template, settings(&template).assignment, &test)?;
    let document = json!({
        "training_points": training.len(),
        "queries": queries.len(),
        "components": template.component_count(),
        "template_bytes": trained.bytes.len(),
        "training_threads": rayon::current_num_threads(),
        "training_seconds": training_seconds,
        "scoring_seconds": scoring_seconds,
        "map_scoring_seconds": map_scoring_seconds,
        "nearest_point_seconds": nearest_point_seconds,
        "mesh_distance_seconds": mesh_seconds,
        "f_score": shape.f_score,
        "chamfer": shape.chamfer,
        "rms": residual.rms,
    });
    println!("{document:#}");
    Ok(())
}

fn settings(template: &Template<'_>) -> Settings {
    Settings::for_template(template, 0.01)
}

/// The median time that the likelihoods of all points take, on one core.
fn scoring(template: &Template<'_>, points: &[Point3<f32>]) -> Result<f64, ScoreError> {
    // As a host scores.
    let mut room = vec![DecodedTerm::default(); template.decoded_len()];
    let decoded = template.decoded(&mut room);
    let template = decoded.as_ref().unwrap_or(template);
    let mixture = Mixture::<LARGEST_TEMPLATE>::new(template, &settings(template))?;
    Ok(median(SCORINGS, || {
        let found = points.iter().filter_map(|point| mixture.evaluate(point));
        found.map(|found| found.likelihood).sum::<f32>()
    }))
}

fn table(points: &[Point3<f64>]) -> String {
    let line = |p: &Point3<f64>| format!("{},{},{}\n", p.x, p.y, p.z);
    points.iter().map(line).collect()
}

/// The median of the seconds that `routine` takes, after as many runs as a tenth to warm up.
fn median<T>(runs: usize, mut routine: impl FnMut() -> T) -> f64 {
    for _ in 0..runs / 10 {
        black_box(routine());
    }
    let mut seconds: Vec<f64> = (0..runs)
        .map(|_| {
            let start = Instant::now();
            black_box(routine());
            start.elapsed().as_secs_f64()
        })
        .collect();
    seconds.sort_by(f64::total_cmp);
    (seconds[(runs - 1) / 2] + seconds[runs / 2]) / 2.0
}
