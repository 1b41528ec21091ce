//! The ways in to octrees that need no operating system, and reading from paths.

#[cfg(feature = "std")]
use super::buffer;
use super::buffer::Buffer;
use super::channel::{self, ChannelLayout};
use super::contents::{check_in_place, metadata, verify_contents};
use super::layout::Layout;
use super::swap::swap_bytes;
use crate::error::Error;
use crate::memory;
use crate::octree::{Metadata, Octree, OctreeRef};
use alloc::sync::Arc;
use alloc::vec::Vec;
#[cfg(feature = "std")]
use std::path::Path;

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
/// [`FormatError::Endianness`](crate::FormatError::Endianness) on big-endian machines.
pub fn view(bytes: &[u8]) -> Result<OctreeRef<'_>, Error> {
    Ok(viewed(bytes)?.1)
}

/// Checks all of a file with an octree; see [`verify`](super::verify).
pub(super) fn verify_octree(bytes: &[u8]) -> Result<(), Error> {
    let (layout, tree) = viewed(bytes)?;
    verify_contents(&layout.head, &layout.sections, bytes)?;
    // All records before any contents, so that every way in that verifies finds the same thing first.
    let channels = channel::read(&layout, bytes)?;
    tree.check()?;
    channels.iter().try_for_each(|(channel, _)| channel.verify(bytes))
}

/// The tree in `bytes`, a whole file, copied and [verified](super::verify). The bytes may have any alignment, and
/// the machine any byte order.
///
/// # Errors
/// As [`verify`](super::verify).
pub fn from_bytes(bytes: &[u8]) -> Result<Octree, Error> {
    // Refused before anything is allocated.
    let layout = Layout::read(bytes)?;
    adopt(layout, Buffer::copy(bytes)?)
}

/// The tree in `bytes`, a whole file that lives as long as the program (one that was linked into it, say),
/// read where it lies as by [`view`].
///
/// # Errors
/// As [`view`], and [`FormatError::Metadata`](crate::FormatError::Metadata).
pub fn from_static(bytes: &'static [u8]) -> Result<Octree, Error> {
    let (layout, _) = viewed(bytes)?;
    let metadata = metadata(&layout.sections, bytes)?;
    let channels = channel::read(&layout, bytes)?;
    let owner = Arc::new(bytes);
    let octree = Octree::attach(owner.clone(), metadata, |bytes| layout.octree(bytes))?;
    with_channels(octree, owner, channels, false)
}

/// The tree in the file at `path`, read into memory and [verified](super::verify). Later changes of the file do not
/// matter. A pipe or device may be read too.
///
/// # Errors
/// [`Error::File`] with the path and one of these causes: as [`verify`](super::verify), and [`Error::Io`].
#[cfg(feature = "std")]
pub fn open(path: impl AsRef<Path>) -> Result<Octree, Error> {
    let path = path.as_ref();
    let read = || {
        let buffer = buffer::read(path, |head| head.demand_model(false))?;
        adopt(Layout::read(buffer.bytes())?, buffer)
    };
    read().map_err(|error| error.of_file(path))
}

/// The tree in `bytes` and what was found on the way to it.
pub(super) fn viewed(bytes: &[u8]) -> Result<(Layout, OctreeRef<'_>), Error> {
    let layout = Layout::read(bytes)?;
    check_in_place(bytes)?;
    let tree = layout.octree(bytes)?;
    Ok((layout, tree))
}

/// An octree over a file in memory, once all of it is verified.
fn adopt(layout: Layout, mut buffer: Buffer) -> Result<Octree, Error> {
    let metadata = verify_contents(&layout.head, &layout.sections, buffer.bytes())?;
    let channels = channel::read(&layout, buffer.bytes())?;
    if cfg!(target_endian = "big") {
        swap_bytes(&layout, &channels, buffer.bytes_mut())?;
    }
    let owner = Arc::new(buffer);
    let octree = Octree::attach(owner.clone(), metadata, |buffer| {
        let tree = layout.octree(buffer.bytes())?;
        tree.check()?;
        Ok::<_, Error>(tree)
    })?;
    channels.iter().try_for_each(|(channel, _)| channel.verify(owner.bytes()))?;
    with_channels(octree, owner, channels, true)
}

/// The octree with the channels that lie in the same bytes.
pub(super) fn with_channels<C: AsRef<[u8]> + Send + Sync + 'static>(
    octree: Octree,
    owner: Arc<C>,
    channels: Vec<(ChannelLayout, Metadata)>,
    verified: bool,
) -> Result<Octree, Error> {
    let mut attached = memory::with_capacity(channels.len())?;
    for (channel, metadata) in channels {
        attached.push(channel.attach(owner.clone(), metadata, verified)?);
    }
    Ok(octree.with_all_channels(attached))
}
