//! The agreement vectors: templates, 2,000 correspondences for each, and the bits they score.
//!
//! Everything is little-endian. A `.points` file holds the camera's K, row-major, 9 `f32`; a `u32`
//! count of poses and as many R, row-major, and t, 12 `f32`; a `u32` count of correspondences and
//! as many pixels, points and weights, 6 `f32`. A `.expected` file holds, for each of [`CASES`], the
//! bits of one likelihood a correspondence that the case takes, and then the words of
//! [`report_words`].

use crate::depth::{self, Depth};
use cobra_infer::nalgebra::{Point2, Point3};
use cobra_infer::{
    Assignment, Camera, Correspondence, Decision, Doubt, Likelihood, Pose, Rejection, Report,
    Scorer, Settings, Sigma, Template, Threshold,
};
use core::fmt;

/// The most components that a template of the vectors has.
pub const COMPONENTS: usize = 8;

/// A template with its correspondences and what they score.
#[derive(Clone, Copy, Debug)]
pub struct Set {
    /// Its name, that of its files.
    pub name: &'static str,
    /// The template.
    pub template: &'static [u8],
    /// Camera, poses and correspondences.
    pub points: &'static [u8],
    /// The recorded bits.
    pub expected: &'static [u8],
    /// Of a template with validity, a scene to check it against.
    pub depth: Option<Depth>,
}

macro_rules! set {
    ($name:literal) => {
        set!($name, None)
    };
    ($name:literal, depth) => {
        set!(
            $name,
            Some(Depth {
                image: {
                    static IMAGE: depth::Image = depth::image(include_bytes!(concat!(
                        "../../golden/agreement/",
                        $name,
                        ".image"
                    )));
                    &IMAGE
                },
                scene: include_bytes!(concat!("../../golden/agreement/", $name, ".scene")),
                expected: include_bytes!(concat!("../../golden/agreement/", $name, ".checked")),
            })
        )
    };
    ($name:literal, $depth:expr) => {
        Set {
            name: $name,
            template: include_bytes!(concat!("../../golden/agreement/", $name, ".cobra")),
            points: include_bytes!(concat!("../../golden/agreement/", $name, ".points")),
            expected: include_bytes!(concat!("../../golden/agreement/", $name, ".expected")),
            depth: $depth,
        }
    };
}

/// Reference points by k-means under exponent ½; by expectation maximisation, with precisions,
/// under exponent 1; a template of one component and 20 terms; charts with validity, of compact terms
/// under exponent ½, and of maps.
pub const SETS: [Set; 5] = [
    set!("k-means"),
    set!("em"),
    set!("tiny"),
    set!("charts", depth),
    set!("map", depth),
];

/// The set of that name, or all of them by the name `all`. For boards whose flash does not hold all
/// at once: as a constant, it links only what it names.
///
/// # Panics
/// On any other name, which for a constant is when it is compiled.
#[must_use]
pub const fn sets_named(name: &str) -> &'static [Set] {
    match name.as_bytes() {
        b"all" => &SETS,
        b"k-means" => &[SETS[0]],
        b"em" => &[SETS[1]],
        b"tiny" => &[SETS[2]],
        b"charts" => &[SETS[3]],
        b"map" => &[SETS[4]],
        _ => panic!("a set is one of all, k-means, em, tiny, charts and map"),
    }
}

/// One way to score the correspondences of a set.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    settings: Settings,
    /// Which pose, and whether it is orthonormalised first.
    pose: usize,
    orthonormalised: bool,
    /// Leaves out what would make the decision undecided: numbers that are not finite, and negative
    /// weights.
    sound_only: bool,
}

const fn case(assignment: Assignment, likelihood: Likelihood, threshold: Threshold) -> Case {
    Case {
        settings: Settings {
            likelihood,
            assignment,
            sigma: Sigma::Template { noise: 0.5 },
            threshold,
            delta: 2.0,
            minimum_points: Settings::MINIMUM_POINTS,
        },
        pose: 0,
        orthonormalised: false,
        sound_only: true,
    }
}

/// What each set goes through: every assignment, likelihood and threshold, the right pose, a wrong
/// one and a damaged one, with and without what is not finite.
pub const CASES: [Case; 6] = [
    Case {
        sound_only: false,
        ..case(Assignment::Nearest, Likelihood::Peak, Threshold::Paper)
    },
    case(Assignment::Nearest, Likelihood::Peak, Threshold::Paper),
    Case {
        pose: 1,
        ..case(Assignment::Nearest, Likelihood::Density, Threshold::Worst)
    },
    case(Assignment::Maximum, Likelihood::Density, Threshold::Mean),
    Case {
        pose: 2,
        orthonormalised: true,
        ..case(Assignment::Maximum, Likelihood::Peak, Threshold::Mean)
    },
    case(Assignment::Soft, Likelihood::Peak, Threshold::Worst),
];

/// What a comparison came to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outcome {
    /// Correspondences in the set.
    pub points: u32,
    /// Words compared.
    pub words: u32,
    /// Bits that differ; 32 for a word that only one side has.
    pub mismatched_bits: u32,
}

/// Why a set cannot be scored.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Unreadable {
    /// The template is refused.
    Template(cobra_infer::TemplateError),
    /// The points do not read.
    Points,
    /// The template does not suit the vectors.
    Score(cobra_infer::ScoreError),
    /// Nor the check against depth.
    Depth(cobra_infer::depth::DepthError),
}

/// A word that is not what is recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Difference {
    /// Which of [`CASES`].
    pub case: usize,
    /// Which of its words.
    pub place: Place,
    /// What is recorded; `None` where the record has ended.
    pub expected: Option<u32>,
    /// What was computed.
    pub found: u32,
}

/// Which word of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The likelihood of a correspondence, counted from 0 among all in the set.
    Likelihood(usize),
    /// One of [`REPORT_WORDS`].
    Report(usize),
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "case {}, ", self.case)?;
        match self.place {
            Place::Likelihood(index) => write!(f, "likelihood of correspondence {index}: ")?,
            Place::Report(index) => {
                write!(f, "{}: ", REPORT_WORDS.get(index).unwrap_or(&"report"))?;
            }
        }
        match self.expected {
            Some(expected) => write!(f, "expected {expected:08x}, ")?,
            None => f.write_str("expected nothing, ")?,
        }
        write!(f, "found {:08x}", self.found)
    }
}

/// Scores the set under every case and compares each bit.
///
/// # Errors
/// [`Unreadable`].
pub fn compare(set: &Set) -> Result<Outcome, Unreadable> {
    compare_telling(set, |_| {})
}

/// As [`compare`], and tells `tell` every word that differs.
///
/// # Errors
/// [`Unreadable`].
pub fn compare_telling(
    set: &Set,
    mut tell: impl FnMut(&Difference),
) -> Result<Outcome, Unreadable> {
    let mut recorded = set.expected.as_chunks().0.iter();
    let mut outcome = Outcome::default();
    outcome.points = each_word(set.template, set.points, |case, place, found| {
        let expected = recorded.next().map(|word| u32::from_le_bytes(*word));
        let bits = expected.map_or(u32::BITS, |expected| (expected ^ found).count_ones());
        outcome.words += 1;
        outcome.mismatched_bits += bits;
        if bits != 0 {
            tell(&Difference {
                case,
                place,
                expected,
                found,
            });
        }
    })?;
    outcome.mismatched_bits += recorded.map(|_| u32::BITS).sum::<u32>();
    Ok(outcome)
}

/// Scores `points` under every case and tells `each` every word of the result; how many
/// correspondences there are.
///
/// # Errors
/// [`Unreadable`].
pub fn score(template: &[u8], points: &[u8], mut each: impl FnMut(u32)) -> Result<u32, Unreadable> {
    each_word(template, points, |_, _, word| each(word))
}

fn each_word(
    template: &[u8],
    points: &[u8],
    mut each: impl FnMut(usize, Place, u32),
) -> Result<u32, Unreadable> {
    let template = Template::from_bytes(template).map_err(Unreadable::Template)?;
    let points = Points::read(points).ok_or(Unreadable::Points)?;
    for (index, case) in CASES.iter().enumerate() {
        points.score(&template, case, |place, word| each(index, place, word))?;
    }
    Ok(points.correspondences.len() as u32)
}

/// What the numbers of [`report_words`] are.
pub const REPORT_WORDS: [&str; 7] = [
    "confidence",
    "threshold",
    "sum of weights",
    "share of inliers",
    "points",
    "points behind the camera",
    "decision",
];

/// Confidence, threshold, sum of weights and share of inliers as bits, the points, those behind the
/// camera, and the number of the decision.
#[must_use]
pub fn report_words(report: &Report) -> [u32; 7] {
    [
        report.confidence.to_bits(),
        report.threshold.to_bits(),
        report.weight_sum.to_bits(),
        report.inlier_share.to_bits(),
        report.points,
        report.behind_camera,
        decision_number(report.decision),
    ]
}

/// A number for each decision.
pub(crate) const fn decision_number(decision: Decision) -> u32 {
    match decision {
        Decision::Accept => 0,
        Decision::Reject(Rejection::BelowThreshold) => 1,
        Decision::Reject(Rejection::NoSupport) => 2,
        Decision::Reject(Rejection::BehindCamera) => 3,
        Decision::Undecided(Doubt::TooFewPoints) => 4,
        Decision::Undecided(Doubt::NoWeight) => 5,
        Decision::Undecided(Doubt::NonFiniteInput) => 6,
        Decision::Undecided(Doubt::NegativeWeight) => 7,
        Decision::Undecided(Doubt::NoThreshold) => 8,
        Decision::Undecided(Doubt::Hidden) => 9,
        Decision::Undecided(Doubt::NotCalibrated) => 10,
        Decision::Undecided(Doubt::BetweenThresholds) => 11,
    }
}

/// Four bytes of a file.
pub(crate) type Word = [u8; 4];

/// A `.points` file, read where it lies.
#[derive(Clone, Copy, Debug)]
pub struct Points<'a> {
    camera: &'a [Word; 9],
    poses: &'a [[Word; 12]],
    correspondences: &'a [[Word; 6]],
}

impl<'a> Points<'a> {
    /// `None` where the lengths do not fit.
    #[must_use]
    pub fn read(bytes: &'a [u8]) -> Option<Self> {
        let (words, odd) = bytes.as_chunks();
        let (camera, words) = words.split_first_chunk()?;
        let (poses, words) = counted(words)?;
        let (correspondences, words) = counted(words)?;
        (odd.is_empty() && words.is_empty()).then_some(Self {
            camera,
            poses,
            correspondences,
        })
    }

    /// The camera.
    #[must_use]
    pub fn camera(&self) -> Option<Camera> {
        Camera::from_matrix(self.camera.map(f32::from_le_bytes)).ok()
    }

    /// Pose `index`, as it stands or orthonormalised.
    #[must_use]
    pub fn pose(&self, index: usize, orthonormalised: bool) -> Option<Pose> {
        let numbers = self.poses.get(index)?.map(f32::from_le_bytes);
        let (r, t) = numbers.split_first_chunk()?;
        let t = *t.first_chunk()?;
        if orthonormalised {
            Pose::from_row_major_orthonormalised(*r, t).ok()
        } else {
            Pose::from_row_major(*r, t).ok()
        }
    }

    /// The correspondences, each read as it is asked for.
    pub fn correspondences(&self) -> impl ExactSizeIterator<Item = Correspondence> + use<'a> {
        self.correspondences.iter().map(|words| {
            let [u, v, x, y, z, weight] = words.map(f32::from_le_bytes);
            Correspondence {
                pixel: Point2::new(u, v),
                point: Point3::new(x, y, z),
                weight,
            }
        })
    }

    fn score(
        &self,
        template: &Template<'_>,
        case: &Case,
        mut each: impl FnMut(Place, u32),
    ) -> Result<(), Unreadable> {
        let camera = self.camera().ok_or(Unreadable::Points)?;
        let pose = self
            .pose(case.pose, case.orthonormalised)
            .ok_or(Unreadable::Points)?;
        let mut scorer = Scorer::<COMPONENTS>::new(template, &camera, &pose, &case.settings)
            .map_err(Unreadable::Score)?;
        for (index, correspondence) in self.correspondences().enumerate() {
            let sound = correspondence.is_finite() && correspondence.weight >= 0.0;
            if sound || !case.sound_only {
                let likelihood = scorer.push(&correspondence).likelihood;
                each(Place::Likelihood(index), likelihood.to_bits());
            }
        }
        for (index, word) in report_words(&scorer.finish()).into_iter().enumerate() {
            each(Place::Report(index), word);
        }
        Ok(())
    }
}

/// A count, and as many arrays of words.
pub(crate) fn counted<const N: usize>(words: &[Word]) -> Option<(&[[Word; N]], &[Word])> {
    let (count, words) = words.split_first()?;
    let length = usize::try_from(u32::from_le_bytes(*count))
        .ok()?
        .checked_mul(N)?;
    let (arrays, rest) = words.split_at_checked(length)?;
    Some((arrays.as_chunks().0, rest))
}
