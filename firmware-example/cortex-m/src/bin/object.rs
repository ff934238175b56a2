//! A template of one's own on a Cortex-M board with megabytes of RAM: `cargo run --release --bin
//! object`, in a folder that holds its files. Instructions need QEMU's `-icount`.
#![no_std]
#![no_main]

use cobra_cortex_m::CortexM;
use cobra_firmware_app::console::{Console, exit};
use cobra_firmware_app::object::{self, Room};
use cortex_m_rt::entry;

cobra_firmware_app::print_panics!();

#[entry]
fn main() -> ! {
    let room = cortex_m::singleton!(ROOM: Room = Room::EMPTY);
    let (Some(mut board), Some(mut console), Some(room)) = (CortexM::new(), Console::new(), room)
    else {
        exit(false)
    };
    exit(object::run(&mut board, &mut console, room).is_ok())
}
