//! What the tests that cross crates share: the folder of real data.

use std::path::{Path, PathBuf};

/// The folder of real data, which is no part of the repository: `COBRA_SHARED`, or `../shared`
/// beside the workspace. `None`, with a line that says so, where it is not.
#[must_use]
pub fn shared_data() -> Option<PathBuf> {
    let folder = std::env::var_os("COBRA_SHARED").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared"),
        PathBuf::from,
    );
    let data = folder.join("data");
    if data.is_dir() {
        return Some(data);
    }
    println!("skipped: ../shared/data is not there; COBRA_SHARED names its parent");
    None
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
