//! Encodings of a term on the M4F: bytes and instructions.

use crate::lines::{Lines, number};
use crate::tenth;
use serde_json::{Value, json};
use std::error::Error;
use std::fmt::Write;
use std::path::Path;

/// By the names that the program has for them, the format's own first.
const ENCODINGS: [(&str, &str); 4] = [
    ("3xi8+i16", "3 × `i8`, weight `i16`: compact terms"),
    ("octahedral-2xi16+i16", "octahedral 2 × `i16`, weight `i16`"),
    ("3xi16+i16", "3 × `i16`, weight `i16`"),
    ("3xf32+f32", "3 × `f32`, weight `f32`"),
];

/// What a term takes in one of them.
pub(crate) struct Encoding {
    text: &'static str,
    bytes: u64,
    instructions: f64,
}

/// Of the file `encodings`.
pub(crate) fn measured(folder: &Path) -> Result<Vec<Encoding>, Box<dyn Error>> {
    let printed = Lines::read(&folder.join("encodings"), "encoding")?;
    ENCODINGS
        .into_iter()
        .map(|(name, text)| {
            let line = printed.named.get(name);
            let line = line.ok_or_else(|| format!("no encoding {name}"))?;
            let terms = number(line, "terms")? as f64;
            Ok(Encoding {
                text,
                bytes: number(line, "bytes")?,
                instructions: number(line, "instructions")? as f64 / terms,
            })
        })
        .collect()
}

impl Encoding {
    /// As it stands in `target/firmware.json`.
    pub(crate) fn document(&self) -> Value {
        json!({
            "encoding": self.text.replace('`', ""),
            "bytes_per_term": self.bytes,
            "instructions_per_term": tenth(self.instructions),
        })
    }
}

/// Under the version that built the program.
pub(crate) fn table(all: &[Encoding], rustc: &str) -> String {
    let mut text = format!(
        "Built by {rustc}, `opt-level = \"s\"`:\n\n\
         | a term as | bytes | instructions |\n\
         |---|--:|--:|\n"
    );
    for encoding in all {
        let Encoding {
            text: name,
            bytes,
            instructions,
        } = encoding;
        writeln!(text, "| {name} | {bytes} | {instructions:.1} |").expect("a string takes all");
    }
    text
}
