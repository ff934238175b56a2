//! What an experiment found, and the files that it becomes.

use super::Experiment;
use super::error::ExperimentError;
use super::table::Table;
use crate::output::write_whole;
use std::path::{Path, PathBuf};

/// What an experiment found.
#[derive(Clone, Debug)]
pub struct Findings {
    /// Which one.
    pub experiment: Experiment,
    /// What it is called in a document.
    pub title: &'static str,
    /// What was done, in a paragraph.
    pub protocol: String,
    /// What that leaves to another experiment's paragraph; empty where it leaves nothing.
    pub elsewhere: String,
    /// Every number, for programs.
    pub numbers: Table,
    /// What there is to read, beside what the paper prints.
    pub tables: Vec<Table>,
    /// What follows from it, a sentence or two each.
    pub remarks: Vec<String>,
    /// The figure, as SVG.
    pub figure: String,
    /// The seconds that it took.
    pub seconds: f64,
}

impl Findings {
    /// Its section of a document, which shows the figure that lies beside it.
    #[must_use]
    pub fn markdown(&self) -> String {
        let name = self.experiment.name();
        let mut text = format!("## {}\n\n{}\n", self.title, self.protocol);
        for table in &self.tables {
            if !table.caption.is_empty() {
                text += &format!("\n{}\n", table.caption);
            }
            text += &format!("\n{}", table.markdown());
        }
        if !self.remarks.is_empty() {
            text += "\n";
        }
        for remark in &self.remarks {
            text += &format!("- {remark}\n");
        }
        text += &format!("\n![{}]({name}.svg)\n", self.title);
        text += &format!(
            "\n`cobra experiment {name}`, {:.0} s; every number: [{name}.csv]({name}.csv).\n",
            self.seconds
        );
        text
    }

    /// The same for whoever has nothing else of that run, whose seed and data are named.
    fn alone(&self, seed: u64, data: &str) -> String {
        let mut text = self.markdown();
        if !self.elsewhere.is_empty() {
            text += &format!("\n{}\n", self.elsewhere);
        }
        text += &format!(
            "\nVersion {}, seed {seed}; objects in the data: {data}.\n",
            env!("CARGO_PKG_VERSION")
        );
        text
    }

    /// Writes `NAME.csv`, `NAME.svg` and `NAME.md` into a folder, and tells their names. Seed and data are the
    /// run's, the latter in words ([`super::Data::words`]).
    ///
    /// # Errors
    /// [`ExperimentError::Write`].
    pub fn write(
        &self,
        folder: &Path,
        seed: u64,
        data: &str,
    ) -> Result<Vec<PathBuf>, ExperimentError> {
        let files = [
            ("csv", self.numbers.csv()),
            ("svg", self.figure.clone()),
            ("md", self.alone(seed, data)),
        ];
        files
            .into_iter()
            .map(|(extension, text)| {
                let path = folder.join(format!("{}.{extension}", self.experiment.name()));
                write_whole(&path, text.as_bytes())?;
                Ok(path)
            })
            .collect()
    }
}
