//! Judges each pose as its points arrive.

use crate::estimator::{MESSAGES, Message};
use crate::watchdog::{PROGRESS, Progress};
use cobra_firmware_app::console::Console;
use cobra_firmware_app::footprint::{COMPONENTS, Refusal, settings};
use cobra_firmware_app::score::{TEMPLATE, print};
use cobra_infer::{Camera, Scorer, Template};
use core::fmt::{self, Write};
use embassy_futures::yield_now;

/// Why it ended early.
enum Failure {
    Console,
    Refused(Refusal),
}

impl From<fmt::Error> for Failure {
    fn from(_: fmt::Error) -> Self {
        Failure::Console
    }
}

/// Scores until the stream ends, and says so to the watchdog.
#[embassy_executor::task]
pub(crate) async fn run(camera: Camera, mut console: Console) {
    let outcome = score(&camera, &mut console).await;
    if let Err(Failure::Refused(refusal)) = &outcome {
        // The exit status says it too, should this not be printed.
        let _ = match refusal {
            Refusal::Template(error) => writeln!(console, "the template is refused: {error}"),
            Refusal::Score(error) => writeln!(console, "{error}"),
            Refusal::Depth(error) => writeln!(console, "{error}"),
        };
    }
    PROGRESS.signal(Progress::Over {
        passed: outcome.is_ok(),
    });
}

/// The template is read where it lies in flash; it and the scorer live in this future, across every
/// wait for the next point, and so in static memory.
async fn score(camera: &Camera, console: &mut Console) -> Result<(), Failure> {
    let template =
        Template::from_bytes(TEMPLATE).map_err(|e| Failure::Refused(Refusal::Template(e)))?;
    let settings = settings(&template);
    let mut current = None;
    loop {
        match MESSAGES.receive().await {
            Message::Pose(title, pose) => {
                let scorer = Scorer::<COMPONENTS>::new(&template, camera, &pose, &settings)
                    .map_err(|e| Failure::Refused(Refusal::Score(e)))?;
                current = Some((title, scorer));
            }
            Message::Point(correspondence) => {
                if let Some((_, scorer)) = &mut current {
                    scorer.push(&correspondence);
                    PROGRESS.signal(Progress::Point);
                }
                // While the channel is full, `receive` never waits: without this, other tasks would
                // wait for all that is in it, and not for a point or two.
                yield_now().await;
            }
            Message::EndOfPose => {
                if let Some((title, scorer)) = current.take() {
                    print(&scorer.finish(), title, console)?;
                }
            }
            Message::EndOfStream => return Ok(()),
        }
    }
}
