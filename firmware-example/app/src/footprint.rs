//! The least that a controller links: load a template, score one pose, decide.

use cobra_infer::depth::DepthError;
use cobra_infer::{
    Camera, Correspondence, Decision, Pose, Report, ScoreError, Scorer, Settings, Sigma, Template,
    TemplateError,
};

/// The most components that the examples make room for.
pub const COMPONENTS: usize = 16;

/// Why there is no report.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refusal {
    /// The bytes are no template.
    Template(TemplateError),
    /// The template does not suit the scorer.
    Score(ScoreError),
    /// The template, the settings or the memory do not suit the check against depth.
    Depth(DepthError),
}

/// How the examples score: σ as in the README's example, a tolerance of 2 mm. One function, so that
/// programs which score the same stream in different ways agree on every bit.
#[must_use]
pub fn settings(template: &Template<'_>) -> Settings {
    Settings {
        sigma: Sigma::Fixed(1.93),
        ..Settings::for_template(template, 2.0)
    }
}

/// Loads the template, scores one pose on the correspondences, and reports.
///
/// `each` is called after every correspondence: the place to feed a watchdog.
///
/// # Errors
/// [`Refusal`].
#[inline(never)]
pub fn load_and_score(
    template: &[u8],
    camera: &Camera,
    pose: &Pose,
    correspondences: impl Iterator<Item = Correspondence>,
    mut each: impl FnMut(),
) -> Result<Report, Refusal> {
    // Both are used inside the results that they come in: moved out, they would lie on the stack
    // twice.
    let template = Template::from_bytes(template);
    let template = match &template {
        Ok(template) => template,
        Err(error) => return Err(Refusal::Template(*error)),
    };
    let settings = settings(template);
    let mut scorer = Scorer::<COMPONENTS>::new(template, camera, pose, &settings);
    let scorer = match &mut scorer {
        Ok(scorer) => scorer,
        Err(error) => return Err(Refusal::Score(*error)),
    };
    for correspondence in correspondences {
        scorer.push(&correspondence);
        each();
    }
    Ok(scorer.finish())
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
    /// How many correspondences there are.
    pub count: u32,
    /// Pixel, point and weight, written anew for each correspondence.
    pub correspondence: [f32; 6],
    /// The confidence.
    pub confidence: f32,
    /// The threshold.
    pub threshold: f32,
    /// 0 accept, 1 reject, 2 undecided, 3 nothing could be scored.
    pub answer: u32,
}

/// One round: reads the mailbox, scores, answers.
///
/// # Safety
/// `mailbox` must be valid for reads and writes and aligned.
pub unsafe fn serve(template: &[u8], mailbox: *mut Mailbox) {
    // SAFETY: the caller's promise. Volatile and field by field, because a device writes there.
    let ([fx, fy, cx, cy], rotation, translation, count) = unsafe {
        (
            (&raw const (*mailbox).camera).read_volatile(),
            (&raw const (*mailbox).rotation).read_volatile(),
            (&raw const (*mailbox).translation).read_volatile(),
            (&raw const (*mailbox).count).read_volatile(),
        )
    };
    let stream = (0..count).map(|_| {
        // SAFETY: as above.
        let [u, v, x, y, z, weight] =
            unsafe { (&raw const (*mailbox).correspondence).read_volatile() };
        Correspondence {
            pixel: [u, v].into(),
            point: [x, y, z].into(),
            weight,
        }
    });
    let mut answer = 3;
    if let (Ok(camera), Ok(pose)) = (
        Camera::new(fx, fy, cx, cy),
        Pose::from_row_major(rotation, translation),
    ) && let Ok(report) = load_and_score(template, &camera, &pose, stream, || ())
    {
        // SAFETY: the caller's promise.
        unsafe {
            (&raw mut (*mailbox).confidence).write_volatile(report.confidence);
            (&raw mut (*mailbox).threshold).write_volatile(report.threshold);
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
