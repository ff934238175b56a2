//! Templates as source text, for firmware that links them into flash.
//!
//! Owns how the bytes and what is said of them become Rust or C. The text depends on the template
//! and the name alone; no line has more than 100 characters.

mod c;
mod identifier;
mod rust;

pub use c::c_header;
pub use identifier::{Identifier, IdentifierError, MOST_CHARACTERS};
pub use rust::rust_source;

use cobra_infer::{Assignment, Template};
use std::fmt::Write;

/// The features of `cobra-infer` that a controller needs to read a template: those of its kernel and
/// metric, which maps do without.
#[must_use]
pub fn features(template: &Template<'_>) -> Vec<&'static str> {
    if template.has_maps() {
        return Vec::new();
    }
    std::iter::once(template.kernel().feature())
        .chain(template.metric().feature())
        .collect()
}

/// What a template's components are made of.
#[must_use]
pub fn elements(template: &Template<'_>) -> &'static str {
    if template.has_maps() {
        "nodes"
    } else {
        "terms"
    }
}

/// What [`Template::cost`] counts.
#[must_use]
pub fn counted(template: &Template<'_>) -> &'static str {
    if template.has_maps() {
        "nodes read"
    } else {
        "kernel evaluations"
    }
}

/// What whoever opens the file wants to know, a fact a line; `quote` stands around names.
fn facts(template: &Template<'_>, bytes: usize, quote: &str) -> Vec<String> {
    let cost = template.cost();
    let counted = counted(template);
    let features: Vec<String> = features(template)
        .iter()
        .map(|feature| format!("{quote}{feature}{quote}"))
        .collect();
    vec![
        format!("object: {quote}{}{quote}", plain(template.name())),
        format!("unit of length: {}", template.unit().symbol()),
        format!("bytes: {bytes}"),
        format!("components: {}", template.component_count()),
        format!(
            "kernel: {}, {} metric",
            template.kernel().name(),
            template.metric().name()
        ),
        format!(
            "{counted} a point: at most {} (nearest), {} (maximum, soft)",
            cost.of(Assignment::Nearest),
            cost.of(Assignment::Maximum)
        ),
        format!(
            "features of cobra-infer: {}",
            if features.is_empty() {
                "none".to_owned()
            } else {
                features.join(" and ")
            }
        ),
    ]
}

/// A name that ends no comment, continues no line, opens no markup and reverses no text.
fn plain(name: &str) -> String {
    name.chars()
        .map(|c| match c {
            ' ' | '-' | '_' | '.' | ',' | '+' | '(' | ')' => c,
            _ if c.is_alphanumeric() => c,
            _ => '_',
        })
        .collect()
}

/// Bytes in a line of source: as many as in a line of a hexadecimal dump.
const IN_A_LINE: usize = 16;

/// Lines of [`IN_A_LINE`] bytes, each byte in hexadecimal between `before` and `after`.
fn lines<'a>(bytes: &'a [u8], before: &'a str, after: &'a str) -> impl Iterator<Item = String> {
    bytes.chunks(IN_A_LINE).map(move |line| {
        line.iter().fold(String::new(), |mut text, byte| {
            // Writing to a string cannot fail.
            let _ = write!(text, "{before}{byte:02x}{after}");
            text
        })
    })
}
