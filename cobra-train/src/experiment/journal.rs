//! What is done of an experiment, kept so that a run that was interrupted goes on.
//!
//! Owns the journal's form: a line of JSON for the settings, and one for each unit that is done. A line
//! that was cut short is as if it were not there.

use super::error::ExperimentError;
use crate::output::write_whole;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::Instant;

/// What results depend on besides the unit.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Heading {
    pub(super) experiment: String,
    pub(super) version: String,
    /// [`PROTOCOL`](super::PROTOCOL).
    pub(super) protocol: u32,
    pub(super) seed: u64,
}

#[derive(Serialize, Deserialize)]
struct Line {
    unit: String,
    /// Which run it was done in, from 0.
    session: u32,
    /// Since that run began.
    seconds: f64,
    row: Value,
}

/// The journal of one experiment.
pub(super) struct Journal {
    path: PathBuf,
    file: Mutex<File>,
    done: BTreeMap<String, Value>,
    session: u32,
    earlier: f64,
    began: Instant,
}

impl Journal {
    /// Opens the journal at `path`; one of other settings, or of `fresh`, begins anew. A file that is no journal is
    /// left alone.
    pub(super) fn open(
        path: &Path,
        heading: &Heading,
        fresh: bool,
    ) -> Result<Self, ExperimentError> {
        let failed = |source| ExperimentError::Journal {
            path: path.to_owned(),
            source,
        };
        let text = match std::fs::read_to_string(path) {
            Ok(text) => text,
            Err(source) if source.kind() != std::io::ErrorKind::NotFound => {
                return Err(failed(source));
            }
            Err(_) => String::new(),
        };
        let mut lines = text.lines();
        let known = match lines.next() {
            Some(line) => Some(serde_json::from_str::<Heading>(line).map_err(|_| {
                ExperimentError::NoJournal {
                    path: path.to_owned(),
                }
            })?),
            None => None,
        };
        let mut kept: Vec<Line> = Vec::new();
        if !fresh && known.as_ref() == Some(heading) {
            kept.extend(lines.map_while(|line| serde_json::from_str(line).ok()));
        }
        // Written anew, so that nothing follows half a line.
        let mut whole = serde_json::to_string(heading).map_err(|e| failed(e.into()))? + "\n";
        for line in &kept {
            whole += &(serde_json::to_string(line).map_err(|e| failed(e.into()))? + "\n");
        }
        write_whole(path, whole.as_bytes())?;
        let file = File::options().append(true).open(path).map_err(failed)?;
        Ok(Self {
            path: path.to_owned(),
            file: Mutex::new(file),
            session: kept.iter().map(|line| line.session + 1).max().unwrap_or(0),
            earlier: sessions(&kept),
            done: kept.into_iter().map(|line| (line.unit, line.row)).collect(),
            began: Instant::now(),
        })
    }

    /// The row of a unit that is done.
    pub(super) fn row<R: DeserializeOwned>(&self, unit: &str) -> Option<R> {
        serde_json::from_value(self.done.get(unit)?.clone()).ok()
    }

    /// Keeps a unit that is done.
    pub(super) fn keep<R: Serialize>(&self, unit: &str, row: &R) -> Result<(), ExperimentError> {
        let failed = |source| ExperimentError::Row {
            unit: unit.to_owned(),
            source,
        };
        let line = Line {
            unit: unit.to_owned(),
            session: self.session,
            seconds: self.began.elapsed().as_secs_f64(),
            row: serde_json::to_value(row).map_err(failed)?,
        };
        let line = serde_json::to_string(&line).map_err(failed)? + "\n";
        let written = match self.file.lock() {
            // In one piece, so that a run that is killed leaves at most its last line short.
            Ok(mut file) => file.write_all(line.as_bytes()).and_then(|()| file.flush()),
            Err(_) => Err(std::io::Error::other("another thread failed while writing")),
        };
        written.map_err(|source| ExperimentError::Journal {
            path: self.path.clone(),
            source,
        })
    }

    /// The seconds that all sessions took, as far as the journal knows.
    pub(super) fn seconds(&self) -> f64 {
        self.earlier + self.began.elapsed().as_secs_f64()
    }
}

/// The latest time of each session, added.
fn sessions(lines: &[Line]) -> f64 {
    let mut latest = BTreeMap::<u32, f64>::new();
    for line in lines {
        let of = latest.entry(line.session).or_default();
        *of = of.max(line.seconds);
    }
    latest.values().sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn heading(seed: u64) -> Heading {
        Heading {
            experiment: "shape".to_owned(),
            version: "1".to_owned(),
            protocol: 1,
            seed,
        }
    }

    #[test]
    fn what_is_done_is_known_again_and_a_line_cut_short_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("shape.jsonl");
        let journal = Journal::open(&path, &heading(0), false).unwrap();
        journal.keep("a", &1.5).unwrap();
        journal.keep("b", &2.5).unwrap();
        drop(journal);
        let text = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, &text[..text.len() - 4]).unwrap();
        let journal = Journal::open(&path, &heading(0), false).unwrap();
        assert_eq!(journal.row("a"), Some(1.5));
        assert_eq!(journal.row::<f64>("b"), None);
        journal.keep("c", &3.5).unwrap();
        let journal = Journal::open(&path, &heading(0), false).unwrap();
        assert_eq!((journal.row("a"), journal.row("c")), (Some(1.5), Some(3.5)));
    }

    #[test]
    fn other_settings_and_a_fresh_start_begin_anew() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("shape.jsonl");
        for (heading_again, fresh) in [(heading(1), false), (heading(0), true)] {
            let journal = Journal::open(&path, &heading(0), true).unwrap();
            journal.keep("a", &1.5).unwrap();
            drop(journal);
            let journal = Journal::open(&path, &heading_again, fresh).unwrap();
            assert_eq!(journal.row::<f64>("a"), None);
        }
    }

    #[test]
    fn a_file_that_is_no_journal_is_left_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("shape.jsonl");
        std::fs::write(&path, "somebody's notes\n").unwrap();
        let refused = Journal::open(&path, &heading(0), true).err().unwrap();
        assert!(refused.to_string().contains("shape.jsonl"), "{refused}");
        assert_eq!(std::fs::read(&path).unwrap(), b"somebody's notes\n");
    }

    #[test]
    fn a_row_of_another_form_is_done_again() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("shape.jsonl");
        let journal = Journal::open(&path, &heading(0), false).unwrap();
        journal.keep("a", &"text").unwrap();
        drop(journal);
        let journal = Journal::open(&path, &heading(0), false).unwrap();
        assert_eq!(journal.row::<f64>("a"), None);
    }

    #[test]
    fn the_time_is_that_of_all_sessions() {
        let line = |(session, seconds)| Line {
            unit: String::new(),
            session,
            seconds,
            row: Value::Null,
        };
        // Two threads may swap their lines, and a later session may begin with a longer unit.
        let lines = [(0, 5.0), (0, 2.0), (1, 10.0), (1, 11.0)].map(line);
        assert_eq!(sessions(&lines), 16.0);
        assert_eq!(sessions(&[]), 0.0);
    }
}
