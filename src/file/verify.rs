//! Verifying whatever a file holds.

use super::header::{Head, Model};
use super::read;
use crate::dexel::TriDexel;
use crate::error::Error;
use crate::octree::Octree;

/// Checks everything that the format promises: what [`view`](super::view) checks, all checksums, that padding is zero,
/// that the metadata can be read, and that the tree and the channels, or the tri-dexel model, are well-formed and in
/// canonical form ([`OctreeRef::check`](crate::OctreeRef::check), [`ChannelRef::check`](crate::attribute::ChannelRef::check),
/// [`TriDexelRef::check`](crate::dexel::TriDexelRef::check)). Only whether a writer chose the
/// encoding of the bricks by the rule is not checked: any encoding is readable. O(n) in the lengths of all
/// sections, of which several may have the same bytes; needs what `view` needs of the bytes, and memory for
/// the metadata.
///
/// # Errors
/// [`Error::Format`], [`Error::Damaged`] or [`Error::DamagedRays`]; [`Error::OutOfMemory`].
pub fn verify(bytes: &[u8]) -> Result<(), Error> {
    match Head::read(bytes)?.header.model() {
        Model::Octree => read::verify::<Octree>(bytes),
        Model::Dexels => read::verify::<TriDexel>(bytes),
    }
}
