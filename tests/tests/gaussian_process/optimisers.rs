//! Where Adam ends against L-BFGS-B: the pairs and components that part, by name, and why.
//!
//! What parts them was tested by taking it away: see [`unhindered`].

use crate::dense::{models, patch, split};
use cobra_infer::{Kernel, Metric, Model, Smoothness};
use cobra_tests::data::real_data;
use cobra_tests::tolerance;
use cobra_train::gp::{
    AdamOptions, Coordinates, Learned, NOISE_FLOOR, Optimiser, PAPER_NOISE_FLOOR, PlateauOptions,
    Start, Subset, learn,
};
use cobra_train::progress::Silent;
use cobra_train::surface::read_mesh;
use cobra_train::train::{TrainOptions, train};

/// The paper's Adam at a rate that never falls, with a memory of ten squared gradients instead of a
/// thousand, and no more iterations.
///
/// The scheduler lowers the rate where the likelihood rises for a while, and never raises it again;
/// the long memory divides steps by the first gradients long after they are gone.
fn unhindered() -> AdamOptions {
    let paper = AdamOptions::paper();
    AdamOptions {
        second_decay: 0.9,
        plateau: PlateauOptions {
            patience: u32::MAX,
            ..paper.plateau
        },
        ..paper
    }
}

fn learned(model: Model, optimiser: Optimiser) -> Learned {
    let (u, y) = split(&patch(80));
    let points = Coordinates::new(model.metric, &u);
    learn(model.kernel, &points, &y, &optimiser, NOISE_FLOOR).unwrap()
}

/// How far the likelihood per point that Adam reaches lies above L-BFGS-B's.
fn gap(model: Model, options: AdamOptions) -> f64 {
    learned(model, Optimiser::Adam(options)).likelihood_per_point
        - learned(model, Optimiser::Lbfgs).likelihood_per_point
}

/// The pairs where the paper's Adam stays above, and the gap that was measured. With a short memory
/// alone all three meet (2e-6 at most), with ten times the iterations too (1e-9); without the
/// scheduler alone the first does (1e-7), the linear ones do not.
const APART: [(Metric, Kernel, f64); 3] = [
    (Metric::Chord, Kernel::Matern(Smoothness::Half), 0.022),
    (Metric::Chord, Kernel::Linear, 0.066),
    (Metric::Angles, Kernel::Linear, 0.0073),
];

fn apart(model: Model) -> Option<f64> {
    let mut apart = APART.into_iter();
    let found =
        apart.find(|(metric, kernel, _)| (*metric, *kernel) == (model.metric, model.kernel));
    found.map(|(_, _, gap)| gap)
}

#[test]
fn both_optimisers_reach_the_same_likelihood_in_17_of_20_pairs() {
    for model in models().filter(|model| apart(*model).is_none()) {
        let gap = gap(model, AdamOptions::paper());
        assert!(
            gap.abs() < tolerance::OPTIMISERS_AGREE,
            "{model:?}: {gap:e}"
        );
    }
}

#[test]
fn in_the_three_others_adam_ends_above_by_what_is_documented() {
    for model in models() {
        let Some(measured) = apart(model) else {
            continue;
        };
        let gap = gap(model, AdamOptions::paper());
        assert!(
            (gap / measured - 1.0).abs() < tolerance::OPTIMISERS_APART,
            "{model:?}: {gap:e}"
        );
    }
}

#[test]
fn without_the_scheduler_and_with_a_short_memory_adam_meets_in_every_pair() {
    for model in models() {
        let gap = gap(model, unhindered());
        assert!(
            gap.abs() < tolerance::OPTIMISERS_AGREE,
            "{model:?}: {gap:e}"
        );
    }
}

/// Why the paper's recipe does not start where GPyTorch does: on these few points the noise, which
/// starts at the box's edge, keeps explaining what the surface should.
#[test]
fn from_gpytorchs_start_adam_ends_above_in_most_pairs_and_below_in_none() {
    let mut meet = 0;
    for model in models() {
        let gap = gap(
            model,
            AdamOptions {
                start: Start::Softplus,
                ..AdamOptions::paper()
            },
        );
        assert!(gap > -tolerance::OPTIMISERS_AGREE, "{model:?}: {gap:e}");
        meet += u32::from(gap < tolerance::OPTIMISERS_AGREE);
    }
    // Measured: 6 of 20, against 17 from the targets' start.
    assert!(meet <= 8, "{meet}");
}

/// Components of some 100 points of which hyperparameters are learned on all, and the gap that was
/// measured. Without the scheduler alone, 1 and 4 meet and 7 is 0.002 above; with ten times the
/// iterations alone, 4 meets; with a short memory alone, none does.
const COMPONENTS_APART: [(usize, f64); 3] = [(1, 0.013), (4, 0.0031), (7, 0.12)];

#[test]
fn both_optimisers_reach_the_same_likelihood_in_13_of_16_components_of_a_real_screwdriver() {
    let Some(data) = real_data("both optimisers on the screwdriver") else {
        return;
    };
    let mesh = read_mesh(&data.join("screwdriver/model.ply")).unwrap();
    let [lbfgs, paper, unhindered] = [
        Optimiser::Lbfgs,
        Optimiser::Adam(AdamOptions::paper()),
        Optimiser::Adam(unhindered()),
    ]
    .map(|optimiser| {
        let mut options = TrainOptions::clustered("screwdriver", 16);
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
    for (index, lbfgs) in lbfgs.iter().enumerate() {
        let gap = paper[index] - lbfgs;
        match COMPONENTS_APART.iter().find(|(apart, _)| *apart == index) {
            Some((_, measured)) => assert!(
                (gap / measured - 1.0).abs() < tolerance::OPTIMISERS_APART,
                "component {index}: {gap:e}"
            ),
            None => assert!(
                gap.abs() < tolerance::OPTIMISERS_AGREE,
                "component {index}: {gap:e}"
            ),
        }
        let gap = unhindered[index] - lbfgs;
        assert!(
            gap.abs() < tolerance::OPTIMISERS_AGREE,
            "component {index}, unhindered: {gap:e}"
        );
    }
}
