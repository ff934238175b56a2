//! Where learning ends, step by step around it; `optimisers` compares the ways there.

use crate::dense::{free, models, moved, patch, split};
use cobra_tests::tolerance;
use cobra_train::gp::{
    Coordinates, NOISE_FLOOR, Optimiser, learn, negative_log_marginal_likelihood, search_box,
};

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
