//! Replays recorded scores against a recorded template, bit by bit.
//!
//! A file of vectors is text. Numbers are the eight hexadecimal digits of an `f32`'s bits unless
//! said otherwise; a line that starts with `#` says nothing. In order:
//!
//! | line | its words |
//! |---|---|
//! | `camera` | K, row-major, 9 numbers |
//! | `pose` | R, row-major, and t, 12 numbers; any number of such lines |
//! | `correspondence` | pixel, point, weight, 6 numbers; any number of such lines |
//! | `case` | assignment, likelihood, `template` or `fixed` with its σ_m or σ, δ, in decimal the fewest points, which pose, how many of the correspondences, and the threshold unless it is `paper` |
//! | `likelihoods` | one a correspondence of the case before |
//! | `report` | confidence, threshold, sum of weights, share of inliers, in decimal the points and those behind the camera, and the decision |

use crate::depth;
use cobra_infer::nalgebra::{Point2, Point3};
use cobra_infer::{
    Assignment, Camera, Correspondence, Decision, Doubt, Likelihood, Pose, Rejection, Report,
    Scorer, Settings, Sigma, Template, TemplateError, Threshold,
};
use core::fmt;
use core::str::SplitAsciiWhitespace;

/// The most components that a golden template has.
pub const COMPONENTS: usize = 4;

/// A golden template with recorded scores.
#[derive(Clone, Copy, Debug)]
pub struct Golden {
    /// The name of the vectors.
    pub name: &'static str,
    /// The template.
    pub template: &'static [u8],
    /// The record.
    pub vectors: &'static str,
    /// How many cases it holds.
    pub cases: usize,
    /// The recorded gradients of the template's mean.
    pub gradients: &'static [u8],
}

impl Golden {
    /// How many bits of the gradients differ from those that are recorded.
    ///
    /// # Errors
    /// Where the template does not load.
    pub fn compare_gradients(&self) -> Result<u32, TemplateError> {
        let words = |each: &mut dyn FnMut(u32)| {
            depth::gradients(&Template::from_bytes(self.template)?, each);
            Ok(())
        };
        Ok(depth::compare(self.gradients, words, |_| {})?.mismatched_bits)
    }
}

#[cfg(feature = "golden")]
macro_rules! golden {
    ($template:literal, $vectors:literal, $cases:literal) => {
        Golden {
            name: $vectors,
            template: include_bytes!(concat!("../../golden/v1-", $template, ".cobra")),
            vectors: include_str!(concat!("../../golden/v1-", $vectors, ".txt")),
            cases: $cases,
            gradients: include_bytes!(concat!("../../golden/v1-", $template, ".gradients")),
        }
    };
}

/// The golden templates of every kernel, and of every way to write components.
#[cfg(feature = "golden")]
pub const GOLDEN: [Golden; 19] = [
    golden!("exponent-one", "exponent-one", 32),
    golden!("exponent-half", "exponent-half", 32),
    golden!("exponent-free", "exponent-free", 32),
    golden!("exponent-one", "exponent-one-soft", 28),
    golden!("exponent-half", "exponent-half-soft", 28),
    golden!("exponent-free", "exponent-free-soft", 28),
    golden!("radial-basis", "radial-basis", 24),
    golden!("matern-half", "matern-half", 24),
    golden!("matern-three-halves", "matern-three-halves", 24),
    golden!("matern-five-halves", "matern-five-halves", 24),
    golden!("linear", "linear", 24),
    golden!("polynomial", "polynomial", 24),
    golden!("periodic", "periodic", 24),
    golden!("angles", "angles", 24),
    golden!(
        "angles-matern-three-halves",
        "angles-matern-three-halves",
        24
    ),
    golden!("angles-periodic", "angles-periodic", 24),
    golden!("precisions", "precisions", 24),
    golden!("validity-compact", "validity-compact", 24),
    golden!("map", "map", 24),
];

/// Where a replay went wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mismatch {
    /// The template does not load, or a line does not read.
    Unreadable {
        /// The line, from 1; 0 for the template.
        line: usize,
    },
    /// Recorded and computed differ.
    Differs {
        /// The line of the record, from 1.
        line: usize,
        /// Which number on it, from 0.
        word: usize,
        /// What is recorded.
        expected: u32,
        /// What was computed.
        found: u32,
    },
}

impl fmt::Display for Mismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Unreadable { line: 0 } => f.write_str("the template does not load"),
            Self::Unreadable { line } => write!(f, "line {line} does not read"),
            Self::Differs {
                line,
                word,
                expected,
                found,
            } => write!(
                f,
                "line {line}, word {word}: expected {expected:08x}, found {found:08x}"
            ),
        }
    }
}

/// One `case` line.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    settings: Settings,
    pose: usize,
    correspondences: usize,
}

/// Scores every case of `vectors` and compares all bits; the number of cases.
///
/// # Errors
/// [`Mismatch`], the first.
pub fn replay(template: &[u8], vectors: &str) -> Result<usize, Mismatch> {
    let template = Template::from_bytes(template).map_err(|_| Mismatch::Unreadable { line: 0 })?;
    let mut cases = 0;
    let mut likelihoods = None;
    let mut current = None;
    for (index, text) in vectors.lines().enumerate() {
        let line = index + 1;
        let unreadable = Mismatch::Unreadable { line };
        let mut words = text.split_ascii_whitespace();
        match words.next() {
            Some("case") => current = Some(case(&mut words).ok_or(unreadable)?),
            Some("likelihoods") => likelihoods = Some((line, words)),
            Some("report") => {
                let case = current.take().ok_or(unreadable)?;
                let (at, mut recorded) = likelihoods.take().ok_or(unreadable)?;
                let mut outcome = Ok(());
                let mut word = 0;
                let report = score(&template, vectors, &case, |found| {
                    let expected = recorded.next().and_then(hexadecimal);
                    let compared = compare(at, word, expected, found.to_bits());
                    outcome = outcome.and(compared);
                    word += 1;
                })
                .ok_or(unreadable)?;
                outcome?;
                if recorded.next().is_some() {
                    return Err(Mismatch::Unreadable { line: at });
                }
                for (word, found) in report_bits(&report).into_iter().enumerate() {
                    compare(line, word, words.next().and_then(hexadecimal), found)?;
                }
                for (word, found) in (4..).zip([report.points, report.behind_camera]) {
                    let expected = words.next().and_then(|word| word.parse().ok());
                    compare(line, word, expected, found)?;
                }
                if words.next() != Some(decision_name(report.decision)) {
                    return Err(unreadable);
                }
                cases += 1;
            }
            _ => {}
        }
    }
    Ok(cases)
}

fn compare(line: usize, word: usize, expected: Option<u32>, found: u32) -> Result<(), Mismatch> {
    match expected {
        None => Err(Mismatch::Unreadable { line }),
        Some(expected) if expected != found => Err(Mismatch::Differs {
            line,
            word,
            expected,
            found,
        }),
        Some(_) => Ok(()),
    }
}

/// Scores the correspondences of `vectors` as `case` says, telling `each` every likelihood; `None`
/// where `vectors` does not read.
pub fn score(
    template: &Template<'_>,
    vectors: &str,
    case: &Case,
    mut each: impl FnMut(f32),
) -> Option<Report> {
    let camera = Camera::from_matrix(numbers(lines(vectors, "camera").next()?)?).ok()?;
    let pose: [f32; 12] = numbers(lines(vectors, "pose").nth(case.pose)?)?;
    let [r0, r1, r2, r3, r4, r5, r6, r7, r8, tx, ty, tz] = pose;
    let rotation = [r0, r1, r2, r3, r4, r5, r6, r7, r8];
    let pose = Pose::from_row_major(rotation, [tx, ty, tz]).ok()?;
    let mut scorer = Scorer::<COMPONENTS>::new(template, &camera, &pose, &case.settings).ok()?;
    for words in lines(vectors, "correspondence").take(case.correspondences) {
        let [u, v, x, y, z, weight] = numbers(words)?;
        let point = scorer.push(&Correspondence {
            pixel: Point2::new(u, v),
            point: Point3::new(x, y, z),
            weight,
        });
        each(point.likelihood);
    }
    Some(scorer.finish())
}

/// The case that the words behind `case` describe.
#[must_use]
pub fn case(words: &mut SplitAsciiWhitespace<'_>) -> Option<Case> {
    let assignment = match words.next()? {
        "nearest" => Assignment::Nearest,
        "maximum" => Assignment::Maximum,
        "soft" => Assignment::Soft,
        _ => return None,
    };
    let likelihood = match words.next()? {
        "peak" => Likelihood::Peak,
        "density" => Likelihood::Density,
        _ => return None,
    };
    let kind = words.next()?;
    let value = f32::from_bits(hexadecimal(words.next()?)?);
    let sigma = match kind {
        "template" => Sigma::Template { noise: value },
        "fixed" => Sigma::Fixed(value),
        _ => return None,
    };
    let delta = f32::from_bits(hexadecimal(words.next()?)?);
    let minimum_points = words.next()?.parse().ok()?;
    let pose = words.next()?.parse().ok()?;
    let correspondences = words.next()?.parse().ok()?;
    let threshold = match words.next() {
        None => Threshold::Paper,
        Some("mean") => Threshold::Mean,
        Some("worst") => Threshold::Worst,
        Some(_) => return None,
    };
    Some(Case {
        settings: Settings {
            assignment,
            likelihood,
            sigma,
            threshold,
            delta,
            minimum_points,
        },
        pose,
        correspondences,
    })
}

/// The bits that a `report` line starts with.
#[must_use]
pub fn report_bits(report: &Report) -> [u32; 4] {
    [
        report.confidence,
        report.threshold,
        report.weight_sum,
        report.inlier_share,
    ]
    .map(f32::to_bits)
}

/// The word that a `report` line ends with.
#[must_use]
pub const fn decision_name(decision: Decision) -> &'static str {
    match decision {
        Decision::Accept => "accept",
        Decision::Reject(Rejection::BelowThreshold) => "below-threshold",
        Decision::Reject(Rejection::NoSupport) => "no-support",
        Decision::Reject(Rejection::BehindCamera) => "behind-camera",
        Decision::Undecided(Doubt::TooFewPoints) => "too-few-points",
        Decision::Undecided(Doubt::NoWeight) => "no-weight",
        Decision::Undecided(Doubt::NonFiniteInput) => "non-finite-input",
        Decision::Undecided(Doubt::NegativeWeight) => "negative-weight",
        Decision::Undecided(Doubt::NoThreshold) => "no-threshold",
        Decision::Undecided(Doubt::Hidden) => "hidden",
        Decision::Undecided(Doubt::NotCalibrated) => "not-calibrated",
        Decision::Undecided(Doubt::BetweenThresholds) => "between-thresholds",
    }
}

fn lines<'a>(vectors: &'a str, kind: &'a str) -> impl Iterator<Item = SplitAsciiWhitespace<'a>> {
    vectors.lines().filter_map(move |line| {
        let mut words = line.split_ascii_whitespace();
        (words.next() == Some(kind)).then_some(words)
    })
}

fn hexadecimal(word: &str) -> Option<u32> {
    u32::from_str_radix(word, 16).ok()
}

fn numbers<const N: usize>(mut words: SplitAsciiWhitespace<'_>) -> Option<[f32; N]> {
    let mut numbers = [0.0; N];
    for number in &mut numbers {
        *number = f32::from_bits(hexadecimal(words.next()?)?);
    }
    words.next().is_none().then_some(numbers)
}
