//! When the caller's watchdog is fed.
//!
//! Owns the count of what was looked at since it was fed last, whether or not anything came of it.

/// Calls `alive` on every [`Pulse::EVERY`]th beat.
#[derive(Debug)]
pub(super) struct Pulse<'a, A> {
    alive: &'a mut A,
    count: u8,
}

impl<'a, A: FnMut()> Pulse<'a, A> {
    /// What [`super::DepthCheck::run`] promises.
    const EVERY: u8 = 64;

    pub(super) fn new(alive: &'a mut A) -> Self {
        Self { alive, count: 0 }
    }

    /// For every pixel, cell of the depth buffer, and place where a point of the surface may be.
    #[inline]
    pub(super) fn beat(&mut self) {
        self.count += 1;
        if self.count >= Self::EVERY {
            self.count = 0;
            (self.alive)();
        }
    }
}
