//! Damage that the checksum does not find: whatever loads can be used, without a panic and without
//! a NaN.

use crate::charts::{self, charts};
use crate::content::{Content, content};
use crate::scene::{
    COMPONENTS, EVERY_RULE, THRESHOLDS, at, correspondence, has_nan, pose, settings, stream,
};
use crate::sections::{Raw, join, reseal, set_record_word, set_term_word, split};
use cobra_infer::template::{Precision, peek_len};
use cobra_infer::{Kernel, Metric, Model, Settings, Sigma, Template};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::Index;

/// Numbers at which arithmetic goes wrong.
pub(crate) const SPECIAL: [f32; 20] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    1e-45,
    1e-40,
    f32::MIN_POSITIVE,
    -f32::MIN_POSITIVE,
    1e-30,
    1e-19,
    1e-7,
    1e7,
    1e18,
    1e19,
    -1e30,
    1e38,
    f32::MAX,
    f32::MIN,
    f32::INFINITY,
    f32::NAN,
];

/// Loads and, where that succeeds, scores under every rule.
pub(crate) fn load_and_use(bytes: &[u8]) -> bool {
    let Ok(template) = Template::from_bytes(bytes) else {
        return false;
    };
    let correspondences = [
        at([10.0, 0.0, 0.0]),
        at([0.0, -12.0, 3.0]),
        // On a reference point of the small template.
        at([-2.0, 0.5, -0.25]),
        correspondence([1e30, -1e30], [1e-40, 0.0, 0.0], 1.0),
        correspondence([0.0, 0.0], [0.0, 0.0, -1000.0], 1.0),
        correspondence([320.0, 240.0], [1e38, 1e38, 1e38], 1e-3),
    ];
    for (assignment, likelihood) in EVERY_RULE {
        for sigma in [Sigma::Template { noise: 0.0 }, Sigma::Fixed(1e-30)] {
            if template.component_count() > COMPONENTS {
                continue;
            }
            for threshold in THRESHOLDS {
                let settings = Settings {
                    threshold,
                    ..settings(assignment, likelihood, sigma)
                };
                let (points, report) = stream(&template, &pose(0.0), &settings, &correspondences);
                assert!(!has_nan(&points, &report), "{points:?}\n{report:?}");
            }
        }
    }
    true
}

proptest! {
    #![proptest_config(crate::seed::config())]

    #[test]
    fn random_bytes_never_panic(bytes in vec(any::<u8>(), 0..300)) {
        prop_assert!(!load_and_use(&bytes));
        let _ = peek_len(&bytes);
    }

    #[test]
    fn random_sections_never_panic(
        bodies in vec((0_u16..9, 0_u16..2, vec(any::<u8>(), 0..120)), 0..6),
    ) {
        let sections: Vec<Raw> = bodies
            .into_iter()
            .map(|(tag, flags, body)| Raw { tag, flags, body })
            .collect();
        load_and_use(&join(&sections));
    }

    #[test]
    fn damaged_bytes_with_the_right_checksum_never_panic(
        content in content(),
        damage in vec((any::<Index>(), any::<u8>()), 1..6),
    ) {
        let mut bytes = content.encode();
        for (place, value) in damage {
            let length = bytes.len() - 16;
            bytes[16 + place.index(length)] = value;
        }
        reseal(&mut bytes);
        load_and_use(&bytes);
    }

    #[test]
    fn damaged_charts_with_the_right_checksum_never_panic(
        content in charts(),
        damage in vec((any::<Index>(), any::<u8>()), 1..6),
    ) {
        let mut bytes = content.encode();
        for (place, value) in damage {
            let length = bytes.len() - 16;
            bytes[16 + place.index(length)] = value;
        }
        reseal(&mut bytes);
        load_and_use(&bytes);
    }

    #[test]
    fn removed_or_inserted_bytes_with_the_right_checksum_never_panic(
        content in content(),
        section in any::<Index>(),
        from in any::<Index>(),
        to in any::<Index>(),
        inserted in vec(any::<u8>(), 0..5),
    ) {
        let mut sections = split(&content.encode());
        let section = section.index(sections.len());
        let body = &mut sections[section].body;
        let (from, to) = (from.index(body.len()), to.index(body.len()));
        body.splice(from.min(to)..from.max(to), inserted);
        load_and_use(&join(&sections));
    }
}

#[test]
fn every_byte_at_its_extremes_with_the_right_checksum_never_panics() {
    every_byte_at_its_extremes(&Content::small());
}

#[test]
fn every_byte_of_a_chart_at_its_extremes_with_the_right_checksum_never_panics() {
    every_byte_at_its_extremes(&charts::small());
}

pub(crate) fn every_byte_at_its_extremes(content: &Content) {
    let bytes = content.encode();
    let mut loaded = 0;
    for place in 16..bytes.len() {
        for value in [0x00, 0x01, 0x7f, 0x80, 0xff, !bytes[place]] {
            let mut damaged = bytes.clone();
            damaged[place] = value;
            reseal(&mut damaged);
            loaded += usize::from(load_and_use(&damaged));
        }
    }
    assert!(loaded > 100, "the test must reach the scorer: {loaded}");
}

/// The small template with every kernel and metric, and precisions.
fn every_model() -> impl Iterator<Item = Content> {
    let models = Metric::ALL
        .into_iter()
        .flat_map(|metric| Kernel::ALL.map(|kernel| Model { metric, kernel }));
    models.map(|model| {
        let mut content = Content::small();
        content.model = model;
        for part in &mut content.parts {
            let h = &mut part.hyperparameters;
            h.length_scale = model.kernel.fixed_length_scale().unwrap_or(0.5);
            h.parameter = model.kernel.fixed_parameter().unwrap_or(1.5);
            part.precision = Precision::from_factor([0.5, 0.1, 0.25, -0.2, 0.0, 0.125]);
        }
        content
    })
}

#[test]
fn every_number_at_its_extremes_gives_no_nan() {
    let mut loaded = 0;
    for content in every_model() {
        let bytes = content.encode();
        for value in SPECIAL {
            for word in 0..7 {
                let damaged = set_record_word(&bytes, 0, word, value.to_le_bytes());
                loaded += usize::from(load_and_use(&damaged));
            }
            for word in 0..20 {
                let damaged = set_term_word(&bytes, word, value);
                loaded += usize::from(load_and_use(&damaged));
            }
            for word in 0..6 {
                let mut sections = split(&bytes);
                let body = &mut sections.last_mut().unwrap().body;
                body[2 + 4 * word..][..4].copy_from_slice(&value.to_le_bytes());
                loaded += usize::from(load_and_use(&join(&sections)));
            }
        }
    }
    assert!(loaded > 1000, "the test must reach the scorer: {loaded}");
}

#[test]
fn sums_that_overflow_give_no_nan() {
    let mut content = Content::small();
    for part in &mut content.parts {
        // In one direction +∞, in the other −∞, and ∞ − ∞ between them.
        part.weights.fill(f32::MAX);
        part.weights[1] = f32::MIN;
        part.hyperparameters.prior_mean = f32::MAX;
        part.hyperparameters.length_scale = 1e9;
        part.centre = [f32::MIN, 0.0, f32::MAX];
        part.sigma_hat = f32::MIN_POSITIVE;
        assert!(load_and_use(&content_of(part)));
    }
    content.radius = f32::MAX;
    assert!(load_and_use(&content.encode()));
}

fn content_of(part: &crate::content::Part) -> Vec<u8> {
    let mut content = Content::small();
    content.parts = vec![part.clone()];
    content.encode()
}
