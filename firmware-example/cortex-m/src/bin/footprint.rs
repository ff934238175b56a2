//! The least that a Cortex-M board links. It is built to be looked at: its size, and that it links at
//! all, because its panic handler calls a function that nobody defines.
#![no_std]
#![no_main]

use cobra_firmware_app::footprint::{Mailbox, serve};
use core::hint::black_box;
use core::panic::PanicInfo;
use cortex_m_rt::entry;

// Brings the vector table or the memory layout along.
use cobra_cortex_m as _;

/// Where a bootloader would have put the template, and where a device would write: addresses of an
/// M4F that stand for any. The program is not meant to be run.
const TEMPLATE: (usize, usize) = (0x0002_0000, 0x4000);
const MAILBOX: usize = 0x2000_2000;

#[entry]
fn main() -> ! {
    let (start, length) = black_box(TEMPLATE);
    // SAFETY: flash and RAM of the board that the addresses are of, in use for nothing else.
    unsafe {
        let template =
            core::slice::from_raw_parts(core::ptr::with_exposed_provenance(start), length);
        loop {
            serve(
                template,
                core::ptr::with_exposed_provenance_mut::<Mailbox>(MAILBOX),
            );
        }
    }
}

unsafe extern "C" {
    /// Nowhere. A program in which a panic can be reached does not link.
    fn a_panic_can_be_reached() -> !;
}

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    // SAFETY: never called: there is nothing to call.
    unsafe { a_panic_can_be_reached() }
}
