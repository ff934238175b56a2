//! A Cortex-M board under QEMU.
#![no_std]

use cobra_firmware_app::Board;
use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;

/// The board that the build chose, its SysTick running.
pub struct CortexM {
    ticks: SYST,
    total: u64,
}

const BOARD: &str = env!("COBRA_BOARD");

/// SysTick's ticks for 1,000 instructions where each takes 64 ns, as under `-icount shift=6`: the
/// board's frequency in MHz times 64.
const TICKS_IN_1000_INSTRUCTIONS: u64 =
    64 * match BOARD.as_bytes() {
        b"microbit" => 16_000,
        b"lm3s6965evb" => 12_500,
        b"mps2-an385" | b"mps2-an386" => 25_000,
        b"mps2-an505" => 20_000,
        b"mps3-an547" => 32_000,
        _ => panic!("a board without a frequency"),
    } / 1_000;

/// SysTick counts down 24 bits.
const WRAP: u32 = 1 << 24;

impl CortexM {
    /// Starts SysTick. `None` when called twice.
    #[must_use]
    pub fn new() -> Option<Self> {
        let mut ticks = cortex_m::Peripherals::take()?.SYST;
        ticks.set_clock_source(SystClkSource::Core);
        ticks.set_reload(WRAP - 1);
        ticks.clear_current();
        ticks.enable_counter();
        Some(Self { ticks, total: 0 })
    }
}

impl Board for CortexM {
    fn name(&self) -> &'static str {
        BOARD
    }

    fn feed_watchdog(&mut self) {
        // None of these boards has one that QEMU runs; here it would be told.
    }

    fn instructions(&mut self) -> u64 {
        // Set where the counter has reached 0 since it was last cleared. Read between two looks at the
        // counter, which grows from one to the next only where it wraps around there.
        let before = SYST::get_current();
        let wrapped = self.ticks.has_wrapped();
        let now = SYST::get_current();
        let wraps = u32::from(wrapped || now > before);
        self.total += u64::from(WRAP - 1 - now + wraps * WRAP);
        // From the top again, so that the next call may come as late as twice the counter's range.
        self.ticks.clear_current();
        self.total * 1_000 / TICKS_IN_1000_INSTRUCTIONS
    }
}
