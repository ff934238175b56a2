//! The recorded vectors on a RISC-V board: `cargo run --release --bin agreement`.
#![no_std]
#![no_main]

use cobra_agreement::Set;
use cobra_agreement::vectors::sets_named;
use cobra_firmware_app::agreement;
use cobra_firmware_app::console::{Console, exit};
use cobra_riscv::Virt;
use riscv_rt::entry;

cobra_firmware_app::print_panics!();

/// Those that the build chose.
const SETS: &[Set] = sets_named(env!("COBRA_SET"));

#[entry]
fn main() -> ! {
    let (Some(mut board), Some(mut console)) = (Virt::new(), Console::new()) else {
        exit(false)
    };
    exit(agreement::run(&mut board, &mut console, SETS) == Ok(true))
}
