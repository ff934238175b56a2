//! Folders that have a file for each object: `obj_000001.ply`, `obj_000001.cobra`.

use std::path::Path;

/// The objects that have a file with this extension, in rising order.
pub(super) fn objects_in(folder: &Path, extension: &str) -> std::io::Result<Vec<u32>> {
    let mut objects = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let name = entry?.file_name();
        let stem = name.to_str().and_then(|name| {
            let stem = name.strip_suffix(extension)?;
            stem.strip_suffix('.')
        });
        let Some(digits) = stem.and_then(|stem| stem.strip_prefix("obj_")) else {
            continue;
        };
        let object: Option<u32> = digits.parse().ok();
        objects.extend(object.filter(|object| format!("{object:06}") == digits));
    }
    objects.sort_unstable();
    Ok(objects)
}

/// Most objects that a line names.
const NAMED: usize = 40;

/// Objects for a line of text.
pub(super) fn listed(objects: &[u32]) -> String {
    let words: Vec<String> = objects.iter().take(NAMED).map(u32::to_string).collect();
    match objects.len().saturating_sub(NAMED) {
        0 if words.is_empty() => "none".to_owned(),
        0 => words.join(", "),
        more => format!("{} and {more} more", words.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn objects_are_those_of_files_named_as_bop_names_them() {
        let folder = tempfile::tempdir().unwrap();
        for name in [
            "obj_000010.ply",
            "obj_000002.ply",
            "obj_3.ply",
            "obj_000004.cobra",
            "part.ply",
            "obj_1000000.ply",
        ] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        let found = objects_in(folder.path(), "ply").unwrap();
        assert_eq!(found, [2, 10, 1_000_000]);
        assert_eq!(listed(&found), "2, 10, 1000000");
        assert_eq!(listed(&[]), "none");
        let many: Vec<u32> = (1..=50).collect();
        assert!(listed(&many).ends_with("39, 40 and 10 more"));
    }
}
