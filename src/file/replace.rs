//! Atomic replacement of a file: at any moment either the old file or the new file is there.

use crate::error::Error;
#[cfg(target_os = "linux")]
use alloc::format;
use alloc::string::ToString;
use alloc::vec::Vec;
use std::fs::{File, OpenOptions, Permissions};
#[cfg(target_os = "linux")]
use std::io::Seek;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use tempfile::{Builder, NamedTempFile};

/// Replaces the file at `path` by the output of `write`, with the same guarantees as [`save`](super::save)
/// for octrees. Meant for files of other kinds.
///
/// `write` gets a file, positioned at its beginning, or at the end of its contents if `path` is no regular
/// file. The old file stays as it is until `write` has returned without an error.
///
/// ```
/// # let folder = tempfile::tempdir().unwrap();
/// # let path = folder.path().join("report.txt");
/// use std::io::Write;
/// leafless::file::replace(&path, |file| Ok(file.write_all(b"All is well.\n")?))?;
/// # assert_eq!(std::fs::read(&path).unwrap(), b"All is well.\n");
/// # Ok::<(), leafless::Error>(())
/// ```
///
/// # Errors
/// The errors of `write`, and [`Error::File`] with the path and the cause [`Error::Io`]. On an error the old
/// file is unchanged, and no temporary file remains. The only exception is a failure of the very last step,
/// synchronising the directory: the new file is then in place already.
pub fn replace(
    path: impl AsRef<Path>,
    write: impl FnOnce(&mut File) -> Result<(), Error>,
) -> Result<(), Error> {
    let path = path.as_ref();
    replace_path(path, write).map_err(|error| match error {
        Error::Io(_) => error.of_file(path),
        // The contents are damaged, not the file.
        error => error,
    })
}

/// Removes the temporary files of all running saves of this process. Call it right before the process ends:
/// **from then on, every save in this process blocks for ever** where it would create, rename or remove a
/// temporary file.
///
/// This function is for programs that end when a signal arrives. Such a program waits for the signal in a
/// thread of its own and calls this function there: the function takes a lock, which a signal handler must
/// not do. The old files stay as they are.
///
/// On Linux a save has no named temporary file for most of the time, so that a process which just ends leaves
/// nothing behind. Other systems, and file systems without unnamed files such as NFS, need this function.
pub fn abandon_saves() {
    let names = names();
    remove_all(&names);
    // The lock is never released.
    std::mem::forget(names);
}

/// The names of temporary files that exist now. The lock is held while a temporary file is created, renamed
/// or removed.
static NAMES: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn names() -> MutexGuard<'static, Vec<PathBuf>> {
    // The list is consistent whenever a panic may happen.
    NAMES.lock().unwrap_or_else(PoisonError::into_inner)
}

fn remove_all(names: &[PathBuf]) {
    for name in names {
        // The process is about to end: nothing can be done about a failure.
        let _ = std::fs::remove_file(name);
    }
}

fn replace_path(path: &Path, write: impl FnOnce(&mut File) -> Result<(), Error>) -> Result<(), Error> {
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
        // Renaming would not check the write permission of the old file.
        OpenOptions::new().write(true).open(&target)?;
    }
    // A directory with write but without read permission cannot be synchronised.
    #[cfg(unix)]
    let handle = File::open(directory).ok();
    let permissions = existing.map(|existing| existing.permissions());
    let mut temporary = Temporary::new(directory, permissions.is_none())?;
    write(temporary.file())?;
    temporary.finish(permissions.as_ref())?;
    temporary.put(&target, directory, permissions.as_ref())?;
    #[cfg(unix)]
    if let Some(handle) = handle {
        synchronise(&handle)?;
    }
    Ok(())
}

/// A file that is not in its place yet. If it is dropped, it is removed.
enum Temporary {
    /// A file without a name, which vanishes with the process, however the process ends.
    #[cfg(target_os = "linux")]
    Unnamed(File),
    Named(Named),
}

impl Temporary {
    /// Creates a temporary file in a directory, without a name if the file system supports that. If the file
    /// `is_new` and replaces none, it gets the permissions that the process gives to new files.
    fn new(directory: &Path, is_new: bool) -> io::Result<Temporary> {
        #[cfg(target_os = "linux")]
        {
            use rustix::fs::{Mode, OFlags, open};
            let flags = OFlags::TMPFILE | OFlags::RDWR | OFlags::CLOEXEC;
            // The system subtracts the umask.
            let mode = Mode::from_raw_mode(if is_new { 0o666 } else { 0o600 });
            // If this fails for another reason than missing support, the second attempt fails too and reports
            // the reason.
            if let Ok(file) = open(directory, flags, mode) {
                return Ok(Temporary::Unnamed(file.into()));
            }
        }
        Named::new(directory, is_new).map(Temporary::Named)
    }

    fn file(&mut self) -> &mut File {
        match self {
            #[cfg(target_os = "linux")]
            Temporary::Unnamed(file) => file,
            Temporary::Named(named) => named.file.as_file_mut(),
        }
    }

    /// Gives the file its permissions, if it does not have them, and writes it to the disk.
    fn finish(&mut self, permissions: Option<&Permissions>) -> io::Result<()> {
        let file = self.file();
        if let Some(permissions) = permissions {
            file.set_permissions(permissions.clone())?;
        }
        file.sync_all()
    }

    /// Moves the finished file to its place.
    #[cfg_attr(not(target_os = "linux"), expect(unused_variables))]
    fn put(self, target: &Path, directory: &Path, permissions: Option<&Permissions>) -> io::Result<()> {
        match self {
            #[cfg(target_os = "linux")]
            Temporary::Unnamed(mut file) => {
                // Linking cannot replace a file, so the file gets a temporary name first. The name exists
                // only while the lock is held.
                let guard = names();
                if let Ok(linked) = builder().make_in(directory, |name| link(&file, name)) {
                    linked.persist(target).map_err(|refused| refused.error)?;
                    return Ok(());
                }
                drop(guard);
                // Without `/proc`, or if a rule of the system forbids links, a copy with a name is made.
                let mut named = Named::new(directory, permissions.is_none())?;
                file.rewind()?;
                io::copy(&mut file, named.file.as_file_mut())?;
                let mut copy = Temporary::Named(named);
                copy.finish(permissions)?;
                copy.put(target, directory, permissions)
            }
            Temporary::Named(named) => named.put(target),
        }
    }
}

/// Gives a name to an unnamed file.
#[cfg(target_os = "linux")]
fn link(file: &File, name: &Path) -> io::Result<()> {
    use rustix::fs::{AtFlags, CWD, linkat};
    use std::os::fd::AsRawFd;
    let unnamed = format!("/proc/self/fd/{}", file.as_raw_fd());
    Ok(linkat(CWD, &unnamed, CWD, name, AtFlags::SYMLINK_FOLLOW)?)
}

/// Returns a builder with the naming scheme of temporary files.
fn builder() -> Builder<'static, 'static> {
    let mut builder = Builder::new();
    builder.prefix(".leafless-").suffix(".tmp");
    builder
}

/// A temporary file whose name is in the list.
struct Named {
    file: NamedTempFile,
    /// Dropped after `file`, whose drop removes the file.
    listed: Listed,
}

impl Named {
    fn new(directory: &Path, is_new: bool) -> io::Result<Named> {
        let builder = builder();
        #[cfg(unix)]
        let builder = {
            use std::os::unix::fs::PermissionsExt;
            let mut builder = builder;
            // The system subtracts the umask. If a file is replaced, nobody else may read the new one before
            // it has the permissions of the old one.
            if is_new {
                builder.permissions(Permissions::from_mode(0o666));
            }
            builder
        };
        #[cfg(not(unix))]
        let _ = is_new;
        let mut names = names();
        let file = builder.tempfile_in(directory).map_err(without_name)?;
        names.push(file.path().to_path_buf());
        let listed = Listed(file.path().to_path_buf());
        Ok(Named { file, listed })
    }

    fn put(self, target: &Path) -> io::Result<()> {
        let Named { file, listed } = self;
        let guard = names();
        let put = file.persist(target);
        drop(guard);
        drop(listed);
        put.map(drop).map_err(|refused| refused.error)
    }
}

/// A name that is in the list.
struct Listed(PathBuf);

impl Drop for Listed {
    fn drop(&mut self) {
        names().retain(|name| *name != self.0);
    }
}

/// Removes the temporary file's name, which means nothing to the caller, from an error of `tempfile`. The
/// system's error number is only in its text.
fn without_name(error: io::Error) -> io::Error {
    let text = error.to_string();
    let number = text.split_once("(os error ").and_then(|(_, rest)| rest.split_once(')'));
    let code = number.and_then(|(code, _)| code.parse().ok());
    code.map_or(error.kind().into(), io::Error::from_raw_os_error)
}

/// Synchronises a directory, if its file system supports that.
#[cfg(unix)]
fn synchronise(directory: &File) -> Result<(), Error> {
    match directory.sync_all() {
        Err(error) if !matches!(error.kind(), ErrorKind::InvalidInput | ErrorKind::Unsupported) => {
            Err(error.into())
        }
        _ => Ok(()),
    }
}

/// Follows all symbolic links at the end of `path` and returns the target, which need not exist. `None` if
/// one of the links stands for an open file of a process.
fn follow_links(path: &Path) -> Result<Option<PathBuf>, Error> {
    let mut target = path.to_path_buf();
    // The same limit as in Linux.
    for _ in 0..40 {
        match std::fs::symlink_metadata(&target) {
            Ok(metadata) if metadata.file_type().is_symlink() => {
                let directory = target.parent().unwrap_or(Path::new(""));
                // `/proc/self/fd/1`, the target of `/dev/stdout`, reads as a link but is none: the file may
                // be a pipe, removed, or open for appending.
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
    // The system reports the problem of such a chain.
    std::fs::metadata(&target)?;
    Ok(Some(target))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn count(folder: &Path) -> usize {
        std::fs::read_dir(folder).unwrap().count()
    }

    #[test]
    fn files_with_names_are_removed_when_saves_are_abandoned() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("target");
        let mut one = Named::new(folder.path(), true).unwrap();
        let two = Named::new(folder.path(), true).unwrap();
        one.file.write_all(b"new").unwrap();
        assert_eq!(count(folder.path()), 2);
        // (Other tests may save at the same time.)
        let here = |names: &[PathBuf]| -> Vec<PathBuf> {
            names.iter().filter(|name| name.starts_with(folder.path())).cloned().collect()
        };
        assert_eq!(here(&names()).len(), 2);
        one.put(&target).unwrap();
        assert_eq!((count(folder.path()), std::fs::read(&target).unwrap()), (2, b"new".to_vec()));
        let left = here(&names());
        assert_eq!(left.len(), 1);
        remove_all(&left);
        assert_eq!(count(folder.path()), 1);
        assert!(two.put(&target).is_err());
        assert_eq!((count(folder.path()), here(&names()).len()), (1, 0));
        drop(Named::new(folder.path(), true).unwrap());
        assert_eq!((count(folder.path()), here(&names()).len()), (1, 0));
    }

    /// Both kinds of temporary files behave alike.
    #[test]
    fn what_is_put_in_place_is_complete() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("target");
        for is_new in [true, false] {
            let permissions = (!is_new).then(|| std::fs::metadata(&target).unwrap().permissions());
            for named in [false, true] {
                let mut temporary = match named {
                    true => Temporary::Named(Named::new(folder.path(), is_new).unwrap()),
                    false => Temporary::new(folder.path(), is_new).unwrap(),
                };
                let bytes = format!("{is_new} {named}");
                temporary.file().write_all(bytes.as_bytes()).unwrap();
                temporary.finish(permissions.as_ref()).unwrap();
                temporary.put(&target, folder.path(), permissions.as_ref()).unwrap();
                assert_eq!((std::fs::read(&target).unwrap(), count(folder.path())), (bytes.into_bytes(), 1));
            }
        }
        // A file that cannot be put in its place leaves nothing behind.
        for named in [false, true] {
            let temporary = match named {
                true => Temporary::Named(Named::new(folder.path(), true).unwrap()),
                false => Temporary::new(folder.path(), true).unwrap(),
            };
            assert!(temporary.put(&folder.path().join("none/target"), folder.path(), None).is_err());
            assert_eq!(count(folder.path()), 1);
        }
    }
}
