//! The least that a RISC-V board links to check poses against depth: built to be looked at, as `footprint`.
#![no_std]
#![no_main]

use cobra_firmware_app::footprint_depth::{CELLS, Mailbox, Memory, serve};
use core::hint::black_box;
use core::panic::PanicInfo;
use core::ptr::{with_exposed_provenance, with_exposed_provenance_mut};
use core::slice::{from_raw_parts, from_raw_parts_mut};
use riscv_rt::entry;

// Brings the vector table or the memory layout along.
use cobra_riscv as _;

/// Where a bootloader would have put the template, where devices would write, and scratch memory: addresses
/// that stand for any. The program is not meant to be run.
const TEMPLATE: (usize, usize) = (0x8040_0000, 0x4000);
const MAILBOX: usize = 0x80a0_0000;
const PIXELS: (usize, usize) = (0x80a0_4000, 500);
const CELLS_START: usize = 0x80a0_8000;
const IMAGE: (usize, usize) = (0x80a1_0000, 96 * 72);

#[entry]
fn main() -> ! {
    let (template, pixels, image) = black_box((TEMPLATE, PIXELS, IMAGE));
    // SAFETY: flash and RAM of the board that the addresses are of, in use for nothing else.
    unsafe {
        let (start, length) = template;
        let template = from_raw_parts(with_exposed_provenance(start), length);
        let mut memory = Memory {
            image: from_raw_parts(with_exposed_provenance(image.0), image.1),
            pixels: from_raw_parts(with_exposed_provenance(pixels.0), pixels.1),
            cells: from_raw_parts_mut(with_exposed_provenance_mut(CELLS_START), CELLS),
        };
        loop {
            serve(
                template,
                with_exposed_provenance_mut::<Mailbox>(MAILBOX),
                &mut memory,
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
