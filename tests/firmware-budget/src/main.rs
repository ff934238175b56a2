//! Turns what `tests/run firmware` collected into `target/firmware.json`, the tables of README and
//! `docs/BENCHMARKS.md`, and `cobra-train/assets/boards.csv`, which `cobra report` shows.
//!
//! `firmware-budget FOLDER RUSTC`: FOLDER holds, for each row `TARGET BOARD` of its file `rows`,
//! `BOARD-TARGET.elf` (the program `footprint`), `.depth.elf` (`footprint-depth`), `.budget` and `.agreement` (what these programs
//! printed); for each row `NAME ARGUMENT…` of its file `objects`, if there is one, `NAME.object`,
//! `NAME.check` and `NAME.json` (what `object`, `object-depth` and `cobra eval` printed); and `encodings` (what that program printed).
//! RUSTC is the version that built them. With `--write` they are replaced, else compared.

mod boards;
mod checks;
mod encodings;
mod lines;
mod objects;
mod page;

use boards::Row;
use page::{Near, compare_or_write, compare_or_write_csv};
use serde_json::{Value, json};
use std::error::Error;
use std::fs;
use std::path::Path;

const BOARDS: &str =
    "<!-- what `tests/run firmware` measured; `tests/run firmware --write` renews it -->\n";
const OBJECTS: &str = "<!-- objects: what `tests/run firmware` measured; `tests/run firmware --write` renews it -->\n";
const CHECKS: &str =
    "<!-- checks: what `tests/run firmware` measured; `tests/run firmware --write` renews it -->\n";
const ENCODINGS: &str = "<!-- encodings: what `tests/run firmware` measured; `tests/run firmware --write` renews it -->\n";

/// The board that objects and encodings are measured on.
const M4F: &str = "mps2-an386";

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    let write = arguments.iter().any(|argument| argument == "--write");
    arguments.retain(|argument| argument != "--write");
    let [folder, rustc] = &arguments[..] else {
        return Err("usage: firmware-budget FOLDER RUSTC [--write]".into());
    };
    let folder = Path::new(folder);
    let rows = fs::read_to_string(folder.join("rows"))?
        .lines()
        .map(|line| boards::row(folder, line).map_err(|error| format!("{line}: {error}").into()))
        .collect::<Result<Vec<Row>, Box<dyn Error>>>()?;
    let objects = objects::measured(folder)?;
    let checks = checks::measured(folder)?;
    let encodings = encodings::measured(folder)?;
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    fs::create_dir_all(root.join("target"))?;
    let json: Vec<Value> = rows
        .iter()
        .map(|row| {
            let mut document = boards::document(row);
            if row.board == M4F {
                let objects = objects.iter().map(objects::Measured::document);
                document["objects"] = objects.collect();
                let checks = checks.iter().map(checks::Measured::document);
                document["depth_checks"] = checks.collect();
                let encodings = encodings.iter().map(encodings::Encoding::document);
                document["encodings"] = encodings.collect();
            }
            document
        })
        .collect();
    let json = serde_json::to_string_pretty(&json!(json))? + "\n";
    fs::write(root.join("target/firmware.json"), json)?;
    for row in &rows {
        if row.mismatched_bits != 0 {
            return Err(format!("{}: {} mismatched bits", row.board, row.mismatched_bits).into());
        }
    }
    for object in &objects {
        object.check()?;
    }
    for checks in &checks {
        checks.check()?;
    }
    let table = boards::table(&rows, rustc);
    let page = root.join("README.md");
    compare_or_write(&page, BOARDS, &table, Near::SameUnlessCompiler, write)?;
    let file = root.join("cobra-train/assets/boards.csv");
    compare_or_write_csv(&file, &boards::csv(&rows, rustc), write)?;
    let page = root.join("docs/BENCHMARKS.md");
    let table = encodings::table(&encodings, rustc);
    compare_or_write(&page, ENCODINGS, &table, Near::Tenth, write)?;
    if objects.is_empty() {
        return Ok(());
    }
    let table = objects::table(&objects, rustc);
    compare_or_write(&page, OBJECTS, &table, Near::Tenth, write)?;
    let table = checks::table(&checks, rustc);
    compare_or_write(&page, CHECKS, &table, Near::Tenth, write)
}

fn tenth(value: f64) -> f64 {
    (value * 10.0).round() / 10.0
}
