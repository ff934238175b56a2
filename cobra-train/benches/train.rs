//! What training costs on all cores: the whole, and the steps that take most of it.

mod support;

use cobra_train::gp;
use cobra_train::progress::Silent;
use cobra_train::random::{Purpose, stream};
use cobra_train::reference::{Cluster, kmeans, members, most_explanatory};
use cobra_train::surface::{RayCaster, sample_visible};
use cobra_train::train::{PLACEMENTS, TrainOptions, train};
use criterion::{Criterion, SamplingMode};
use nalgebra::Point3;
use rayon::prelude::*;
use std::time::Duration;
use support::{Object, Size, Table, objects};

fn main() {
    let size = Size::from_arguments();
    let mut criterion = Criterion::default()
        .warm_up_time(Duration::from_millis(1))
        .measurement_time(Duration::from_secs(1))
        .configure_from_args();
    for (index, object) in objects().iter().enumerate() {
        let options = size.train_options();
        let mut group = criterion.benchmark_group(format!("train/{}", object.name));
        group.sampling_mode(SamplingMode::Flat);
        let mut table = Table::new(&mut group, 10);
        table.bench("whole", || {
            train(&object.mesh.clone().into(), &options, &Silent)
                .expect("both objects can be trained")
        });
        // They cost as much as the whole again: those of one object have to do.
        if index == 0 {
            bench_steps(&mut table, object, &size, &options);
        }
        table.print(&format!(
            "{}, {} points, {} threads",
            object.name,
            size.points,
            rayon::current_num_threads()
        ));
        group.finish();
    }
    criterion.final_summary();
}

fn bench_steps(table: &mut Table<'_, '_>, object: &Object, size: &Size, options: &TrainOptions) {
    table.bench("sampling", || sample(object, size));
    let mut points = sample(object, size);
    points.truncate(size.points);
    let place = || {
        kmeans(&points, size.components, PLACEMENTS, options.seed)
            .expect("there are more points than components")
    };
    table.bench("k-means", place);
    let placements: Vec<Vec<Cluster>> = place()
        .into_iter()
        .map(|centres| centres.into_iter().map(Cluster::round).collect())
        .collect();
    let choose = |placements| {
        most_explanatory(&points, placements, options.seed).expect("there are several placements")
    };
    table.bench("choosing a placement", || choose(placements.clone()));
    let clusters = choose(placements);
    table.bench("fitting", || fit(&points, &clusters, options));
}

fn sample(object: &Object, size: &Size) -> Vec<Point3<f64>> {
    let unit = object.mesh.normalised(&object.mesh.bounding_sphere());
    let wanted = size.points + size.test_points;
    sample_visible(&unit, &RayCaster::new(&unit), wanted, 0, Purpose::Training)
        .expect("both objects show their surface")
        .iter()
        .map(|point| point.position)
        .collect()
}

fn fit(points: &[Point3<f64>], clusters: &[Cluster], options: &TrainOptions) -> Vec<gp::FittedGp> {
    let members = members(points, clusters);
    let fitted = members.par_iter().zip(clusters).enumerate();
    fitted
        .map(|(component, (members, cluster))| {
            let purpose = Purpose::HyperparameterSubset;
            let mut rng = stream(options.seed, purpose, component as u64);
            gp::fit(&cluster.centre(), members, &options.fit, &mut rng)
                .expect("both objects can be trained")
        })
        .collect()
}
