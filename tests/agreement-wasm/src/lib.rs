//! The comparison as a WebAssembly module, which `run.mjs` loads and asks.
//!
//! The module imports nothing: a host calls [`agrees`] and reads what there is to print from the
//! module's memory.

#![allow(
    unsafe_code,
    reason = "unmangled names: no other crate is linked that has any"
)]

use cobra_agreement::{SETS, report};
use std::sync::OnceLock;

static COMPARED: OnceLock<(String, bool)> = OnceLock::new();

fn compared() -> &'static (String, bool) {
    COMPARED.get_or_init(|| {
        let mut text = String::new();
        let agrees = report::write(&mut text, &SETS, || {});
        (text, agrees == Ok(true))
    })
}

/// Whether no bit differs.
#[unsafe(no_mangle)]
pub extern "C" fn agrees() -> bool {
    compared().1
}

/// Where the report lies, in UTF-8.
#[unsafe(no_mangle)]
pub extern "C" fn report_start() -> *const u8 {
    compared().0.as_ptr()
}

/// How many bytes the report has.
#[unsafe(no_mangle)]
pub extern "C" fn report_length() -> usize {
    compared().0.len()
}
