//! What each board came to: README's table, and the same for the command's pages.

use crate::lines::{Lines, number};
use crate::tenth;
use object::{Object, ObjectSection};
use serde_json::{Value, json};
use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

/// What one board came to.
pub(crate) struct Row {
    target: String,
    /// As QEMU has it.
    pub(crate) board: String,
    points: u64,
    /// Of the agreement vectors.
    pub(crate) mismatched_bits: u64,
    text_bytes: u64,
    stack_bytes: u64,
    /// The same of a check against depth.
    depth_text_bytes: u64,
    depth_stack_bytes: u64,
    per_point: f64,
    per_component: f64,
    per_precision: f64,
    /// With exponent 1 and with exponent ½.
    per_evaluation: [f64; 2],
}

/// As it stands in `target/firmware.json`.
pub(crate) fn document(row: &Row) -> Value {
    json!({
        "target": row.target,
        "board": row.board,
        "points": row.points,
        "mismatched_bits": row.mismatched_bits,
        "text_bytes": row.text_bytes,
        "stack_bytes": row.stack_bytes,
        "depth_text_bytes": row.depth_text_bytes,
        "depth_stack_bytes": row.depth_stack_bytes,
        "instructions_per_point": tenth(row.per_point),
        "instructions_per_evaluation": tenth(row.per_evaluation[0]),
    })
}

/// Of a line `TARGET BOARD`.
pub(crate) fn row(folder: &Path, line: &str) -> Result<Row, Box<dyn Error>> {
    let (target, board) = line.split_once(' ').ok_or("no target and board")?;
    let file = |ending: &str| -> PathBuf { folder.join(format!("{board}-{target}.{ending}")) };
    let (text_bytes, static_bytes) = sizes(&file("elf"))?;
    let (depth_text_bytes, depth_static_bytes) = sizes(&file("depth.elf"))?;
    let static_bytes = static_bytes + depth_static_bytes;
    if static_bytes != 0 {
        return Err(format!("{static_bytes} bytes of static RAM").into());
    }
    let agreement = Lines::read(&file("agreement"), "agreement")?;
    let checks = Lines::read(&file("agreement"), "depth")?;
    let budget = fs::read_to_string(file("budget"))?;
    if !budget.lines().any(|line| line.ends_with("scored=true")) || budget.contains("scored=false")
    {
        return Err("nothing was scored where the stack was measured".into());
    }
    let stack = Lines::read(&file("budget"), "stack")?;
    let depth_stack = Lines::read(&file("budget"), "depth-stack")?;
    let costs = Lines::read(&file("budget"), "cost")?;
    let cost = |name: &str| -> Result<f64, Box<dyn Error>> {
        let line = costs
            .named
            .get(name)
            .ok_or_else(|| format!("no cost of {name}"))?;
        Ok(number(line, "instructions")? as f64 / number(line, "points")? as f64)
    };
    let (small, large) = (cost("one-1x32")?, cost("one-1x192")?);
    let per_evaluation = (large - small) / 160.0;
    let nine = cost("one-9x32")?;
    let per_component = (nine - small) / 8.0;
    Ok(Row {
        target: target.into(),
        board: board.into(),
        points: agreement.sum("points")?,
        mismatched_bits: agreement.sum("mismatched_bits")? + checks.sum("mismatched_bits")?,
        text_bytes,
        stack_bytes: stack.most("bytes")?,
        depth_text_bytes,
        depth_stack_bytes: depth_stack.most("bytes")?,
        per_point: small - 32.0 * per_evaluation - per_component,
        per_component,
        per_precision: per_component + (cost("one-9x32-precisions")? - nine) / 9.0,
        per_evaluation: [
            per_evaluation,
            (cost("half-1x192")? - cost("half-1x32")?) / 160.0,
        ],
    })
}

/// Bytes of code and constants, and bytes of RAM that are taken before anything runs.
fn sizes(path: &Path) -> Result<(u64, u64), Box<dyn Error>> {
    let bytes = fs::read(path)?;
    let file = object::File::parse(&*bytes)?;
    let (mut text, mut ram) = (0, 0);
    for section in file.sections() {
        match section.name()? {
            ".text" | ".rodata" => text += section.size(),
            ".data" | ".bss" => ram += section.size(),
            _ => {}
        }
    }
    if text == 0 {
        return Err("no code".into());
    }
    Ok((text, ram))
}

/// Under the version that built the programs.
pub(crate) fn table(rows: &[Row], rustc: &str) -> String {
    let mut text = format!(
        "Built by {rustc}, `opt-level = \"s\"`:\n\n\
         | target, board | code, bytes | stack, bytes | depth: code | stack | a point | a component | with precisions \
         | an evaluation, α = 1 | α = ½ | bits that differ |\n\
         |---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n"
    );
    for row in rows {
        let [one, half] = row.per_evaluation;
        writeln!(
            text,
            "| `{}`, {} | {} | {} | {} | {} | {:.0} | {:.0} | {:.0} | {one:.1} | {half:.1} | {} of {} points |",
            row.target,
            row.board,
            row.text_bytes,
            row.stack_bytes,
            row.depth_text_bytes,
            row.depth_stack_bytes,
            row.per_point,
            row.per_component,
            row.per_precision,
            row.mismatched_bits,
            row.points,
        )
        .expect("a string takes all");
    }
    text
}

/// The same numbers for the command, which shows them beside a template's own: `cobra-train/assets/boards.csv`.
pub(crate) fn csv(rows: &[Row], rustc: &str) -> String {
    let mut text = format!(
        "# {rustc}\n\
         target,board,code,stack,depth_code,depth_stack,point,component,component_with_precisions,\
         evaluation_alpha_1,evaluation_alpha_half\n"
    );
    for row in rows {
        let [one, half] = row.per_evaluation;
        writeln!(
            text,
            "{},{},{},{},{},{},{:.0},{:.0},{:.0},{one:.1},{half:.1}",
            row.target,
            row.board,
            row.text_bytes,
            row.stack_bytes,
            row.depth_text_bytes,
            row.depth_stack_bytes,
            row.per_point,
            row.per_component,
            row.per_precision,
        )
        .expect("a string takes all");
    }
    text
}
