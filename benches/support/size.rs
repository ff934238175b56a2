//! How much is computed: all of it under `cargo bench`, hardly any where benchmarks are only
//! checked.

use cobra_train::train::TrainOptions;

/// The size of the problem.
#[derive(Clone, Copy)]
pub(crate) struct Size {
    /// Training points.
    pub(crate) points: usize,
    /// Test points.
    pub(crate) test_points: usize,
    /// Components.
    pub(crate) components: usize,
}

impl Size {
    /// The paper's numbers when cargo asks for a measurement, else a few points: `cargo test`
    /// runs every benchmark once.
    pub(crate) fn from_arguments() -> Self {
        let given = |name| std::env::args().any(|argument| argument == name);
        if given("--bench") && !given("--test") {
            Self {
                points: 10_000,
                test_points: 30_000,
                components: 16,
            }
        } else {
            Self {
                points: 200,
                test_points: 200,
                components: 2,
            }
        }
    }

    /// What `cobra train` does unless it is told otherwise.
    pub(crate) fn default_options(&self) -> TrainOptions {
        TrainOptions {
            points: self.points,
            test_points: self.test_points,
            ..TrainOptions::new("benchmark")
        }
    }

    /// So many k-means components that speak everywhere, uncompressed.
    pub(crate) fn kmeans_options(&self) -> TrainOptions {
        TrainOptions {
            points: self.points,
            test_points: self.test_points,
            ..TrainOptions::clustered("benchmark", self.components)
        }
    }
}
