//! What a term takes by how it is written: bytes in flash, and instructions of the sum over terms.
//!
//! Owns the encodings that were compared with the format's own; how the format adds is
//! `cobra_infer::gp`'s. All are summed in one loop that suits each of them, one term after the other into
//! eight accumulators, under the default kernel, the rational quadratic with exponent ½.

use crate::{Board, Failed};
use cobra_infer::kernel::{Covariance, RationalQuadraticHalf};
use cobra_infer::math::Real;
use core::fmt::Write;
use core::hint::black_box;

/// Terms that are summed.
const TERMS: usize = 256;

/// Directions that the sum is asked in.
const QUERIES: usize = 16;

const LANES: usize = 8;

const LENGTH_SCALE: f32 = 0.5;

/// What the kernel changes by, at most, where a direction moves by 1: 2/(3√3·l).
const STEEPEST: f32 = 0.385 / LENGTH_SCALE;

/// The largest of the whole numbers that weights are, and coordinates of 16 bits.
const LARGEST: f32 = 32767.0;

/// What rounding in `f32` may change of a sum of weights that are 1 at most.
const ROUNDING: f32 = 1e-6;

/// A number as it lies in flash.
trait Number: Copy {
    /// Whole numbers in a unit.
    const STEPS: f32;
    /// The nearest to `x`, which is −1 to 1.
    fn nearest(x: f32) -> Self;
    /// In steps.
    fn read(self) -> f32;
}

impl Number for u8 {
    const STEPS: f32 = 127.0;

    fn nearest(x: f32) -> Self {
        rounded(x * Self::STEPS) as i8 as u8
    }

    #[inline(always)]
    fn read(self) -> f32 {
        f32::from(self as i8)
    }
}

impl Number for [u8; 2] {
    const STEPS: f32 = LARGEST;

    fn nearest(x: f32) -> Self {
        (rounded(x * Self::STEPS) as i16).to_le_bytes()
    }

    #[inline(always)]
    fn read(self) -> f32 {
        f32::from(i16::from_le_bytes(self))
    }
}

impl Number for [u8; 4] {
    const STEPS: f32 = 1.0;

    fn nearest(x: f32) -> Self {
        x.to_le_bytes()
    }

    #[inline(always)]
    fn read(self) -> f32 {
        f32::from_le_bytes(self)
    }
}

fn rounded(x: f32) -> i32 {
    (if x < 0.0 { x - 0.5 } else { x + 0.5 }) as i32
}

/// Terms in one encoding, an array a number.
trait Encoding {
    const NAME: &'static str;
    const BYTES: usize;
    /// How far rounding moves a direction at most.
    const AWAY: f32;
    fn new(terms: &[Term; TERMS]) -> Self;
    /// Over the first `count`.
    fn sum(&self, query: [f32; 3], count: usize) -> f32;
}

type Term = ([f32; 3], f32);

/// Three coordinates in steps, and a weight.
struct Coordinates<C, W> {
    axes: [[C; TERMS]; 3],
    weights: [W; TERMS],
}

impl<C: Number, W: Number> Coordinates<C, W> {
    fn rounded(terms: &[Term; TERMS]) -> Self {
        Self {
            axes: [0, 1, 2].map(|axis: usize| terms.map(|(u, _)| C::nearest(u[axis]))),
            weights: terms.map(|(_, weight)| W::nearest(weight)),
        }
    }

    /// The query is brought to steps once, and the length scale with it.
    #[inline(always)]
    fn weighted_sum(&self, query: [f32; 3], count: usize) -> f32 {
        let kernel = RationalQuadraticHalf::new(LENGTH_SCALE * C::STEPS);
        let query = query.map(|coordinate| coordinate * C::STEPS);
        let [xs, ys, zs] = &self.axes;
        let terms = xs.iter().zip(ys).zip(zs).zip(&self.weights).take(count);
        let terms = terms.map(|(((x, y), z), w)| ([x.read(), y.read(), z.read()], w.read()));
        one_by_one(&kernel, query, terms) / W::STEPS
    }
}

macro_rules! coordinates {
    ($number:ty, $weight:ty, $name:literal, $bytes:literal, $away:expr) => {
        impl Encoding for Coordinates<$number, $weight> {
            const NAME: &'static str = $name;
            const BYTES: usize = $bytes;
            const AWAY: f32 = $away;

            fn new(terms: &[Term; TERMS]) -> Self {
                Self::rounded(terms)
            }

            #[inline(never)]
            fn sum(&self, query: [f32; 3], count: usize) -> f32 {
                self.weighted_sum(query, count)
            }
        }
    };
}

/// √3/2 of a step: half of one along each axis.
const fn half_a_step(steps: f32) -> f32 {
    0.867 / steps
}

coordinates!(u8, [u8; 2], "3xi8+i16", 5, half_a_step(127.0));
coordinates!([u8; 2], [u8; 2], "3xi16+i16", 8, half_a_step(LARGEST));
coordinates!([u8; 4], [u8; 4], "3xf32+f32", 16, 0.0);

/// A place on the octahedral map, and a weight.
struct Octahedral {
    places: [[[u8; 2]; TERMS]; 2],
    weights: [[u8; 2]; TERMS],
}

impl Encoding for Octahedral {
    const NAME: &'static str = "octahedral-2xi16+i16";
    const BYTES: usize = 6;
    /// Half a step of each place moves the third coordinate by a step, and what is brought to length
    /// 1 was at least 1/√3 long: √1.5·√3.
    const AWAY: f32 = 2.13 / LARGEST;

    fn new(terms: &[Term; TERMS]) -> Self {
        let place = |([x, y, z], _): Term| {
            let inverse = 1.0 / (x.abs() + y.abs() + z.abs());
            let (p, q) = (x * inverse, y * inverse);
            if z < 0.0 {
                [folded(p, q), folded(q, p)]
            } else {
                [p, q]
            }
        };
        Self {
            places: [0, 1].map(|axis: usize| terms.map(|term| Number::nearest(place(term)[axis]))),
            weights: terms.map(|(_, weight)| Number::nearest(weight)),
        }
    }

    #[inline(never)]
    fn sum(&self, query: [f32; 3], count: usize) -> f32 {
        let kernel = RationalQuadraticHalf::new(LENGTH_SCALE);
        let [ps, qs] = &self.places;
        let terms = ps.iter().zip(qs).zip(&self.weights).take(count);
        let terms = terms.map(|((p, q), w)| (unfolded(p.read(), q.read()), w.read()));
        one_by_one(&kernel, query, terms) / LARGEST
    }
}

/// The unit vector of a place in steps.
#[inline(always)]
fn unfolded(p: f32, q: f32) -> [f32; 3] {
    let c = (LARGEST - p.abs()) - q.abs();
    // What the fold moved outward comes back: by −c along each axis.
    let back = if c < 0.0 { c } else { 0.0 };
    let a = if p < 0.0 { p - back } else { p + back };
    let b = if q < 0.0 { q - back } else { q + back };
    let inverse = 1.0 / ((a * a + b * b) + c * c).square_root();
    [a * inverse, b * inverse, c * inverse]
}

/// (1 − |other|)·sign t.
fn folded(t: f32, other: f32) -> f32 {
    let rest = 1.0 - other.abs();
    if t < 0.0 { -rest } else { rest }
}

/// The format's sum, each term to its own accumulator.
#[inline(always)]
fn one_by_one(
    kernel: &RationalQuadraticHalf<f32>,
    query: [f32; 3],
    terms: impl Iterator<Item = Term>,
) -> f32 {
    let mut lanes = [0.0; LANES];
    for (index, (direction, weight)) in terms.enumerate() {
        if let Some(lane) = lanes.get_mut(index % LANES) {
            *lane += weight * kernel.between(query, direction);
        }
    }
    let [a0, a1, a2, a3, a4, a5, a6, a7] = lanes;
    ((a0 + a1) + (a2 + a3)) + ((a4 + a5) + (a6 + a7))
}

/// Directions all around, each with a weight.
fn terms<const N: usize>(mut state: u32) -> [Term; N] {
    let mut number = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 23) as f32 - 1.0
    };
    core::array::from_fn(|_| {
        let [x, y, z] = loop {
            let vector = [number(), number(), number()];
            if (0.01..=1.0).contains(&squared_length(vector)) {
                break vector;
            }
        };
        let length = squared_length([x, y, z]).square_root();
        ([x / length, y / length, z / length], number())
    })
}

fn squared_length([x, y, z]: [f32; 3]) -> f32 {
    x * x + y * y + z * z
}

/// Measures and prints a line for each encoding.
///
/// # Errors
/// [`Failed`] when a sum is farther from that of `f32` than rounding explains, or when `out` fails.
pub fn run(board: &mut impl Board, out: &mut impl Write) -> Result<(), Failed> {
    let terms = terms::<TERMS>(1);
    measure::<Coordinates<u8, [u8; 2]>>(board, out, &terms)?;
    measure::<Octahedral>(board, out, &terms)?;
    measure::<Coordinates<[u8; 2], [u8; 2]>>(board, out, &terms)?;
    measure::<Coordinates<[u8; 4], [u8; 4]>>(board, out, &terms)
}

#[inline(never)]
fn measure<E: Encoding>(
    board: &mut impl Board,
    out: &mut impl Write,
    terms: &[Term; TERMS],
) -> Result<(), Failed> {
    let encoded = E::new(terms);
    let exact = Coordinates::<[u8; 4], [u8; 4]>::new(terms);
    let queries = self::terms::<QUERIES>(2);
    let weights: f32 = terms.iter().map(|(_, weight)| weight.abs()).sum();
    let most = weights * (STEEPEST * E::AWAY + ROUNDING) + 0.5 * TERMS as f32 / LARGEST;
    let away = |query| (encoded.sum(query, TERMS) - exact.sum(query, TERMS)).abs();
    // Not one maximum of all: that would pass over what is no number.
    let agree = queries.iter().all(|(query, _)| away(*query) <= most);
    let deviation = queries
        .iter()
        .map(|(query, _)| away(*query))
        .fold(0.0, f32::max);
    let mut counted = |count: usize| {
        board.feed_watchdog();
        let start = board.instructions();
        for (query, _) in queries {
            black_box(black_box(&encoded).sum(query, black_box(count)));
        }
        board.instructions().wrapping_sub(start)
    };
    let (without, with) = (counted(0), counted(TERMS));
    writeln!(
        out,
        "encoding {} bytes={} terms={} instructions={} deviation={deviation:.6} most={most:.6}",
        E::NAME,
        E::BYTES,
        QUERIES * TERMS,
        with.wrapping_sub(without),
    )?;
    if agree { Ok(()) } else { Err(Failed) }
}
