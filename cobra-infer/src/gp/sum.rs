//! Σᵢ wᵢ k(query, uᵢ), in the order that the format prescribes.
//!
//! The order is [`crate::gp`]'s; what is owned here is how the compilers are led to do it fast, which
//! takes two shapes of the same sum. A host goes over the terms once and makes vectors of four lanes
//! of the eight accumulators. A controller keeps all of four terms in registers: with eight at a time
//! it loads more words ahead than it has registers for, and a term costs two instructions more. Hence
//! there each half of the accumulators goes over the terms by itself, and the four are written out: a
//! loop over them is unrolled at `opt-level = 3` alone.

use super::{LANES, Terms, Word};
use crate::kernel::Covariance;

/// One array in whole rounds of the accumulators.
type Rounds<'a> = &'a [[Word; LANES]];

/// The sum over all terms.
#[inline]
pub(super) fn weighted_sum<K: Covariance<f32>>(
    kernel: &K,
    terms: &Terms<'_>,
    query: [f32; 3],
) -> f32 {
    // One by one: a `map` over the four is a loop at `opt-level = "s"`.
    let Some([xs, ys, zs, ws]) = terms.arrays() else {
        return f32::NAN;
    };
    let (xs, x_rest) = xs.as_chunks();
    let (ys, y_rest) = ys.as_chunks();
    let (zs, z_rest) = zs.as_chunks();
    let (ws, w_rest) = ws.as_chunks();
    let mut lanes = whole_rounds(kernel, [xs, ys, zs, ws], query);
    let rest = x_rest.iter().zip(y_rest).zip(z_rest).zip(w_rest);
    for (lane, (((x, y), z), w)) in lanes.iter_mut().zip(rest) {
        *lane += term(kernel, query, [x, y, z, w]);
    }
    let [a0, a1, a2, a3, a4, a5, a6, a7] = lanes;
    ((a0 + a1) + (a2 + a3)) + ((a4 + a5) + (a6 + a7))
}

/// The accumulators after the terms that fill whole rounds of them.
///
/// On hosts out of line on purpose: next to the sum over the accumulators, which adds them in pairs,
/// the compiler makes vectors of two lanes where four fit, and the loop takes three times as long.
#[cfg_attr(not(target_os = "none"), inline(never))]
#[cfg_attr(target_os = "none", inline)]
fn whole_rounds<K: Covariance<f32>>(
    kernel: &K,
    rounds: [Rounds<'_>; 4],
    query: [f32; 3],
) -> [f32; LANES] {
    if cfg!(target_os = "none") {
        in_halves(kernel, rounds, query)
    } else {
        at_once(kernel, rounds, query)
    }
}

/// For hosts. All of a round is read before any of it is computed with: a kernel that calls a
/// function then has the distances of a round ready before the first call.
#[inline(always)]
fn at_once<K: Covariance<f32>>(
    kernel: &K,
    [xs, ys, zs, ws]: [Rounds<'_>; 4],
    query: [f32; 3],
) -> [f32; LANES] {
    let mut lanes = [0.0; LANES];
    for (((x, y), z), w) in xs.iter().zip(ys).zip(zs).zip(ws) {
        let [x, y, z, w] = [x, y, z, w].map(|words| words.map(f32::from_le_bytes));
        for ((((lane, x), y), z), w) in lanes.iter_mut().zip(x).zip(y).zip(z).zip(w) {
            *lane += w * kernel.between(query, [x, y, z]);
        }
    }
    lanes
}

/// For controllers.
#[inline(always)]
fn in_halves<K: Covariance<f32>>(
    kernel: &K,
    rounds: [Rounds<'_>; 4],
    query: [f32; 3],
) -> [f32; LANES] {
    let [a0, a1, a2, a3] = four(kernel, rounds, query, |[a, b, c, d, ..]| [a, b, c, d]);
    let [a4, a5, a6, a7] = four(kernel, rounds, query, |[.., a, b, c, d]| [a, b, c, d]);
    [a0, a1, a2, a3, a4, a5, a6, a7]
}

/// Four accumulators: of those words that `pick` takes from a round.
#[inline(always)]
fn four<K: Covariance<f32>>(
    kernel: &K,
    [xs, ys, zs, ws]: [Rounds<'_>; 4],
    query: [f32; 3],
    pick: impl Fn(&[Word; LANES]) -> [&Word; 4],
) -> [f32; 4] {
    let [mut a, mut b, mut c, mut d] = [0.0; 4];
    for (((x, y), z), w) in xs.iter().zip(ys).zip(zs).zip(ws) {
        let [x0, x1, x2, x3] = pick(x);
        let [y0, y1, y2, y3] = pick(y);
        let [z0, z1, z2, z3] = pick(z);
        let [w0, w1, w2, w3] = pick(w);
        a += term(kernel, query, [x0, y0, z0, w0]);
        b += term(kernel, query, [x1, y1, z1, w1]);
        c += term(kernel, query, [x2, y2, z2, w2]);
        d += term(kernel, query, [x3, y3, z3, w3]);
    }
    [a, b, c, d]
}

#[inline(always)]
fn term<K: Covariance<f32>>(kernel: &K, query: [f32; 3], [x, y, z, w]: [&Word; 4]) -> f32 {
    let read = |word: &Word| f32::from_le_bytes(*word);
    read(w) * kernel.between(query, [read(x), read(y), read(z)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::RationalQuadraticHalf;
    use std::vec::Vec;

    #[test]
    fn both_shapes_have_the_same_bits() {
        let kernel = RationalQuadraticHalf::new(0.7);
        let mut state = 1_u32;
        let mut number = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / (1 << 23) as f32 - 1.0
        };
        for count in 0..20 {
            let mut array = || -> Vec<[Word; LANES]> {
                let words = core::iter::repeat_with(|| number().to_le_bytes());
                let words: Vec<Word> = words.take(count * LANES).collect();
                words.as_chunks().0.to_vec()
            };
            let arrays = [array(), array(), array(), array()];
            let rounds = arrays.each_ref().map(Vec::as_slice);
            let query = [0.6, -0.8, 0.1];
            assert_eq!(
                at_once(&kernel, rounds, query).map(f32::to_bits),
                in_halves(&kernel, rounds, query).map(f32::to_bits),
            );
        }
    }
}
