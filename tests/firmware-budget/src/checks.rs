//! Checks of a real object's template against depth on the M4F: what they take, and what they must not exceed.

use crate::lines::{Lines, number};
use crate::objects;
use serde_json::{Value, json};
use std::error::Error;
use std::fmt::Write;
use std::path::Path;

/// Memory of the caller's: pixels and cells. The image is the sensor's.
const MEMORY: u64 = 48 * 1024;

/// The most instructions of a check, by the names that `tests/parts/objects.sh` gives templates.
const INSTRUCTIONS: [(&str, u64); 4] = [
    ("terms", 18_000_000),
    ("few-terms", 24_000_000),
    ("maps", 6_000_000),
    ("few-maps", 6_000_000),
];

/// By the program's names, and the table's.
const PARTS: [(&str, &str); 7] = [
    ("total", "a check"),
    ("visible", "visible surface"),
    ("reverse", "reverse"),
    ("forward", "forward"),
    ("refinement", "refinement"),
    ("displacement", "displacement"),
    ("silhouette", "a check by the silhouette"),
];

/// What the checks of one template came to.
pub(crate) struct Measured {
    name: String,
    arguments: String,
    pixels: u64,
    memory_bytes: u64,
    mismatched_bits: u64,
    /// Instructions, as [`PARTS`].
    instructions: [u64; PARTS.len()],
}

pub(crate) fn measured(folder: &Path) -> Result<Vec<Measured>, Box<dyn Error>> {
    objects::each(folder, one)
}

/// Of the poses, the one that is off: it is the dearer.
fn one(folder: &Path, line: &str) -> Result<Measured, Box<dyn Error>> {
    let (name, arguments) = line.split_once(' ').unwrap_or((line, ""));
    let printed = Lines::read(&folder.join(format!("{name}.check")), "check")?;
    let line = printed.named.get("pose-1").ok_or("no check of pose-1")?;
    let mut instructions = [0; PARTS.len()];
    for (to, (key, _)) in instructions.iter_mut().zip(PARTS) {
        *to = number(line, key)?;
    }
    Ok(Measured {
        name: name.into(),
        arguments: arguments.trim().into(),
        pixels: number(line, "pixels")?,
        memory_bytes: number(line, "bytes")?,
        mismatched_bits: number(line, "mismatched_bits")?,
        instructions,
    })
}

impl Measured {
    /// As it stands in `target/firmware.json`.
    pub(crate) fn document(&self) -> Value {
        let mut document = json!({
            "template": self.name,
            "arguments": self.arguments,
            "pixels": self.pixels,
            "memory_bytes": self.memory_bytes,
            "mismatched_bits": self.mismatched_bits,
        });
        for ((key, _), instructions) in PARTS.into_iter().zip(self.instructions) {
            document[format!("instructions_{key}")] = instructions.into();
        }
        document
    }

    /// # Errors
    /// The limit that it is beyond.
    pub(crate) fn check(&self) -> Result<(), Box<dyn Error>> {
        let (_, most) = INSTRUCTIONS
            .into_iter()
            .find(|(name, _)| *name == self.name)
            .ok_or_else(|| format!("{}: no limits", self.name))?;
        let [total, ..] = self.instructions;
        let broken = [
            ("bits of checks differ", self.mismatched_bits, 0),
            ("bytes of memory for a check", self.memory_bytes, MEMORY),
            ("instructions a check", total, most),
        ]
        .into_iter()
        .find(|(_, found, most)| found > most);
        match broken {
            None => Ok(()),
            Some((what, found, most)) => {
                Err(format!("{}: {found} {what}, at most {most}", self.name).into())
            }
        }
    }
}

/// Under the version that built the program; in thousands of instructions.
pub(crate) fn table(all: &[Measured], rustc: &str) -> String {
    let mut text = format!(
        "Built by {rustc}, `opt-level = \"s\"`; thousands of instructions:\n\n\
         | `cobra train model.ply` with | pixels | memory, bytes |"
    );
    for (_, part) in PARTS {
        write!(text, " {part} |").expect("a string takes all");
    }
    text.push_str(" bits that differ |\n|---|--:|--:|");
    text.push_str(&"--:|".repeat(PARTS.len() + 1));
    text.push('\n');
    for checks in all {
        let arguments = match checks.arguments.as_str() {
            "" => "its defaults".to_owned(),
            arguments => format!("`{arguments}`"),
        };
        let (pixels, bytes) = (checks.pixels, checks.memory_bytes);
        write!(text, "| {arguments} | {pixels} | {bytes} |").expect("a string takes all");
        for instructions in checks.instructions {
            write!(text, " {:.0} |", instructions as f64 / 1000.0).expect("a string takes all");
        }
        writeln!(text, " {} |", checks.mismatched_bits).expect("a string takes all");
    }
    text
}
