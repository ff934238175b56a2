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
    let target = behind_links(path)?;
    let mut file = beside(path, &target)?;
    file.write_all(bytes).map_err(io)?;
    file.as_file().sync_all().map_err(io)?;
    file.persist(&target).map_err(|error| io(error.error))?;
    Ok(())
}

/// Finds out whether [`write_whole`] could write `path`, before hours of work depend on it.
///
/// # Errors
/// [`WriteError`], as [`write_whole`].
pub fn check_writable(path: &Path) -> Result<(), WriteError> {
    beside(path, &behind_links(path)?).map(drop)
}

/// The file that `path` stands for: a rename onto a link would replace the link.
fn behind_links(path: &Path) -> Result<PathBuf, WriteError> {
    let io = |source| WriteError::Io {
        path: path.to_owned(),
        source,
    };
    // A name with a separator behind it is a folder's, whether there is one or not.
    let bytes = path.as_os_str().as_encoded_bytes();
    if bytes
        .last()
        .is_some_and(|last| std::path::is_separator(char::from(*last)))
    {
        return Err(io(std::io::ErrorKind::IsADirectory.into()));
    }
    match path.metadata() {
        Ok(metadata) if !metadata.is_file() => Err(WriteError::NotAFile {
            path: path.to_owned(),
        }),
        Ok(_) if path.is_symlink() => path.canonicalize().map_err(io),
        Ok(_) => Ok(path.to_owned()),
        // A link to nothing is left alone: where it leads is somebody's intention.
        Err(error) if error.kind() != std::io::ErrorKind::NotFound || path.is_symlink() => {
            Err(io(error))
        }
        Err(_) => Ok(path.to_owned()),
    }
}

/// An empty file in `target`'s folder; errors name `path`.
fn beside(path: &Path, target: &Path) -> Result<tempfile::NamedTempFile, WriteError> {
    let folder = match target.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    // Asked first, because tempfile hides what the system says of a missing folder.
    folder.metadata().map_err(|source| WriteError::Io {
        path: path.to_owned(),
        source,
    })?;
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

    #[cfg(unix)]
    #[test]
    fn a_link_is_followed_and_a_link_to_nothing_refused() {
        let folder = tempfile::tempdir().unwrap();
        let [target, link] = ["target", "link"].map(|name| folder.path().join(name));
        std::os::unix::fs::symlink("target", &link).unwrap();
        assert!(check_writable(&link).is_err());
        assert!(link.is_symlink() && !target.exists());
        std::fs::write(&target, b"old").unwrap();
        write_whole(&link, b"new").unwrap();
        assert!(link.is_symlink());
        assert_eq!(std::fs::read(&target).unwrap(), b"new");
    }

    #[test]
    fn a_name_that_no_file_can_have_is_found_beforehand() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["x".repeat(300), "new/".to_owned()] {
            assert!(check_writable(&folder.path().join(name)).is_err());
        }
    }
}
