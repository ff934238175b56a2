//! A template of one's own, read from the debugger's side: instructions a point, and the host's bits.
//!
//! Reads `object.cobra`, `object.points` and `object.expected` from the folder that the emulator was
//! started in; `tests/examples/object-points.rs` writes them.

use crate::{Board, Failed};
use cobra_agreement::object::{NOISES, score};
use cobra_agreement::vectors::{Points, REPORT_WORDS, Unreadable};
use cobra_infer::Template;
use core::ffi::CStr;
use core::fmt::{self, Write};
use core::hint::black_box;
use semihosting::fs::File;
use semihosting::io::Read;

/// The largest file that is read.
pub const LARGEST: usize = 512 * 1024;

/// Where the three files are kept.
#[derive(Debug)]
pub struct Room {
    template: [u8; LARGEST],
    points: [u8; LARGEST],
    expected: [u8; LARGEST],
}

impl Room {
    /// Empty.
    pub const EMPTY: Self = Self {
        template: [0; LARGEST],
        points: [0; LARGEST],
        expected: [0; LARGEST],
    };

    /// Two files, and the room that is left.
    pub(crate) fn read_two(
        &mut self,
        first: &CStr,
        second: &CStr,
        out: &mut impl Write,
    ) -> Result<(&[u8], &[u8], &mut [u8; LARGEST]), Failed> {
        let first = read(first, &mut self.template, out)?;
        let second = read(second, &mut self.points, out)?;
        Ok((first, second, &mut self.expected))
    }
}

/// Measures and prints a line for each noise.
///
/// # Errors
/// [`Failed`] when a file does not read, when a bit differs, or when `out` fails.
pub fn run(board: &mut impl Board, out: &mut impl Write, room: &mut Room) -> Result<(), Failed> {
    let bytes = read(c"object.cobra", &mut room.template, out)?;
    let points = read(c"object.points", &mut room.points, out)?;
    let expected = read(c"object.expected", &mut room.expected, out)?;
    let template = match Template::from_bytes(bytes) {
        Ok(template) => template,
        Err(error) => return failed(out, format_args!("object.cobra: {error}")),
    };
    let Some(points) = Points::read(points) else {
        return failed(out, format_args!("object.points does not read"));
    };
    let all = points.correspondences().len();
    let mut recorded = expected.as_chunks().0.iter();
    let missing = recorded
        .len()
        .abs_diff(NOISES.len() * (all + REPORT_WORDS.len()));
    let mut mismatched = missing as u32 * u32::BITS;
    for noise in NOISES {
        let mut compare = |word: u32| {
            if let Some(bytes) = recorded.next() {
                mismatched += (u32::from_le_bytes(*bytes) ^ word).count_ones();
            }
        };
        if let Err(error) = score(&template, &points, noise, all, &mut compare) {
            return refused(out, error);
        }
        let mut counted = |count: usize| {
            board.feed_watchdog();
            let start = board.instructions();
            let scored = score(
                black_box(&template),
                &points,
                noise,
                black_box(count),
                |_| (),
            );
            let instructions = board.instructions().wrapping_sub(start);
            scored.map(|()| instructions)
        };
        match (counted(0), counted(all)) {
            (Ok(without), Ok(with)) => writeln!(
                out,
                "object noise={noise} points={all} instructions={} mismatched_bits={mismatched} \
                 bytes={} components={}",
                with.wrapping_sub(without),
                bytes.len(),
                template.component_count(),
            )?,
            (Err(error), _) | (_, Err(error)) => return refused(out, error),
        }
    }
    if mismatched == 0 { Ok(()) } else { Err(Failed) }
}

fn refused(out: &mut impl Write, error: Unreadable) -> Result<(), Failed> {
    failed(out, format_args!("the object cannot be scored: {error:?}"))
}

pub(crate) fn failed<T>(out: &mut impl Write, text: fmt::Arguments<'_>) -> Result<T, Failed> {
    writeln!(out, "{text}")?;
    Err(Failed)
}

pub(crate) fn read<'r>(
    name: &CStr,
    room: &'r mut [u8; LARGEST],
    out: &mut impl Write,
) -> Result<&'r [u8], Failed> {
    let mut length = 0;
    if let Ok(mut file) = File::open(name) {
        while let Some(rest) = room.get_mut(length..) {
            match file.read(rest) {
                Ok(0) => return Ok(room.get(..length).unwrap_or_default()),
                Ok(read) => length += read,
                Err(_) => break,
            }
        }
    }
    failed(out, format_args!("{name:?} does not read"))
}
