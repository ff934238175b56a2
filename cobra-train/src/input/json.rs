//! Numbers in JSON documents, and how to say what is there instead.
//!
//! Owns no file format and opens no file: the readers of single formats add the file's name.

use serde_json::Value;

/// A place in a document that does not hold what it should.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Misfit {
    /// Where in the document.
    pub(crate) place: String,
    /// What should stand there.
    pub(crate) expected: &'static str,
    /// What does, cut short.
    pub(crate) found: String,
}

impl Misfit {
    pub(crate) fn new(place: impl Into<String>, expected: &'static str, found: &Value) -> Self {
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
pub(crate) fn numbers<const N: usize>(
    place: &str,
    entry: &Value,
    key: &str,
    expected: &'static str,
) -> Result<[f32; N], Misfit> {
    let numbers = exact_numbers(place, entry, key, expected)?;
    Ok(numbers.map(|number| number as f32))
}

/// The list of N numbers under `key` of `entry`, in `f64`.
pub(crate) fn exact_numbers<const N: usize>(
    place: &str,
    entry: &Value,
    key: &str,
    expected: &'static str,
) -> Result<[f64; N], Misfit> {
    let value = entry.get(key).unwrap_or(&Value::Null);
    let place = format!("{place}.{key}");
    let list = value
        .as_array()
        .filter(|list| list.len() == N)
        .ok_or_else(|| Misfit::new(&place, expected, value))?;
    let mut numbers = [0.0; N];
    for (index, (number, value)) in numbers.iter_mut().zip(list).enumerate() {
        *number = value
            .as_f64()
            .ok_or_else(|| Misfit::new(format!("{place}[{index}]"), "a number", value))?;
    }
    Ok(numbers)
}

/// The number, rounded to `f32` once; infinite beyond its range.
pub(crate) fn to_f32(value: &Value) -> Option<f32> {
    value.as_f64().map(|number| number as f32)
}
