//! Writing solids of any kind to files.

use super::channel::PreparedChannel;
use super::compose::{Deliver, Section, bytes_of, compose};
use super::elements::Elements;
use super::kind::Kind;
use super::object::Object;
#[cfg(feature = "std")]
use super::replace::replace;
use super::stored::Stored;
use crate::error::Error;
use crate::memory;
use crate::octree::metadata::MetadataLimit;
use alloc::vec::Vec;
#[cfg(feature = "std")]
use std::{io::Write, path::Path};

/// Returns the file of `solid` as bytes.
pub(super) fn to_bytes(solid: &impl Stored) -> Result<Vec<u8>, Error> {
    let mut file = Vec::new();
    assemble(solid, &mut |length, write| {
        let length = usize::try_from(length).map_err(|_| Error::OutOfMemory)?;
        file.try_reserve_exact(length)?;
        write(&mut |bytes| {
            file.extend_from_slice(bytes);
            Ok(())
        })
    })?;
    Ok(file)
}

/// Writes the file of `solid` to `out`, which is flushed at the end.
#[cfg(feature = "std")]
pub(super) fn write_to(solid: &impl Stored, mut out: impl Write) -> Result<(), Error> {
    assemble(solid, &mut |_, write| write(&mut |bytes| Ok(out.write_all(bytes)?)))?;
    Ok(out.flush()?)
}

/// Saves `solid` in the file at `path`.
#[cfg(feature = "std")]
pub(super) fn save(solid: &impl Stored, path: &Path) -> Result<(), Error> {
    replace(path, |file| write_to(solid, file))
}

/// Lays out the file of `solid` and calls `deliver` with its length and a function that writes it.
fn assemble<T: Stored>(solid: &T, deliver: Deliver<'_>) -> Result<(), Error> {
    T::checked(solid.as_view())?;
    let metadata = bytes_of(solid.metadata(), MetadataLimit::SOLID)?;
    let prepared = solid.prepare()?;
    let mut channels = memory::with_capacity(solid.channels().len())?;
    for channel in solid.channels() {
        channels.push(PreparedChannel::of(channel)?);
    }
    let mut objects: Vec<Object> = memory::with_capacity(1 + channels.len())?;
    let mut sections: Vec<Section<'_>> = memory::with_capacity((1 + channels.len()) * Kind::MOST)?;
    // In ascending order, as in the file, where the sections that are read first are neighbours.
    sections.push((0, Kind::Metadata, Elements::Bytes(&metadata)));
    let header = solid.append_sections(&prepared, &mut sections);
    objects.push(Object::main(&header));
    for (channel, owner) in channels.iter().zip(1..) {
        objects.push(channel.append_sections(owner, &header, &mut sections));
    }
    compose(header, &objects, &sections, deliver)
}
