//! The scorer as a task of an async executor: `cargo run --release -p cobra-embassy`.
//!
//! ```text
//! estimator ── a bounded channel of messages ──► scorer ── progress ──► watchdog
//! ```
//!
//! The report lines are those of `score`, bit by bit: streaming, in whatever pieces, changes nothing.
#![no_std]
#![no_main]

mod estimator;
mod scorer;
mod watchdog;

use cobra_agreement::vectors::Points;
use cobra_cortex_m::CortexM;
use cobra_firmware_app::Board;
use cobra_firmware_app::console::{Console, exit};
use cobra_firmware_app::score::{POSES, STREAM};
use cobra_infer::Camera;
use core::fmt::Write;
use embassy_executor::Spawner;
use estimator::Poses;

cobra_firmware_app::print_panics!();

#[embassy_executor::main]
async fn main(spawner: Spawner) {
    let (Some(board), Some(mut console)) = (CortexM::new(), Console::new()) else {
        exit(false)
    };
    if writeln!(console, "COBRA on {}, in three tasks", board.name()).is_err() {
        exit(false);
    }
    let Some((points, camera, poses)) = read() else {
        // An exit status of failure is left, should even this not be printed.
        let _ = writeln!(console, "the stream does not read");
        exit(false)
    };
    match (
        estimator::run(points, poses),
        scorer::run(camera, console),
        watchdog::run(board),
    ) {
        (Ok(estimator), Ok(scorer), Ok(watchdog)) => {
            spawner.spawn(estimator);
            spawner.spawn(scorer);
            spawner.spawn(watchdog);
        }
        _ => exit(false),
    }
}

/// What is read before anything starts, so that the estimator has nothing left to fail at.
fn read() -> Option<(Points<'static>, Camera, Poses)> {
    let points = Points::read(STREAM)?;
    let [right, wrong] = POSES;
    let pose = |(index, title)| Some((title, points.pose(index, false)?));
    Some((points, points.camera()?, [pose(right)?, pose(wrong)?]))
}
