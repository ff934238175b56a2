//! Tables between two lines of a page: compared with what was measured, or written anew.

use std::error::Error;
use std::fs;
use std::path::Path;

const END: &str = "<!-- end of what was measured -->\n";

/// How near a page must be to what was measured.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Near {
    /// To the digit where the page's compiler is this one, else within a tenth, because counts move with
    /// the compiler.
    SameUnlessCompiler,
    /// Within a tenth.
    Tenth,
}

/// Whether what follows `start` on the page is `table`, which its first line says the compiler of; where
/// `write` is set, it is made so.
pub(crate) fn compare_or_write(
    page: &Path,
    start: &str,
    table: &str,
    near: Near,
    write: bool,
) -> Result<(), Box<dyn Error>> {
    let name = page.file_name().unwrap_or_default().to_string_lossy();
    let text = fs::read_to_string(page)?;
    let (before, rest) = text
        .split_once(start)
        .ok_or_else(|| format!("{name}: no line {start}"))?;
    let (written, after) = rest
        .split_once(END)
        .ok_or_else(|| format!("{name}: no end of the table"))?;
    if write {
        fs::write(page, [before, start, table, END, after].concat())?;
        println!("{table}");
        return Ok(());
    }
    agree(&name, written, table, near, '|')?;
    println!("{table}");
    Ok(())
}

/// The same of a file that is nothing but a table: lines of values with commas between them, below the compiler
/// in a comment and the names of the columns.
pub(crate) fn compare_or_write_csv(
    path: &Path,
    table: &str,
    write: bool,
) -> Result<(), Box<dyn Error>> {
    if write {
        return Ok(fs::write(path, table)?);
    }
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let written = fs::read_to_string(path)?;
    agree(&name, &written, table, Near::SameUnlessCompiler, ',')
}

fn agree(
    name: &str,
    written: &str,
    table: &str,
    near: Near,
    between: char,
) -> Result<(), Box<dyn Error>> {
    let same_compiler = written.lines().next() == table.lines().next();
    let agrees = if near == Near::SameUnlessCompiler && same_compiler {
        written == table
    } else {
        within_a_tenth(written, table, between)
    };
    if agrees {
        return Ok(());
    }
    Err(format!(
        "{name} says\n{written}\nand measured was\n{table}\n\
         `tests/run --write firmware` renews the table"
    )
    .into())
}

/// Whether both tables have the same rows, with numbers that differ by a tenth at most.
fn within_a_tenth(written: &str, measured: &str, between: char) -> bool {
    let cells = |text: &str| -> Vec<String> {
        // Behind the two lines of the head: of names and of dashes, or of the compiler and of names.
        let rows = text
            .lines()
            .filter(|line| line.contains(between))
            .skip(match between {
                '|' => 2,
                _ => 1,
            });
        rows.flat_map(|line| line.split(between).map(|cell| cell.trim().to_owned()))
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

#[cfg(test)]
mod tests {
    use super::{Near, agree};

    fn csv(compiler: &str, code: u32) -> String {
        format!("# {compiler}\ntarget,code\nthumbv6m,{code}\n")
    }

    #[test]
    fn a_csv_is_exact_of_its_own_compiler_and_near_of_another() {
        let written = csv("rustc 1.95.0", 1000);
        let agrees = |compiler, code| {
            let measured = csv(compiler, code);
            agree(
                "boards.csv",
                &written,
                &measured,
                Near::SameUnlessCompiler,
                ',',
            )
            .is_ok()
        };
        assert!(agrees("rustc 1.95.0", 1000));
        assert!(!agrees("rustc 1.95.0", 1001));
        assert!(agrees("rustc 1.96.0", 1090));
        assert!(!agrees("rustc 1.96.0", 1110));
        let more = written.clone() + "thumbv7m,900\n";
        assert!(
            agree(
                "boards.csv",
                &more,
                &csv("rustc 1.96.0", 1000),
                Near::Tenth,
                ','
            )
            .is_err()
        );
    }
}
