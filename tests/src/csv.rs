//! The committed numbers of the experiments, `docs/paper/*.csv`.

use std::collections::BTreeMap;
use std::path::Path;

/// A row: its cells by the names of their columns.
pub type Row = BTreeMap<String, String>;

/// The rows of an experiment's committed numbers.
///
/// # Panics
/// Where the file is missing or no CSV.
#[must_use]
pub fn read(experiment: &str) -> Vec<Row> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/paper");
    let path = folder.join(format!("{experiment}.csv"));
    let mut reader = csv::Reader::from_path(&path).expect("the committed numbers");
    let rows = reader.deserialize();
    rows.map(|row| row.expect("a row of the header's length"))
        .collect()
}
