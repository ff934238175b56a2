//! Stack and instructions on a Cortex-M board. Instructions need QEMU's `-icount`.
#![no_std]
#![no_main]

use cobra_cortex_m::CortexM;
use cobra_firmware_app::budget;
use cobra_firmware_app::console::{Console, exit};
use cortex_m_rt::entry;

cobra_firmware_app::print_panics!();

#[entry]
fn main() -> ! {
    let (Some(mut board), Some(mut console)) = (CortexM::new(), Console::new()) else {
        exit(false)
    };
    exit(budget::run(&mut board, &mut console).is_ok())
}
