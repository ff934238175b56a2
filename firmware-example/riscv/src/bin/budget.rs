//! Stack and instructions on a RISC-V board. Instructions need QEMU's `-icount`.
#![no_std]
#![no_main]

use cobra_firmware_app::budget;
use cobra_firmware_app::console::{Console, exit};
use cobra_riscv::Virt;
use riscv_rt::entry;

cobra_firmware_app::print_panics!();

#[entry]
fn main() -> ! {
    let (Some(mut board), Some(mut console)) = (Virt::new(), Console::new()) else {
        exit(false)
    };
    exit(budget::run(&mut board, &mut console).is_ok())
}
