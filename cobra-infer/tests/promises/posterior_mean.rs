//! The posterior mean: right against a plain sum in `f64`, and bit for bit the documented order of
//! summation.
#![expect(
    clippy::disallowed_methods,
    reason = "the reference values are computed independently of the crate's own functions"
)]

use crate::content::{Part, direction, exponent, part};
use crate::tolerance::POSTERIOR_MEAN;
use cobra_infer::gp::{Terms, UnitDirection, Word, posterior_mean};
use cobra_infer::{Exponent, Kernel};
use proptest::prelude::*;

fn words(part: &Part) -> Vec<Word> {
    let directions = part.directions.iter();
    let xs = directions.clone().map(|u| u.x);
    let ys = directions.clone().map(|u| u.y);
    let zs = directions.map(|u| u.z);
    xs.chain(ys)
        .chain(zs)
        .chain(part.weights.iter().copied())
        .map(f32::to_le_bytes)
        .collect()
}

fn computed(exponent: Exponent, part: &Part, u: &UnitDirection) -> f32 {
    let words = words(part);
    let terms = Terms::from_words(&words).unwrap();
    let kernel = Kernel::RationalQuadratic(exponent);
    posterior_mean(kernel, &part.hyperparameters, &terms, u)
}

/// The mean and |m| + Σ|wᵢ|kᵢ, in `f64`, term by term.
fn plain(part: &Part, u: &UnitDirection) -> (f64, f64) {
    let h = &part.hyperparameters;
    let [l, alpha, m] = [h.length_scale, h.exponent, h.prior_mean].map(f64::from);
    let mut sums = (m, m.abs());
    for (v, w) in part.directions.iter().zip(&part.weights) {
        let s = (u.cast::<f64>().into_inner() - v.cast::<f64>().into_inner()).norm_squared();
        let k = (1.0 + s / (2.0 * alpha * l * l)).powf(-alpha);
        sums.0 += f64::from(*w) * k;
        sums.1 += f64::from(w.abs()) * k;
    }
    sums
}

/// The order of summation as its documentation puts it, one term at a time.
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
                let base = 1.0 + s * (1.0 / (2.0 * h.exponent * l * l));
                cobra_infer::math::Real::power(base, -h.exponent)
            }
        };
        a[i % 8] += w * k;
    }
    h.prior_mean + (((a[0] + a[1]) + (a[2] + a[3])) + ((a[4] + a[5]) + (a[6] + a[7])))
}

fn any_part() -> impl Strategy<Value = (Exponent, Part)> {
    (exponent(), 1_usize..41)
        .prop_flat_map(|(exponent, terms)| (Just(exponent), part(exponent, terms)))
}

proptest! {
    #[test]
    fn the_mean_is_that_of_a_plain_sum((exponent, part) in any_part(), u in direction()) {
        let (expected, size) = plain(&part, &u);
        let found = f64::from(computed(exponent, &part, &u));
        let error = (found - expected).abs() / size;
        prop_assert!(error <= POSTERIOR_MEAN, "{} terms: {error:e}", part.weights.len());
    }

    #[test]
    fn the_order_of_summation_is_the_documented_one(
        (exponent, part) in any_part(),
        u in direction(),
    ) {
        let expected = in_the_documented_order(exponent, &part, &u);
        prop_assert_eq!(computed(exponent, &part, &u).to_bits(), expected.to_bits());
    }
}

#[test]
fn every_tail_of_every_exponent_is_summed_in_order() {
    use proptest::strategy::ValueTree;
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    for exponent in [Exponent::One, Exponent::Half, Exponent::Free] {
        for terms in 1..=40 {
            let part = part(exponent, terms)
                .new_tree(&mut runner)
                .unwrap()
                .current();
            let u = direction().new_tree(&mut runner).unwrap().current();
            let found = computed(exponent, &part, &u);
            let expected = in_the_documented_order(exponent, &part, &u);
            assert_eq!(found.to_bits(), expected.to_bits(), "{terms} terms");
            let (expected, size) = plain(&part, &u);
            assert!((f64::from(found) - expected).abs() <= POSTERIOR_MEAN * size);
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
