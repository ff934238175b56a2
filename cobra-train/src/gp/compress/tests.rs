use super::*;
use cobra_infer::Exponent;

const KERNEL: Kernel = Kernel::RationalQuadratic(Exponent::Half);

/// An ellipsoid of half axes 1.2, 1 and 0.8 as its centre sees it, as far as `cosine` from `pole`.
fn patch(pole: Vector3<f64>, cosine: f64, count: usize) -> Uncompressed {
    let directions: Vec<UnitVector3<f64>> = crate::surface::fibonacci_sphere(count)
        .into_iter()
        .filter(|u| u.dot(&pole) > cosine)
        .collect();
    let distance = |u: &UnitVector3<f64>| {
        let scaled = Vector3::new(u.x / 1.2, u.y, u.z / 0.8);
        1.0 / scaled.norm()
    };
    let prior_mean = directions.iter().map(distance).sum::<f64>() / directions.len().max(1) as f64;
    Uncompressed {
        kernel: KERNEL,
        hyperparameters: Hyperparameters {
            length_scale: 0.8,
            signal_variance: 0.05,
            noise_variance: 1e-6,
            parameter: 0.5,
        },
        targets: directions
            .iter()
            .map(|u| distance(u) - prior_mean)
            .collect(),
        directions,
        prior_mean,
    }
}

/// The largest error of what the terms say of the patch's own points.
fn largest_error(patch: &Uncompressed, terms: &Compressed) -> f64 {
    let unit = Hyperparameters {
        signal_variance: 1.0,
        ..patch.hyperparameters
    };
    let points = Coordinates::new(Metric::Chord, &patch.directions);
    let mut left = patch.targets.clone();
    for (direction, weight) in terms.directions.iter().zip(&terms.weights) {
        let column = covariances(patch.kernel, &unit, &points, unrounded(*direction));
        for (left, k) in left.iter_mut().zip(column) {
            *left -= f64::from(*weight) * terms.scale * k;
        }
    }
    left.iter().fold(0.0, |most, error| most.max(error.abs()))
}

fn terms(compressed: &[Compressed]) -> usize {
    compressed.iter().map(|c| c.weights.len()).sum()
}

#[test]
fn few_terms_reproduce_a_smooth_patch() {
    let patch = patch(Vector3::z(), 0.3, 3000);
    assert!(patch.directions.len() > 900);
    let error = |terms| {
        let compressed = compress(std::slice::from_ref(&patch), terms, usize::MAX).unwrap();
        largest_error(&patch, &compressed[0])
    };
    let (few, some, many) = (error(8), error(30), error(90));
    assert!(many < 2e-3, "{many}");
    assert!(many < some && some < few, "{few} {some} {many}");
}

#[test]
fn there_are_never_more_terms_than_asked_for_and_at_least_one_each() {
    let patches = [
        patch(Vector3::z(), 0.5, 800),
        patch(Vector3::x(), 0.8, 800),
        patch(Vector3::y(), 0.9, 300),
    ];
    for wanted in [0, 1, 3, 7, 24, 25, 61, 100] {
        let compressed = compress(&patches, wanted, usize::MAX).unwrap();
        assert_eq!(compressed.len(), patches.len());
        let most = wanted.max(patches.len());
        assert!(terms(&compressed) <= most, "{wanted}");
        for component in &compressed {
            assert_eq!(component.directions.len(), component.weights.len());
            assert!(!component.weights.is_empty());
        }
    }
    // Directions that are left do not fill the room.
    let all: usize = patches.iter().map(|patch| patch.directions.len()).sum();
    assert!(terms(&compress(&patches, 10 * all, usize::MAX).unwrap()) <= all);
    assert_eq!(compress(&[], 10, usize::MAX).unwrap(), []);
}

#[test]
fn terms_go_where_the_surface_is_hard_to_reproduce() {
    let round = Uncompressed {
        targets: vec![0.0; patch(Vector3::z(), 0.5, 800).targets.len()],
        ..patch(Vector3::z(), 0.5, 800)
    };
    let compressed = compress(&[round, patch(Vector3::x(), 0.5, 800)], 60, usize::MAX).unwrap();
    assert!(compressed[0].weights.iter().all(|weight| *weight == 0));
    assert!(compressed[0].scale > 0.0);
    assert!(compressed[1].weights.len() > 4 * compressed[0].weights.len());
}

#[test]
fn directions_are_unit_vectors_on_the_grid_and_no_two_the_same() {
    let compressed = compress(&[patch(Vector3::y(), -1.0, 1500)], 200, usize::MAX).unwrap();
    let directions = &compressed[0].directions;
    for direction in directions {
        let length = Vector3::from(unrounded(*direction)).norm();
        // Half a step in each coordinate.
        assert!((length - 1.0).abs() < 0.87 / 127.0, "{direction:?}");
    }
    let mut sorted = directions.clone();
    sorted.sort_unstable();
    sorted.dedup();
    assert_eq!(sorted.len(), directions.len());
    // The largest weight takes all 16 bits.
    let weights = compressed[0].weights.iter();
    assert_eq!(weights.map(|w| w.unsigned_abs()).max(), Some(32767));
}

#[test]
fn the_number_of_threads_does_not_matter() {
    let patches = [patch(Vector3::z(), 0.4, 700), patch(Vector3::x(), 0.4, 700)];
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build()
            .unwrap()
            .install(|| compress(&patches, 90, usize::MAX).unwrap())
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn no_component_has_more_terms_than_the_most() {
    let patches = [
        patch(Vector3::x(), 0.5, 800),
        patch(Vector3::z(), -1.0, 800),
    ];
    let compressed = compress(&patches, 200, 56).unwrap();
    let counts: Vec<usize> = compressed.iter().map(|c| c.weights.len()).collect();
    assert!(counts.iter().all(|count| *count <= 56), "{counts:?}");
    assert_eq!(counts.iter().max(), Some(&56));
    let few = compress(&patches, 200, 3).unwrap();
    assert!(few.iter().all(|c| c.weights.len() == 3));
}

#[test]
fn terms_fill_whole_rounds_of_the_accumulators() {
    let patches = [patch(Vector3::z(), 0.4, 900), patch(Vector3::x(), 0.8, 600)];
    for asked in [9, 16, 41, 60, 100] {
        let compressed = compress(&patches, asked, 48).unwrap();
        for component in &compressed {
            let count = component.weights.len();
            assert!(count < LANES || count % LANES == 0, "{count} of {asked}");
        }
        let all = terms(&compressed);
        assert!(
            all <= asked && all + 2 * LANES > asked.min(96),
            "{all} of {asked}"
        );
    }
}
