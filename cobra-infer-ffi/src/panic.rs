//! The panic handler of bare metal. The release build reaches no panic, so that the linker drops
//! it; a debug build checks its arithmetic and may.
#![allow(
    unsafe_code,
    reason = "an undefined symbol can only be declared in an extern block"
)]

use core::panic::PanicInfo;

#[cfg(feature = "link-error-on-panic")]
#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    unsafe extern "C" {
        fn cobra_infer_reaches_a_panic() -> !;
    }
    // SAFETY: no program that contains this call links.
    unsafe { cobra_infer_reaches_a_panic() }
}

/// Stops: the watchdog that a controller has is the one to go on from here.
#[cfg(not(feature = "link-error-on-panic"))]
#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    loop {
        core::hint::spin_loop();
    }
}
