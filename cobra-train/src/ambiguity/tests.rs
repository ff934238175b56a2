//! Objects made by code, of which it is known what cannot be told apart.

use super::*;
use crate::bop::symmetry::Axis;
use crate::demo::mechanical_part;
use crate::depth::MeshSurface;
use crate::progress::Silent;
use cobra_infer::template::DepthRecord;
use nalgebra::{Point3, Vector3};
use std::f64::consts::{PI, TAU};

/// Few views and candidates: the tests are of the rules, not of how finely is looked.
fn options() -> SearchOptions {
    SearchOptions {
        views: 3,
        candidates: 300,
        ..SearchOptions::new(DepthSettings::DEFAULT)
    }
}

fn find(mesh: &Mesh, symmetries: Option<&Symmetries>, options: &SearchOptions) -> Ambiguities {
    let noise = DepthRecord::NOISE_SHARE * mesh.diameter() as f32;
    let surface = MeshSurface::new(mesh, noise, 0);
    find_ambiguities(mesh, surface, symmetries, options, &Silent).unwrap()
}

/// A solid of revolution about the line along z through (10, 0): of radii and heights.
fn lathed(profile: &[[f64; 2]]) -> Mesh {
    const SIDES: u32 = 48;
    let mut vertices = Vec::new();
    for [radius, height] in profile {
        for side in 0..SIDES {
            let (sin, cos) = (TAU * f64::from(side) / f64::from(SIDES)).sin_cos();
            vertices.push(Point3::new(10.0 + radius * cos, radius * sin, *height));
        }
    }
    let mut triangles = Vec::new();
    for ring in 0..profile.len() as u32 - 1 {
        for side in 0..SIDES {
            let next = (side + 1) % SIDES;
            let [a, b] = [side, next].map(|side| ring * SIDES + side);
            triangles.push([a, b, b + SIDES]);
            triangles.push([a, b + SIDES, a + SIDES]);
        }
    }
    Mesh::new(vertices, triangles).unwrap()
}

/// Of which half is neck: no end looks like the other.
fn bottle() -> Mesh {
    lathed(&[
        [0.0, 0.0],
        [30.0, 0.0],
        [30.0, 60.0],
        [10.0, 75.0],
        [10.0, 150.0],
        [0.0, 150.0],
    ])
}

fn cube() -> Mesh {
    let corner =
        |i: u32| Point3::from([i & 1, i >> 1 & 1, i >> 2 & 1].map(|b| 80.0 * f64::from(b)));
    let faces = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let triangles = faces
        .iter()
        .flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]);
    Mesh::new((0..8).map(corner).collect(), triangles.collect()).unwrap()
}

fn axis_of(ambiguity: &Ambiguity) -> (Axis, Range) {
    match ambiguity.what {
        What::Path {
            path: Path::Turn(axis),
            range,
        } => (axis, range),
        what => panic!("{what:?}"),
    }
}

#[test]
fn a_bottle_may_be_turned_about_its_axis_by_any_angle_and_nothing_else() {
    let found = find(&bottle(), None, &options());
    assert_eq!(found.found.len(), 1, "{found:?}");
    let (axis, range) = axis_of(&found.found[0]);
    assert_eq!(range, Range::Any);
    assert!(axis.direction.angle(&Vector3::z_axis()) < 0.02, "{axis:?}");
    assert!(
        (axis.offset.x - 10.0).hypot(axis.offset.y) < 1.0,
        "{axis:?}"
    );
    assert_eq!((found.found[0].views, found.found[0].stated), (3, None));
    assert!(found.found[0].add > found.limit && found.found[0].add_s < found.limit);
}

#[test]
fn a_can_may_be_turned_upside_down_besides() {
    let can = lathed(&[[0.0, 0.0], [30.0, 0.0], [30.0, 110.0], [0.0, 110.0]]);
    let axis = Axis {
        direction: Vector3::z_axis(),
        offset: Point3::new(10.0, 0.0, 0.0),
    };
    let symmetries = Symmetries {
        discrete: Vec::new(),
        continuous: vec![axis],
    };
    let found = find(&can, Some(&symmetries), &options());
    assert_eq!(found.stated_found, [true]);
    let [turns, flip] = &found.found[..] else {
        panic!("{found:?}")
    };
    assert_eq!((axis_of(turns).1, turns.stated), (Range::Any, Some(true)));
    let What::Motion { screw, .. } = flip.what else {
        panic!("{flip:?}")
    };
    assert!(
        (screw.angle - PI).abs() < 0.05 && screw.axis.direction.z.abs() < 0.05,
        "{flip:?}"
    );
    assert_eq!((flip.views, flip.stated), (3, Some(false)));
    assert!(turns.mssd_stated.unwrap() < 0.1 * turns.mssd);
    assert_eq!(flip.mssd_stated.map(|mssd| mssd > found.limit), Some(true));
}

#[test]
fn a_cube_has_its_23_rotations() {
    let found = find(&cube(), None, &options());
    let mut angles: Vec<i64> = found
        .found
        .iter()
        .map(|ambiguity| match ambiguity.what {
            What::Motion { screw, .. } => screw.angle.to_degrees().round() as i64,
            what => panic!("{what:?}"),
        })
        .collect();
    angles.sort_unstable();
    assert_eq!(angles.len(), 23, "{angles:?}");
    for (angle, count) in [(90, 6), (120, 8), (180, 9)] {
        let near = angles
            .iter()
            .filter(|found| (**found - angle).abs() <= 3)
            .count();
        assert_eq!(near, count, "{angle} {angles:?}");
    }
    assert!(found.found.iter().all(|ambiguity| ambiguity.views == 3));
}

#[test]
fn a_bracket_that_no_rotation_maps_onto_itself_has_none() {
    let found = find(&mechanical_part(), Some(&Symmetries::default()), &options());
    assert!(found.found.is_empty(), "{found:?}");
    assert!(found.stated_found.is_empty());
    assert!(found.truth > 0.9, "{found:?}");
}

#[test]
fn of_a_ball_any_rotation_is_explained() {
    let profile: Vec<[f64; 2]> = (0..=24)
        .map(|i| (PI * f64::from(i) / 24.0).sin_cos())
        .map(|(sin, cos)| [40.0 * sin, -40.0 * cos])
        .collect();
    let found = find(&lathed(&profile), None, &options());
    assert!(found.found.len() >= 2, "{found:?}");
    for ambiguity in &found.found {
        assert_eq!(axis_of(ambiguity).1, Range::Any, "{ambiguity:?}");
    }
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let few = SearchOptions {
        views: 2,
        candidates: 100,
        noise: 1.0,
        ..options()
    };
    let all: Vec<String> = [1, 3]
        .into_iter()
        .map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            format!("{:?}", pool.install(|| find(&cube(), None, &few)))
        })
        .collect();
    assert_eq!(all[0], all[1]);
}

#[test]
fn a_surface_of_another_size_is_refused() {
    let (bottle, cube) = (bottle(), cube());
    let other = MeshSurface::new(&cube, 8.0, 0);
    let refused = find_ambiguities(&bottle, other, None, &options(), &Silent).unwrap_err();
    assert!(
        matches!(refused, AmbiguityError::Truth { .. }),
        "{refused:?}"
    );
    let none = SearchOptions {
        views: 0,
        ..options()
    };
    let surface = MeshSurface::new(&cube, 8.0, 0);
    let refused = find_ambiguities(&cube, surface, None, &none, &Silent).unwrap_err();
    assert_eq!(refused, AmbiguityError::NoView);
}
