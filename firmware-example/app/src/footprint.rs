//! The least that a controller links: load a template, score one pose, decide.

use cobra_infer::{
    Camera, Correspondence, Decision, Pose, Report, ScoreError, Scorer, Settings, Template,
    TemplateError,
};

/// The most components that the examples make room for.
pub const COMPONENTS: usize = 16;

/// How the examples score: a tolerance of 2 mm. One function, so that programs which score the same
/// stream in different ways agree on every bit.
#[must_use]
pub fn settings(template: &Template<'_>) -> Settings {
    Settings::for_template(template, 2.0)
}

/// Why there is no report.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refusal {
    /// The bytes are no template.
    Template(TemplateError),
    /// The template does not suit the scorer.
    Score(ScoreError),
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
    let template = Template::from_bytes(template).map_err(Refusal::Template)?;
    let settings = settings(&template);
    let mut scorer =
        Scorer::<COMPONENTS>::new(&template, camera, pose, &settings).map_err(Refusal::Score)?;
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
    // SAFETY: the caller's promise. Volatile, because a device writes there.
    let read = || unsafe { mailbox.read_volatile() };
    let start = read();
    let [fx, fy, cx, cy] = start.camera;
    let mut answer = 3;
    if let (Ok(camera), Ok(pose)) = (
        Camera::new(fx, fy, cx, cy),
        Pose::from_row_major(start.rotation, start.translation),
    ) {
        let stream = (0..start.count).map(|_| {
            let [u, v, x, y, z, weight] = read().correspondence;
            Correspondence {
                pixel: [u, v].into(),
                point: [x, y, z].into(),
                weight,
            }
        });
        if let Ok(report) = load_and_score(template, &camera, &pose, stream, || ()) {
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
    }
    // SAFETY: the caller's promise.
    unsafe { (&raw mut (*mailbox).answer).write_volatile(answer) };
}
