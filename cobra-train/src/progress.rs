//! How long work tells whoever waits for it.

use std::sync::Mutex;
use std::time::{Duration, Instant};

/// Receives progress; called from several threads.
pub trait Progress: Sync {
    /// A stage of `steps` steps begins.
    fn start(&self, stage: &str, steps: u64);
    /// One step of the current stage is done.
    fn step(&self);
    /// The current stage is done.
    fn finish(&self);
    /// Something the user should know although the work goes on.
    fn warn(&self, message: &str);
}

/// Tells nobody.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {
    fn start(&self, _stage: &str, _steps: u64) {}
    fn step(&self) {}
    fn finish(&self) {}
    fn warn(&self, _message: &str) {}
}

/// Tells nobody, and times the stages of one name: those of [`crate::train::FITTING`], for example.
#[derive(Debug)]
pub struct Stopwatch {
    stage: &'static str,
    /// Since when such a stage runs, and how long earlier ones took.
    state: Mutex<(Option<Instant>, Duration)>,
}

impl Stopwatch {
    /// For the stages of this name.
    #[must_use]
    pub fn new(stage: &'static str) -> Self {
        Self {
            stage,
            state: Mutex::default(),
        }
    }

    /// How long those that are done took together.
    #[must_use]
    pub fn total(&self) -> Duration {
        self.state.lock().map(|state| state.1).unwrap_or_default()
    }
}

impl Progress for Stopwatch {
    fn start(&self, stage: &str, _steps: u64) {
        if let Ok(mut state) = self.state.lock() {
            state.0 = (stage == self.stage).then(Instant::now);
        }
    }

    fn step(&self) {}

    fn finish(&self) {
        if let Ok(mut state) = self.state.lock()
            && let Some(started) = state.0.take()
        {
            state.1 += started.elapsed();
        }
    }

    fn warn(&self, _message: &str) {}
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stopwatch_times_stages_of_its_name_alone() {
        let watch = Stopwatch::new("one");
        watch.start("other", 1);
        watch.finish();
        assert_eq!(watch.total(), Duration::ZERO);
        watch.start("one", 1);
        std::thread::sleep(Duration::from_millis(2));
        watch.finish();
        watch.finish();
        assert!(watch.total() >= Duration::from_millis(2));
    }
}
