//! The header of the C interface as cbindgen makes it of the source: for the test that compares it
//! with the file and for the example that writes the file.

use std::error::Error;
use std::path::{Path, PathBuf};

fn interface() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../cobra-infer-ffi")
}

/// Where the header lies.
pub(crate) fn path() -> PathBuf {
    interface().join("include/cobra_infer.h")
}

/// Its text.
pub(crate) fn header() -> Result<String, Box<dyn Error>> {
    let config = cbindgen::Config::from_file(interface().join("cbindgen.toml"))?;
    // By file, because asking for the crate would run cargo. The order is the header's.
    let mut builder = cbindgen::Builder::new().with_config(config);
    for module in [
        "status",
        "layout",
        "types",
        "depth_types",
        "template",
        "camera",
        "scorer",
        "depth",
        "strings",
    ] {
        builder = builder.with_src(interface().join(format!("src/{module}.rs")));
    }
    let mut text = Vec::new();
    builder.generate()?.write(&mut text);
    Ok(String::from_utf8(text)?)
}
