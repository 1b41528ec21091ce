//! Verification of files of any kind.

#[cfg(feature = "std")]
use super::buffer;
use super::header::{Head, Model};
use super::read;
use crate::dexel::TriDexel;
use crate::error::Error;
use crate::octree::Octree;
#[cfg(feature = "std")]
use std::path::Path;

/// Checks everything that the format guarantees: the checks of [`view`](super::view), all checksums, that
/// padding is zero, that the metadata can be read, and that the tree and the channels, or the tri-dexel
/// model, are well-formed and in canonical form ([`OctreeRef::check`](crate::OctreeRef::check),
/// [`ChannelRef::check`](crate::attribute::ChannelRef::check),
/// [`TriDexelRef::check`](crate::dexel::TriDexelRef::check)). Only one rule is not checked: the writer's
/// choice of the encoding of the bricks, because any encoding is readable. O(n) in the lengths of all
/// sections, several of which may share their bytes. The bytes must satisfy the conditions of `view`, and
/// memory for the metadata is needed.
///
/// # Errors
/// [`Error::Format`], [`Error::Damaged`] or [`Error::DamagedRays`]; [`Error::OutOfMemory`].
pub fn verify(bytes: &[u8]) -> Result<(), Error> {
    match Head::read(bytes)?.header.model() {
        Model::Octree => read::verify::<Octree>(bytes),
        Model::Dexels => read::verify::<TriDexel>(bytes),
    }
}

/// Verifies the file at `path` as [`verify`] does, after reading it into memory. A pipe or device may be read
/// too.
///
/// # Errors
/// [`Error::File`] with the path and one of these causes: the errors of [`verify`], and [`Error::Io`].
#[cfg(feature = "std")]
pub fn verify_path(path: impl AsRef<Path>) -> Result<(), Error> {
    let path = path.as_ref();
    let read = || verify(buffer::read(path, |_| Ok(()))?.bytes());
    read().map_err(|error| error.of_file(path))
}
