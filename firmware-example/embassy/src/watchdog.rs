//! Feeds the watchdog, but only while the scorer makes progress.

use cobra_cortex_m::CortexM;
use cobra_firmware_app::Board;
use cobra_firmware_app::console::{Console, exit};
use core::fmt::Write;
use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::signal::Signal;

/// What the scorer has done.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Progress {
    /// It has scored a point.
    Point,
    /// It has ended. One in a product never does.
    Over {
        /// Whether it went well.
        passed: bool,
    },
}

/// The latest progress, not a queue of it: what matters is that there was some. The watchdog is fed
/// less often than points are scored.
pub(crate) static PROGRESS: Signal<CriticalSectionRawMutex, Progress> = Signal::new();

/// Not by a timer: a timer goes on when the scorer hangs, or waits for an estimator that does.
#[embassy_executor::task]
pub(crate) async fn run(mut board: CortexM) {
    let mut fed: u32 = 0;
    loop {
        match PROGRESS.wait().await {
            Progress::Point => {
                board.feed_watchdog();
                fed = fed.saturating_add(1);
            }
            Progress::Over { passed } => {
                let told = Console::new().is_some_and(|mut console| {
                    writeln!(console, "watchdog fed {fed} times").is_ok()
                });
                exit(passed && told);
            }
        }
    }
}
