//! That nobody sees which components were passed over.

use super::reach::Look;
use super::{Assignment, Likelihood, Match, Mixture, Settings, Sigma};
use crate::gp::{Hyperparameters, UnitDirection, evaluations};
use crate::kernel::{Exponent, Kernel, Model};
use crate::template::{
    ComponentSource, Template, TemplateSource, TermsSource, ValiditySource, encode, encoded_len,
};
use crate::unit::Unit;
use crate::validity::Pole;
use nalgebra::{Point3, Vector3};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::vec;
use std::vec::Vec;

const MOST: usize = 8;

#[derive(Clone, Debug)]
struct Part {
    centre: [f32; 3],
    sigma_hat: f32,
    prior_mean: f32,
    weights: Vec<f32>,
    pole: Pole,
    side: u8,
    cells: Vec<bool>,
    low: [u8; 3],
    high: [u8; 3],
}

impl Part {
    /// Valid everywhere.
    fn whole(centre: [f32; 3], prior_mean: f32) -> Self {
        Self {
            centre,
            sigma_hat: 0.5,
            prior_mean,
            weights: vec![0.25; 5],
            pole: Pole::PlusZ,
            side: 4,
            cells: vec![true; 16],
            low: [0; 3],
            high: [127; 3],
        }
    }
}

const RADIUS: f32 = 50.0;

fn encoded(parts: &[Part], centre: [f32; 3]) -> Vec<u8> {
    let directions: Vec<UnitDirection> = (0..8_u8)
        .map(|i| {
            let z = f32::from(i) * 0.25 - 0.9;
            UnitDirection::new_normalize(Vector3::new(0.7 - z * z, z * 0.5, z))
        })
        .collect();
    let components: Vec<ComponentSource<'_>> = parts
        .iter()
        .map(|part| ComponentSource {
            centre: part.centre,
            sigma_hat: part.sigma_hat,
            precision: None,
            hyperparameters: Hyperparameters {
                length_scale: 0.4,
                parameter: 1.0,
                prior_mean: part.prior_mean,
            },
            terms: TermsSource::Exact {
                directions: &directions[..part.weights.len()],
                weights: &part.weights,
            },
            validity: Some(ValiditySource {
                pole: part.pole,
                side: part.side,
                cells: &part.cells,
                low: part.low,
                high: part.high,
            }),
        })
        .collect();
    let source = TemplateSource {
        name: "pruned",
        unit: Unit::Millimetre,
        centre,
        radius: RADIUS,
        diameter: 2.0 * RADIUS,
        model: Model::chord(Kernel::RationalQuadratic(Exponent::One)),
        components: &components,
        quality: None,
        depth: None,
    };
    let mut bytes = vec![0; encoded_len(&source)];
    let length = encode(&source, &mut bytes).unwrap();
    bytes.truncate(length);
    bytes
}

fn settings(likelihood: Likelihood, sigma: Sigma) -> Settings {
    Settings {
        likelihood,
        sigma,
        assignment: Assignment::Maximum,
        ..Settings::with_delta(2.0)
    }
}

/// The mixture that asks every component.
fn unpruned<'t>(template: &'t Template<'t>, settings: &Settings) -> Mixture<'t, MOST> {
    let mut mixture = Mixture::new(template, settings).unwrap();
    mixture.reach.first = Look::EVERYWHERE;
    mixture
}

fn bits(found: Option<Match>) -> Option<(usize, [u32; 4])> {
    found.map(|found| {
        let numbers = [
            found.distance,
            found.predicted,
            found.likelihood,
            found.threshold,
        ];
        (found.component, numbers.map(f32::to_bits))
    })
}

fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![
        8 => -60.0_f32..60.0,
        1 => -1e6_f32..1e6,
        1 => proptest::sample::select(&[
            f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN, 1e19, -1e19, 0.0,
        ][..]),
    ]
}

/// Near or so far away that all of what it says is rounding, but predicting points of the object.
fn place() -> impl Strategy<Value = ([f32; 3], f32)> {
    let near = -15.0_f32..15.0;
    let towards = -1.0_f32..1.0;
    prop_oneof![
        5 => ([near.clone(), near.clone(), near], 5.0_f32..40.0),
        1 => ([towards.clone(), towards.clone(), towards], 1e3_f32..3e7, -30.0_f32..30.0).prop_map(
            |([x, y, z], far, beyond)| {
                let centre = Vector3::new(x + 2.0, y, z) * far;
                (centre.into(), centre.norm() + beyond)
            }
        ),
    ]
}

fn part() -> impl Strategy<Value = Part> {
    // Of every size, but often such that several find a point possible.
    let sigma_hat = prop_oneof![3 => -1.0_f32..3.0, 1 => -9.0_f32..7.0].prop_map(libm::exp2f);
    let axis = prop_oneof![
        2 => Just((0, 127)),
        1 => (0_u8..128, 0_u8..128).prop_map(|(a, b)| (a.min(b), a.max(b))),
    ];
    (
        place(),
        sigma_hat,
        proptest::collection::vec(-2.0_f32..2.0, 1..8),
        proptest::sample::select(Pole::ALL.as_slice()),
        (1_u8..=3).prop_flat_map(|blocks| {
            let cells = usize::from(blocks * 4).pow(2);
            let cell = proptest::bool::weighted(0.9);
            (Just(blocks * 4), proptest::collection::vec(cell, cells))
        }),
        [axis.clone(), axis.clone(), axis],
    )
        .prop_map(
            |((centre, prior_mean), sigma_hat, weights, pole, (side, mut cells), axes)| {
                cells[0] = true;
                Part {
                    centre,
                    sigma_hat,
                    prior_mean,
                    weights,
                    pole,
                    side,
                    cells,
                    low: axes.map(|(low, _)| low),
                    high: axes.map(|(_, high)| high),
                }
            },
        )
}

/// On what a component predicts, or beside it by a share of its σ.
type Beside = (proptest::sample::Index, [f32; 3], f32);

fn beside(template: &Template<'_>, (index, towards, by): &Beside) -> Option<[f32; 3]> {
    let component = template.component(index.index(template.component_count()))?;
    let u = UnitDirection::try_new(Vector3::from(*towards), 1e-3)?;
    let distance = component.posterior_mean(template.model(), &u) + by * component.sigma_hat;
    let [x, y, z] = component.centre;
    Some([x + distance * u.x, y + distance * u.y, z + distance * u.z])
}

fn config() -> ProptestConfig {
    ProptestConfig {
        rng_seed: RngSeed::Fixed(1),
        cases: 2000,
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

fn agree(template: &Template<'_>, point: [f32; 3]) -> (usize, usize) {
    let mut spoken = 0;
    let mut saved = 0;
    for likelihood in [Likelihood::Peak, Likelihood::Density] {
        for sigma in [
            Sigma::Template { noise: 0.0 },
            Sigma::Template { noise: 3.0 },
            Sigma::Fixed(0.02),
            Sigma::Fixed(1e-30),
            Sigma::Fixed(f32::MAX),
        ] {
            let settings = settings(likelihood, sigma);
            let all = unpruned(template, &settings);
            let some = Mixture::<MOST>::new(template, &settings).unwrap();
            let point = Point3::from(point);
            let (expected, most) = evaluations::during(|| all.evaluate(&point));
            let (found, made) = evaluations::during(|| some.evaluate(&point));
            assert_eq!(bits(found), bits(expected), "{settings:?} {point}");
            assert!(made <= most, "asked twice: {made} of {most}");
            spoken += usize::from(found.is_some());
            saved += usize::from(made < most);
        }
    }
    (spoken, saved)
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn the_answer_does_not_show_which_components_were_passed_over(
        parts in proptest::collection::vec(part(), 1..=MOST),
        centre in [-5.0_f32..5.0, -5.0..5.0, -5.0..5.0],
        points in proptest::collection::vec([coordinate(), coordinate(), coordinate()], 1..8),
        near in proptest::collection::vec(
            (any::<proptest::sample::Index>(), [-1.0_f32..1.0, -1.0..1.0, -1.0..1.0], -6.0_f32..6.0),
            1..16,
        ),
    ) {
        let bytes = encoded(&parts, centre);
        let template = Template::from_bytes(&bytes).unwrap();
        let near = near.iter().filter_map(|near| beside(&template, near));
        let centres = parts.iter().map(|part| part.centre);
        for point in points.into_iter().chain(near).chain(centres) {
            agree(&template, point);
        }
    }
}

#[test]
fn equals_go_to_the_first_whenever_they_are_asked() {
    // The second is asked first: its box holds the point, the first one's begins beyond its reach. Both
    // residuals are 8, and so is the third's.
    let mut parts = vec![Part::whole([0.0; 3], 18.0); 3];
    for part in &mut parts {
        part.weights.fill(0.0);
    }
    parts[1].prior_mean = 2.0;
    parts[0].low = [80, 0, 0];
    parts[1].high = [70, 127, 127];
    let bytes = encoded(&parts, [0.0; 3]);
    let template = Template::from_bytes(&bytes).unwrap();
    let settings = settings(Likelihood::Peak, Sigma::Template { noise: 0.0 });
    let mixture = Mixture::<MOST>::new(&template, &settings).unwrap();
    let found = mixture.evaluate(&Point3::new(10.0, 0.0, 0.0)).unwrap();
    assert_eq!(found.component, 0);
    agree(&template, [10.0, 0.0, 0.0]);
}

#[test]
fn a_point_on_one_of_many_patches_asks_few() {
    // Six faces of a cube around the origin, each with its own slab as box.
    let parts: Vec<Part> = (0..6_usize)
        .map(|face| {
            let mut part = Part::whole([0.0; 3], 30.0);
            part.weights.fill(0.0);
            let (axis, above) = (face / 2, face % 2 == 1);
            part.low[axis] = if above { 96 } else { 0 };
            part.high[axis] = if above { 127 } else { 31 };
            part
        })
        .collect();
    let bytes = encoded(&parts, [0.0; 3]);
    let template = Template::from_bytes(&bytes).unwrap();
    let (mut spoken, mut saved) = (0, 0);
    for point in [[30.0, 0.0, 0.0], [0.0, -30.5, 1.0], [1.0, -1.0, 29.0]] {
        let (s, c) = agree(&template, point);
        (spoken, saved) = (spoken + s, saved + c);
    }
    assert!(
        spoken >= 12 && saved >= 12,
        "{spoken} spoken, {saved} saved"
    );
    let settings = settings(Likelihood::Peak, Sigma::Template { noise: 0.0 });
    let mixture = Mixture::<MOST>::new(&template, &settings).unwrap();
    let (found, made) = evaluations::during(|| mixture.evaluate(&Point3::new(30.0, 0.0, 0.0)));
    assert_eq!(found.map(|found| found.component), Some(1));
    assert_eq!(made, 5, "one component of five terms");
}

#[test]
fn components_of_every_group_are_found() {
    // A sphere of 18 around each of 70 points along x, each with its own slice of it as box.
    let parts: Vec<Part> = (0..70_u8)
        .map(|index| {
            let x = f32::from(index) * 1.4 - 48.0;
            let mut part = Part::whole([x, 0.0, 0.0], 18.0);
            part.weights.fill(0.0);
            let position = 64.0 + x * 64.0 / RADIUS;
            part.low[0] = (position - 2.0).max(0.0) as u8;
            part.high[0] = (position + 2.0).min(127.0) as u8;
            part
        })
        .collect();
    let bytes = encoded(&parts, [0.0; 3]);
    let template = Template::from_bytes(&bytes).unwrap();
    let settings = settings(Likelihood::Peak, Sigma::Template { noise: 0.0 });
    let some = Mixture::<70>::new(&template, &settings).unwrap();
    let mut all = some.clone();
    all.reach.first = Look::EVERYWHERE;
    for (index, part) in parts.iter().enumerate() {
        let [x, ..] = part.centre;
        for off in [0.0, 0.3, 2.5, 6.0] {
            let point = Point3::new(x, 18.0 + off, 0.0);
            let (found, made) = evaluations::during(|| some.evaluate(&point));
            let (expected, most) = evaluations::during(|| all.evaluate(&point));
            assert_eq!(bits(found), bits(expected), "{index} {off}");
            assert!(
                found.is_some() && (off > 1.0 || made < most / 8),
                "{made} of {most}"
            );
        }
    }
}
