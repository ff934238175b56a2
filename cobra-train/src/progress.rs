//! How long work tells whoever waits for it.

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
