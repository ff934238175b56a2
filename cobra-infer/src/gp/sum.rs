//! Σᵢ wᵢ k(query, uᵢ), in the order that the format prescribes.
//!
//! The order is [`crate::gp`]'s; what is owned here is how the compilers are led to do it fast, which
//! takes some shapes of the same sum. A host goes over the terms once and makes vectors of the eight
//! accumulators, as wide as `widest` finds them; compact terms it converts a block at a time before that.
//! A controller keeps all of four terms in registers: with eight at a time it loads more words ahead than
//! it has registers for, and a term costs two instructions more. Hence there each half of the accumulators
//! goes over the terms by itself, and the four are written out: a loop over them is unrolled at
//! `opt-level = 3` alone. Compact terms it takes one by one, those of one accumulator after the other's.

use super::LANES;
use super::terms::{Arrays, Number};
use crate::kernel::Covariance;
use crate::widest::{Routine, widest};

/// One array in whole rounds of the accumulators.
type Rounds<'a, N> = &'a [[N; LANES]];

/// The sum over all terms.
#[inline]
pub(super) fn weighted_sum<K: Covariance<f32>, C: Number, W: Number>(
    kernel: &K,
    terms: Option<Arrays<'_, C, W>>,
    query: [f32; 3],
) -> f32 {
    let Some(terms) = terms else {
        return f32::NAN;
    };
    let lanes = if cfg!(target_os = "none") && size_of::<C>() < size_of::<f32>() {
        one_by_one(kernel, terms, query)
    } else {
        in_rounds(kernel, terms, query)
    };
    let [a0, a1, a2, a3, a4, a5, a6, a7] = lanes;
    ((a0 + a1) + (a2 + a3)) + ((a4 + a5) + (a6 + a7))
}

/// Whole rounds of the accumulators, then the rest.
#[inline(always)]
fn in_rounds<K: Covariance<f32>, C: Number, W: Number>(
    kernel: &K,
    terms: Arrays<'_, C, W>,
    query: [f32; 3],
) -> [f32; LANES] {
    // One by one: a `map` over the four is a loop at `opt-level = "s"`.
    let [xs, ys, zs] = terms.coordinates;
    let (xs, x_rest) = xs.as_chunks();
    let (ys, y_rest) = ys.as_chunks();
    let (zs, z_rest) = zs.as_chunks();
    let (ws, w_rest) = terms.weights.as_chunks();
    let mut lanes = whole_rounds(kernel, [xs, ys, zs], ws, query);
    let rest = x_rest.iter().zip(y_rest).zip(z_rest).zip(w_rest);
    for (lane, (((x, y), z), w)) in lanes.iter_mut().zip(rest) {
        *lane += term(kernel, query, [x, y, z], w);
    }
    lanes
}

/// The accumulators after the terms that fill whole rounds of them.
#[inline]
fn whole_rounds<K: Covariance<f32>, C: Number, W: Number>(
    kernel: &K,
    coordinates: [Rounds<'_, C>; 3],
    weights: Rounds<'_, W>,
    query: [f32; 3],
) -> [f32; LANES] {
    if cfg!(target_os = "none") {
        return in_halves(kernel, coordinates, weights, query);
    }
    let mut lanes = [0.0; LANES];
    if size_of::<C>() == size_of::<f32>() {
        at_once(kernel, coordinates, weights, query, &mut lanes);
    } else {
        in_blocks(kernel, coordinates, weights, query, &mut lanes);
    }
    lanes
}

/// For hosts.
///
/// Out of line on purpose: next to the sum over the accumulators, which adds them in pairs, the compiler
/// makes vectors of two lanes where four fit, and the loop takes three times as long.
#[inline(never)]
fn at_once<K: Covariance<f32>, C: Number, W: Number>(
    kernel: &K,
    coordinates: [Rounds<'_, C>; 3],
    weights: Rounds<'_, W>,
    query: [f32; 3],
    lanes: &mut [f32; LANES],
) {
    *lanes = widest(AtOnce {
        kernel,
        coordinates,
        weights,
        query,
        lanes: *lanes,
    });
}

/// All of a round is read before any of it is computed with: a kernel that calls a function then has the
/// distances of a round ready before the first call.
struct AtOnce<'a, K, C, W> {
    kernel: &'a K,
    coordinates: [Rounds<'a, C>; 3],
    weights: Rounds<'a, W>,
    query: [f32; 3],
    lanes: [f32; LANES],
}

impl<K: Covariance<f32>, C: Number, W: Number> Routine for AtOnce<'_, K, C, W> {
    type Output = [f32; LANES];

    #[inline(always)]
    fn run(self) -> [f32; LANES] {
        let [xs, ys, zs] = self.coordinates;
        let mut sums = self.lanes;
        for (((x, y), z), w) in xs.iter().zip(ys).zip(zs).zip(self.weights) {
            let [x, y, z] = [x, y, z].map(|numbers| numbers.map(C::read));
            let w = w.map(W::read);
            for ((((lane, x), y), z), w) in sums.iter_mut().zip(x).zip(y).zip(z).zip(w) {
                *lane += w * self.kernel.between(self.query, [x, y, z]);
            }
        }
        sums
    }
}

/// Rounds that are converted at a time.
const BLOCK: usize = 16;

/// For hosts, of compact terms: converted a block at a time, because in the loop that uses them the
/// compiler converts one by one, which takes longer than all the rest.
#[inline(always)]
fn in_blocks<K: Covariance<f32>, C: Number, W: Number>(
    kernel: &K,
    [xs, ys, zs]: [Rounds<'_, C>; 3],
    ws: Rounds<'_, W>,
    query: [f32; 3],
    lanes: &mut [f32; LANES],
) {
    let blocks = xs.chunks(BLOCK).zip(ys.chunks(BLOCK));
    let blocks = blocks.zip(zs.chunks(BLOCK)).zip(ws.chunks(BLOCK));
    let [mut x, mut y, mut z, mut w] = [[[0.0; LANES]; BLOCK]; 4];
    for (((xs, ys), zs), ws) in blocks {
        let coordinates = [
            converted(xs, &mut x),
            converted(ys, &mut y),
            converted(zs, &mut z),
        ];
        at_once(kernel, coordinates, converted(ws, &mut w), query, lanes);
    }
}

#[inline(never)]
fn converted<'b, N: Number>(
    from: Rounds<'_, N>,
    to: &'b mut [[f32; LANES]; BLOCK],
) -> Rounds<'b, f32> {
    for (to, from) in to.iter_mut().zip(from) {
        *to = from.map(N::read);
    }
    to.get(..from.len()).unwrap_or(to)
}

/// For controllers: the halves one after the other, each with a loop of its own.
#[inline(always)]
fn in_halves<K: Covariance<f32>, C: Number, W: Number>(
    kernel: &K,
    coordinates: [Rounds<'_, C>; 3],
    weights: Rounds<'_, W>,
    query: [f32; 3],
) -> [f32; LANES] {
    let [a0, a1, a2, a3] = four::<false, _, _, _>(kernel, coordinates, weights, query);
    let [a4, a5, a6, a7] = four::<true, _, _, _>(kernel, coordinates, weights, query);
    [a0, a1, a2, a3, a4, a5, a6, a7]
}

/// Four accumulators: the first or the last of a round.
#[inline(always)]
fn four<const LAST: bool, K: Covariance<f32>, C: Number, W: Number>(
    kernel: &K,
    [xs, ys, zs]: [Rounds<'_, C>; 3],
    ws: Rounds<'_, W>,
    query: [f32; 3],
) -> [f32; 4] {
    let mut sums = [0.0; 4];
    for (((x, y), z), w) in xs.iter().zip(ys).zip(zs).zip(ws) {
        let (x, y) = (half::<LAST, _>(x), half::<LAST, _>(y));
        let (z, w) = (half::<LAST, _>(z), half::<LAST, _>(w));
        add_four(kernel, query, &mut sums, x, y, z, w);
    }
    sums
}

/// Of a round, the first four or the last.
#[inline(always)]
fn half<const LAST: bool, N>(round: &[N; LANES]) -> [&N; 4] {
    let [a, b, c, d, e, f, g, h] = round;
    if LAST { [e, f, g, h] } else { [a, b, c, d] }
}

/// For controllers, of compact terms: each accumulator goes over its terms by itself, and stays in a
/// register. Four terms at a time take more registers than there are once numbers are converted, so that
/// a term is no faster and the code four times as long.
#[inline(always)]
fn one_by_one<K: Covariance<f32>, C: Number, W: Number>(
    kernel: &K,
    terms: Arrays<'_, C, W>,
    query: [f32; 3],
) -> [f32; LANES] {
    let [xs, ys, zs] = terms.coordinates;
    let (xs, x_rest) = xs.as_chunks();
    let (ys, y_rest) = ys.as_chunks();
    let (zs, z_rest) = zs.as_chunks();
    let (ws, w_rest) = terms.weights.as_chunks();
    let mut lanes = [0.0; LANES];
    let ((x_pairs, xs), (y_pairs, ys)) = (xs.as_chunks::<2>(), ys.as_chunks::<2>());
    let ((z_pairs, zs), (w_pairs, ws)) = (zs.as_chunks::<2>(), ws.as_chunks::<2>());
    for (index, lane) in lanes.iter_mut().enumerate() {
        let at = |x: &[C; LANES], y: &[C; LANES], z: &[C; LANES], w: &[W; LANES]| {
            let place = [&of(x, index), &of(y, index), &of(z, index)];
            term(kernel, query, place, &of(w, index))
        };
        let mut sum = 0.0;
        // Two a turn: counting takes a tenth of it otherwise.
        for ((([x, x2], [y, y2]), [z, z2]), [w, w2]) in
            x_pairs.iter().zip(y_pairs).zip(z_pairs).zip(w_pairs)
        {
            sum += at(x, y, z, w);
            sum += at(x2, y2, z2, w2);
        }
        for (((x, y), z), w) in xs.iter().zip(ys).zip(zs).zip(ws) {
            sum += at(x, y, z, w);
        }
        *lane = sum;
    }
    let rest = x_rest.iter().zip(y_rest).zip(z_rest).zip(w_rest);
    for (lane, (((x, y), z), w)) in lanes.iter_mut().zip(rest) {
        *lane += term(kernel, query, [x, y, z], w);
    }
    lanes
}

/// The remainder is the compiler's: it then sees that there is such a number.
#[inline(always)]
fn of<N: Copy>(round: &[N; LANES], index: usize) -> N {
    let [first, ..] = *round;
    round.get(index % LANES).copied().unwrap_or(first)
}

/// Written out: a loop over them is unrolled at `opt-level = 3` alone.
#[inline(always)]
fn add_four<K: Covariance<f32>, C: Number, W: Number>(
    kernel: &K,
    query: [f32; 3],
    [a, b, c, d]: &mut [f32; 4],
    [x0, x1, x2, x3]: [&C; 4],
    [y0, y1, y2, y3]: [&C; 4],
    [z0, z1, z2, z3]: [&C; 4],
    [w0, w1, w2, w3]: [&W; 4],
) {
    *a += term(kernel, query, [x0, y0, z0], w0);
    *b += term(kernel, query, [x1, y1, z1], w1);
    *c += term(kernel, query, [x2, y2, z2], w2);
    *d += term(kernel, query, [x3, y3, z3], w3);
}

#[inline(always)]
fn term<K: Covariance<f32>, C: Number, W: Number>(
    kernel: &K,
    query: [f32; 3],
    [x, y, z]: [&C; 3],
    w: &W,
) -> f32 {
    w.read() * kernel.between(query, [x.read(), y.read(), z.read()])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gp::Word;
    use crate::kernel::RationalQuadraticHalf;
    use std::vec::Vec;

    #[test]
    fn all_shapes_have_the_same_bits() {
        let kernel = RationalQuadraticHalf::new(0.7);
        let mut state = 1_u32;
        let mut number = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / (1 << 23) as f32 - 1.0
        };
        let query = [0.6, -0.8, 0.1];
        for count in 0..20 {
            let mut array = || -> Vec<[Word; LANES]> {
                let words = core::iter::repeat_with(|| number().to_le_bytes());
                let words: Vec<Word> = words.take(count * LANES).collect();
                words.as_chunks().0.to_vec()
            };
            let (x, y, z, w) = (array(), array(), array(), array());
            agree(&kernel, [&x, &y, &z], &w, query);
            // Bytes of the same numbers, as a compact run would have them.
            let bytes = |words: &[[Word; LANES]]| -> Vec<[u8; LANES]> {
                words.iter().map(|round| round.map(|[b, ..]| b)).collect()
            };
            let halves: Vec<[[u8; 2]; LANES]> = w
                .iter()
                .map(|round| round.map(|[b, c, ..]| [b, c]))
                .collect();
            let steps = query.map(|coordinate| coordinate * 127.0);
            agree(
                &kernel,
                [&bytes(&x), &bytes(&y), &bytes(&z)],
                &halves,
                steps,
            );
        }
    }

    fn agree<K: Covariance<f32>, C: Number, W: Number>(
        kernel: &K,
        coordinates: [Rounds<'_, C>; 3],
        weights: Rounds<'_, W>,
        query: [f32; 3],
    ) {
        let [mut expected, mut blocks] = [[0.0; LANES]; 2];
        at_once(kernel, coordinates, weights, query, &mut expected);
        in_blocks(kernel, coordinates, weights, query, &mut blocks);
        let expected = expected.map(f32::to_bits);
        assert_eq!(blocks.map(f32::to_bits), expected);
        let halves = in_halves(kernel, coordinates, weights, query);
        assert_eq!(halves.map(f32::to_bits), expected);
        let terms = Arrays {
            coordinates: coordinates.map(<[[C; LANES]]>::as_flattened),
            weights: weights.as_flattened(),
        };
        let single = one_by_one(kernel, terms, query);
        assert_eq!(single.map(f32::to_bits), expected);
        // With `wide-vectors`, on the vectors of this processor.
        let widest = whole_rounds(kernel, coordinates, weights, query);
        assert_eq!(widest.map(f32::to_bits), expected);
    }
}
