//! Where the real data lies, if it is there.

use std::path::PathBuf;

/// The folder of real meshes and estimates: `COBRA_SHARED`, else `shared` beside the workspace.
///
/// Prints `skipped: …` and returns `None` where it is missing, so that a test can pass and say what
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
        println!("skipped: {test}: {} is not there", folder.display());
        None
    }
}
