//! Where the real data lies, if it is there.

use std::io::Write;
use std::path::{Path, PathBuf};

/// The folder of real meshes and estimates: `COBRA_SHARED`, else `shared` beside the workspace.
///
/// Says `skipped: …` on standard error and returns `None` where it is missing, so that a test can pass and say what
/// it did not test.
#[must_use]
pub fn real_data(test: &str) -> Option<PathBuf> {
    let shared = std::env::var_os("COBRA_SHARED").map_or_else(
        || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared"),
        PathBuf::from,
    );
    let folder = shared.join("data");
    if folder.is_dir() {
        Some(folder)
    } else {
        // Straight to standard error: what `println!` writes, the test runner keeps to itself.
        let line = format!("skipped: {test}: {} is not there", folder.display());
        let _ = writeln!(std::io::stderr(), "{line}");
        None
    }
}

/// All files below `folder` with one of the extensions, in order.
#[must_use]
pub fn files_below(folder: &Path, extensions: &[&str]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            found.extend(files_below(&path, extensions));
        } else if path
            .extension()
            .is_some_and(|e| extensions.iter().any(|wanted| e == *wanted))
        {
            found.push(path);
        }
    }
    found.sort();
    found
}
