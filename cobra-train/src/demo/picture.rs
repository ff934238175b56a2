//! The demonstration's picture: panels of poses over a plot of all of them.
//!
//! Owns the choice of the poses that are shown, and the page. How one pose is rendered is
//! `render`'s business, how confidences come about nobody's here.

use std::error::Error;
use std::io;

use nalgebra::{Isometry3, Point3};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use super::camera::Camera;
use super::canvas::Canvas;
use super::render::{Look, Renderer};
use super::style::{Drawn, INK, PAPER, Page, QUIET, SUPERSAMPLING, bold, px, text};
use super::{RgbImage, panel, scatter};
use crate::surface::Mesh;

/// What was decided about a pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The pose may be acted on.
    Accept,
    /// The pose may not be acted on.
    Reject,
    /// The measurement does not suffice to decide.
    Undecided,
}

impl From<cobra_infer::Decision> for Verdict {
    fn from(decision: cobra_infer::Decision) -> Self {
        match decision {
            cobra_infer::Decision::Accept => Verdict::Accept,
            cobra_infer::Decision::Reject(_) => Verdict::Reject,
            cobra_infer::Decision::Undecided(_) => Verdict::Undecided,
        }
    }
}

/// An estimate of a pose, its true error and what was decided about it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScoredPose {
    /// The true pose: object to camera, +Z forward, in millimetres.
    pub truth: Isometry3<f64>,
    /// The estimated pose, likewise.
    pub pose: Isometry3<f64>,
    /// ADD: the mean distance in millimetres between the model's points in both poses.
    pub error_mm: f64,
    /// The confidence, from 0 to 1.
    pub confidence: f64,
    /// The confidence from which on the pose is accepted.
    pub threshold: f64,
    /// What was decided.
    pub verdict: Verdict,
}

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// There is nothing to show.
    #[error("there are no poses to draw")]
    NoPoses,
    /// An error, confidence or threshold is NaN or infinite, or the error is negative.
    #[error(
        "pose {index} has error {error_mm} mm, confidence {confidence}, threshold {threshold}: all must be finite, and the error not negative"
    )]
    NotFinite {
        /// The pose, counted from 0.
        index: usize,
        /// Its error in millimetres.
        error_mm: f64,
        /// Its confidence.
        confidence: f64,
        /// Its threshold.
        threshold: f64,
    },
    /// The object is not wholly in front of the camera.
    #[error("the true pose {index} does not put the whole object in front of the camera")]
    BehindCamera {
        /// The pose, counted from 0.
        index: usize,
    },
    /// The drawing library gave up.
    #[error("the picture cannot be drawn")]
    Drawing(#[source] Box<dyn Error + Send + Sync>),
    /// The image is empty or incomplete.
    #[error("the picture cannot be encoded")]
    Encoding(#[source] io::Error),
}

const WIDTH: i32 = px(1600);
const HEIGHT: i32 = px(1112);
const MARGIN: i32 = px(32);
/// Type size of a title that fits the page; longer ones are set smaller.
const TITLE: i32 = 29;
const COLUMNS: usize = 5;
const ROWS: usize = 2;

/// Draws a picture of 1600 × 1112 pixels: up to ten of the poses, evenly chosen by the rank of
/// their error, each over the object as observed, and a plot of the errors and confidences of all.
///
/// `camera` says how the observations were taken; the panels are close-ups of its image around
/// the object. The same arguments draw the same bytes.
///
/// # Errors
/// [`PictureError`]: there are no poses, a figure is not finite, or a shown object is not wholly in front of the camera.
pub fn draw(
    mesh: &Mesh,
    camera: &Camera,
    poses: &[ScoredPose],
    title: &str,
) -> Result<RgbImage, PictureError> {
    check(poses)?;
    let shown = evenly_ranked(poses, COLUMNS * ROWS);
    let renderings = render(mesh, camera, poses, &shown)?;
    let (red, green, blue) = PAPER.rgb();
    let mut image = RgbImage::filled(WIDTH as u32, HEIGHT as u32, [red, green, blue]);
    for (place, rendering) in renderings.iter().enumerate() {
        image.paste(panel::rendering_corner(corner(place)), rendering);
    }
    {
        let page = Canvas::new(&mut image).into_drawing_area();
        lay_out(&page, poses, &shown, title)
            .map_err(|cause| PictureError::Drawing(Box::new(cause)))?;
    }
    Ok(image.reduced(SUPERSAMPLING as u32))
}

/// The picture as a PNG file; the same picture gives the same bytes.
///
/// # Errors
/// [`PictureError::Encoding`] if the image is empty or does not hold its pixels.
pub fn encode_png(image: &RgbImage) -> Result<Vec<u8>, PictureError> {
    image.encode_png().map_err(PictureError::Encoding)
}

fn check(poses: &[ScoredPose]) -> Result<(), PictureError> {
    if poses.is_empty() {
        return Err(PictureError::NoPoses);
    }
    for (index, pose) in poses.iter().enumerate() {
        let &ScoredPose {
            error_mm,
            confidence,
            threshold,
            ..
        } = pose;
        let finite = [error_mm, confidence, threshold]
            .iter()
            .all(|f| f.is_finite());
        if !finite || error_mm < 0.0 {
            return Err(PictureError::NotFinite {
                index,
                error_mm,
                confidence,
                threshold,
            });
        }
    }
    Ok(())
}

/// The indices of `count` poses at even steps of the errors' ranks, smallest and largest included,
/// by growing error.
fn evenly_ranked(poses: &[ScoredPose], count: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..poses.len()).collect();
    order.sort_by(|&a, &b| poses[a].error_mm.total_cmp(&poses[b].error_mm));
    if order.len() <= count {
        return order;
    }
    (0..count)
        .map(|i| order[i * (order.len() - 1) / (count - 1)])
        .collect()
}

fn render(
    mesh: &Mesh,
    camera: &Camera,
    poses: &[ScoredPose],
    shown: &[usize],
) -> Result<Vec<RgbImage>, PictureError> {
    let renderer = Renderer::new(mesh);
    let (width, height) = panel::RENDERING;
    shown
        .iter()
        .map(|&index| {
            let pose = &poses[index];
            let placed = |at: &Isometry3<f64>| -> Vec<Point3<f64>> {
                mesh.vertices().iter().map(|v| at * v).collect()
            };
            let view = camera
                .framing(&placed(&pose.truth), &placed(&pose.pose), width, height)
                .ok_or(PictureError::BehindCamera { index })?;
            let (red, green, blue) = pose.verdict.colour().rgb();
            let look = Look {
                estimate: [red, green, blue],
                background: pose.verdict.background(),
                pen: f64::from(px(5)) / 2.0,
            };
            Ok(renderer.render(&view, &pose.truth, &pose.pose, &look))
        })
        .collect()
}

/// The upper left corner of a panel, counted row by row.
fn corner(place: usize) -> (i32, i32) {
    let (column, row) = ((place % COLUMNS) as i32, (place / COLUMNS) as i32);
    let gap = (WIDTH - 2 * MARGIN - COLUMNS as i32 * panel::WIDTH) / (COLUMNS as i32 - 1);
    (
        MARGIN + column * (panel::WIDTH + gap),
        px(104) + row * (panel::HEIGHT + px(14)),
    )
}

fn lay_out(page: &Page, poses: &[ScoredPose], shown: &[usize], title: &str) -> Drawn {
    let heading = |size: i32| bold(size, INK, HPos::Left, VPos::Center);
    let (width, _) = page.estimate_text_size(title, &heading(TITLE))?;
    let excess = f64::from(width) / f64::from(WIDTH - 2 * MARGIN);
    let size = (f64::from(TITLE) / excess.max(1.0)).floor() as i32;
    page.draw(&Text::new(title, (MARGIN, px(42)), heading(size)))?;
    page.draw(&Text::new(
        "Grey: the object as the camera saw it.  Colour: where the estimated pose puts it.  \
         Bar: confidence, with a tick at the threshold.",
        (MARGIN, px(78)),
        text(17, QUIET, HPos::Left, VPos::Center),
    ))?;
    for (place, &index) in shown.iter().enumerate() {
        panel::draw(page, corner(place), place, &poses[index])?;
    }
    let (_, below) = corner(COLUMNS * ROWS);
    let below = below + px(10);
    scatter::draw(
        page,
        (MARGIN, below),
        (WIDTH - 2 * MARGIN, HEIGHT - below - px(14)),
        poses,
        shown,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::demo::mechanical_part;

    const CAMERA: Camera = Camera {
        fx: 600.0,
        fy: 600.0,
        cx: 319.5,
        cy: 239.5,
        width: 640,
        height: 480,
    };

    fn pose(error_mm: f64, decision: Verdict) -> ScoredPose {
        let truth = Isometry3::translation(0.0, 0.0, 600.0);
        ScoredPose {
            truth,
            pose: Isometry3::translation(error_mm, 0.0, 0.0) * truth,
            error_mm,
            confidence: 1.0 / (1.0 + error_mm),
            threshold: 0.5,
            verdict: decision,
        }
    }

    #[test]
    fn the_same_poses_draw_the_same_bytes() {
        let poses = [pose(9.0, Verdict::Undecided)];
        let part = mechanical_part();
        let picture = || draw(&part, &CAMERA, &poses, "Title").unwrap();
        let first = picture();
        assert_eq!((first.width, first.height), (1600, 1112));
        let bytes = encode_png(&first).unwrap();
        assert_eq!(bytes, encode_png(&picture()).unwrap());
    }

    #[test]
    fn a_picture_has_the_colours_of_its_decisions_only() {
        let count = |image: &RgbImage, decision: Verdict| {
            let (red, green, blue) = decision.colour().rgb();
            let pixels = image.pixels.as_chunks::<3>().0;
            pixels.iter().filter(|&p| *p == [red, green, blue]).count()
        };
        for decision in [Verdict::Accept, Verdict::Reject] {
            let image = draw(&mechanical_part(), &CAMERA, &[pose(2.0, decision)], "").unwrap();
            for other in Verdict::ALL {
                assert_eq!(count(&image, other) > 1000, other == decision, "{other:?}");
            }
        }
    }

    #[test]
    fn shown_poses_are_evenly_spread_over_the_ranks_of_the_errors() {
        let poses: Vec<_> = (0..199)
            .map(|i| pose(f64::from((i * 70) % 199), Verdict::Accept))
            .collect();
        let errors: Vec<_> = evenly_ranked(&poses, 10)
            .iter()
            .map(|&i| poses[i].error_mm)
            .collect();
        let expected: Vec<_> = (0..10).map(|i| f64::from(i * 22)).collect();
        assert_eq!(errors, expected);
        assert_eq!(evenly_ranked(&poses[..3], 10).len(), 3);
    }

    #[test]
    fn what_cannot_be_drawn_is_named() {
        let part = mechanical_part();
        let refusal = |poses: &[ScoredPose]| draw(&part, &CAMERA, poses, "").unwrap_err();
        assert!(matches!(refusal(&[]), PictureError::NoPoses));

        let good = pose(1.0, Verdict::Accept);
        let unknown = ScoredPose {
            confidence: f64::NAN,
            ..good
        };
        assert!(matches!(
            refusal(&[good, unknown]),
            PictureError::NotFinite { index: 1, .. }
        ));
        let behind = ScoredPose {
            truth: Isometry3::translation(0.0, 0.0, -600.0),
            ..good
        };
        assert!(matches!(
            refusal(&[behind]),
            PictureError::BehindCamera { index: 0 }
        ));
    }
}
