//! The recorded vectors on a Cortex-M board: `cargo run --release --bin agreement`.
#![no_std]
#![no_main]

use cobra_agreement::Set;
use cobra_agreement::vectors::sets_named;
use cobra_cortex_m::CortexM;
use cobra_firmware_app::agreement;
use cobra_firmware_app::console::{Console, exit};
use cortex_m_rt::entry;

cobra_firmware_app::print_panics!();

/// Those that the build chose.
const SETS: &[Set] = sets_named(env!("COBRA_SET"));

#[entry]
fn main() -> ! {
    let (Some(mut board), Some(mut console)) = (CortexM::new(), Console::new()) else {
        exit(false)
    };
    exit(agreement::run(&mut board, &mut console, SETS) == Ok(true))
}
