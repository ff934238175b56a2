//! The least that a controller links to check a pose against depth: load a template, check, decide.

use crate::footprint::{COMPONENTS, Refusal};
use cobra_infer::depth::{
    Cell, DepthCheck, DepthImage, DepthPixel, DepthReport, DepthSettings, DepthWords, Observed,
    TemplateSurface,
};
use cobra_infer::{Camera, Decision, Pose, Template};

/// How the examples check: a depth buffer of 20² cells, 1,600 bytes, because it is to fit into the
/// smallest board.
pub const SETTINGS: DepthSettings = cobra_agreement::depth::SETTINGS[0];

/// How many cells of scratch memory that takes.
pub const CELLS: usize = SETTINGS.cells();

/// Loads the template, checks one pose, and reports.
///
/// `alive` is called as [`DepthCheck::run`] says: the place to feed a watchdog.
///
/// # Errors
/// [`Refusal`].
#[inline(never)]
pub fn load_and_check(
    template: &[u8],
    camera: &Camera,
    pose: &Pose,
    observed: Observed<'_>,
    image: &impl DepthImage,
    cells: &mut [Cell],
    mut alive: impl FnMut(),
) -> Result<DepthReport, Refusal> {
    // Used inside the results that they come in: moved out, they would lie on the stack twice.
    let template = Template::from_bytes(template);
    let template = match &template {
        Ok(template) => template,
        Err(error) => return Err(Refusal::Template(*error)),
    };
    let surface = TemplateSurface::<COMPONENTS>::at_pose(template, &SETTINGS, pose);
    let surface = match &surface {
        Ok(surface) => surface,
        Err(error) => return Err(Refusal::Depth(*error)),
    };
    DepthCheck::new(surface, camera, &SETTINGS)
        .and_then(|check| check.run(pose, observed, image, cells, &mut alive))
        .map_err(Refusal::Depth)
}

/// Where a controller without anything else finds its input, and leaves its answer.
#[repr(C)]
#[derive(Debug)]
pub struct Mailbox {
    /// fx, fy, cx, cy.
    pub camera: [f32; 4],
    /// R, row-major.
    pub rotation: [f32; 9],
    /// t.
    pub translation: [f32; 3],
    /// Columns of the depth image.
    pub width: u16,
    /// How many pixels a mask has; 0 where there is none, and the silhouette is to be taken.
    pub pixels: u16,
    /// The confidence.
    pub confidence: f32,
    /// How far the pose is estimated to be off.
    pub estimated_error: f32,
    /// How far the object would have to move.
    pub suggested: [f32; 3],
    /// 0 accept, 1 reject, 2 undecided, 3 nothing could be checked.
    pub answer: u32,
}

/// What a controller keeps in RAM besides its stack, and the sensor's image.
#[derive(Debug)]
pub struct Memory<'m> {
    /// Row by row, as the sensor's DMA leaves it.
    pub image: &'m [u16],
    /// A mask's pixels.
    pub pixels: &'m [DepthPixel],
    /// Scratch memory.
    pub cells: &'m mut [Cell],
}

/// One round: reads the mailbox, checks, answers.
///
/// # Safety
/// `mailbox` must be valid for reads and writes and aligned.
pub unsafe fn serve(template: &[u8], mailbox: *mut Mailbox, memory: &mut Memory<'_>) {
    // SAFETY: the caller's promise. Volatile and field by field, because a device writes there.
    let ([fx, fy, cx, cy], rotation, translation, width, pixels) = unsafe {
        (
            (&raw const (*mailbox).camera).read_volatile(),
            (&raw const (*mailbox).rotation).read_volatile(),
            (&raw const (*mailbox).translation).read_volatile(),
            (&raw const (*mailbox).width).read_volatile(),
            (&raw const (*mailbox).pixels).read_volatile(),
        )
    };
    let observed = match memory.pixels.get(..usize::from(pixels)) {
        Some(pixels) if !pixels.is_empty() => Observed::Pixels(pixels),
        _ => Observed::Silhouette,
    };
    let mut answer = 3;
    if let (Ok(camera), Ok(pose), Some(image)) = (
        Camera::new(fx, fy, cx, cy),
        Pose::from_row_major(rotation, translation),
        DepthWords::new(memory.image, width, 1.0),
    ) && let Ok(report) =
        load_and_check(template, &camera, &pose, observed, &image, memory.cells, || ())
    {
        let [x, y, z] = translation;
        let t = report.refined.translation();
        // SAFETY: the caller's promise.
        unsafe {
            (&raw mut (*mailbox).confidence).write_volatile(report.confidence);
            (&raw mut (*mailbox).estimated_error).write_volatile(report.estimated_error);
            (&raw mut (*mailbox).suggested).write_volatile([t.x - x, t.y - y, t.z - z]);
        }
        answer = match report.decision {
            Decision::Accept => 0,
            Decision::Reject(_) => 1,
            Decision::Undecided(_) => 2,
        };
    }
    // SAFETY: the caller's promise.
    unsafe { (&raw mut (*mailbox).answer).write_volatile(answer) };
}
