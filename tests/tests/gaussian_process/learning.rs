//! Where learning ends, and that both optimisers end there.

use crate::dense::{free, models, moved, patch, split};
use cobra_infer::{Kernel, Metric, Model, Smoothness};
use cobra_tests::data::real_data;
use cobra_tests::tolerance;
use cobra_train::gp::{
    AdamOptions, Coordinates, Learned, NOISE_FLOOR, Optimiser, PAPER_NOISE_FLOOR, StopReason,
    Subset, learn, negative_log_marginal_likelihood, search_box,
};
use cobra_train::progress::Silent;
use cobra_train::surface::read_mesh;
use cobra_train::train::{TrainOptions, train};

#[test]
fn learning_ends_where_no_small_step_within_the_box_is_better() {
    let (u, y) = split(&patch(80));
    for model in models() {
        let kernel = model.kernel;
        let points = Coordinates::new(model.metric, &u);
        let learned = learn(kernel, &points, &y, &Optimiser::Lbfgs, NOISE_FLOOR).unwrap();
        assert!(!learned.stop.is_early(), "{model:?}: {}", learned.stop);
        let best = learned.likelihood_per_point;
        let search_box = search_box(kernel, NOISE_FLOOR);
        assert!(search_box.contains(&learned.hyperparameters), "{model:?}");
        let mut tried = 0;
        for factor in [0.95, 1.05] {
            for index in 0..free(kernel) {
                let moved = moved(kernel, &learned.hyperparameters, index, factor);
                // Where the search ends on the edge, as that of Matern 1/2 on angles does, what lies
                // beyond may well be better: it is not asked for.
                if !search_box.contains(&moved) {
                    continue;
                }
                tried += 1;
                let there = negative_log_marginal_likelihood(kernel, &moved, &points, &y)
                    .unwrap()
                    .value
                    / y.len() as f64;
                assert!(
                    there >= best - tolerance::LEARNED,
                    "{model:?}, entry {index} times {factor}: {there} below {best}"
                );
            }
        }
        // An edge takes away one of the two steps of an entry.
        assert!(tried >= free(kernel), "{model:?}");
    }
}

/// Both optimisers from the same start on the same data, all of it.
fn both(model: Model) -> [Learned; 2] {
    let (u, y) = split(&patch(80));
    let points = Coordinates::new(model.metric, &u);
    [Optimiser::Lbfgs, Optimiser::Adam(AdamOptions::paper())]
        .map(|optimiser| learn(model.kernel, &points, &y, &optimiser, NOISE_FLOOR).unwrap())
}

/// How far Adam's likelihood per point lies above L-BFGS-B's.
fn gap(model: Model) -> f64 {
    let [lbfgs, adam] = both(model);
    adam.likelihood_per_point - lbfgs.likelihood_per_point
}

/// Where the two do not meet, and at most how far Adam stays above: its 250 iterations end on the way.
/// Matern 1/2 on unit vectors is bound for the box's edge (measured 0.022), the noise of a linear
/// kernel, which explains next to nothing, for its optimum (0.066 on unit vectors, 0.007 on angles).
const APART: [(Metric, Kernel, f64); 3] = [
    (Metric::Chord, Kernel::Matern(Smoothness::Half), 0.03),
    (Metric::Chord, Kernel::Linear, 0.07),
    (Metric::Angles, Kernel::Linear, 0.01),
];

fn apart(model: Model) -> Option<f64> {
    let mut apart = APART.into_iter();
    let found =
        apart.find(|(metric, kernel, _)| (*metric, *kernel) == (model.metric, model.kernel));
    found.map(|(_, _, gap)| gap)
}

#[test]
fn both_optimisers_reach_the_same_likelihood_where_the_problem_allows() {
    for model in models().filter(|model| apart(*model).is_none()) {
        let gap = gap(model);
        assert!(
            gap.abs() < tolerance::OPTIMISERS_AGREE,
            "{model:?}: {gap:e}"
        );
    }
}

#[test]
fn where_adam_is_stopped_on_the_way_it_is_worse_by_little() {
    for model in models() {
        let Some(most) = apart(model) else { continue };
        assert_eq!(both(model)[1].stop, StopReason::IterationLimit, "{model:?}");
        let gap = gap(model);
        assert!(
            (tolerance::OPTIMISERS_AGREE..most).contains(&gap),
            "{model:?}: {gap:e}"
        );
    }
}

#[test]
fn both_optimisers_reach_the_same_likelihood_in_most_components_of_a_real_screwdriver() {
    let Some(data) = real_data("both optimisers on the screwdriver") else {
        return;
    };
    let mesh = read_mesh(&data.join("screwdriver/model.ply")).unwrap();
    let [lbfgs, adam] =
        [Optimiser::Lbfgs, Optimiser::Adam(AdamOptions::paper())].map(|optimiser| {
            let mut options = TrainOptions::new("screwdriver");
            options.points = 1600;
            options.test_points = 300;
            options.fit.optimiser = optimiser;
            options.fit.subset = Subset::All;
            options.fit.noise_floor = PAPER_NOISE_FLOOR;
            let components = train(&mesh.clone().into(), &options, &Silent)
                .unwrap()
                .components;
            components
                .into_iter()
                .map(|c| c.fitted.learned.likelihood_per_point)
                .collect::<Vec<_>>()
        });
    let gaps: Vec<f64> = adam
        .iter()
        .zip(&lbfgs)
        .map(|(adam, lbfgs)| adam - lbfgs)
        .collect();
    let meet = gaps
        .iter()
        .filter(|gap| gap.abs() < tolerance::OPTIMISERS_AGREE)
        .count();
    // Measured: 13 of 16; in the others, which explain their points badly, the 250 iterations end up to
    // 0.12 above.
    assert!(meet >= 12, "{gaps:?}");
}
