//! Output files that are either whole or not there.

use std::io::Write;
use std::path::{Path, PathBuf};

/// Why a file was not written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// The system refused.
    #[error("cannot write {}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// Something that is no file has that name.
    #[error("cannot write {}: it exists and is no regular file", path.display())]
    NotAFile {
        /// Its name.
        path: PathBuf,
    },
}

/// Writes `bytes` beside `path` and renames: whoever looks finds the old file, the new one, or
/// none, but never a part.
///
/// # Errors
/// [`WriteError`] names the file; nothing is left behind.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    let io = |source| WriteError::Io {
        path: path.to_owned(),
        source,
    };
    let mut file = beside(path)?;
    file.write_all(bytes).map_err(io)?;
    file.as_file().sync_all().map_err(io)?;
    file.persist(path).map_err(|error| io(error.error))?;
    Ok(())
}

/// Finds out whether [`write_whole`] could write `path`, before hours of work depend on it.
///
/// # Errors
/// [`WriteError`], as [`write_whole`].
pub fn check_writable(path: &Path) -> Result<(), WriteError> {
    beside(path).map(drop)
}

fn beside(path: &Path) -> Result<tempfile::NamedTempFile, WriteError> {
    if path.exists() && !path.is_file() {
        return Err(WriteError::NotAFile {
            path: path.to_owned(),
        });
    }
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".cobra-").suffix(".tmp");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // What an ordinary new file gets, less the umask; a temporary file is private otherwise.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder).map_err(|error| WriteError::Io {
        path: path.to_owned(),
        // tempfile wraps the system's error to add its own, internal name.
        source: error.raw_os_error().map_or_else(
            || std::io::Error::from(error.kind()),
            std::io::Error::from_raw_os_error,
        ),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_replaced_whole_and_nothing_stays_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.cobra");
        write_whole(&path, b"first").unwrap();
        write_whole(&path, b"second").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"second");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_missing_folder_and_a_folder_as_target_are_refused_by_name() {
        let folder = tempfile::tempdir().unwrap();
        let missing = folder.path().join("no/such/a.cobra");
        let error = write_whole(&missing, b"x").unwrap_err().to_string();
        assert!(
            error.contains("a.cobra") && error.contains("No such file"),
            "{error}"
        );
        assert!(matches!(
            write_whole(folder.path(), b"x"),
            Err(WriteError::NotAFile { .. })
        ));
    }
}
