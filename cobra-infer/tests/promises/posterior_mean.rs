//! The posterior mean: right against a plain sum in `f64`, and bit for bit the documented order of
//! summation.
#![expect(
    clippy::disallowed_methods,
    reason = "the reference values are computed independently of the crate's own functions"
)]

use crate::content::{Part, direction, model, part};
use crate::tolerance::POSTERIOR_MEAN;
use cobra_infer::gp::{Terms, UnitDirection, Word, posterior_mean};
use cobra_infer::{Exponent, Kernel, Model, Smoothness};
use core::f64::consts::PI;
use proptest::prelude::*;

fn coordinates(model: Model, u: &UnitDirection) -> [f32; 3] {
    model.metric.coordinates([u.x, u.y, u.z]).unwrap()
}

fn words(model: Model, part: &Part) -> Vec<Word> {
    let directions = part.directions.iter().map(|u| coordinates(model, u));
    let xs = directions.clone().map(|[x, _, _]| x);
    let ys = directions.clone().map(|[_, y, _]| y);
    let zs = directions.map(|[_, _, z]| z);
    xs.chain(ys)
        .chain(zs)
        .chain(part.weights.iter().copied())
        .map(f32::to_le_bytes)
        .collect()
}

fn computed(model: Model, part: &Part, u: &UnitDirection) -> f32 {
    let words = words(model, part);
    let terms = Terms::from_words(&words).unwrap();
    posterior_mean(model, &part.hyperparameters, &terms, u)
}

/// k in `f64`, and the size that its rounding in `f32` is relative to: the rational quadratic's is
/// its own; an exponential's is 1, because its argument is rounded; a polynomial's is that without
/// cancellation.
fn kernel(kernel: Kernel, l: f64, p: f64, a: [f64; 3], b: [f64; 3]) -> (f64, f64) {
    let d = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let s: f64 = d.iter().map(|d| d * d).sum();
    let products = [a[0] * b[0], a[1] * b[1], a[2] * b[2]];
    let q: f64 = products.iter().sum();
    let size: f64 = products.iter().map(|q| q.abs()).sum();
    match kernel {
        Kernel::RationalQuadratic(_) => {
            let k = (1.0 + s / (2.0 * p * l * l)).powf(-p);
            (k, k)
        }
        Kernel::RadialBasis => ((-s / (2.0 * l * l)).exp(), 1.0),
        Kernel::Matern(Smoothness::Half) => ((-s.sqrt() / l).exp(), 1.0),
        Kernel::Matern(Smoothness::ThreeHalves) => {
            let z = (3.0 * s).sqrt() / l;
            ((1.0 + z) * (-z).exp(), 1.0)
        }
        Kernel::Matern(Smoothness::FiveHalves) => {
            let z = (5.0 * s).sqrt() / l;
            ((1.0 + z + z * z / 3.0) * (-z).exp(), 1.0)
        }
        Kernel::Linear => (q, size),
        Kernel::Polynomial => ((q + p).powi(3), (size + p).powi(3)),
        Kernel::Periodic => {
            let squares: f64 = d.iter().map(|d| (PI * d / p).sin().powi(2)).sum();
            // The sines' own rounding is amplified by 1/l², at most 400 here.
            ((-2.0 * squares / (l * l)).exp(), 1.0 + 2.0 / (l * l))
        }
    }
}

/// The mean and |m| + Σ|wᵢ|kᵢ, in `f64`, term by term.
fn plain(model: Model, part: &Part, u: &UnitDirection) -> (f64, f64) {
    let h = &part.hyperparameters;
    let [l, p, m] = [h.length_scale, h.parameter, h.prior_mean].map(f64::from);
    let query = coordinates(model, u).map(f64::from);
    let mut sums = (m, m.abs());
    for (v, w) in part.directions.iter().zip(&part.weights) {
        let term = coordinates(model, v).map(f64::from);
        let (k, size) = kernel(model.kernel, l, p, query, term);
        sums.0 += f64::from(*w) * k;
        sums.1 += f64::from(w.abs()) * size;
    }
    sums
}

/// The order of summation of the rational quadratic as its documentation puts it, one term at a
/// time.
fn in_the_documented_order(exponent: Exponent, part: &Part, u: &UnitDirection) -> f32 {
    let h = &part.hyperparameters;
    let l = h.length_scale;
    let mut a = [0.0_f32; 8];
    for (i, (v, w)) in part.directions.iter().zip(&part.weights).enumerate() {
        let (dx, dy, dz) = (u.x - v.x, u.y - v.y, u.z - v.z);
        let s = (dx * dx + dy * dy) + dz * dz;
        let k = match exponent {
            Exponent::One => 1.0 / (1.0 + s * (1.0 / (2.0 * l * l))),
            Exponent::Half => 1.0 / (1.0 + s * (1.0 / (l * l))).sqrt(),
            Exponent::Free => {
                let base = 1.0 + s * (1.0 / (2.0 * h.parameter * l * l));
                cobra_infer::math::Real::power(base, -h.parameter)
            }
        };
        a[i % 8] += w * k;
    }
    h.prior_mean + (((a[0] + a[1]) + (a[2] + a[3])) + ((a[4] + a[5]) + (a[6] + a[7])))
}

fn any_part() -> impl Strategy<Value = (Model, Part)> {
    (model(), 1_usize..41).prop_flat_map(|(model, terms)| (Just(model), part(model.kernel, terms)))
}

proptest! {
    #![proptest_config(crate::seed::config())]

    #[test]
    fn the_mean_is_that_of_a_plain_sum((model, part) in any_part(), u in direction()) {
        let (expected, size) = plain(model, &part, &u);
        let found = f64::from(computed(model, &part, &u));
        let error = (found - expected).abs() / size;
        prop_assert!(error <= POSTERIOR_MEAN, "{model:?}, {} terms: {error:e}", part.weights.len());
    }
}

#[test]
fn every_tail_of_every_exponent_is_summed_in_order() {
    use proptest::strategy::ValueTree;
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    for exponent in [Exponent::One, Exponent::Half, Exponent::Free] {
        let model = Model::chord(Kernel::RationalQuadratic(exponent));
        for terms in 1..=40 {
            let part = part(model.kernel, terms)
                .new_tree(&mut runner)
                .unwrap()
                .current();
            let u = direction().new_tree(&mut runner).unwrap().current();
            let found = computed(model, &part, &u);
            let expected = in_the_documented_order(exponent, &part, &u);
            assert_eq!(found.to_bits(), expected.to_bits(), "{terms} terms");
        }
    }
}

#[test]
fn words_that_are_no_four_equal_runs_are_no_terms() {
    let words = [[0; 4]; 41];
    for count in 0..words.len() {
        let terms = Terms::from_words(&words[..count]);
        assert_eq!(terms.is_some(), count % 4 == 0, "{count} words");
        assert_eq!(terms.map_or(count / 4, |terms| terms.len()), count / 4);
    }
}
