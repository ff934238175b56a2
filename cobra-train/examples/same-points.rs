//! Writes the points that a template of a mesh is trained and tested on, for other programs to train
//! and score on the same, and measures training and scoring them here: `benches/peers/run`.
//!
//! `cargo run --release -p cobra-train --example same-points -- MESH FOLDER`: `training.csv` and
//! `test.csv` in the unit sphere, `x,y,z` a line; the measurements as JSON on standard output.

use cobra_infer::{Mixture, Settings, Template};
use cobra_train::evaluate::{Evaluation, evaluate, evaluation_points};
use cobra_train::output::write_whole;
use cobra_train::progress::Silent;
use cobra_train::random::Purpose;
use cobra_train::surface::{Geometry, RayCaster, read_mesh, sample_visible};
use cobra_train::train::{LARGEST_TEMPLATE, TrainOptions, train};
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
    // Clusters: others than charts are not trained on all points that are drawn.
    let options = TrainOptions::clustered("same points", 16);

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

    let template = Template::from_bytes(&trained.bytes)?;
    let settings = Settings::with_delta(template.radius());
    let queries = &test[..QUERIES];
    let single: Vec<Point3<f32>> = queries.iter().map(|point| point.cast()).collect();
    Mixture::<LARGEST_TEMPLATE>::new(&template, &settings)?;
    let scoring_seconds = median(SCORINGS, || {
        let mixture = Mixture::<LARGEST_TEMPLATE>::new(&template, &settings).ok()?;
        let found = single.iter().filter_map(|point| mixture.evaluate(point));
        Some(found.map(|found| found.likelihood).sum::<f32>())
    });
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
    } = evaluate(&template, settings.assignment, &test)?;
    let document = json!({
        "training_points": training.len(),
        "queries": queries.len(),
        "components": template.component_count(),
        "template_bytes": trained.bytes.len(),
        "training_threads": rayon::current_num_threads(),
        "training_seconds": training_seconds,
        "scoring_seconds": scoring_seconds,
        "nearest_point_seconds": nearest_point_seconds,
        "mesh_distance_seconds": mesh_seconds,
        "f_score": shape.f_score,
        "chamfer": shape.chamfer,
        "rms": residual.rms,
    });
    println!("{document:#}");
    Ok(())
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
