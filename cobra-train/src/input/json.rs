//! Numbers in JSON documents, and how to say what is there instead.
//!
//! Owns no file format and opens no file: the readers of single formats add the file's name.

use serde_json::Value;

/// A place in a document that does not hold what it should.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Misfit {
    /// Where in the document.
    pub(super) place: String,
    /// What should stand there.
    pub(super) expected: &'static str,
    /// What does, cut short.
    pub(super) found: String,
}

impl Misfit {
    pub(super) fn new(place: impl Into<String>, expected: &'static str, found: &Value) -> Self {
        Self {
            place: place.into(),
            expected,
            found: match found {
                Value::Null => "nothing".to_owned(),
                Value::Array(list) => format!("a list of {}", list.len()),
                Value::Object(map) => format!("an object with {} keys", map.len()),
                other => other.to_string().chars().take(60).collect(),
            },
        }
    }
}

/// The list of N numbers under `key` of `entry`, each rounded to `f32` once.
pub(super) fn numbers<const N: usize>(
    place: &str,
    entry: &Value,
    key: &str,
    expected: &'static str,
) -> Result<[f32; N], Misfit> {
    let value = entry.get(key).unwrap_or(&Value::Null);
    let place = format!("{place}.{key}");
    let list = value
        .as_array()
        .filter(|list| list.len() == N)
        .ok_or_else(|| Misfit::new(&place, expected, value))?;
    let mut numbers = [0.0; N];
    for (index, (number, value)) in numbers.iter_mut().zip(list).enumerate() {
        *number = to_f32(value)
            .ok_or_else(|| Misfit::new(format!("{place}[{index}]"), "a number", value))?;
    }
    Ok(numbers)
}

/// The number, rounded to `f32` once; infinite beyond its range.
pub(super) fn to_f32(value: &Value) -> Option<f32> {
    value.as_f64().map(|number| number as f32)
}
