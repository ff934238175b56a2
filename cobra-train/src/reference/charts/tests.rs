//! Charts of surfaces that everybody can imagine.

use super::*;
use nalgebra::{UnitVector3, Vector3};

/// The sides of a cube of half side `half`, an even grid of `side`² points on each, with normals that
/// point outward.
fn cube(half: f64, side: u32) -> Vec<SurfacePoint> {
    let mut points = Vec::new();
    for axis in 0..3 {
        for sign in [-1.0, 1.0] {
            for place in 0..side * side {
                let at =
                    |index: u32| half * (2.0 * (f64::from(index) + 0.5) / f64::from(side) - 1.0);
                let mut position = Point3::origin();
                let mut normal = Vector3::zeros();
                position[axis] = sign * half;
                normal[axis] = sign;
                position[(axis + 1) % 3] = at(place % side);
                position[(axis + 2) % 3] = at(place / side);
                points.push(SurfacePoint {
                    position,
                    normal: UnitVector3::new_normalize(normal),
                });
            }
        }
    }
    points
}

/// The cube without its lid: what is inside can be seen from outside.
fn open_box(side: u32) -> Vec<SurfacePoint> {
    let mut points = cube(0.5, side);
    points.retain(|point| point.position.z < 0.5);
    points
}

fn sphere(centre: Point3<f64>, radius: f64, count: usize) -> Vec<SurfacePoint> {
    crate::surface::fibonacci_sphere(count)
        .into_iter()
        .map(|normal| SurfacePoint {
            position: centre + normal.scale(radius),
            normal,
        })
        .collect()
}

fn two_spheres() -> Vec<SurfacePoint> {
    let mut points = sphere(Point3::new(-0.6, 0.0, 0.0), 0.35, 700);
    points.extend(sphere(Point3::new(0.6, 0.1, 0.0), 0.35, 700));
    points
}

/// The share of the samples that some chart owns.
fn owned(points: &[SurfacePoint], charts: &[Chart]) -> f64 {
    let mut owned = vec![false; points.len()];
    for chart in charts {
        for &index in &chart.own {
            owned[index] = true;
        }
    }
    owned.iter().filter(|owned| **owned).count() as f64 / points.len() as f64
}

#[test]
fn most_of_a_cube_an_open_box_and_two_spheres_is_owned() {
    for (name, points) in [
        ("cube", cube(0.5, 15)),
        ("open box", open_box(15)),
        ("two spheres", two_spheres()),
    ] {
        let charts = charts(&points, &[], 64, Aim::Coverage, 0).unwrap();
        let share = owned(&points, &charts);
        assert!(share > 0.9, "{name}: {share}");
        for chart in &charts {
            for list in [&chart.own, &chart.training] {
                assert!(list.is_sorted() && !list.is_empty(), "{name}");
            }
            assert!(chart.centre.coords.iter().all(|x| x.is_finite()), "{name}");
        }
    }
}

#[test]
fn no_chart_is_of_both_spheres() {
    let points = two_spheres();
    for chart in charts(&points, &[], 64, Aim::Coverage, 1).unwrap() {
        let left = chart.own.iter().filter(|&&index| index < 700).count();
        assert!(left == 0 || left == chart.own.len(), "{left}");
    }
}

#[test]
fn there_are_never_more_charts_than_asked_for() {
    let points = cube(0.5, 12);
    for most in [0, 1, 2, 5] {
        let found = charts(&points, &[], most, Aim::Coverage, 0).unwrap();
        assert!(found.len() <= most, "{} of {most}", found.len());
        assert_eq!(found.is_empty(), most == 0);
    }
}

#[test]
fn which_side_is_outside_does_not_matter() {
    let points = cube(0.5, 12);
    let mut turned = points.clone();
    for point in &mut turned {
        point.normal = -point.normal;
    }
    for points in [points, turned] {
        assert!(
            owned(
                &points,
                &charts(&points, &[], 64, Aim::Coverage, 0).unwrap()
            ) > 0.9
        );
    }
}

#[test]
fn a_handful_of_points_has_no_charts() {
    assert!(charts(&[], &[], 64, Aim::Coverage, 0).unwrap().is_empty());
    assert!(
        charts(&cube(0.5, 1), &[], 64, Aim::Coverage, 0)
            .unwrap()
            .is_empty()
    );
}

#[test]
fn the_seed_decides_and_the_number_of_threads_does_not() {
    let points = open_box(12);
    let with = |threads, seed| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let found = pool
            .build()
            .unwrap()
            .install(|| charts(&points, &[], 64, Aim::Coverage, seed));
        let charts = found.unwrap().into_iter();
        charts
            .map(|chart| (chart.centre, chart.own, chart.training))
            .collect::<Vec<_>>()
    };
    assert_eq!(with(1, 0), with(3, 0));
    assert_ne!(with(1, 0), with(1, 1));
}

#[test]
fn where_charts_cost_something_no_sample_is_of_two() {
    for points in [cube(0.5, 16), open_box(16), two_spheres()] {
        for aim in [Aim::Bytes, Aim::Time] {
            let charts = charts(&points, &[], 64, aim, 0).unwrap();
            let mut all: Vec<usize> = charts.iter().flat_map(|chart| chart.own.clone()).collect();
            let count = all.len();
            all.sort_unstable();
            all.dedup();
            assert_eq!(all.len(), count, "{aim:?}");
        }
    }
}

#[test]
fn large_charts_are_split_into_halves_that_own_what_they_owned() {
    let points = two_spheres();
    let whole = charts(&points, &[], 64, Aim::Bytes, 0).unwrap();
    for most in [1, whole.len(), 9, 64] {
        let pieces = split(whole.clone(), &points, most);
        assert!(pieces.len() <= most.max(whole.len()));
        assert_eq!(owned(&points, &pieces), owned(&points, &whole));
        for piece in &pieces {
            let from = whole.iter().find(|chart| chart.centre == piece.centre);
            let from = from.expect("no chart at this centre");
            assert!(piece.own.iter().all(|i| from.own.contains(i)));
            assert!(piece.training.iter().all(|i| from.training.contains(i)));
            assert!(piece.own.is_sorted() && piece.training.is_sorted());
            if most == 64 {
                assert!(piece.own.len() * 25 < points.len() * 2);
            }
        }
    }
}

#[test]
fn charts_of_few_samples_stay_whole() {
    let points = sphere(Point3::origin(), 0.5, 40);
    let whole = Chart {
        centre: Point3::origin(),
        own: (0..points.len()).collect(),
        training: (0..points.len()).collect(),
        hyperparameters: charts(&two_spheres(), &[], 64, Aim::Bytes, 0).unwrap()[0].hyperparameters,
    };
    let pieces = split(vec![whole], &points, 64);
    assert!(pieces.len() > 1);
    assert!(pieces.iter().all(|piece| piece.own.len() >= 8));
}

#[test]
fn what_nobody_asks_about_takes_no_charts() {
    let samples = two_spheres();
    let asked_often: Vec<SurfacePoint> = sphere(Point3::new(-0.6, 0.0, 0.0), 0.35, 600_000);
    let of_left = |others: &[SurfacePoint]| {
        let found = charts(&samples, others, 64, Aim::Coverage, 0).unwrap();
        let (left, right): (Vec<_>, Vec<_>) = found.iter().partition(|chart| chart.own[0] < 700);
        (left.len(), right.len())
    };
    let (left, right) = of_left(&[]);
    assert!(left > 0 && right > 0);
    let (left, right) = of_left(&asked_often);
    assert!(left > 0 && right == 0, "{left} {right}");
}
