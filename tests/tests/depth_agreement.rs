//! The depth check has the recorded bits on this host, and what is recorded is worth comparing.

use cobra_agreement::depth::{self, HEIGHT, PIXELS, REPORT_WORDS, SETTINGS, Scene, WIDTH};
use cobra_agreement::golden::GOLDEN;
use cobra_agreement::{SETS, Set};
use cobra_infer::Template;
use std::collections::HashSet;

fn scenes() -> impl Iterator<Item = (&'static Set, &'static depth::Depth)> {
    SETS.iter()
        .filter_map(|set| Some((set, set.depth.as_ref()?)))
}

fn compared(set: &Set, scene: &depth::Depth, expected: &[u8]) -> depth::Checked {
    let words =
        |each: &mut dyn FnMut(u32)| depth::words(set.template, scene.scene, scene.image, each);
    depth::compare(expected, words, |_| {}).unwrap()
}

#[test]
fn the_host_checks_poses_to_the_recorded_bits() {
    for (set, scene) in scenes() {
        let checked = compared(set, scene, scene.expected);
        assert_eq!(checked.mismatched_bits, 0, "{}", set.name);
        let poses = Scene::read(scene.scene).unwrap().poses().count();
        let reports = poses * SETTINGS.len() * 2 * REPORT_WORDS;
        assert!(checked.words as usize > reports + 100, "{}", set.name);
    }
    let templates = scenes().map(|(set, _)| Template::from_bytes(set.template).unwrap());
    let maps: Vec<bool> = templates.map(|template| template.has_maps()).collect();
    assert_eq!(maps, [false, true]);
}

#[test]
fn the_gradients_of_every_kernel_and_metric_have_the_recorded_bits() {
    for golden in GOLDEN {
        assert!(golden.gradients.len() > 300, "{}", golden.name);
        assert_eq!(golden.compare_gradients(), Ok(0), "{}", golden.name);
    }
}

#[test]
fn a_flipped_bit_anywhere_in_a_record_is_counted_once() {
    let (set, scene) = scenes().next().unwrap();
    for place in (0..scene.expected.len()).step_by(997) {
        let mut expected = scene.expected.to_vec();
        expected[place] ^= 1 << (place % 8);
        assert_eq!(compared(set, scene, &expected).mismatched_bits, 1);
    }
    let short = &scene.expected[4..];
    assert!(compared(set, scene, short).mismatched_bits >= 32);
}

#[test]
fn a_word_that_differs_is_told_with_its_check_and_its_place() {
    let (set, scene) = scenes().next().unwrap();
    let mut expected = scene.expected.to_vec();
    expected[4 * (2 * REPORT_WORDS + 5)] ^= 1;
    let mut told = Vec::new();
    depth::compare(
        &expected,
        |each| depth::words(set.template, scene.scene, scene.image, each),
        |difference| told.push(difference.to_string()),
    )
    .unwrap();
    assert_eq!(told.len(), 1);
    assert!(told[0].starts_with("depth check 2, word 5: expected "));
}

#[test]
fn every_scene_holds_what_a_check_can_meet() {
    for (set, scene) in scenes() {
        let words = scene.expected.as_chunks().0.iter();
        let words: Vec<u32> = words.copied().map(u32::from_le_bytes).collect();
        let count = Scene::read(scene.scene).unwrap().poses().count() * SETTINGS.len() * 2;
        let reports: Vec<&[u32]> = words.chunks(REPORT_WORDS).take(count).collect();
        let some = |holds: &dyn Fn(&[u32]) -> bool| reports.iter().any(|report| holds(report));
        // Silent and unmeasured, hidden and seen through.
        for place in [25, 28, 29, 30] {
            assert!(some(&|report| report[place] > 0), "{} {place}", set.name);
        }
        // Behind the camera nothing is visible.
        assert!(some(&|report| report[26] == 0));
        let different =
            |place: usize| -> HashSet<u32> { reports.iter().map(|report| report[place]).collect() };
        assert!(different(31).len() >= 5, "decisions of {}", set.name);
        assert!(different(32).len() >= 5, "causes of {}", set.name);
        assert!(some(&|report| f32::from_bits(report[0]) > 0.7));
        // Every number is one.
        for report in &reports {
            let numbers = report[..24].iter().copied().map(f32::from_bits);
            assert!(numbers.into_iter().all(f32::is_finite), "{}", set.name);
        }
        assert!(scene.image.contains(&0) && scene.image.len() == WIDTH * HEIGHT);
        let mut room = vec![depth::NO_PIXEL; PIXELS + 1];
        let read = Scene::read(scene.scene).unwrap();
        let pixels = read.observed(&read.image(scene.image).unwrap(), &mut room);
        assert!(pixels.len() <= PIXELS && pixels.iter().any(|pixel| pixel.depth == 0.0));
    }
}
