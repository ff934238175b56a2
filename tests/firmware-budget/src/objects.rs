//! Templates of a real object on the M4F: what a point takes, and what they must not exceed.

use crate::lines::{Lines, number};
use crate::tenth;
use serde_json::{Value, json};
use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// What a template may take, and how well it must reproduce its object.
struct Limits {
    name: &'static str,
    bytes: u64,
    /// Instructions a point without measurement noise.
    per_point: f64,
    f_score: f64,
}

/// By the names that `tests/parts/objects.sh` gives them.
const LIMITS: [Limits; 4] = [
    limits("terms", 14_336, 7_000.0, 98.0),
    limits("few-terms", 8_704, f64::INFINITY, 96.0),
    limits("maps", 24_576, 1_500.0, 98.0),
    limits("few-maps", 12_288, 1_500.0, 98.0),
];

const fn limits(name: &'static str, bytes: u64, per_point: f64, f_score: f64) -> Limits {
    Limits {
        name,
        bytes,
        per_point,
        f_score,
    }
}

/// What one template came to.
pub(crate) struct Measured {
    name: String,
    arguments: String,
    bytes: u64,
    components: u64,
    f_score: f64,
    points: u64,
    mismatched_bits: u64,
    /// Instructions a point without noise and with 1 mm.
    per_point: [f64; 2],
}

pub(crate) fn measured(folder: &Path) -> Result<Vec<Measured>, Box<dyn Error>> {
    each(folder, one)
}

/// What `one` makes of each line `NAME ARGUMENT…` of the file `objects`; nothing where there is none.
pub(crate) fn each<T>(
    folder: &Path,
    one: impl Fn(&Path, &str) -> Result<T, Box<dyn Error>>,
) -> Result<Vec<T>, Box<dyn Error>> {
    let list = folder.join("objects");
    if !list.exists() {
        return Ok(Vec::new());
    }
    fs::read_to_string(list)?
        .lines()
        .map(|line| one(folder, line).map_err(|error| format!("{line}: {error}").into()))
        .collect()
}

fn one(folder: &Path, line: &str) -> Result<Measured, Box<dyn Error>> {
    let (name, arguments) = line.split_once(' ').unwrap_or((line, ""));
    let file = |ending: &str| folder.join(format!("{name}.{ending}"));
    let printed = Lines::read(&file("object"), "object")?;
    let noise = |noise: &str| {
        let line = printed.named.get(noise);
        line.ok_or_else(|| format!("nothing of {noise}"))
    };
    let (without, with) = (noise("noise=0")?, noise("noise=1")?);
    let per_point = |line: &str| -> Result<f64, Box<dyn Error>> {
        Ok(number(line, "instructions")? as f64 / number(line, "points")? as f64)
    };
    let evaluated: Value = serde_json::from_str(&fs::read_to_string(file("json"))?)?;
    Ok(Measured {
        name: name.into(),
        arguments: arguments.trim().into(),
        bytes: number(without, "bytes")?,
        components: number(without, "components")?,
        f_score: evaluated["f_score"].as_f64().ok_or("no F-score")?,
        points: number(without, "points")?,
        mismatched_bits: number(with, "mismatched_bits")?,
        per_point: [per_point(without)?, per_point(with)?],
    })
}

impl Measured {
    /// As it stands in `target/firmware.json`.
    pub(crate) fn document(&self) -> Value {
        let [without, with] = self.per_point;
        json!({
            "template": self.name,
            "arguments": self.arguments,
            "bytes": self.bytes,
            "components": self.components,
            "f_score": self.f_score,
            "points": self.points,
            "mismatched_bits": self.mismatched_bits,
            "instructions_per_point": tenth(without),
            "instructions_per_point_noise_1_mm": tenth(with),
        })
    }

    /// # Errors
    /// The limit that it is beyond.
    pub(crate) fn check(&self) -> Result<(), Box<dyn Error>> {
        let limits = LIMITS
            .iter()
            .find(|limits| limits.name == self.name)
            .ok_or_else(|| format!("{}: no limits", self.name))?;
        let [per_point, _] = self.per_point;
        let broken = [
            ("bits differ", self.mismatched_bits as f64, 0.0),
            ("bytes", self.bytes as f64, limits.bytes as f64),
            ("instructions a point", per_point, limits.per_point),
            (
                "% missing of F",
                100.0 - self.f_score,
                100.0 - limits.f_score,
            ),
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

/// Under the version that built the program.
pub(crate) fn table(all: &[Measured], rustc: &str) -> String {
    let mut text = format!(
        "Built by {rustc}, `opt-level = \"s\"`:\n\n\
         | `cobra train model.ply` with | bytes | components | F % | instructions a point, σ_m = 0 \
         | σ_m = 1 mm | bits that differ |\n\
         |---|--:|--:|--:|--:|--:|--:|\n"
    );
    for object in all {
        let arguments = match object.arguments.as_str() {
            "" => "its defaults".to_owned(),
            arguments => format!("`{arguments}`"),
        };
        let [without, with] = object.per_point;
        writeln!(
            text,
            "| {arguments} | {} | {} | {:.2} | {without:.0} | {with:.0} | {} of {} points |",
            object.bytes, object.components, object.f_score, object.mismatched_bits, object.points,
        )
        .expect("a string takes all");
    }
    text
}
