//! What training costs: the whole and the steps that take most of it on all cores, and one
//! component next to other crates.

mod support;

use cobra_train::gp::{self, FitOptions, FittedGp, Subset};
use cobra_train::progress::Silent;
use cobra_train::random::{Purpose, stream};
use cobra_train::reference::{Cluster, kmeans, most_explanatory};
use cobra_train::train::{PLACEMENTS, train};
use criterion::{Criterion, SamplingMode};
use rayon::prelude::*;
use std::time::Duration;
use support::{Component, Object, PEERS, Size, Table, components, objects, training_points};

fn main() {
    let size = Size::from_arguments();
    let mut criterion = Criterion::default()
        .warm_up_time(Duration::from_millis(1))
        .measurement_time(Duration::from_secs(1))
        .configure_from_args();
    let objects = objects();
    for (index, object) in objects.iter().enumerate() {
        let options = size.default_options();
        let mut group = criterion.benchmark_group(format!("train/{}", object.name));
        group.sampling_mode(SamplingMode::Flat);
        let mut table = Table::new(&mut group, 10);
        table.bench("whole", || {
            train(&object.mesh.clone().into(), &options, &Silent)
                .expect("both objects can be trained")
        });
        // They cost as much as the whole again: those of one object have to do.
        if index == 0 {
            bench_steps(&mut table, object, &size);
        }
        table.print(&format!(
            "{}, {} points, {} threads",
            object.name,
            size.points,
            rayon::current_num_threads()
        ));
        group.finish();
    }
    // The screwdriver, where it is: a minute of peers is enough.
    if let Some(object) = objects.last() {
        bench_peers(&mut criterion, object, &size);
    }
    criterion.final_summary();
}

/// The steps of training with k-means components.
fn bench_steps(table: &mut Table<'_, '_>, object: &Object, size: &Size) {
    let options = size.kmeans_options();
    table.bench("k-means components: sampling", || {
        training_points(object, size)
    });
    let points = training_points(object, size);
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
    let components = Component::of(&choose(placements), &points);
    table.bench("fitting", || {
        let fitted = components.par_iter().enumerate();
        fitted
            .map(|(index, component)| fit(component, index, &options.fit))
            .collect::<Vec<_>>()
    });
}

/// One component of a middling number of points: peers take seconds for it, and the more the
/// larger it is.
fn bench_peers(criterion: &mut Criterion, object: &Object, size: &Size) {
    let mut components = components(&training_points(object, size), size);
    components.sort_by_key(|component| component.points.len());
    let component = components.swap_remove(components.len() / 2);
    let options = size.default_options().fit;
    let all = FitOptions {
        subset: Subset::All,
        ..options
    };

    let mut group = criterion.benchmark_group(format!("fit/{}", object.name));
    group.sampling_mode(SamplingMode::Flat);
    let mut table = Table::new(&mut group, 10);
    table.bench("cobra-train", || fit(&component, 0, &options));
    table.bench("cobra-train, all points", || fit(&component, 0, &all));
    for (name, fit) in PEERS {
        table.bench(name, || fit(&component, None));
    }
    table.print(&format!(
        "{}, a component of {} points",
        object.name,
        component.points.len()
    ));
    group.finish();
}

fn fit(component: &Component, index: usize, options: &FitOptions) -> FittedGp {
    let mut rng = stream(0, Purpose::HyperparameterSubset, index as u64);
    gp::fit(&component.centre, &component.points, options, &mut rng)
        .expect("both objects can be trained")
}
