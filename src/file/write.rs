//! Writing: how the bytes of a tree reach memory or a disk.

use super::assemble::assemble;
use crate::error::Error;
use crate::octree::Octree;
use alloc::vec::Vec;
#[cfg(feature = "std")]
use std::{
    fs::{File, OpenOptions},
    io::{ErrorKind, Write},
    path::{Path, PathBuf},
};

/// The file of `octree`, in memory.
///
/// The bytes depend on the tree and its metadata alone: not on how its bricks are coded in memory, nor on
/// whether it was built, read or mapped. The tree is [checked](crate::OctreeRef::check) first, so that every
/// file that is written can be read. O(n); besides the result, memory for the dictionary is needed.
///
/// # Errors
/// [`Error::Damaged`] if the tree, or a channel of it, is a mapped one that nobody has verified, and is
/// damaged; [`Error::Argument`] if the metadata take more than 1 MiB, or those of a channel more than 64 KiB;
/// [`Error::OutOfMemory`].
pub fn to_bytes(octree: &Octree) -> Result<Vec<u8>, Error> {
    let mut file = Vec::new();
    assemble(octree, &mut |length, write| {
        let length = usize::try_from(length).map_err(|_| Error::OutOfMemory)?;
        file.try_reserve_exact(length)?;
        write(&mut |bytes| {
            file.extend_from_slice(bytes);
            Ok(())
        })
    })?;
    Ok(file)
}

/// Writes the file of `octree` to `out`, the same bytes as [`to_bytes`], in a few large pieces: no buffer is
/// needed around `out`, and the file is never in memory as a whole. `out` is flushed at the end.
///
/// # Errors
/// As [`to_bytes`], before anything is written; [`Error::Io`] as `out` returns it.
#[cfg(feature = "std")]
pub fn write_to(octree: &Octree, mut out: impl Write) -> Result<(), Error> {
    assemble(octree, &mut |_, write| write(&mut |bytes| Ok(out.write_all(bytes)?)))?;
    Ok(out.flush()?)
}

/// Saves `octree` in the file at `path`: at any moment, also after a crash or a power failure, there is the
/// old file or the new one, each complete.
///
/// The bytes, those of [`to_bytes`], go to a temporary file in the same directory, which is synchronised with
/// the disk and then renamed over the old file; at last the directory is synchronised (on Unix). Whoever has
/// the old file open or mapped keeps it.
///
/// * A file that is replaced keeps its permissions, a new one gets those that the process gives to new files
///   (its umask). A file that may not be written to is not replaced. The file belongs to the user who saves;
///   its other hard links, if any, keep the old contents.
/// * A symbolic link is followed, also to a file that does not exist yet: what it points to is replaced, the
///   link stays.
/// * What is not a regular file, such as a pipe or a terminal, is written to directly, and so is an open file
///   of the process that is named like `/dev/stdout`: the bytes go to its end.
///
/// A process that is killed meanwhile may leave a file `.leafless-….tmp` behind.
///
/// # Errors
/// As [`to_bytes`], and [`Error::File`] with the path and the cause [`Error::Io`]. The old file is then as it
/// was, and no temporary file is left; only if it is the very last step that fails, synchronising the
/// directory, the new file is already in place.
#[cfg(feature = "std")]
pub fn save(octree: &Octree, path: impl AsRef<Path>) -> Result<(), Error> {
    save_with(path.as_ref(), |file| write_to(octree, file))
}

/// As [`save`] for a file of any kind, whose bytes `write` writes.
#[cfg(feature = "std")]
pub(crate) fn save_with(
    path: &Path,
    write: impl FnOnce(&mut File) -> Result<(), Error>,
) -> Result<(), Error> {
    save_path(path, write).map_err(|error| match error {
        Error::Io(_) => error.of_file(path),
        // It is what is to be written that is damaged.
        error => error,
    })
}

#[cfg(feature = "std")]
fn save_path(path: &Path, write: impl FnOnce(&mut File) -> Result<(), Error>) -> Result<(), Error> {
    let existing = match std::fs::metadata(path) {
        Ok(metadata) => Some(metadata),
        Err(error) if error.kind() == ErrorKind::NotFound => None,
        Err(error) => return Err(error.into()),
    };
    let target = follow_links(path)?.filter(|_| existing.as_ref().is_none_or(|file| file.is_file()));
    let Some(target) = target else {
        return write(&mut OpenOptions::new().append(true).open(path)?);
    };
    let directory = target.parent().filter(|parent| !parent.as_os_str().is_empty());
    let directory = directory.unwrap_or(Path::new("."));
    if existing.is_some() {
        // Renaming would not ask whether the old file may be written to.
        OpenOptions::new().write(true).open(&target)?;
    }
    // A directory that may be written to but not read cannot be synchronised.
    #[cfg(unix)]
    let handle = File::open(directory).ok();

    let mut builder = tempfile::Builder::new();
    builder.prefix(".leafless-").suffix(".tmp");
    #[cfg(unix)]
    if existing.is_none() {
        use std::os::unix::fs::PermissionsExt;
        // The umask is taken off by the system. Where a file is replaced nobody else may look at the new
        // one before it has the old one's permissions.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut temporary = builder.tempfile_in(directory).map_err(without_name)?;
    write(temporary.as_file_mut())?;
    if let Some(existing) = existing {
        temporary.as_file().set_permissions(existing.permissions())?;
    }
    temporary.as_file().sync_all()?;
    temporary.persist(&target).map_err(|refused| refused.error)?;
    #[cfg(unix)]
    if let Some(handle) = handle {
        synchronise(&handle)?;
    }
    Ok(())
}

/// An error of `tempfile` without the temporary file's name, which means nothing to whoever saves. The system's
/// number is kept in its text only.
#[cfg(feature = "std")]
fn without_name(error: std::io::Error) -> std::io::Error {
    let text = alloc::string::ToString::to_string(&error);
    let number = text.split_once("(os error ").and_then(|(_, rest)| rest.split_once(')'));
    let code = number.and_then(|(code, _)| code.parse().ok());
    code.map_or(error.kind().into(), std::io::Error::from_raw_os_error)
}

/// Synchronises a directory, where its file system can.
#[cfg(all(feature = "std", unix))]
fn synchronise(directory: &File) -> Result<(), Error> {
    match directory.sync_all() {
        Err(error) if !matches!(error.kind(), ErrorKind::InvalidInput | ErrorKind::Unsupported) => {
            Err(error.into())
        }
        _ => Ok(()),
    }
}

/// The path that `path` names once all symbolic links at its end are followed; the last need not exist.
/// `None` if one of them stands for an open file of a process.
#[cfg(feature = "std")]
fn follow_links(path: &Path) -> Result<Option<PathBuf>, Error> {
    let mut target = path.to_path_buf();
    // As many as Linux follows.
    for _ in 0..40 {
        match std::fs::symlink_metadata(&target) {
            Ok(metadata) if metadata.file_type().is_symlink() => {
                let directory = target.parent().unwrap_or(Path::new(""));
                // `/proc/self/fd/1`, which `/dev/stdout` leads to, reads as a link, but is none: what it
                // names may be a pipe, removed, or open for appending.
                if directory.canonicalize().is_ok_and(|directory| directory.starts_with("/proc")) {
                    return Ok(None);
                }
                target = directory.join(std::fs::read_link(&target)?);
            }
            Ok(_) => return Ok(Some(target)),
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Some(target)),
            Err(error) => return Err(error.into()),
        }
    }
    // The system says what is wrong with such a chain.
    std::fs::metadata(&target)?;
    Ok(Some(target))
}
