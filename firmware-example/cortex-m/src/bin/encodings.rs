//! What a term takes by how it is written, on a Cortex-M board with 32 KB of RAM: `cargo run --release
//! --bin encodings`. Instructions need QEMU's `-icount`.
#![no_std]
#![no_main]

use cobra_cortex_m::CortexM;
use cobra_firmware_app::console::{Console, exit};
use cobra_firmware_app::encodings;
use cortex_m_rt::entry;

cobra_firmware_app::print_panics!();

#[entry]
fn main() -> ! {
    let (Some(mut board), Some(mut console)) = (CortexM::new(), Console::new()) else {
        exit(false)
    };
    exit(encodings::run(&mut board, &mut console).is_ok())
}
