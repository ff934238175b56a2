//! Maps in the place of terms: what is written is read, what does not fit is refused, the mean is the
//! documented one, and damage leads to no panic and to no NaN.

use crate::charts::{self, charts};
use crate::content::{Content, Map};
use crate::sections::{join, split, with_body};
use crate::template_mutations::{SPECIAL, every_byte_at_its_extremes, load_and_use};
use cobra_infer::template::{Number, Range};
use cobra_infer::validity::Pole;
use cobra_infer::{
    Assignment, EncodeError, Kernel, Metric, Mixture, Settings, Template, TemplateError, gp,
};
use nalgebra::Point3;
use proptest::prelude::*;

const TERMS: u16 = 4;
const VALIDITY: u16 = 6;

/// The small template with maps of 5 × 4 and 4 × 6 nodes.
fn small() -> Content {
    let mut content = charts::small();
    for (part, size) in content.parts.iter_mut().zip([[5, 4], [4, 6]]) {
        part.compact = None;
        part.hyperparameters.length_scale = 0.5;
        part.map = Some(Map {
            pole: Pole::MinusX,
            size,
            spacing: 1.25,
            origin: [0.5, 0.75],
            scale: 0.001,
            nodes: (0..size[0] * size[1])
                .map(|i| i.wrapping_mul(37) as i8)
                .collect(),
        });
    }
    content
}

/// Any template with validity, and with maps.
fn maps() -> impl Strategy<Value = Content> {
    let size = [4_u8..12, 4_u8..12];
    let map = (
        size,
        0.1_f32..40.0,
        [-3.0_f32..9.0, -3.0..9.0],
        1e-5_f32..0.01,
    )
        .prop_flat_map(|(size, spacing, origin, scale)| {
            let count = usize::from(size[0]) * usize::from(size[1]);
            prop::collection::vec(any::<i8>(), count).prop_map(move |nodes| Map {
                pole: Pole::PlusZ,
                size,
                spacing,
                origin,
                scale,
                nodes,
            })
        });
    (charts(), prop::collection::vec(map, 5)).prop_map(|(mut content, maps)| {
        for (part, map) in content.parts.iter_mut().zip(maps) {
            if let Some(valid) = &part.validity {
                let pole = valid.pole;
                part.compact = None;
                part.map = Some(Map { pole, ..map });
            }
        }
        content
    })
}

/// What the format's document says of the projection and of the mean, word by word.
fn documented(map: &Map, prior_mean: f32, [x, y, z]: [f32; 3]) -> f32 {
    let [a, b, c] = match map.pole {
        Pole::PlusZ => [x, y, z],
        Pole::PlusX => [y, z, x],
        Pole::PlusY => [z, x, y],
        Pole::MinusZ => [x, y, -z],
        Pole::MinusX => [y, z, -x],
        Pole::MinusY => [z, x, -y],
    };
    let n = 1.0 / ((a.abs() + b.abs()) + c.abs());
    let (mut p, mut q) = (a * n, b * n);
    if c < 0.0 {
        let sign = |t: f32| if t < 0.0 { -1.0 } else { 1.0 };
        (p, q) = ((1.0 - q.abs()) * sign(p), (1.0 - p.abs()) * sign(q));
    }
    let along = |at: f32, count: u8| {
        // Below 0 and of NaN 0, else rounded down.
        let first = (at as u32).min(u32::from(count - 4));
        let t = at - first as f32;
        let r = 1.0 - t;
        let weights = [
            (r * r) * r,
            (3.0 * t - 6.0) * (t * t) + 4.0,
            (3.0 * r - 6.0) * (r * r) + 4.0,
            (t * t) * t,
        ];
        (first as usize, weights)
    };
    let (column, w) = along(p * map.spacing + map.origin[0], map.size[0]);
    let (row, v) = along(q * map.spacing + map.origin[1], map.size[1]);
    let sum = |w: [f32; 4], n: [f32; 4]| (w[0] * n[0] + w[1] * n[1]) + (w[2] * n[2] + w[3] * n[3]);
    let rows = [0, 1, 2, 3].map(|j| {
        let first = (row + j) * usize::from(map.size[0]) + column;
        sum(w, [0, 1, 2, 3].map(|i| f32::from(map.nodes[first + i])))
    });
    prior_mean + map.scale * sum(v, rows)
}

proptest! {
    #![proptest_config(crate::seed::config())]

    #[test]
    fn what_is_encoded_is_decoded(content in maps()) {
        let bytes = content.encode();
        let template = Template::from_bytes(&bytes).unwrap();
        prop_assert!(template.has_maps() && !template.has_compact_terms());
        let nodes = content.parts.iter().map(|part| part.map.as_ref().unwrap().nodes.len());
        prop_assert_eq!(template.term_count(), nodes.sum::<usize>());
        prop_assert_eq!(template.cost().nearest, 16);
        prop_assert_eq!(template.cost().maximum, 16 * template.component_count());
        for (component, part) in template.components().zip(&content.parts) {
            let (read, written) = (component.terms.map().unwrap(), part.map.as_ref().unwrap());
            prop_assert_eq!([read.columns(), read.rows()], written.size);
            prop_assert_eq!(read.pole(), written.pole);
            prop_assert_eq!((read.scale(), read.spacing()), (written.scale, written.spacing));
            prop_assert_eq!(read.origin(), written.origin);
            prop_assert!(read.nodes().eq(written.nodes.iter().copied()));
            prop_assert_eq!(component.terms.iter().count(), 0);
        }
    }

    #[test]
    fn the_mean_is_the_documented_one_bit_by_bit(
        content in maps(),
        points in prop::collection::vec([-20.0_f32..20.0, -20.0..20.0, -20.0..20.0], 1..20),
    ) {
        let bytes = content.encode();
        let template = Template::from_bytes(&bytes).unwrap();
        let settings = Settings { assignment: Assignment::Maximum, ..Settings::with_delta(1.0) };
        let mixture = Mixture::<8>::new(&template, &settings).unwrap();
        for point in points {
            let of = |index: usize, towards: [f32; 3]| {
                let part = &content.parts[index];
                documented(part.map.as_ref().unwrap(), part.hyperparameters.prior_mean, towards)
            };
            for (index, component) in template.components().enumerate() {
                let (u, _) = gp::direction_and_distance(point, component.centre, 1e-6).unwrap();
                let found = component.posterior_mean(template.model(), &u);
                prop_assert_eq!(found.to_bits(), of(index, [u.x, u.y, u.z]).to_bits());
            }
            let Some(found) = mixture.evaluate(&Point3::from(point)) else { continue };
            let [cx, cy, cz] = content.parts[found.component].centre;
            let [x, y, z] = point;
            let expected = of(found.component, [x - cx, y - cy, z - cz]);
            prop_assert_eq!(found.predicted.to_bits(), expected.to_bits());
        }
    }

    #[test]
    fn damaged_maps_with_the_right_checksum_never_panic(
        content in maps(),
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let mut bytes = content.encode();
        for (place, value) in damage {
            let length = bytes.len() - 16;
            bytes[16 + place.index(length)] = value;
        }
        crate::sections::reseal(&mut bytes);
        load_and_use(&bytes);
    }
}

#[test]
fn every_byte_of_a_map_at_its_extremes_with_the_right_checksum_never_panics() {
    every_byte_at_its_extremes(&small());
}

#[test]
fn every_number_of_a_map_at_its_extremes_gives_no_nan() {
    let bytes = small().encode();
    let mut loaded = 0;
    for value in SPECIAL {
        for word in 0..4 {
            let damaged = with_body(&bytes, TERMS, |body| {
                body[2 + 4 * word..][..4].copy_from_slice(&value.to_le_bytes());
            });
            loaded += usize::from(load_and_use(&damaged));
        }
    }
    assert!(loaded > 20, "the test must reach the scorer: {loaded}");
}

#[test]
fn a_map_is_read_whatever_the_model() {
    let mut content = small();
    for kernel in Kernel::ALL {
        content.model.kernel = kernel;
        for part in &mut content.parts {
            let h = &mut part.hyperparameters;
            h.length_scale = kernel.fixed_length_scale().unwrap_or(0.5);
            h.parameter = kernel.fixed_parameter().unwrap_or(1.5);
        }
        for metric in Metric::ALL {
            content.model.metric = metric;
            let bytes = content.encode();
            let template = Template::from_bytes(&bytes).unwrap();
            let component = template.component(1).unwrap();
            let u = cobra_infer::UnitDirection::new_normalize([-1.0, 0.3, 0.2].into());
            let map = content.parts[1].map.as_ref().unwrap();
            let expected = documented(map, 10.0, [u.x, u.y, u.z]);
            let found = component.posterior_mean(template.model(), &u);
            assert_eq!(found.to_bits(), expected.to_bits());
        }
    }
}

#[test]
fn a_map_needs_a_validity() {
    let mut content = small();
    for part in &mut content.parts {
        part.validity = None;
    }
    let expected = EncodeError::Invalid(TemplateError::MapValidity);
    assert_eq!(content.try_encode(), Err(expected));
    let mut sections = split(&small().encode());
    sections.retain(|section| section.tag != VALIDITY);
    let found = Template::from_bytes(&join(&sections)).unwrap_err();
    assert_eq!(found, TemplateError::MapValidity);
}

fn with_map(change: impl FnOnce(&mut Map)) -> Result<Vec<u8>, EncodeError> {
    let mut content = small();
    change(content.parts[1].map.as_mut().unwrap());
    content.try_encode()
}

#[test]
fn numbers_of_a_map_out_of_their_range_are_refused() {
    type Place = fn(&mut Map) -> &mut f32;
    let places: [(Place, Number, Range); 4] = [
        (|map| &mut map.scale, Number::MapScale, Range::Normal),
        (|map| &mut map.spacing, Number::MapSpacing, Range::Normal),
        (|map| &mut map.origin[0], Number::MapOrigin, Range::Finite),
        (|map| &mut map.origin[1], Number::MapOrigin, Range::Finite),
    ];
    for (place, number, expected) in places {
        for value in [0.0, -1.0, f32::NAN, f32::INFINITY, 1e-40] {
            let found = with_map(|map| *place(map) = value);
            let holds = expected == Range::Finite && value.is_finite();
            assert_eq!(found.is_ok(), holds, "{number:?} {value}");
            let Err(error) = found else { continue };
            let EncodeError::Invalid(TemplateError::ComponentNumber {
                component: 1,
                number: found,
                ..
            }) = error
            else {
                panic!("{error}");
            };
            assert_eq!(found, number);
        }
    }
}

#[test]
fn maps_of_another_size_or_pole_are_refused() {
    let expected = EncodeError::TermCount {
        component: 1,
        directions: 24,
        weights: 23,
    };
    assert_eq!(with_map(|map| map.nodes.truncate(23)), Err(expected));
    let grid = |columns, rows, pole, found| TemplateError::MapGrid {
        component: 1,
        columns,
        rows,
        pole,
        found,
    };
    let narrow = with_map(|map| map.size = [3, 8]);
    assert_eq!(narrow, Err(EncodeError::Invalid(grid(3, 8, 4, 24))));
    let turned = with_map(|map| map.pole = Pole::PlusY);
    assert_eq!(turned, Err(EncodeError::Invalid(grid(4, 6, 2, 24))));
    // The second header lies behind the encoding, the length, and 20 + 20 bytes.
    let bytes = small().encode();
    for (at, value, expected) in [
        (16, 5, grid(5, 6, 4, 24)),
        (17, 7, grid(4, 7, 4, 24)),
        (17, 0, grid(4, 0, 4, 24)),
        (18, 6, grid(4, 6, 6, 24)),
        (19, 1, grid(4, 6, 4, 24)),
    ] {
        let damaged = with_body(&bytes, TERMS, |body| body[2 + 40 + at] = value);
        assert_eq!(Template::from_bytes(&damaged).unwrap_err(), expected);
    }
    let damaged = with_body(&bytes, TERMS, |body| {
        body[1] += 1;
        body.push(0);
    });
    let expected = TemplateError::UnusedTerms {
        expected: 84,
        found: 85,
    };
    assert_eq!(Template::from_bytes(&damaged).unwrap_err(), expected);
}

#[test]
fn maps_and_terms_are_not_mixed() {
    let mut content = small();
    content.parts[1].map = None;
    assert_eq!(content.try_encode(), Err(EncodeError::TermEncodings));
}
