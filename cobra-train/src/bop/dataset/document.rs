//! JSON files that hold an entry for each image or each object.
//!
//! Owns finding the entry. It is taken apart when it is asked for, so that what is wrong with one is
//! an error of that one alone.

use super::DatasetError;
use crate::input::json::Misfit;
use crate::input::{read_text, same_image};
use serde_json::{Map, Value};
use std::path::{Path, PathBuf};

#[derive(Clone, Debug)]
pub(super) struct Document {
    path: PathBuf,
    entries: Map<String, Value>,
}

/// What stands under an id.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry<'a> {
    /// The file.
    pub(super) path: &'a Path,
    /// The id, as the file writes it.
    pub(super) key: &'a str,
    pub(super) value: &'a Value,
}

impl Document {
    pub(super) fn read(path: PathBuf) -> Result<Self, DatasetError> {
        let text = read_text(&path).map_err(|source| DatasetError::io(&path, source))?;
        match serde_json::from_str(&text) {
            Ok(Value::Object(entries)) => Ok(Self { path, entries }),
            Ok(other) => {
                let misfit = Misfit::new("the document", "an object with ids as keys", &other);
                Err(DatasetError::form(&path, misfit))
            }
            Err(source) => Err(DatasetError::Json { path, source }),
        }
    }

    /// As [`Document::read`], and `None` where there is no such file.
    pub(super) fn read_if_there(path: PathBuf) -> Result<Option<Self>, DatasetError> {
        match Self::read(path) {
            Err(DatasetError::Io { source, .. })
                if source.kind() == std::io::ErrorKind::NotFound =>
            {
                Ok(None)
            }
            read => read.map(Some),
        }
    }

    /// The entry under an id; zeros before it do not count. `kind` says what the id is of.
    pub(super) fn entry(&self, kind: &'static str, id: u32) -> Result<Entry<'_>, DatasetError> {
        let key = id.to_string();
        let found = self.entries.get_key_value(&key).or_else(|| {
            let mut entries = self.entries.iter();
            entries.find(|(other, _)| same_image(other, &key))
        });
        let (key, value) = found.ok_or_else(|| DatasetError::NoEntry {
            path: self.path.clone(),
            kind,
            id,
        })?;
        Ok(Entry {
            path: &self.path,
            key,
            value,
        })
    }

    /// The ids that are whole numbers, in rising order.
    pub(super) fn ids(&self) -> Vec<u32> {
        let mut ids: Vec<u32> = self
            .entries
            .keys()
            .filter_map(|key| key.parse().ok())
            .collect();
        ids.sort_unstable();
        ids.dedup();
        ids
    }
}
