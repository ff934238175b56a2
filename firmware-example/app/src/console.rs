//! Standard output and an exit code through a debugger, which QEMU plays.

use core::fmt::{self, Write as _};
use core::panic::PanicInfo;
use semihosting::io::{Stdout, Write};
use semihosting::process::ExitCode;

/// QEMU's standard output.
#[derive(Debug)]
pub struct Console(Stdout);

impl Console {
    /// `None` where no debugger listens.
    #[must_use]
    pub fn new() -> Option<Self> {
        semihosting::io::stdout().ok().map(Self)
    }
}

impl fmt::Write for Console {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.write_all(text.as_bytes()).map_err(|_| fmt::Error)
    }
}

/// Ends the emulator, with its exit status.
pub fn exit(passed: bool) -> ! {
    if passed {
        ExitCode::SUCCESS.exit_process()
    } else {
        ExitCode::FAILURE.exit_process()
    }
}

/// Says where the program panicked, and ends it.
pub fn panicked(info: &PanicInfo<'_>) -> ! {
    if let Some(mut console) = Console::new() {
        // Nothing is left to tell that it cannot be told.
        let _ = writeln!(console, "{info}");
    }
    exit(false)
}

/// A panic handler that prints. A macro, because `footprint` must bring its own.
#[macro_export]
macro_rules! print_panics {
    () => {
        #[panic_handler]
        fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
            $crate::console::panicked(info)
        }
    };
}
