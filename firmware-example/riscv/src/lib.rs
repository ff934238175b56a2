//! QEMU's RISC-V `virt` machine.
#![no_std]

use cobra_firmware_app::Board;
use riscv::register::{minstret, minstreth};

/// One hart.
#[derive(Debug)]
pub struct Virt(());

impl Virt {
    /// Always there.
    #[must_use]
    pub fn new() -> Option<Self> {
        Some(Self(()))
    }
}

impl Board for Virt {
    fn name(&self) -> &'static str {
        "virt"
    }

    fn feed_watchdog(&mut self) {
        // QEMU's machine has none; here it would be told.
    }

    fn instructions(&mut self) -> u64 {
        loop {
            let high = minstreth::read();
            let low = minstret::read();
            if minstreth::read() == high {
                return (high as u64) << 32 | low as u64;
            }
        }
    }
}
