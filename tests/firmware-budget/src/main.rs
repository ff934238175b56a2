//! Turns what `tests/run firmware` collected into `target/firmware.json` and README's table.
//!
//! `firmware-budget FOLDER RUSTC`: FOLDER holds, for each row `TARGET BOARD` of its file `rows`,
//! `BOARD-TARGET.elf` (the program `footprint`), `.budget` and `.agreement` (what these programs
//! printed). RUSTC is the version that built them. With `--write` README's table is replaced, else
//! compared: to the digit where the version is README's, else within a tenth, because counts move
//! with the compiler.

use object::{Object, ObjectSection};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

const START: &str =
    "<!-- what `tests/run firmware` measured; `tests/run firmware --write` renews it -->\n";
const END: &str = "<!-- end of what was measured -->\n";

/// What one board came to.
struct Row {
    target: String,
    board: String,
    points: u64,
    mismatched_bits: u64,
    text_bytes: u64,
    stack_bytes: u64,
    per_point: f64,
    per_component: f64,
    per_precision: f64,
    /// With exponent 1 and with exponent ½.
    per_evaluation: [f64; 2],
}

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
        .map(|line| row(folder, line).map_err(|error| format!("{line}: {error}").into()))
        .collect::<Result<Vec<Row>, Box<dyn Error>>>()?;
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    fs::create_dir_all(root.join("target"))?;
    let json: Vec<Value> = rows.iter().map(document).collect();
    let json = serde_json::to_string_pretty(&json)? + "\n";
    fs::write(root.join("target/firmware.json"), json)?;
    for row in &rows {
        if row.mismatched_bits != 0 {
            return Err(format!("{}: {} mismatched bits", row.board, row.mismatched_bits).into());
        }
    }
    compare_or_write(&root.join("README.md"), &table(&rows, rustc), write)
}

fn document(row: &Row) -> Value {
    json!({
        "target": row.target,
        "board": row.board,
        "points": row.points,
        "mismatched_bits": row.mismatched_bits,
        "text_bytes": row.text_bytes,
        "stack_bytes": row.stack_bytes,
        "instructions_per_point": tenth(row.per_point),
        "instructions_per_evaluation": tenth(row.per_evaluation[0]),
    })
}

fn tenth(value: f64) -> f64 {
    (value * 10.0).round() / 10.0
}

fn row(folder: &Path, line: &str) -> Result<Row, Box<dyn Error>> {
    let (target, board) = line.split_once(' ').ok_or("no target and board")?;
    let file = |ending: &str| -> PathBuf { folder.join(format!("{board}-{target}.{ending}")) };
    let (text_bytes, static_bytes) = sizes(&file("elf"))?;
    if static_bytes != 0 {
        return Err(format!("{static_bytes} bytes of static RAM").into());
    }
    let agreement = Lines::read(&file("agreement"), "agreement")?;
    let budget = fs::read_to_string(file("budget"))?;
    if !budget.lines().any(|line| line.ends_with("scored=true")) || budget.contains("scored=false")
    {
        return Err("nothing was scored where the stack was measured".into());
    }
    let stack = Lines::read(&file("budget"), "stack")?;
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
        mismatched_bits: agreement.sum("mismatched_bits")?,
        text_bytes,
        stack_bytes: stack.most("bytes")?,
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

/// The lines `KIND NAME KEY=VALUE…` of a program's output, by name.
struct Lines {
    named: HashMap<String, String>,
}

impl Lines {
    fn read(path: &Path, kind: &str) -> Result<Self, Box<dyn Error>> {
        let text = fs::read_to_string(path)?;
        let named: HashMap<String, String> = text
            .lines()
            .filter_map(|line| line.strip_prefix(kind)?.trim_start().split_once(' '))
            .map(|(name, rest)| (name.into(), rest.into()))
            .collect();
        if named.is_empty() {
            return Err(format!("{}: no line of {kind}", path.display()).into());
        }
        Ok(Self { named })
    }

    fn sum(&self, key: &str) -> Result<u64, Box<dyn Error>> {
        self.named.values().map(|line| number(line, key)).sum()
    }

    fn most(&self, key: &str) -> Result<u64, Box<dyn Error>> {
        let all = self.named.values().map(|line| number(line, key));
        let all = all.collect::<Result<Vec<u64>, _>>()?;
        all.into_iter().max().ok_or_else(|| key.into())
    }
}

fn number(line: &str, key: &str) -> Result<u64, Box<dyn Error>> {
    let value = line
        .split_ascii_whitespace()
        .find_map(|word| word.strip_prefix(key)?.strip_prefix('='))
        .ok_or_else(|| format!("no {key} in '{line}'"))?;
    Ok(value.parse()?)
}

fn table(rows: &[Row], rustc: &str) -> String {
    let mut text = format!(
        "Built by {rustc}, `opt-level = \"s\"`:\n\n\
         | target, board | code, bytes | stack, bytes | a point | a component | with precisions \
         | an evaluation, α = 1 | α = ½ | bits that differ |\n\
         |---|--:|--:|--:|--:|--:|--:|--:|--:|\n"
    );
    for row in rows {
        let [one, half] = row.per_evaluation;
        writeln!(
            text,
            "| `{}`, {} | {} | {} | {:.0} | {:.0} | {:.0} | {one:.1} | {half:.1} | {} of {} points |",
            row.target,
            row.board,
            row.text_bytes,
            row.stack_bytes,
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

fn compare_or_write(readme: &Path, table: &str, write: bool) -> Result<(), Box<dyn Error>> {
    let text = fs::read_to_string(readme)?;
    let (before, rest) = text
        .split_once(START)
        .ok_or("README.md: no start of the table")?;
    let (written, after) = rest
        .split_once(END)
        .ok_or("README.md: no end of the table")?;
    if write {
        fs::write(readme, [before, START, table, END, after].concat())?;
        println!("{table}");
        return Ok(());
    }
    let same_compiler = written.lines().next() == table.lines().next();
    let agrees = if same_compiler {
        written == table
    } else {
        within_a_tenth(written, table)
    };
    if agrees {
        println!("{table}");
        return Ok(());
    }
    Err(format!(
        "README.md says\n{written}\nand measured was\n{table}\n\
         `tests/run firmware --write` renews the table"
    )
    .into())
}

/// Whether both tables have the same rows, with numbers that differ by a tenth at most.
fn within_a_tenth(written: &str, measured: &str) -> bool {
    let cells = |text: &str| -> Vec<String> {
        let rows = text.lines().filter(|line| line.starts_with("| `"));
        rows.flat_map(|line| line.split('|').map(|cell| cell.trim().to_owned()))
            .collect()
    };
    let (written, measured) = (cells(written), cells(measured));
    written.len() == measured.len()
        && written
            .iter()
            .zip(&measured)
            .all(|(a, b)| match (a.parse::<f64>(), b.parse::<f64>()) {
                (Ok(a), Ok(b)) => (a - b).abs() <= 0.1 * a,
                _ => a == b,
            })
}
