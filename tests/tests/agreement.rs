//! The agreement vectors score the recorded bits on this host, and would show it if not.

use cobra_agreement::golden::GOLDEN;
use cobra_agreement::vectors::{CASES, COMPONENTS, Points, Unreadable, compare, compare_telling};
use cobra_agreement::{Outcome, SETS, Set, report};
use cobra_infer::gp::direction_and_distance;
use cobra_infer::template::{Component, DecodedTerm};
use cobra_infer::validity::BoxGrid;
use cobra_infer::{Assignment, Camera, Correspondence, Scorer, Settings, Template, tolerance};

#[test]
fn the_host_scores_the_recorded_bits_of_every_set() {
    for set in SETS {
        let outcome = compare(&set).unwrap();
        assert_eq!(outcome.mismatched_bits, 0, "{}", set.name);
        assert_eq!(outcome.points, 2000, "{}", set.name);
        assert!(outcome.words > 2000 * CASES.len() as u32 * 9 / 10);
    }
}

#[test]
fn decoded_terms_score_the_bits_of_compact_ones_and_tell_the_same() {
    for set in SETS {
        let template = Template::from_bytes(set.template).unwrap();
        let mut room = vec![DecodedTerm::default(); template.decoded_len()];
        assert_eq!(room.is_empty(), !template.has_compact_terms());
        if !room.is_empty() {
            let short = room.len() - 1;
            assert!(template.decoded(&mut room[..short]).is_none());
        }
        let decoded = template.decoded(&mut room).unwrap();
        assert_eq!(decoded.cost(), template.cost());
        assert_eq!(decoded.terms_len(), template.terms_len());
        for (one, other) in template.components().zip(decoded.components()) {
            assert!(one.terms.iter().eq(other.terms.iter()));
            assert_eq!(one.terms.compact_scale(), other.terms.compact_scale());
        }
        let points = Points::read(set.points).unwrap();
        let (camera, pose) = (points.camera().unwrap(), points.pose(0, false).unwrap());
        for assignment in [Assignment::Nearest, Assignment::Maximum, Assignment::Soft] {
            let settings = Settings {
                assignment,
                ..Settings::with_delta(2.0)
            };
            let [mut one, mut other] = [&template, &decoded].map(|template| {
                Scorer::<COMPONENTS>::new(template, &camera, &pose, &settings).unwrap()
            });
            for correspondence in points.correspondences() {
                let bits = |scorer: &mut Scorer<'_, COMPONENTS>| {
                    scorer.push(&correspondence).likelihood.to_bits()
                };
                assert_eq!(bits(&mut one), bits(&mut other), "{}", set.name);
            }
        }
    }
}

#[test]
fn a_flipped_bit_anywhere_in_the_record_is_counted_once() {
    let set = SETS[2];
    for place in (0..set.expected.len()).step_by(997) {
        let mut expected = set.expected.to_vec();
        expected[place] ^= 1 << (place % 8);
        let set = Set {
            expected: expected.leak(),
            ..set
        };
        assert_eq!(compare(&set).unwrap().mismatched_bits, 1);
    }
}

#[test]
fn a_word_that_differs_is_told_with_its_case_and_its_place() {
    let set = SETS[2];
    let told = |word: usize| {
        let mut expected = set.expected.to_vec();
        expected[4 * word] ^= 1;
        let expected = &*expected.leak();
        let mut told = Vec::new();
        compare_telling(&Set { expected, ..set }, |difference| {
            told.push(difference.to_string());
        })
        .unwrap();
        assert_eq!(told.len(), 1);
        // The bits are those of the vectors: what is promised is all before them.
        told[0].split_once(": expected ").unwrap().0.to_owned()
    };
    assert_eq!(told(17), "case 0, likelihood of correspondence 17");
    assert_eq!(told(2000), "case 0, confidence");
    assert_eq!(told(2006), "case 0, decision");
    assert_eq!(told(2007), "case 1, likelihood of correspondence 0");
}

#[test]
fn the_report_is_of_every_set_and_every_golden_template() {
    let mut text = String::new();
    assert_eq!(report::write(&mut text, &SETS, || {}), Ok(true));
    for set in SETS {
        assert!(text.contains(&format!("agreement {} points=2000 ", set.name)));
    }
    let replayed = format!("golden vectors of {} templates", GOLDEN.len());
    assert!(text.contains(&replayed), "{text}");
    let scenes = SETS.iter().filter(|set| set.depth.is_some()).count();
    assert_eq!(text.lines().count(), SETS.len() + scenes + 2, "{text}");
}

#[test]
fn a_record_of_another_length_is_no_agreement() {
    let set = SETS[2];
    let longer = [set.expected, &[0; 4]].concat().leak();
    for expected in [&set.expected[4..], &longer[..], &[]] {
        let Outcome {
            mismatched_bits, ..
        } = compare(&Set { expected, ..set }).unwrap();
        assert!(mismatched_bits >= 32);
    }
}

#[test]
fn a_set_that_does_not_read_is_an_error() {
    let set = SETS[2];
    for points in [&set.points[1..], &set.points[..set.points.len() - 4], &[]] {
        let outcome = compare(&Set { points, ..set });
        assert_eq!(outcome, Err(Unreadable::Points));
    }
    let template = &set.template[1..];
    assert!(matches!(
        compare(&Set { template, ..set }),
        Err(Unreadable::Template(_))
    ));
}

/// Every number of every correspondence, by its place in the row.
fn rows(points: &Points<'_>) -> Vec<[f32; 6]> {
    let row = |c: Correspondence| {
        let [u, v]: [f32; 2] = c.pixel.into();
        let [x, y, z]: [f32; 3] = c.point.into();
        [u, v, x, y, z, c.weight]
    };
    points.correspondences().map(row).collect()
}

#[test]
fn every_set_holds_what_is_awkward() {
    for set in SETS {
        let template = Template::from_bytes(set.template).unwrap();
        let points = Points::read(set.points).unwrap();
        let rows = rows(&points);
        for place in 0..6 {
            let column = || rows.iter().map(|row| row[place]);
            assert!(column().any(f32::is_nan), "{} {place}", set.name);
            assert!(
                column().any(|x| x == f32::INFINITY) && column().any(|x| x == f32::NEG_INFINITY)
            );
            assert!(column().any(f32::is_subnormal));
        }
        assert!(rows.iter().any(|row| row[5] == 0.0));
        assert!(rows.iter().any(|row| row[5] < 0.0));
        let camera: Camera = points.camera().unwrap();
        let pose = points.pose(0, false).unwrap();
        let back: Vec<_> = points
            .correspondences()
            .filter(Correspondence::is_finite)
            .map(|c| camera.back_project(&pose, &c.pixel, &c.point))
            .collect();
        assert!(back.iter().any(|b| b.depth < 0.0), "behind the camera");
        let radius = template.radius();
        let from = |centre: [f32; 3]| {
            let offsets = back
                .iter()
                .map(move |b| b.point.coords - nalgebra::Vector3::from(centre));
            offsets.filter(|offset| offset.norm().is_finite())
        };
        let centres = || template.components().map(|component| component.centre);
        let on_a_reference_point = centres()
            .flat_map(from)
            .any(|offset| offset.norm() < tolerance::NO_DIRECTION * radius);
        assert!(on_a_reference_point, "{}", set.name);
        let on_a_pole = centres().flat_map(from).any(|offset| {
            offset.norm() > 0.1 * radius && offset.xy().norm() < 1e-4 * offset.norm()
        });
        assert!(on_a_pole, "{}", set.name);
        let far_away = centres()
            .flat_map(from)
            .any(|offset| offset.norm() > 1e6 * radius);
        assert!(far_away, "{}", set.name);
    }
}

/// What a component with validity has to say of a point.
#[derive(Clone, Copy, PartialEq)]
enum Says {
    NotInThisDirection,
    OutsideOfItsBox,
    /// Whether at the edge of its box.
    Something {
        at_the_edge: bool,
    },
}

fn says(template: &Template<'_>, component: &Component<'_>, point: [f32; 3]) -> Says {
    let valid = component.validity.expect("validity");
    let Some((u, _)) = direction_and_distance(point, component.centre, 0.0) else {
        return Says::NotInThisDirection;
    };
    if !valid.contains_direction(u.into_inner().into()) {
        return Says::NotInThisDirection;
    }
    let distance = component.posterior_mean(template.model(), &u);
    let predicted = nalgebra::Vector3::from(component.centre) + u.into_inner() * distance;
    let position = BoxGrid::new(template.centre(), template.radius()).position(predicted.into());
    let sides = || position.into_iter().zip(valid.low()).zip(valid.high());
    if sides().any(|((at, low), high)| at < low || at > high) {
        Says::OutsideOfItsBox
    } else {
        let at_the_edge = sides().any(|((at, low), high)| at == low || at == high);
        Says::Something { at_the_edge }
    }
}

#[test]
fn sets_with_validity_hold_points_that_components_speak_of_and_others() {
    let (mut compact, mut maps) = (0, 0);
    for set in SETS {
        let template = Template::from_bytes(set.template).unwrap();
        if !template.has_validity() {
            continue;
        }
        compact += usize::from(template.has_compact_terms());
        maps += usize::from(template.has_maps());
        let points = Points::read(set.points).unwrap();
        let (camera, pose) = (points.camera().unwrap(), points.pose(0, false).unwrap());
        let said: Vec<Vec<Says>> = points
            .correspondences()
            .filter(Correspondence::is_finite)
            .map(|c| camera.back_project(&pose, &c.pixel, &c.point).point)
            .map(|point| {
                let all = template.components();
                all.map(|c| says(&template, &c, point.coords.into()))
                    .collect()
            })
            .collect();
        let count =
            |holds: &dyn Fn(&Says) -> bool| said.iter().flatten().filter(|s| holds(s)).count();
        let silent = |said: &&Vec<Says>| said.iter().all(|s| *s == Says::NotInThisDirection);
        let spoken_of = said.iter().filter(|said| !silent(said)).count();
        assert!(spoken_of > 1000, "{}: {spoken_of}", set.name);
        assert!(said.len() - spoken_of > 60, "{}", set.name);
        let outside = count(&|s| *s == Says::OutsideOfItsBox);
        assert!(outside > 20, "{}: {outside}", set.name);
        let edge = count(&|s| *s == Says::Something { at_the_edge: true });
        assert!(edge > 20, "{}: {edge}", set.name);
        // The most probable of several is to be found.
        let contested = said.iter().filter(|said| {
            let speaks = |s: &&Says| matches!(s, Says::Something { .. });
            said.iter().filter(speaks).count() > 1
        });
        let contested = contested.count();
        assert!(contested > 50, "{}: {contested}", set.name);
    }
    assert!(compact > 0 && maps > 0);
}
