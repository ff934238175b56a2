//! Gram matrices over directions, in double precision.
//!
//! Owns the loops; the covariance functions are `cobra-infer`'s.

use cobra_infer::kernel::{Covariance, Kernel, Metric, Visitor};
use faer::Mat;
use nalgebra::UnitVector3;

/// What is learned: all positive, in units of the metric's coordinates (`length_scale`) and of the
/// unit sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hyperparameters {
    /// l; 1 where the kernel has none.
    pub length_scale: f64,
    /// v.
    pub signal_variance: f64,
    /// η.
    pub noise_variance: f64,
    /// The kernel's parameter besides the length scale; what the kernel fixes, where it fixes one.
    pub parameter: f64,
}

/// Directions in a metric's coordinates, one array a coordinate.
#[derive(Clone, Debug, PartialEq)]
pub struct Coordinates {
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
}

impl Coordinates {
    /// The coordinates of `directions`.
    #[must_use]
    pub fn new(metric: Metric, directions: &[UnitVector3<f64>]) -> Self {
        let points: Vec<[f64; 3]> = directions
            .iter()
            .map(|direction| coordinates(metric, direction))
            .collect();
        Self {
            x: points.iter().map(|p| p[0]).collect(),
            y: points.iter().map(|p| p[1]).collect(),
            z: points.iter().map(|p| p[2]).collect(),
        }
    }

    /// How many directions.
    #[must_use]
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    /// The coordinates of direction `index`.
    ///
    /// # Panics
    /// Beyond the last.
    #[must_use]
    pub fn at(&self, index: usize) -> [f64; 3] {
        [self.x[index], self.y[index], self.z[index]]
    }

    /// Those from `first` on.
    pub(super) fn from(&self, first: usize) -> impl Iterator<Item = [f64; 3]> {
        let (x, y, z) = (&self.x[first..], &self.y[first..], &self.z[first..]);
        x.iter().zip(y).zip(z).map(|((x, y), z)| [*x, *y, *z])
    }
}

/// The coordinates of one direction.
#[must_use]
pub fn coordinates(metric: Metric, direction: &UnitVector3<f64>) -> [f64; 3] {
    let unit_vector = direction.into_inner().into();
    // The trainer is built with every metric.
    metric.coordinates(unit_vector).unwrap_or(unit_vector)
}

/// v·k(a, b).
#[must_use]
pub fn covariance(kernel: Kernel, h: &Hyperparameters, a: [f64; 3], b: [f64; 3]) -> f64 {
    struct Between([f64; 3], [f64; 3]);
    impl Visitor<f64> for Between {
        type Output = f64;
        fn visit(self, kernel: impl Covariance<f64>) -> f64 {
            kernel.between(self.0, self.1)
        }
    }
    h.signal_variance * visit(kernel, h, Between(a, b))
}

/// v·k(query, xᵢ) for every direction.
#[must_use]
pub fn covariances(
    kernel: Kernel,
    h: &Hyperparameters,
    points: &Coordinates,
    query: [f64; 3],
) -> Vec<f64> {
    struct Row<'a>(&'a Coordinates, [f64; 3], f64);
    impl Visitor<f64> for Row<'_> {
        type Output = Vec<f64>;
        fn visit(self, kernel: impl Covariance<f64>) -> Vec<f64> {
            let Self(points, query, variance) = self;
            let points = points.from(0);
            points
                .map(|point| variance * kernel.between(query, point))
                .collect()
        }
    }
    visit(kernel, h, Row(points, query, h.signal_variance))
}

/// K = v·k(X, X) + η·I, the lower triangle only.
#[must_use]
pub fn gram(kernel: Kernel, hyperparameters: &Hyperparameters, points: &Coordinates) -> Mat<f64> {
    struct Gram<'a>(&'a Coordinates, &'a Hyperparameters);
    impl Visitor<f64> for Gram<'_> {
        type Output = Mat<f64>;
        fn visit(self, kernel: impl Covariance<f64>) -> Mat<f64> {
            let Self(points, h) = self;
            let n = points.len();
            let mut gram = Mat::zeros(n, n);
            for j in 0..n {
                let point = points.at(j);
                let column = &mut gram.col_as_slice_mut(j)[j..];
                for (entry, other) in column.iter_mut().zip(points.from(j)) {
                    *entry = h.signal_variance * kernel.between(point, other);
                }
                column[0] += h.noise_variance;
            }
            gram
        }
    }
    visit(kernel, hyperparameters, Gram(points, hyperparameters))
}

fn visit<V: Visitor<f64>>(kernel: Kernel, h: &Hyperparameters, visitor: V) -> V::Output {
    kernel
        .visit(h.length_scale, h.parameter, visitor)
        .expect("the trainer is built with every kernel")
}
