//! Writing: how the bytes of a tree reach memory or a disk.

use super::assemble::assemble;
#[cfg(feature = "std")]
use super::replace::replace;
use crate::error::Error;
use crate::octree::Octree;
use alloc::vec::Vec;
#[cfg(feature = "std")]
use std::{io::Write, path::Path};

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
/// On Linux the temporary file has no name until it is complete, so that nothing is left of it when the process is
/// killed, where the file system has such files (NFS does not). On other systems a file `.leafless-….tmp` may stay
/// behind. A program that ends when a signal arrives calls [`abandon_saves`](super::abandon_saves) before.
///
/// By default the signal SIGXFSZ kills a process that exceeds its limit on the size of files (`ulimit -f`), and SIGPIPE
/// one that writes to a pipe without readers. A process that ignores the two signals gets errors in their place. (Rust
/// programs ignore SIGPIPE from the start.) Opening a pipe waits until somebody reads it, also if signal handlers run
/// meanwhile.
///
/// # Errors
/// As [`to_bytes`], and [`Error::File`] with the path and the cause [`Error::Io`]. The old file is then as it
/// was, and no temporary file is left; only if it is the very last step that fails, synchronising the
/// directory, the new file is already in place.
#[cfg(feature = "std")]
pub fn save(octree: &Octree, path: impl AsRef<Path>) -> Result<(), Error> {
    replace(path, |file| write_to(octree, file))
}
