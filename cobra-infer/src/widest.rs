//! Which of the processor's vectors a loop is compiled for, chosen when it runs.
//!
//! Owns nothing that shows in an answer: the same operations in the same order, on more lanes at once. A
//! build for a family of processors may use only what all of them have; with the feature `wide-vectors`
//! a loop is there twice, and the processor is asked which it can run.

/// A loop that may be compiled more than once.
pub(crate) trait Routine {
    type Output;

    /// Always to be inlined, down to the arithmetic: what is called out of line is compiled once.
    fn run(self) -> Self::Output;
}

#[cfg(feature = "wide-vectors")]
#[inline(always)]
pub(crate) fn widest<R: Routine>(routine: R) -> R::Output {
    struct Widest<R>(R);

    impl<R: Routine> pulp::WithSimd for Widest<R> {
        type Output = R::Output;

        #[inline(always)]
        fn with_simd<S: pulp::Simd>(self, _: S) -> R::Output {
            self.0.run()
        }
    }

    pulp::Arch::new().dispatch(Widest(routine))
}

#[cfg(not(feature = "wide-vectors"))]
#[inline(always)]
pub(crate) fn widest<R: Routine>(routine: R) -> R::Output {
    routine.run()
}
