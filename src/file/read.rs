//! The ways into a file, whatever it holds.

#[cfg(feature = "std")]
use super::buffer;
use super::buffer::Buffer;
use super::channel::{self, ChannelLayout};
use super::layout::Layout;
#[cfg(feature = "mmap")]
use super::mapping::mapping;
use super::stored::Stored;
use super::swap::swap_bytes;
use crate::error::{Error, FormatError};
use crate::memory;
use crate::octree::Metadata;
use alloc::sync::Arc;
use alloc::vec::Vec;
#[cfg(feature = "std")]
use std::path::Path;

/// All that must be known of a file to read its solid in place.
struct Found<T: Stored> {
    layout: Layout,
    shape: T::Shape,
}

impl<T: Stored> Found<T> {
    /// Checks what the layout and the shape consist of, and nothing else.
    fn read(bytes: &[u8]) -> Result<Found<T>, Error> {
        let layout = Layout::read(bytes, T::MODEL)?;
        let shape = T::shape(&layout, bytes)?;
        Ok(Found { layout, shape })
    }

    /// The same, and the solid in `bytes`, which are not copied.
    fn in_place(bytes: &[u8]) -> Result<(Found<T>, T::View<'_>), Error> {
        let found = Found::<T>::read(bytes)?;
        check_in_place(bytes)?;
        let view = found.view(bytes)?;
        Ok((found, view))
    }

    fn view<'a>(&self, bytes: &'a [u8]) -> Result<T::View<'a>, FormatError> {
        T::view(&self.layout, &self.shape, bytes)
    }

    /// The channels of a file whose layout has been found right. The bytes are still in the file's order.
    fn channels(&self, bytes: &[u8]) -> Result<Vec<(ChannelLayout, Metadata)>, Error> {
        if T::CHANNELS { channel::read(&self.layout, bytes) } else { Ok(Vec::new()) }
    }

    /// The solid and its channels in the bytes that `owner` has. All of them is checked, or nothing.
    fn attach<C: AsRef<[u8]> + Send + Sync + 'static>(
        &self,
        owner: C,
        metadata: Metadata,
        channels: Vec<(ChannelLayout, Metadata)>,
        verify: bool,
    ) -> Result<T, Error> {
        let owner = Arc::new(owner);
        let solid = T::attach(owner.clone(), metadata, |owner| {
            let view = self.view(owner.as_ref())?;
            if verify { T::checked(view) } else { Ok(view) }
        })?;
        if verify {
            verify_channels(&channels, (*owner).as_ref())?;
        }
        let mut attached = memory::with_capacity(channels.len())?;
        for (channel, metadata) in channels {
            attached.push(channel.attach(owner.clone(), metadata, verify)?);
        }
        Ok(solid.with_channels(attached))
    }
}

/// The solid in `bytes`, which are not copied.
pub(super) fn view<T: Stored>(bytes: &[u8]) -> Result<T::View<'_>, Error> {
    Ok(Found::<T>::in_place(bytes)?.1)
}

/// Checks all of a file.
pub(super) fn verify<T: Stored>(bytes: &[u8]) -> Result<(), Error> {
    let (found, view) = Found::<T>::in_place(bytes)?;
    found.layout.verify(bytes)?;
    // All records before any contents, so that every way in that verifies finds the same thing first.
    let channels = found.channels(bytes)?;
    T::checked(view)?;
    verify_channels(&channels, bytes)
}

/// The solid in a copy of `bytes`, of which all is verified.
pub(super) fn from_bytes<T: Stored>(bytes: &[u8]) -> Result<T, Error> {
    // Refused before anything is allocated.
    let found = Found::read(bytes)?;
    adopt(found, Buffer::copy(bytes)?)
}

/// The solid in `bytes`, which are not copied.
pub(super) fn from_static<T: Stored>(bytes: &'static [u8]) -> Result<T, Error> {
    in_place(bytes, false)
}

/// The solid in the file at `path`, read into memory and verified.
#[cfg(feature = "std")]
pub(super) fn open<T: Stored>(path: &Path) -> Result<T, Error> {
    let read = || {
        let buffer = buffer::read(path, |head| head.demand_model(T::MODEL))?;
        adopt(Found::read(buffer.bytes())?, buffer)
    };
    read().map_err(|error| error.of_file(path))
}

/// The solid in the file at `path`, mapped into memory. All of it is verified if that is asked for.
///
/// # Safety
/// As [`file::map`](super::map()).
#[cfg(feature = "mmap")]
#[allow(unsafe_code)]
pub(super) unsafe fn map<T: Stored>(path: &Path, verify: bool) -> Result<T, Error> {
    // SAFETY: the caller promises what `mapping` asks for.
    let map = unsafe { mapping(path) };
    let read = |map| match map {
        Some(map) => in_place(map, verify),
        // Nothing can be mapped; the error is the one of any file that is too short.
        None => from_bytes(&[]),
    };
    map.and_then(read).map_err(|error| error.of_file(path))
}

/// A solid over the bytes of a file that `owner` has. All of it is verified if that is asked for.
fn in_place<T: Stored, C: AsRef<[u8]> + Send + Sync + 'static>(owner: C, verify: bool) -> Result<T, Error> {
    let bytes = owner.as_ref();
    let (found, _) = Found::<T>::in_place(bytes)?;
    let metadata = if verify { found.layout.verify(bytes)? } else { found.layout.metadata(bytes)? };
    let channels = found.channels(bytes)?;
    found.attach(owner, metadata, channels, verify)
}

/// A solid over a file in memory, once all of it is verified.
fn adopt<T: Stored>(found: Found<T>, mut buffer: Buffer) -> Result<T, Error> {
    let metadata = found.layout.verify(buffer.bytes())?;
    let channels = found.channels(buffer.bytes())?;
    if cfg!(target_endian = "big") {
        swap_bytes(&found.layout, &channels, buffer.bytes_mut())?;
    }
    found.attach(buffer, metadata, channels, true)
}

fn verify_channels(channels: &[(ChannelLayout, Metadata)], bytes: &[u8]) -> Result<(), Error> {
    channels.iter().try_for_each(|(channel, _)| channel.verify(bytes))
}

/// Refuses bytes that cannot be read where they lie, on this machine or at this address.
fn check_in_place(bytes: &[u8]) -> Result<(), FormatError> {
    if cfg!(target_endian = "big") {
        return Err(FormatError::Endianness);
    }
    if bytes.as_ptr().align_offset(align_of::<u64>()) != 0 {
        return Err(FormatError::Alignment);
    }
    Ok(())
}
