//! Poses against a depth image, and gradients of the mean: the bits of the depth check.
//!
//! A [`Scene`] is little-endian, as all files here: the camera's K, row-major, 9 `f32`; a `u32` count of
//! columns; the scale of a word of the image, an `f32`; a `u32` count of poses and as many R, row-major, and
//! t, 12 `f32`; a `u32` count of pixels that a mask calls the object's and as many columns and rows, 2 `u16`.
//! The image is a file of its own, row by row, because it is read as `u16`, which have to be aligned. What is
//! expected are the words that [`check`] tells, and then those of [`gradients`].

use crate::vectors::{self, Unreadable, Word};
use cobra_infer::depth::{
    Cause, Cell, Correction, DepthImage, DepthPixel, DepthReport, DepthSettings, DepthWords, Noise,
    Observed, Thresholds, check_depth,
};
use cobra_infer::gp::{direction_and_distance, posterior_gradient};
use cobra_infer::{Camera, Pose, Template};
use core::fmt;

/// The image of every scene of the sets.
pub const WIDTH: usize = 96;
/// Its rows.
pub const HEIGHT: usize = 72;

/// Its words.
pub type Image = [u16; WIDTH * HEIGHT];

/// Cells along a side of the depth buffer of [`SETTINGS`].
pub const SIDE: u16 = 20;

/// The most pixels that the mask of a scene of the sets has.
pub const PIXELS: usize = 128;

/// Ways to check a pose: by a share of the diameter and by a sensor's noise, with and without thresholds.
pub const SETTINGS: [DepthSettings; 2] = [
    DepthSettings {
        side: SIDE,
        step_pixels: 50,
        ..DepthSettings::DEFAULT
    },
    DepthSettings {
        noise: Noise::Sensor {
            constant: 0.5,
            linear: 2e-3,
            quadratic: 1e-5,
        },
        thresholds: Some(Thresholds {
            accept: 0.5,
            reject: 0.1,
        }),
        side: SIDE,
        step_pixels: 50,
        ..DepthSettings::DEFAULT
    },
];

/// A scene with the bits that its template's checks have.
#[derive(Clone, Copy, Debug)]
pub struct Depth {
    /// The image.
    pub image: &'static Image,
    /// The [`Scene`].
    pub scene: &'static [u8],
    /// The recorded bits.
    pub expected: &'static [u8],
}

/// The words of an image, in the order of bytes that this target has; where bytes are missing, nothing was
/// measured.
#[must_use]
pub const fn image(bytes: &[u8]) -> Image {
    let mut words = [0; WIDTH * HEIGHT];
    let mut index = 0;
    while index < words.len() && 2 * index + 1 < bytes.len() {
        words[index] = u16::from_le_bytes([bytes[2 * index], bytes[2 * index + 1]]);
        index += 1;
    }
    words
}

/// Camera, poses and mask, read where they lie.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    camera: &'a [Word; 9],
    width: u16,
    scale: f32,
    poses: &'a [[Word; 12]],
    pixels: &'a [[Word; 1]],
}

impl<'a> Scene<'a> {
    /// `None` where the lengths do not fit.
    #[must_use]
    pub fn read(bytes: &'a [u8]) -> Option<Self> {
        let (words, odd) = bytes.as_chunks();
        let (camera, words) = words.split_first_chunk()?;
        let ([width, scale], words) = words.split_first_chunk()?;
        let (poses, words) = vectors::counted(words)?;
        let (pixels, words) = vectors::counted(words)?;
        (odd.is_empty() && words.is_empty()).then_some(Self {
            camera,
            width: u16::try_from(u32::from_le_bytes(*width)).ok()?,
            scale: f32::from_le_bytes(*scale),
            poses,
            pixels,
        })
    }

    /// The camera.
    #[must_use]
    pub fn camera(&self) -> Option<Camera> {
        Camera::from_matrix(self.camera.map(f32::from_le_bytes)).ok()
    }

    /// The poses, as far as they are poses.
    pub fn poses(&self) -> impl Iterator<Item = Pose> + use<'a> {
        self.poses.iter().filter_map(|words| {
            let numbers = words.map(f32::from_le_bytes);
            let (r, t) = numbers.split_first_chunk()?;
            Pose::from_row_major(*r, *t.first_chunk()?).ok()
        })
    }

    /// These words as the image of the scene.
    #[must_use]
    pub fn image<'w>(&self, words: &'w [u16]) -> Option<DepthWords<'w>> {
        DepthWords::new(words, self.width, self.scale)
    }

    /// The mask's pixels with what the image says of them, as many as `room` holds.
    #[must_use]
    pub fn observed<'r>(
        &self,
        image: &impl DepthImage,
        room: &'r mut [DepthPixel],
    ) -> &'r [DepthPixel] {
        let mut count = 0;
        for ([[c0, c1, r0, r1]], pixel) in self.pixels.iter().zip(room.iter_mut()) {
            let (column, row) = (
                u16::from_le_bytes([*c0, *c1]),
                u16::from_le_bytes([*r0, *r1]),
            );
            *pixel = DepthPixel {
                column,
                row,
                depth: image.depth(column, row).unwrap_or(0.0),
            };
            count += 1;
        }
        room.get(..count).unwrap_or_default()
    }
}

/// Room for a pixel that is not there.
pub const NO_PIXEL: DepthPixel = DepthPixel {
    column: 0,
    row: 0,
    depth: 0.0,
};

/// What a check is given to work in.
#[derive(Debug)]
pub struct Memory<'m> {
    /// Room for the mask's pixels.
    pub pixels: &'m mut [DepthPixel],
    /// The depth buffer's.
    pub cells: &'m mut [Cell],
}

/// Checks every pose of the scene under each of the settings, by the mask and by the silhouette, and tells
/// `each` the words of [`report_words`].
///
/// # Errors
/// [`Unreadable`].
pub fn check<const COMPONENTS: usize>(
    template: &Template<'_>,
    scene: &[u8],
    words: &[u16],
    settings: &[DepthSettings],
    memory: Memory<'_>,
    mut each: impl FnMut(u32),
) -> Result<(), Unreadable> {
    let Memory { pixels, cells } = memory;
    let scene = Scene::read(scene).ok_or(Unreadable::Points)?;
    let (camera, image) = scene
        .camera()
        .zip(scene.image(words))
        .ok_or(Unreadable::Points)?;
    let pixels = scene.observed(&image, pixels);
    for pose in scene.poses() {
        for settings in settings {
            for observed in [Observed::Pixels(pixels), Observed::Silhouette] {
                let report = check_depth::<COMPONENTS>(
                    template, &camera, &pose, settings, observed, &image, cells,
                )
                .map_err(Unreadable::Depth)?;
                report_words(template, &pose, &report)
                    .into_iter()
                    .for_each(&mut each);
            }
        }
    }
    Ok(())
}

/// What a comparison came to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Checked {
    /// Words compared.
    pub words: u32,
    /// Bits that differ; 32 for a word that only one side has.
    pub mismatched_bits: u32,
}

/// A word that is not what is recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Difference {
    /// Which one, from 0: of a report for every pose, settings and way to observe, and then of gradients.
    pub word: u32,
    /// What is recorded; `None` where the record has ended.
    pub expected: Option<u32>,
    /// What was computed.
    pub found: u32,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let length = REPORT_WORDS as u32;
        let (check, word) = (self.word / length, self.word % length);
        write!(f, "depth check {check}, word {word}: ")?;
        match self.expected {
            Some(expected) => write!(f, "expected {expected:08x}, ")?,
            None => f.write_str("expected nothing, ")?,
        }
        write!(f, "found {:08x}", self.found)
    }
}

/// Compares what `words` tells with what is recorded, word by word.
///
/// # Errors
/// Those of `words`.
pub fn compare<E>(
    expected: &[u8],
    words: impl FnOnce(&mut dyn FnMut(u32)) -> Result<(), E>,
    mut tell: impl FnMut(&Difference),
) -> Result<Checked, E> {
    let mut recorded = expected.as_chunks().0.iter();
    let mut checked = Checked::default();
    words(&mut |found| {
        let expected = recorded.next().map(|word| u32::from_le_bytes(*word));
        let bits = expected.map_or(u32::BITS, |expected| (expected ^ found).count_ones());
        if bits != 0 {
            let word = checked.words;
            tell(&Difference {
                word,
                expected,
                found,
            });
        }
        checked.words += 1;
        checked.mismatched_bits += bits;
    })?;
    checked.mismatched_bits += recorded.map(|_| u32::BITS).sum::<u32>();
    Ok(checked)
}

/// All that is recorded of a set: the checks of its scene, and the gradients of its template.
///
/// # Errors
/// [`Unreadable`].
pub fn words(
    template: &[u8],
    scene: &[u8],
    image: &[u16],
    mut each: impl FnMut(u32),
) -> Result<(), Unreadable> {
    let template = Template::from_bytes(template).map_err(Unreadable::Template)?;
    let memory = Memory {
        pixels: &mut [NO_PIXEL; PIXELS],
        cells: &mut [Cell::EMPTY; SIDE as usize * SIDE as usize],
    };
    check::<{ vectors::COMPONENTS }>(&template, scene, image, &SETTINGS, memory, &mut each)?;
    gradients(&template, each);
    Ok(())
}

/// How many words a report has.
pub const REPORT_WORDS: usize = 33;

/// Every number of a report, the refined pose's rows and translation among them, and then the decision, the
/// correction, and the cause with its number.
#[must_use]
pub fn report_words(
    template: &Template<'_>,
    pose: &Pose,
    report: &DepthReport,
) -> [u32; REPORT_WORDS] {
    let correction = Correction::between(pose, &report.refined, template.centre());
    let (cause, number) = cause_words(report.cause(&correction));
    let r = report.refined.rotation().matrix();
    let t = report.refined.translation();
    let numbers = [
        report.confidence,
        report.forward,
        report.reverse,
        report.estimated_error,
        report.displacement,
        report.residual,
        report.noise,
        report.depth_ratio,
        r.m11,
        r.m12,
        r.m13,
        r.m21,
        r.m22,
        r.m23,
        r.m31,
        r.m32,
        r.m33,
        t.x,
        t.y,
        t.z,
        correction.along_ray,
        correction.sideways,
        correction.turn,
        number,
    ];
    let counts = [
        report.pixels,
        report.silent,
        report.visible,
        report.judged,
        report.hidden,
        report.unmeasured,
        report.seen_through,
        vectors::decision_number(report.decision),
        cause,
    ];
    let mut words = [0; REPORT_WORDS];
    let all = numbers.into_iter().map(f32::to_bits).chain(counts);
    words.iter_mut().zip(all).for_each(|(to, word)| *to = word);
    words
}

/// A number for each cause, and the one that it tells; 0 where it tells none.
const fn cause_words(cause: Cause) -> (u32, f32) {
    match cause {
        Cause::Fits => (0, 0.0),
        Cause::BehindCamera => (1, 0.0),
        Cause::Scale { factor } => (2, factor),
        Cause::InFront => (3, 0.0),
        Cause::SeenThrough => (4, 0.0),
        Cause::AlongRay { distance } => (5, distance),
        Cause::Sideways { distance } => (6, distance),
        Cause::Turned { angle } => (7, angle),
        Cause::Elsewhere => (8, 0.0),
        Cause::Hidden => (9, 0.0),
        Cause::Unmeasured => (10, 0.0),
    }
}

/// What the axes of a direction are made of that a gradient is asked for: no pole, and nothing even.
const STEPS: [f32; 3] = [-1.0, 0.25, 2.0];

/// Tells `each` the bits of every component's gradient in 27 directions. What is no number counts as the same
/// whatever its bits, which IEEE 754 leaves to the processor.
pub fn gradients(template: &Template<'_>, mut each: impl FnMut(u32)) {
    for component in template.components() {
        for x in STEPS {
            for y in STEPS {
                for z in STEPS {
                    let Some((u, _)) = direction_and_distance([x, y, z], [0.0; 3], 0.0) else {
                        continue;
                    };
                    let gradient = posterior_gradient(
                        template.model(),
                        &component.hyperparameters,
                        &component.terms,
                        &u,
                    );
                    for number in gradient {
                        each(if number.is_nan() { f32::NAN } else { number }.to_bits());
                    }
                }
            }
        }
    }
}
