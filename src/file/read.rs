//! Reading files, whatever solid they hold.

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

/// The data needed to read the solid of a file in place.
struct Found<T: Stored> {
    layout: Layout,
    shape: T::Shape,
}

impl<T: Stored> Found<T> {
    /// Checks the layout and the shape, and nothing else.
    fn read(bytes: &[u8]) -> Result<Found<T>, Error> {
        let layout = Layout::read(bytes, T::MODEL)?;
        let shape = T::shape(&layout, bytes)?;
        Ok(Found { layout, shape })
    }

    /// Does the same, and returns a view of the solid in `bytes`, which are not copied.
    fn in_place(bytes: &[u8]) -> Result<(Found<T>, T::View<'_>), Error> {
        let found = Found::<T>::read(bytes)?;
        check_in_place(bytes)?;
        let view = found.view(bytes)?;
        Ok((found, view))
    }

    fn view<'a>(&self, bytes: &'a [u8]) -> Result<T::View<'a>, FormatError> {
        T::view(&self.layout, &self.shape, bytes)
    }

    /// Returns the channels of a file whose layout has been checked. The bytes are still in the file's byte
    /// order.
    fn channels(&self, bytes: &[u8]) -> Result<Vec<(ChannelLayout, Metadata)>, Error> {
        if T::CHANNELS { channel::read(&self.layout, bytes) } else { Ok(Vec::new()) }
    }

    /// Returns the solid and its channels in the bytes of `owner`. Either all of them are checked, or none.
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

/// Returns a view of the solid in `bytes`, which are not copied.
pub(super) fn view<T: Stored>(bytes: &[u8]) -> Result<T::View<'_>, Error> {
    Ok(Found::<T>::in_place(bytes)?.1)
}

/// Checks the whole file.
pub(super) fn verify<T: Stored>(bytes: &[u8]) -> Result<(), Error> {
    let (found, view) = Found::<T>::in_place(bytes)?;
    found.layout.verify(bytes)?;
    // All records before any contents, so that all verifying functions report the same error first.
    let channels = found.channels(bytes)?;
    T::checked(view)?;
    verify_channels(&channels, bytes)
}

/// Returns the solid in a copy of `bytes`, completely verified.
pub(super) fn from_bytes<T: Stored>(bytes: &[u8]) -> Result<T, Error> {
    // Check before anything is allocated.
    let found = Found::read(bytes)?;
    adopt(found, Buffer::copy(bytes)?)
}

/// Returns the solid in `bytes`, which are not copied.
pub(super) fn from_static<T: Stored>(bytes: &'static [u8]) -> Result<T, Error> {
    in_place(bytes, false)
}

/// Reads the solid in the file at `path` into memory, and verifies it.
#[cfg(feature = "std")]
pub(super) fn open<T: Stored>(path: &Path) -> Result<T, Error> {
    let read = || {
        let buffer = buffer::read(path, |head| head.demand_model(T::MODEL))?;
        adopt(Found::read(buffer.bytes())?, buffer)
    };
    read().map_err(|error| error.of_file(path))
}

/// Maps the solid in the file at `path` into memory. Verifies all of it if `verify` is true.
///
/// # Safety
/// The conditions of [`file::map`](super::map()).
#[cfg(feature = "mmap")]
#[allow(unsafe_code)]
pub(super) unsafe fn map<T: Stored>(path: &Path, verify: bool) -> Result<T, Error> {
    // SAFETY: the caller promises what `mapping` asks for.
    let map = unsafe { mapping(path) };
    let read = |map| match map {
        Some(map) => in_place(map, verify),
        // An empty file cannot be mapped; the error is that of any file that is too short.
        None => from_bytes(&[]),
    };
    map.and_then(read).map_err(|error| error.of_file(path))
}

/// Returns a solid in the bytes of a file that `owner` owns. Verifies all of it if `verify` is true.
fn in_place<T: Stored, C: AsRef<[u8]> + Send + Sync + 'static>(owner: C, verify: bool) -> Result<T, Error> {
    let bytes = owner.as_ref();
    let (found, _) = Found::<T>::in_place(bytes)?;
    let metadata = if verify { found.layout.verify(bytes)? } else { found.layout.metadata(bytes)? };
    let channels = found.channels(bytes)?;
    found.attach(owner, metadata, channels, verify)
}

/// Returns a solid in a file in memory, after verifying all of it.
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

/// Refuses bytes that cannot be read in place, on this machine or at this address.
fn check_in_place(bytes: &[u8]) -> Result<(), FormatError> {
    if cfg!(target_endian = "big") {
        return Err(FormatError::Endianness);
    }
    if bytes.as_ptr().align_offset(align_of::<u64>()) != 0 {
        return Err(FormatError::Alignment);
    }
    Ok(())
}
