//! Counts kernel evaluations, in tests only: the sum over a template's terms calls the kernel
//! through [`Counted`].

use crate::kernel::Covariance;
use core::cell::Cell;

std::thread_local! {
    static MADE: Cell<usize> = const { Cell::new(0) };
}

/// A kernel whose evaluations are counted.
#[derive(Clone, Copy)]
pub(super) struct Counted<K>(pub(super) K);

impl<K: Covariance<f32>> Covariance<f32> for Counted<K> {
    fn between(&self, a: [f32; 3], b: [f32; 3]) -> f32 {
        MADE.set(MADE.get() + 1);
        self.0.between(a, b)
    }

    fn gradient(&self, a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
        self.0.gradient(a, b)
    }
}

/// Counts what is no kernel's.
pub(super) fn add(evaluations: usize) {
    MADE.set(MADE.get() + evaluations);
}

/// What `act` returns, and how many evaluations this thread made in it.
pub(crate) fn during<R>(act: impl FnOnce() -> R) -> (R, usize) {
    let before = MADE.get();
    let result = act();
    (result, MADE.get() - before)
}
