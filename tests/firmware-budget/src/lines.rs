//! What the programs printed.

use std::collections::HashMap;
use std::error::Error;
use std::fs;
use std::path::Path;

/// The lines `KIND NAME KEY=VALUE…` of a program's output, by name.
pub(crate) struct Lines {
    /// What follows the name.
    pub(crate) named: HashMap<String, String>,
}

impl Lines {
    pub(crate) fn read(path: &Path, kind: &str) -> Result<Self, Box<dyn Error>> {
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

    pub(crate) fn sum(&self, key: &str) -> Result<u64, Box<dyn Error>> {
        self.named.values().map(|line| number(line, key)).sum()
    }

    pub(crate) fn most(&self, key: &str) -> Result<u64, Box<dyn Error>> {
        let all = self.named.values().map(|line| number(line, key));
        let all = all.collect::<Result<Vec<u64>, _>>()?;
        all.into_iter().max().ok_or_else(|| key.into())
    }
}

/// The value of a key, a whole number.
pub(crate) fn number(line: &str, key: &str) -> Result<u64, Box<dyn Error>> {
    let value = line
        .split_ascii_whitespace()
        .find_map(|word| word.strip_prefix(key)?.strip_prefix('='))
        .ok_or_else(|| format!("no {key} in '{line}'"))?;
    Ok(value.parse()?)
}
