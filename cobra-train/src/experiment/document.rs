//! The document of all experiments.

use super::findings::Findings;
use std::fmt::Write as _;

/// The machine that results come from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Machine {
    /// The processor's own name, or its architecture.
    pub processor: String,
    /// How many threads run at once.
    pub cores: usize,
    /// The operating system.
    pub system: &'static str,
}

impl Machine {
    /// This one.
    #[must_use]
    pub fn this() -> Self {
        let told = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let name = told.lines().find_map(|line| {
            let (key, value) = line.split_once(':')?;
            (key.trim() == "model name").then(|| value.trim().to_owned())
        });
        Self {
            processor: name.unwrap_or_else(|| std::env::consts::ARCH.to_owned()),
            cores: std::thread::available_parallelism().map_or(1, usize::from),
            system: std::env::consts::OS,
        }
    }
}

/// All findings as one document of Markdown, whose figures and numbers lie beside it; `command` is what
/// made it.
#[must_use]
pub fn document(findings: &[Findings], machine: &Machine, seed: u64, command: &str) -> String {
    let seconds: f64 = findings.iter().map(|found| found.seconds).sum();
    let mut text = format!(
        "# The paper's tables and figures\n\nMade by `{command}`: version {}, seed {seed}, {} ({} core{}, {}), \
         {:.0} min {:02.0} s in all. Lengths are in radii of the object's bounding sphere. What the paper \
         prints is of other objects of the same classes.\n",
        env!("CARGO_PKG_VERSION"),
        machine.processor,
        machine.cores,
        if machine.cores == 1 { "" } else { "s" },
        machine.system,
        (seconds / 60.0).floor(),
        seconds % 60.0,
    );
    for found in findings {
        let _ = write!(text, "\n{}", found.markdown());
    }
    text
}
