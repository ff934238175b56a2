//! Reference points by k-means, started by k-means++.
//!
//! References: S. Lloyd, Least squares quantization in PCM, 1982; D. Arthur and S. Vassilvitskii,
//! k-means++: the advantages of careful seeding, 2007 (with the greedy choice among a few draws
//! that the authors recommend in their section on experiments).

use super::membership::nearest_to_each;
use crate::random::{Purpose, stream};
use nalgebra::{Point3, Vector3};
use rand::{Rng, RngExt};
use rayon::prelude::*;

/// Lloyd's iterations, a limit that surfaces do not come near.
const ITERATIONS: usize = 300;

/// Why points could not be clustered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ClusterError {
    /// Asked for none.
    #[error("at least one component is needed")]
    NoComponents,
    /// More clusters than distinct points.
    #[error("{components} components need as many distinct training points, found {points}")]
    TooFewPoints {
        /// How many clusters were asked for.
        components: usize,
        /// How many distinct points there are.
        points: usize,
    },
}

/// Cluster centres of `points` from `starts` independent starts: same points and seed, same bits.
///
/// The starts are returned as they come: which one makes the best reference points is not a
/// question of inertia, so the caller decides.
///
/// # Errors
/// [`ClusterError`].
pub fn kmeans(
    points: &[Point3<f64>],
    components: usize,
    starts: usize,
    seed: u64,
) -> Result<Vec<Vec<Point3<f64>>>, ClusterError> {
    if components == 0 {
        return Err(ClusterError::NoComponents);
    }
    let distinct = count_distinct(points);
    if components > distinct {
        return Err(ClusterError::TooFewPoints {
            components,
            points: distinct,
        });
    }
    Ok((0..starts)
        .into_par_iter()
        .map(|start| {
            let mut rng = stream(seed, Purpose::Clustering, start as u64);
            lloyd(points, plus_plus(points, components, &mut rng))
        })
        .collect())
}

fn count_distinct(points: &[Point3<f64>]) -> usize {
    let mut bits: Vec<[u64; 3]> = points
        .iter()
        .map(|p| [p.x.to_bits(), p.y.to_bits(), p.z.to_bits()])
        .collect();
    bits.sort_unstable();
    bits.dedup();
    bits.len()
}

/// Draws each next centre with probability proportional to the squared distance from those before
/// it, the best of a few draws.
fn plus_plus(points: &[Point3<f64>], components: usize, rng: &mut impl Rng) -> Vec<Point3<f64>> {
    let draws = 2 + (components as f64).ln() as usize;
    let mut centres = vec![points[rng.random_range(0..points.len())]];
    let mut squared: Vec<f64> = points
        .iter()
        .map(|p| (p - centres[0]).norm_squared())
        .collect();
    while centres.len() < components {
        let total: f64 = squared.iter().sum();
        let mut best: Option<(f64, Point3<f64>, Vec<f64>)> = None;
        for _ in 0..draws {
            let candidate = points[draw(&squared, rng.random::<f64>() * total)];
            let updated: Vec<f64> = points
                .iter()
                .zip(&squared)
                .map(|(p, s)| s.min((p - candidate).norm_squared()))
                .collect();
            let inertia: f64 = updated.iter().sum();
            if best.as_ref().is_none_or(|(least, ..)| inertia < *least) {
                best = Some((inertia, candidate, updated));
            }
        }
        if let Some((_, centre, updated)) = best {
            centres.push(centre);
            squared = updated;
        }
    }
    centres
}

/// The index at which the running sum of `weights` passes `target`; never one of weight 0.
fn draw(weights: &[f64], target: f64) -> usize {
    let mut sum = 0.0;
    let mut last = 0;
    for (index, weight) in weights.iter().enumerate() {
        if *weight > 0.0 {
            last = index;
            sum += weight;
            if sum >= target {
                break;
            }
        }
    }
    last
}

/// Lloyd's algorithm until no point changes its cluster.
fn lloyd(points: &[Point3<f64>], mut centres: Vec<Point3<f64>>) -> Vec<Point3<f64>> {
    let mut labels = vec![usize::MAX; points.len()];
    for _ in 0..ITERATIONS {
        let assigned = nearest_to_each(points, &centres);
        let changed = assigned
            .iter()
            .zip(&labels)
            .any(|((label, _), old)| label != old);
        if !changed {
            break;
        }
        let mut sums = vec![(Vector3::zeros(), 0_usize); centres.len()];
        for ((label, _), point) in assigned.iter().zip(points) {
            sums[*label].0 += point.coords;
            sums[*label].1 += 1;
        }
        let mut farthest: Vec<usize> = (0..points.len()).collect();
        if sums.iter().any(|(_, count)| *count == 0) {
            farthest.sort_by(|&a, &b| assigned[a].1.total_cmp(&assigned[b].1));
        }
        for (centre, (sum, count)) in centres.iter_mut().zip(&sums) {
            if *count > 0 {
                *centre = Point3::from(sum / *count as f64);
            } else if let Some(index) = farthest.pop() {
                // A cluster that lost all its points starts again at the worst-served one.
                *centre = points[index];
            }
        }
        labels = assigned.into_iter().map(|(label, _)| label).collect();
    }
    centres
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> Vec<Point3<f64>> {
        (0..600)
            .map(|i| {
                let t = f64::from(i);
                Point3::new((t * 0.7).sin(), (t * 1.3).cos(), (t * 0.37).sin())
            })
            .collect()
    }

    #[test]
    fn the_same_seed_gives_the_same_centres_on_any_number_of_threads() {
        let points = grid();
        let run = |threads| {
            rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap()
                .install(|| kmeans(&points, 7, 3, 3).unwrap())
        };
        assert_eq!(run(1), run(3));
    }

    #[test]
    fn separate_clouds_get_a_centre_each() {
        let points: Vec<Point3<f64>> = (0..300)
            .map(|i| {
                let jitter = f64::from(i / 3) * 1e-3;
                Point3::new(f64::from(i % 3) * 10.0 + jitter, 0.0, 0.0)
            })
            .collect();
        let centres = &kmeans(&points, 3, 1, 0).unwrap()[0];
        let mut xs: Vec<f64> = centres.iter().map(|c| c.x).collect();
        xs.sort_by(f64::total_cmp);
        for (x, expected) in xs.iter().zip([0.0495, 10.0495, 20.0495]) {
            assert!((x - expected).abs() < 1e-9, "{xs:?}");
        }
    }

    #[test]
    fn more_components_than_distinct_points_are_refused() {
        let points = vec![Point3::origin(); 50];
        assert_eq!(
            kmeans(&points, 2, 1, 0),
            Err(ClusterError::TooFewPoints {
                components: 2,
                points: 1
            })
        );
        assert!(kmeans(&points, 1, 1, 0).is_ok());
        assert_eq!(kmeans(&points, 0, 1, 0), Err(ClusterError::NoComponents));
    }

    #[test]
    fn as_many_components_as_points_terminate() {
        let points: Vec<_> = grid().into_iter().take(20).collect();
        assert_eq!(kmeans(&points, 20, 1, 1).unwrap()[0].len(), 20);
    }
}
