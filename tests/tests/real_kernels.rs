//! The kernels of the paper's ablation on its own two objects: all of them train, and stand in the
//! order that the paper found.

use cobra_infer::{Assignment, Exponent, Kernel, Metric, Model, Smoothness, Template};
use cobra_tests::data::real_data;
use cobra_train::evaluate::{evaluate, evaluation_points};
use cobra_train::gp::{PriorMean, Subset};
use cobra_train::progress::Silent;
use cobra_train::surface::{Geometry, read_geometry};
use cobra_train::train::{TrainOptions, train};

/// Worse ones first; those on one line are not told apart.
const ORDER: [&[Kernel]; 3] = [
    &[Kernel::Linear],
    &[Kernel::Polynomial],
    &[
        Kernel::RadialBasis,
        Kernel::RationalQuadratic(Exponent::Free),
        Kernel::Matern(Smoothness::FiveHalves),
        Kernel::Periodic,
    ],
];

fn f_score(object: &Geometry, model: Model) -> f64 {
    let mut options = TrainOptions {
        points: 3000,
        test_points: 2000,
        ..TrainOptions::clustered("object", 8)
    };
    options.fit.model = model;
    options.fit.subset = Subset::Points(100);
    options.fit.prior_mean = PriorMean::Zero;
    let trained = train(object, &options, &Silent).unwrap();
    let template = Template::from_bytes(&trained.bytes).unwrap();
    let points = evaluation_points(object, 5000, 0).unwrap();
    let shape = evaluate(&template, Assignment::Nearest, &points)
        .unwrap()
        .shape;
    println!("{model:?}: {shape:?}");
    shape.f_score
}

#[test]
fn the_six_kernels_train_with_eight_components_and_stand_in_the_papers_order() {
    let Some(data) = real_data("the ablation of kernels") else {
        return;
    };
    for file in ["screwdriver/model.ply", "meshes/scans/stanford-bunny.obj"] {
        let object = read_geometry(&data.join(file)).unwrap().geometry;
        let mut least = 0.0;
        for group in ORDER {
            let scores = group.iter().map(|kernel| {
                let metric = Metric::Angles;
                f_score(
                    &object,
                    Model {
                        metric,
                        kernel: *kernel,
                    },
                )
            });
            let scores: Vec<f64> = scores.collect();
            let worst = scores.iter().copied().fold(f64::INFINITY, f64::min);
            assert!(worst > least, "{file}: {group:?} {scores:?}");
            least = scores.iter().copied().fold(0.0, f64::max);
        }
    }
}
