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
    /// The bricks, if they are coded otherwise.
    type Prepared = Option<OwnedBricks>;

    /// Checks that the level table's elements are the ones that are stored. O(depth).
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
        // Thereby the links, too, are the ones that the planes determine.
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
    write::to_bytes(octree)
}

/// Writes the file of `octree` to `out`, the same bytes as [`to_bytes`], in a few large pieces: no buffer is
/// needed around `out`, and the file is never in memory as a whole. `out` is flushed at the end.
///
/// # Errors
/// As [`to_bytes`], before anything is written; [`Error::Io`] as `out` returns it.
#[cfg(feature = "std")]
pub fn write_to(octree: &Octree, out: impl Write) -> Result<(), Error> {
    write::write_to(octree, out)
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
/// On Linux the temporary file has no name until it is complete, so that nothing is left of it when the
/// process is killed, where the file system has such files (NFS does not). On other systems a file
/// `.leafless-….tmp` may stay behind. A program that ends when a signal arrives calls
/// [`abandon_saves`](super::abandon_saves) before.
///
/// By default the signal SIGXFSZ kills a process that exceeds its limit on the size of files (`ulimit -f`),
/// and SIGPIPE one that writes to a pipe without readers. A process that ignores the two signals gets errors
/// in their place. (Rust programs ignore SIGPIPE from the start.) Opening a pipe waits until somebody reads
/// it, also if signal handlers run meanwhile.
///
/// # Errors
/// As [`to_bytes`], and [`Error::File`] with the path and the cause [`Error::Io`]. The old file is then as it
/// was, and no temporary file is left; only if it is the very last step that fails, synchronising the
/// directory, the new file is already in place.
#[cfg(feature = "std")]
pub fn save(octree: &Octree, path: impl AsRef<Path>) -> Result<(), Error> {
    write::save(octree, path.as_ref())
}

/// The tree in `bytes`, a whole file, read where it lies: no copy, no allocation.
///
/// Header, section table, bounds and level table are checked, and nothing else: O(sections + depth). Of a
/// file that is damaged elsewhere all queries are still memory-safe, and end after bounded work; see
/// [`OctreeRef`]. [`verify`](super::verify) checks all of it.
///
/// The bytes must begin on an address that is a multiple of 8. `include_bytes!` does not see to that by
/// itself; a `#[repr(align(8))]` struct around the array does.
///
/// # Errors
/// [`Error::Format`], [`Error::Damaged`] if the level table contradicts the header,
/// [`FormatError::Endianness`](crate::error::FormatError::Endianness) on big-endian machines.
pub fn view(bytes: &[u8]) -> Result<OctreeRef<'_>, Error> {
    read::view::<Octree>(bytes)
}

/// The tree in `bytes`, a whole file, copied and [verified](super::verify). The bytes may have any alignment,
/// and the machine any byte order.
///
/// # Errors
/// As [`verify`](super::verify).
pub fn from_bytes(bytes: &[u8]) -> Result<Octree, Error> {
    read::from_bytes(bytes)
}

/// The tree in `bytes`, a whole file that lives as long as the program (one that was linked into it, say),
/// read where it lies as by [`view`].
///
/// # Errors
/// As [`view`], and [`FormatError::Metadata`](crate::error::FormatError::Metadata).
pub fn from_static(bytes: &'static [u8]) -> Result<Octree, Error> {
    read::from_static(bytes)
}

/// The tree in the file at `path`, read into memory and [verified](super::verify). Later changes of the file
/// do not matter. A pipe or device may be read too.
///
/// # Errors
/// [`Error::File`] with the path and one of these causes: as [`verify`](super::verify), and [`Error::Io`].
#[cfg(feature = "std")]
pub fn open(path: impl AsRef<Path>) -> Result<Octree, Error> {
    read::open(path.as_ref())
}

/// The tree in the file at `path`, mapped into memory: nothing is copied, and only what queries touch is ever
/// read from disk. Header, section table, bounds, level table and metadata are checked, and nothing else:
/// O(sections + depth), some microseconds for a file of any size.
///
/// The pages are shared with all other processes that map the file, and the mapping lives until the last
/// clone of the tree is gone. Removing the file, or replacing it by renaming another over it, as
/// [`save`](super::save) does, leaves the mapping as it is.
///
/// Of a file that is damaged elsewhere all queries are still memory-safe, and end after bounded work; see
/// [`OctreeRef`](crate::OctreeRef). [`map_verified`] and [`open`](super::open) refuse such a file.
///
/// # Errors
/// [`Error::File`] with the path and one of these causes: [`Error::Io`];
/// [`FormatError::NotRegular`](crate::error::FormatError::NotRegular) if there is no regular file at `path`;
/// else as [`view`](super::view), and [`FormatError::Metadata`](crate::error::FormatError::Metadata).
///
/// # Safety
/// While the mapping lives,
///
/// * nobody may make the file shorter: reading beyond its new end raises SIGBUS (an in-page error on
///   Windows), which by default ends the process;
/// * nobody may write to it: the language demands that bytes behind a shared reference stand still. In
///   practice the library checks every index at the moment of its use, after [`map_verified`] too, so changed
///   contents can make answers wrong but are not known to make any access leave the mapping. Do not rely on
///   the latter.
///
/// Programs that replace files instead of rewriting them keep this promise by themselves. Where others
/// cannot be trusted with it, use [`open`](super::open).
#[cfg(feature = "mmap")]
#[allow(unsafe_code)]
pub unsafe fn map(path: impl AsRef<Path>) -> Result<Octree, Error> {
    // SAFETY: the caller promises what `read::map` asks for.
    unsafe { read::map(path.as_ref(), false) }
}

/// As [`map`], but verifies all of the file first, in one scan: everything that [`verify`](super::verify)
/// checks.
///
/// # Errors
/// As [`map`], and as [`verify`](super::verify).
///
/// # Safety
/// As [`map`]. What was verified may be changed afterwards by whoever breaks that promise.
#[cfg(feature = "mmap")]
#[allow(unsafe_code)]
pub unsafe fn map_verified(path: impl AsRef<Path>) -> Result<Octree, Error> {
    // SAFETY: the caller promises what `read::map` asks for.
    unsafe { read::map(path.as_ref(), true) }
}
