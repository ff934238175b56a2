//! Where the real data lies, if it is there.

use std::io::Write;
use std::path::PathBuf;

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
