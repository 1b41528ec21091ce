//! Files of octrees.

use super::compose::Section;
use super::cuts;
use super::header::{Header, Model, OLDEST_MINOR};
use super::kind::Kind;
use super::layout::Layout;
use super::object::{CHANNEL_MINOR, CUTS_MINOR, Object};
use super::stored::Stored;
use super::tree::{self, Starts, starts};
use super::{read, write};
use crate::error::{Error, FormatError};
use crate::octree::brick::OwnedBricks;
use crate::octree::{Channel, Metadata, Octree, OctreeRef, dictionary};
use alloc::sync::Arc;
use alloc::vec::Vec;
#[cfg(feature = "std")]
use std::{io::Write, path::Path};

impl Stored for Octree {
    const MODEL: Model = Model::Octree;
    const CHANNELS: bool = true;

    type View<'a> = OctreeRef<'a>;
    type Shape = Starts;
    /// The bricks, if the file encodes them in another way than memory does.
    type Prepared = Option<OwnedBricks>;

    /// Checks that the level table agrees with the stored elements. O(depth).
    fn shape(layout: &Layout, bytes: &[u8]) -> Result<Starts, Error> {
        starts(&layout.head.header.counts(), layout.sections.bytes(bytes, Kind::Levels)?)
    }

    fn view<'a>(layout: &Layout, starts: &Starts, bytes: &'a [u8]) -> Result<OctreeRef<'a>, FormatError> {
        let head = &layout.head;
        let tree = tree::view(&Object::main(&head.header), &layout.sections, head.frame, starts, bytes)?;
        let cuts = cuts::view(&layout.sections, bytes, &tree.frame)?;
        Ok(OctreeRef { root: head.root, exterior: head.exterior, proof: head.proof, cuts, ..tree })
    }

    fn checked(view: Self::View<'_>) -> Result<Self::View<'_>, Error> {
        // This also proves that the links are those that the planes determine.
        view.check()?;
        Ok(view)
    }

    fn attach<C: Send + Sync + 'static>(
        owner: Arc<C>,
        metadata: Metadata,
        view: impl for<'a> FnOnce(&'a C) -> Result<OctreeRef<'a>, Error>,
    ) -> Result<Octree, Error> {
        Octree::attach(owner, metadata, view)
    }

    fn as_view(&self) -> OctreeRef<'_> {
        *self.view()
    }

    fn metadata(&self) -> &Metadata {
        self.metadata()
    }

    fn channels(&self) -> &[Channel] {
        self.channels()
    }

    fn with_channels(self, channels: Vec<Channel>) -> Octree {
        self.with_all_channels(channels)
    }

    fn prepare(&self) -> Result<Option<OwnedBricks>, Error> {
        dictionary::encode(&self.view().bricks)
    }

    fn append_sections<'a>(
        &'a self,
        encoded: &'a Option<OwnedBricks>,
        sections: &mut Vec<Section<'a>>,
    ) -> Header {
        let tree = self.view();
        let coding = tree::append(0, tree, self.counts(), encoded, sections);
        if let Some(cuts) = &tree.cuts {
            sections.extend(cuts::sections(0, cuts));
        }
        Header {
            minor: match (&tree.cuts, self.channels()) {
                (Some(_), _) => CUTS_MINOR,
                (None, []) => OLDEST_MINOR,
                (None, _) => CHANNEL_MINOR,
            },
            root: tree.root as u8,
            exterior: tree.exterior as u8,
            proof: tree.proof.bits(),
            displacement: tree.proof.displacement().to_bits(),
            elements: tree.element_count(),
            bricks: tree.brick_count(),
            brick_planes: coding.planes,
            brick_encoding: coding.encoding,
            segment_shift: coding.segment_shift,
            dictionary_entries: coding.entries,
            ..Header::of(&tree.frame)
        }
    }
}

/// Returns the file of `octree` as bytes.
///
/// The bytes depend only on the tree, its metadata and its channels: not on the encoding of its bricks in
/// memory, nor on whether it was built, read or mapped. The tree is [checked](crate::OctreeRef::check) first,
/// so that every written file can be read. O(n). Besides the result, memory for the dictionary is needed.
///
/// # Errors
/// [`Error::Damaged`] if the tree, or a channel of it, is mapped, not verified, and damaged;
/// [`Error::Argument`] if the metadata take more than 1 MiB, or those of a channel more than 64 KiB;
/// [`Error::OutOfMemory`].
pub fn to_bytes(octree: &Octree) -> Result<Vec<u8>, Error> {
    write::to_bytes(octree)
}

/// Writes the file of `octree` to `out`, the same bytes as [`to_bytes`], in a few large pieces. `out` needs
/// no buffer around it, and the file is never in memory as a whole. `out` is flushed at the end.
///
/// # Errors
/// The errors of [`to_bytes`], before anything is written; [`Error::Io`] as `out` returns it.
#[cfg(feature = "std")]
pub fn write_to(octree: &Octree, out: impl Write) -> Result<(), Error> {
    write::write_to(octree, out)
}

/// Saves `octree` in the file at `path`. At any moment, also after a crash or a power failure, either the old
/// file or the new file is there, and it is complete.
///
/// The bytes, those of [`to_bytes`], go to a temporary file in the same directory, which is synchronised with
/// the disk and then renamed over the old file. At last the directory is synchronised (on Unix). Processes
/// that have the old file open or mapped keep it.
///
/// * A file that is replaced keeps its permissions. A new one gets the permissions that the process gives to
///   new files (its umask). A file without write permission is not replaced. The new file belongs to the user
///   who saves; other hard links of the old file, if any, keep the old contents.
/// * A symbolic link is followed, also to a file that does not exist yet: the target is replaced, the link
///   stays.
/// * A file that is not regular, such as a pipe or a terminal, is written to directly. So is an open file of
///   the process that is named like `/dev/stdout`: the bytes are appended.
///
/// On Linux the temporary file has no name until it is complete, so that nothing remains of it when the
/// process is killed, if the file system supports unnamed files (NFS does not). On other systems a file
/// `.leafless-….tmp` may remain. A program that ends when a signal arrives should call
/// [`abandon_saves`](super::abandon_saves) first.
///
/// By default the signal SIGXFSZ kills a process that exceeds its limit on the size of files (`ulimit -f`),
/// and SIGPIPE kills a process that writes to a pipe without readers. A process that ignores the two signals
/// gets errors instead. (Rust programs ignore SIGPIPE from the start.) Opening a pipe waits for a reader,
/// also if signal handlers run meanwhile.
///
/// # Errors
/// The errors of [`to_bytes`], and [`Error::File`] with the path and the cause [`Error::Io`]. On an error the
/// old file is unchanged, and no temporary file remains. The only exception is a failure of the very last
/// step, synchronising the directory: the new file is then in place already.
#[cfg(feature = "std")]
pub fn save(octree: &Octree, path: impl AsRef<Path>) -> Result<(), Error> {
    write::save(octree, path.as_ref())
}

/// Returns a view of the tree in `bytes`, a whole file, without a copy and without an allocation.
///
/// Only header, section table, bounds and level table are checked: O(sections + depth). If the file is
/// damaged elsewhere, all queries are still memory-safe, and end after bounded work; see [`OctreeRef`].
/// [`verify`](super::verify) checks everything.
///
/// The bytes must begin at an address that is a multiple of 8. `include_bytes!` does not guarantee that; a
/// `#[repr(align(8))]` struct around the array does.
///
/// # Errors
/// [`Error::Format`], [`Error::Damaged`] if the level table contradicts the header,
/// [`FormatError::Endianness`](crate::error::FormatError::Endianness) on big-endian machines.
pub fn view(bytes: &[u8]) -> Result<OctreeRef<'_>, Error> {
    read::view::<Octree>(bytes)
}

/// Returns the tree in `bytes`, a whole file, copied and [verified](super::verify). The bytes may have any
/// alignment, and the machine any byte order.
///
/// # Errors
/// The errors of [`verify`](super::verify).
pub fn from_bytes(bytes: &[u8]) -> Result<Octree, Error> {
    read::from_bytes(bytes)
}

/// Returns the tree in `bytes`, a whole file that lives as long as the program (for example linked into it),
/// read in place as by [`view`].
///
/// # Errors
/// The errors of [`view`], and [`FormatError::Metadata`](crate::error::FormatError::Metadata).
pub fn from_static(bytes: &'static [u8]) -> Result<Octree, Error> {
    read::from_static(bytes)
}

/// Reads the tree in the file at `path` into memory, and [verifies](super::verify) it. Later changes of the
/// file have no effect. A pipe or device may be read too.
///
/// # Errors
/// [`Error::File`] with the path and one of these causes: the errors of [`verify`](super::verify), and
/// [`Error::Io`].
#[cfg(feature = "std")]
pub fn open(path: impl AsRef<Path>) -> Result<Octree, Error> {
    read::open(path.as_ref())
}

/// Maps the tree in the file at `path` into memory: nothing is copied, and only the parts that queries touch
/// are ever read from disk. Only header, section table, bounds, level table and metadata are checked:
/// O(sections + depth), some microseconds for a file of any size.
///
/// The pages are shared with all other processes that map the file, and the mapping lives until the last
/// clone of the tree is dropped. Removing the file does not affect the mapping, nor does replacing it by
/// renaming another file over it, as [`save`](super::save) does.
///
/// If the file is damaged elsewhere, all queries are still memory-safe, and end after bounded work; see
/// [`OctreeRef`](crate::OctreeRef). [`map_verified`] and [`open`](super::open) refuse such a file.
///
/// # Errors
/// [`Error::File`] with the path and one of these causes: [`Error::Io`];
/// [`FormatError::NotRegular`](crate::error::FormatError::NotRegular) if there is no regular file at `path`;
/// the errors of [`view`](super::view); and [`FormatError::Metadata`](crate::error::FormatError::Metadata).
///
/// # Safety
/// While the mapping lives,
///
/// * nobody may make the file shorter: reading beyond its new end raises SIGBUS (an in-page error on
///   Windows), which by default ends the process;
/// * nobody may write to it: the language demands that bytes behind a shared reference do not change. In
///   practice the library checks every index when it uses it, after [`map_verified`] too, so changed contents
///   can make answers wrong but are not known to make any access leave the mapping. Do not rely on this.
///
/// Programs that replace files instead of rewriting them meet these conditions. If other programs cannot be
/// trusted with them, use [`open`](super::open).
#[cfg(feature = "mmap")]
#[allow(unsafe_code)]
pub unsafe fn map(path: impl AsRef<Path>) -> Result<Octree, Error> {
    // SAFETY: the caller promises what `read::map` asks for.
    unsafe { read::map(path.as_ref(), false) }
}

/// Maps a file as [`map`] does, and verifies all of it in one scan: everything that
/// [`verify`](super::verify) checks.
///
/// # Errors
/// The errors of [`map`] and of [`verify`](super::verify).
///
/// # Safety
/// The conditions of [`map`]. A program that violates them may change the file after it was verified.
#[cfg(feature = "mmap")]
#[allow(unsafe_code)]
pub unsafe fn map_verified(path: impl AsRef<Path>) -> Result<Octree, Error> {
    // SAFETY: the caller promises what `read::map` asks for.
    unsafe { read::map(path.as_ref(), true) }
}
