//! Files mapped into memory and queried in place.

use super::channel;
use super::contents::{metadata, verify_contents};
use super::layout::Layout;
use super::mapping::mapping;
use super::read::{viewed, with_channels};
use crate::error::Error;
use crate::octree::Octree;
use alloc::sync::Arc;
use std::path::Path;

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
/// [`FormatError::NotRegular`](crate::FormatError::NotRegular) if there is no regular file at `path`; else as
/// [`view`](super::view), and [`FormatError::Metadata`](crate::FormatError::Metadata).
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
#[allow(unsafe_code)]
pub unsafe fn map(path: impl AsRef<Path>) -> Result<Octree, Error> {
    // SAFETY: the caller promises what `mapped` asks for.
    unsafe { mapped(path.as_ref(), false) }.map_err(|error| error.of_file(path.as_ref()))
}

/// As [`map`], but verifies all of the file first, in one scan: everything that [`verify`](super::verify)
/// checks.
///
/// # Errors
/// As [`map`], and as [`verify`](super::verify).
///
/// # Safety
/// As [`map`]. What was verified may be changed afterwards by whoever breaks that promise.
#[allow(unsafe_code)]
pub unsafe fn map_verified(path: impl AsRef<Path>) -> Result<Octree, Error> {
    // SAFETY: the caller promises what `mapped` asks for.
    unsafe { mapped(path.as_ref(), true) }.map_err(|error| error.of_file(path.as_ref()))
}

/// # Safety
/// As [`map`].
#[allow(unsafe_code)]
unsafe fn mapped(path: &Path, verify: bool) -> Result<Octree, Error> {
    // SAFETY: the caller promises what `mapping` asks for.
    let Some(map) = unsafe { mapping(path) }? else {
        // Nothing can be mapped; the error is the one of any file that is too short.
        return super::from_bytes(&[]);
    };
    let map = Arc::new(map);
    let (layout, _) = viewed(&map)?;
    let Layout { head, sections, .. } = &layout;
    let metadata = if verify { verify_contents(head, sections, &map)? } else { metadata(sections, &map)? };
    let channels = channel::read(&layout, &map)?;
    let octree = Octree::attach(map.clone(), metadata, |map| {
        let tree = layout.octree(map)?;
        if verify {
            tree.check()?;
        }
        Ok::<_, Error>(tree)
    })?;
    if verify {
        channels.iter().try_for_each(|(channel, _)| channel.verify(&map))?;
    }
    with_channels(octree, map, channels, verify)
}
