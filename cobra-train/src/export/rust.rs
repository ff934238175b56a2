//! A template as a Rust constant.

use super::{Identifier, facts, lines};
use cobra_infer::{Template, TemplateError};

/// Rust source with the template in `bytes` as a constant `NAME: &[u8; N]`, the name in capitals.
/// Aligned to four bytes: a template is read at any alignment, but what is linked before it should
/// not change how long that takes.
///
/// The constant is a reference to one static: it lies in flash once, whatever uses it and however
/// often. The source needs nothing of `std`, compiles in editions 2021 and 2024 by Rust 1.83 or
/// later, as a module and by `include!`, and several of them fit into one module.
///
/// # Errors
/// [`TemplateError`] where `bytes` are no template.
pub fn rust_source(bytes: &[u8], name: &Identifier) -> Result<String, TemplateError> {
    let template = Template::from_bytes(bytes)?;
    let name = name.capitals();
    let length = bytes.len();
    let facts: String = facts(&template, length, "`")
        .iter()
        .map(|fact| format!("/// - {fact}\n"))
        .collect();
    let lines: String = lines(bytes, "\\x", "")
        .map(|line| format!("        {line}\\\n"))
        .collect();
    // Not `//!`, which `include!` does not allow. A byte string, because the compiler takes it for
    // one word, where an array of numbers would be one expression for each byte.
    Ok(format!(
        "// Written by `cobra export`; changes here do not survive the next one.\n\
         \n\
         /// A template for `cobra_infer::Template::from_bytes`.\n\
         ///\n\
         {facts}\
         #[rustfmt::skip]\n\
         pub const {name}: &[u8; {length}] = {{\n    \
             #[repr(C, align(4))]\n    \
             struct Aligned([u8; {length}]);\n    \
             static BYTES: Aligned = Aligned(*b\"\\\n\
         {lines}    \
             \");\n    \
             &BYTES.0\n\
         }};\n"
    ))
}
