//! The recorded vectors on a RISC-V board: `cargo run --release --bin agreement`.
#![no_std]
#![no_main]

use cobra_firmware_app::agreement;
use cobra_firmware_app::console::{Console, exit};
use cobra_riscv::Virt;
use riscv_rt::entry;

cobra_firmware_app::print_panics!();

#[entry]
fn main() -> ! {
    let (Some(mut board), Some(mut console)) = (Virt::new(), Console::new()) else {
        exit(false)
    };
    exit(agreement::run(&mut board, &mut console) == Ok(true))
}
