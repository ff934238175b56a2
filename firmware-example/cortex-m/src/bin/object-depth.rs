//! A template of one's own against a depth image, on a Cortex-M board with megabytes of RAM: `cargo run
//! --release --bin object-depth`, in a folder that holds its files. Instructions need QEMU's `-icount`.
#![no_std]
#![no_main]

use cobra_cortex_m::CortexM;
use cobra_firmware_app::console::{Console, exit};
use cobra_firmware_app::object::Room;
use cobra_firmware_app::object_depth::{self, CheckRoom};
use cortex_m_rt::entry;

cobra_firmware_app::print_panics!();

#[entry]
fn main() -> ! {
    let files = cortex_m::singleton!(FILES: Room = Room::EMPTY);
    let room = cortex_m::singleton!(ROOM: CheckRoom = CheckRoom::EMPTY);
    let (Some(mut board), Some(mut console)) = (CortexM::new(), Console::new()) else {
        exit(false)
    };
    let (Some(files), Some(room)) = (files, room) else {
        exit(false)
    };
    exit(object_depth::run(&mut board, &mut console, files, room).is_ok())
}
