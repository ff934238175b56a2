//! The example on a Cortex-M board: `cargo run --release`.
#![no_std]
#![no_main]

use cobra_cortex_m::CortexM;
use cobra_firmware_app::console::{Console, exit};
use cobra_firmware_app::score;
use cortex_m_rt::entry;

cobra_firmware_app::print_panics!();

#[entry]
fn main() -> ! {
    let (Some(mut board), Some(mut console)) = (CortexM::new(), Console::new()) else {
        exit(false)
    };
    exit(score::run(&mut board, &mut console).is_ok())
}
