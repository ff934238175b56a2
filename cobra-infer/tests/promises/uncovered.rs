//! A component is silent outside its directions and outside its box, and points that nothing speaks for
//! count against a pose.

use crate::charts::compacted;
use crate::content::{Content, Valid};
use crate::scene::{COMPONENTS, EVERY_RULE, at, correspondence, pose, settings, stream};
use cobra_infer::gp::compact::GRID;
use cobra_infer::validity::{BoxGrid, Cell, Pole, cell};
use cobra_infer::{Assignment, Likelihood, Mixture, Settings, Sigma, Template};
use nalgebra::{Point3, Vector3};

const RADIUS: f32 = 12.0;
const SIGMA: Sigma = Sigma::Template { noise: 0.0 };

/// A sphere whose component is valid where `holds` of the cell, in a box.
fn sphere(holds: impl Fn(Cell) -> bool, low: [u8; 3], high: [u8; 3]) -> Content {
    let mut content = Content::sphere(RADIUS, 0.5);
    content.parts[0].validity = Some(Valid {
        cells: (0..64)
            .map(|place| {
                holds(Cell {
                    column: place % 8,
                    row: place / 8,
                })
            })
            .collect(),
        low,
        high,
        ..Valid::everywhere()
    });
    content
}

fn speaks(content: &Content, assignment: Assignment, point: [f32; 3]) -> bool {
    let bytes = content.encode();
    let template = Template::from_bytes(&bytes).unwrap();
    let settings = settings(assignment, Likelihood::Peak, SIGMA);
    let mixture = Mixture::<COMPONENTS>::new(&template, &settings).unwrap();
    mixture.evaluate(&Point3::from(point)).is_some()
}

const ASSIGNMENTS: [Assignment; 3] = [Assignment::Nearest, Assignment::Maximum, Assignment::Soft];

const POINTS: [[f32; 3]; 6] = [
    [12.0, 1.0, 0.5],
    [-11.0, 1.0, 0.5],
    [3.0, 14.0, 0.5],
    [1.0, -12.0, -2.0],
    [0.5, 1.0, 11.0],
    [0.5, 1.0, -13.0],
];

#[test]
fn a_component_is_silent_outside_its_directions() {
    let upper = sphere(|cell| cell.row >= 4, [0; 3], [127; 3]);
    for point in POINTS {
        let valid = cell(Pole::PlusZ, 8, point).row >= 4;
        assert_eq!(valid, point[1] > 0.0, "the grid's rows go along y");
        for assignment in ASSIGNMENTS {
            assert_eq!(
                speaks(&upper, assignment, point),
                valid,
                "{assignment:?} {point:?}"
            );
        }
    }
}

#[test]
fn a_component_is_silent_where_its_prediction_leaves_its_box() {
    let grid = BoxGrid::new([0.0; 3], RADIUS);
    let (low, high) = ([0, 64, 0], [127, 127, 60]);
    let boxed = sphere(|_| true, low, high);
    for point in POINTS {
        let predicted = RADIUS * Vector3::from(point).normalize();
        let position = grid.position(predicted.into());
        let inside = (0..3).all(|axis| (low[axis]..=high[axis]).contains(&position[axis]));
        for assignment in ASSIGNMENTS {
            assert_eq!(
                speaks(&boxed, assignment, point),
                inside,
                "{assignment:?} {point:?}"
            );
        }
    }
}

#[test]
fn a_component_that_speaks_says_what_it_says_without_validity() {
    let whole = sphere(|_| true, [0; 3], [127; 3]);
    let mut plain = whole.clone();
    plain.parts[0].validity = None;
    let (whole, plain) = (whole.encode(), plain.encode());
    let (whole, plain) = (
        Template::from_bytes(&whole).unwrap(),
        Template::from_bytes(&plain).unwrap(),
    );
    for (assignment, likelihood) in EVERY_RULE {
        let settings = settings(assignment, likelihood, SIGMA);
        let with = Mixture::<COMPONENTS>::new(&whole, &settings).unwrap();
        let without = Mixture::<COMPONENTS>::new(&plain, &settings).unwrap();
        for point in POINTS {
            let point = Point3::from(point);
            assert_eq!(with.evaluate(&point), without.evaluate(&point));
        }
    }
}

#[test]
fn nearest_passes_to_the_next_that_is_valid_but_not_out_of_a_box() {
    let mut content = sphere(|_| true, [0; 3], [127; 3]);
    let mut far = content.parts[0].clone();
    far.centre = [0.0, -4.0, 0.0];
    content.parts.push(far);
    let evaluate = |content: &Content| {
        let bytes = content.encode();
        let template = Template::from_bytes(&bytes).unwrap();
        let settings = settings(Assignment::Nearest, Likelihood::Peak, SIGMA);
        let mixture = Mixture::<COMPONENTS>::new(&template, &settings).unwrap();
        let found = mixture.evaluate(&Point3::new(0.5, 11.0, 0.5));
        found.map(|found| found.component)
    };
    assert_eq!(evaluate(&content), Some(0));
    let mut out_of_box = content.clone();
    out_of_box.parts[0].validity.as_mut().unwrap().high = [127, 60, 127];
    assert_eq!(evaluate(&out_of_box), None);
    let valid = content.parts[0].validity.as_mut().unwrap();
    valid.cells[32..].fill(false);
    assert_eq!(evaluate(&content), Some(1));
}

#[test]
fn soft_mixes_those_that_speak() {
    let mut content = sphere(|_| true, [0; 3], [127; 3]);
    let mut silent = content.parts[0].clone();
    silent.centre = [0.0, 4.0, 0.0];
    silent.sigma_hat = 3.0;
    content.parts.push(silent);
    let alone = sphere(|_| true, [0; 3], [127; 3]);
    let settings = settings(Assignment::Soft, Likelihood::Peak, SIGMA);
    let point = Point3::new(0.5, 11.0, 0.5);
    let evaluate = |content: &Content| {
        let bytes = content.encode();
        let template = Template::from_bytes(&bytes).unwrap();
        let mixture = Mixture::<COMPONENTS>::new(&template, &settings).unwrap();
        mixture.evaluate(&point).unwrap()
    };
    let expected = evaluate(&alone);
    let both = evaluate(&content);
    assert_ne!(both.threshold, expected.threshold);
    let valid = content.parts[1].validity.as_mut().unwrap();
    valid.cells[32..].fill(false);
    assert_eq!(evaluate(&content), expected);
    let valid = content.parts[1].validity.as_mut().unwrap();
    valid.cells.fill(true);
    valid.high = [127, 60, 127];
    let boxed = evaluate(&content);
    assert_eq!(boxed.component, 0);
    assert!((boxed.threshold - expected.threshold).abs() < 1e-6);
    assert!((boxed.likelihood - expected.likelihood).abs() < 1e-6);
}

#[test]
fn points_that_nothing_speaks_for_are_counted_and_weigh_on_the_pose() {
    let upper = sphere(|cell| cell.row >= 4, [0; 3], [127; 3]);
    let bytes = upper.encode();
    let template = Template::from_bytes(&bytes).unwrap();
    let settings = Settings {
        minimum_points: 1,
        ..Settings::for_template(&template, 2.0)
    };
    assert_eq!(settings.assignment, Assignment::Maximum);
    let stream_of = [
        at([0.0, 12.0, 0.0]),
        at([0.0, -12.0, 0.0]),
        at([3.0, -11.0, 0.0]),
        // Behind the camera, and nowhere: neither is uncovered.
        correspondence([320.0, 240.0], [0.0, 0.0, -1000.0], 1.0),
        correspondence([320.0, 240.0], [0.0, f32::NAN, 0.0], 1.0),
    ];
    let (points, report) = stream(&template, &pose(0.0), &settings, &stream_of);
    assert_eq!(
        (report.points, report.uncovered, report.behind_camera),
        (5, 2, 1)
    );
    assert!(points[0].found.is_some());
    assert_eq!((points[1].likelihood, points[1].found), (0.0, None));
    let (_, covered) = stream(&template, &pose(0.0), &settings, &stream_of[..1]);
    assert_eq!(covered.uncovered, 0);
    let (_, part) = stream(&template, &pose(0.0), &settings, &stream_of[..3]);
    assert!((part.confidence - covered.confidence / 3.0).abs() < 1e-6);
    assert_eq!(part.threshold, covered.threshold);
}

#[test]
fn a_template_without_validity_asks_for_the_nearest() {
    let bytes = Content::small().encode();
    let template = Template::from_bytes(&bytes).unwrap();
    let settings = Settings::for_template(&template, 2.0);
    assert_eq!(settings.assignment, Assignment::Nearest);
}

#[test]
fn compact_terms_score_as_the_exact_ones_within_their_steps() {
    let exact = Content::small();
    let mut compact = exact.clone();
    for part in &mut compact.parts {
        *part = compacted(part);
        part.hyperparameters.length_scale *= GRID;
    }
    let (exact, compact) = (exact.encode(), compact.encode());
    let (exact, compact) = (
        Template::from_bytes(&exact).unwrap(),
        Template::from_bytes(&compact).unwrap(),
    );
    assert!(compact.has_compact_terms());
    let settings = settings(Assignment::Maximum, Likelihood::Peak, SIGMA);
    let a = Mixture::<COMPONENTS>::new(&exact, &settings).unwrap();
    let b = Mixture::<COMPONENTS>::new(&compact, &settings).unwrap();
    for point in POINTS {
        let point = Point3::from(point);
        let (a, b) = (a.evaluate(&point).unwrap(), b.evaluate(&point).unwrap());
        assert!((a.predicted - b.predicted).abs() < 1e-4, "{a:?} {b:?}");
    }
}
