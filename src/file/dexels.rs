//! Files of tri-dexel models: the functions of [`file`](super) for [`TriDexel`] in place of [`Octree`](crate::Octree).
//!
//! The format is the same, version 0.3: header, section table, and sections that are the model's arrays as they lie in
//! memory. A file holds an octree or a tri-dexel model, and the functions for one refuse a file of the other with
//! [`FormatError::OtherModel`](crate::FormatError::OtherModel). [`file::probe`](super::probe) and
//! [`file::verify`](super::verify) know both.
//!
//! | function | reads | checks | cost |
//! |---|---|---|---|
//! | [`map`], [`view`], [`from_static`] (bytes) | in place | header, section table, bounds, objects, windows | O(sections + objects) |
//! | [`map_verified`], [`verify`](super::verify) (bytes) | in place | everything | O(n) |
//! | [`open`], [`from_bytes`] | a copy | everything | O(n) |
//!
//! After [`view`], [`map`] or [`from_static`] nothing has looked at the intervals. Whatever they are, asking for single
//! rays and cells is safe, and meets each interval at most once; what is read is what stands there. Operations on the whole
//! model, such as Booleans, [check](TriDexelRef::check) it first and return
//! [`Error::DamagedRays`] if it is damaged.
//!
//! ```no_run
//! use leafless::{Control, DexelEditor, file::dexels};
//! let part = dexels::open("part.lfl")?;
//! let tool = dexels::open("tool.lfl")?;
//! let mut editor = DexelEditor::new(part.view())?;
//! editor.subtract(tool.view(), &Control::default())?;
//! dexels::save(&editor.freeze(&Control::default())?, "cut.lfl")?;
//! # Ok::<(), leafless::Error>(())
//! ```

#[cfg(feature = "std")]
use super::buffer;
use super::buffer::Buffer;
use super::contents::{check_in_place, metadata, verify_contents};
use super::dexel_assemble::assemble;
use super::dexel_layout::DexelLayout;
#[cfg(feature = "mmap")]
use super::mapping::mapping;
#[cfg(feature = "std")]
use super::replace::replace;
use super::swap::swap_dexels;
use crate::dexel::{TriDexel, TriDexelRef};
use crate::error::Error;
use alloc::sync::Arc;
use alloc::vec::Vec;
#[cfg(feature = "std")]
use std::{io::Write, path::Path};

/// The file of `model`, in memory.
///
/// The bytes depend on the model and its metadata alone: equal models with equal metadata give equal bytes. The model is
/// [checked](TriDexelRef::check) first, so that every file that is written can be read. O(n).
///
/// # Errors
/// [`Error::DamagedRays`] if the model is a mapped one that nobody has verified, and is damaged; [`Error::Argument`] if the
/// metadata take more than 1 MiB; [`Error::OutOfMemory`].
pub fn to_bytes(model: &TriDexel) -> Result<Vec<u8>, Error> {
    let mut file = Vec::new();
    assemble(model, &mut |length, write| {
        let length = usize::try_from(length).map_err(|_| Error::OutOfMemory)?;
        file.try_reserve_exact(length)?;
        write(&mut |bytes| {
            file.extend_from_slice(bytes);
            Ok(())
        })
    })?;
    Ok(file)
}

/// Writes the file of `model` to `out`, the same bytes as [`to_bytes`], in a few large pieces: no buffer is needed around
/// `out`, and the file is never in memory as a whole. `out` is flushed at the end.
///
/// # Errors
/// As [`to_bytes`], before anything is written; [`Error::Io`] as `out` returns it.
#[cfg(feature = "std")]
pub fn write_to(model: &TriDexel, mut out: impl Write) -> Result<(), Error> {
    assemble(model, &mut |_, write| write(&mut |bytes| Ok(out.write_all(bytes)?)))?;
    Ok(out.flush()?)
}

/// Saves `model` in the file at `path`: at any moment, also after a crash or a power failure, there is the old file or the
/// new one, each complete. What [`file::save`](super::save) says of permissions, links, pipes and temporary files holds
/// here, too.
///
/// # Errors
/// As [`to_bytes`], and [`Error::File`] with the path and the cause [`Error::Io`]. The old file is then as it was, unless it
/// is the very last step that fails, synchronising the directory.
#[cfg(feature = "std")]
pub fn save(model: &TriDexel, path: impl AsRef<Path>) -> Result<(), Error> {
    replace(path, |file| write_to(model, file))
}

/// The model in `bytes`, a whole file, read where it lies: no copy, no allocation.
///
/// Header, section table, bounds and windows are checked, and nothing else: O(sections + objects). What holds of damaged
/// intervals is said [above](self). The bytes must begin on an address that is a multiple of 8.
///
/// # Errors
/// [`Error::Format`]; among them [`FormatError::OtherModel`](crate::FormatError::OtherModel) for the file of an octree,
/// and [`FormatError::Endianness`](crate::FormatError::Endianness) on big-endian machines.
pub fn view(bytes: &[u8]) -> Result<TriDexelRef<'_>, Error> {
    let layout = DexelLayout::read(bytes)?;
    check_in_place(bytes)?;
    Ok(layout.view(bytes, false)?)
}

/// Checks everything that the format promises of a tri-dexel model in `bytes`.
pub(super) fn verify_dexels(bytes: &[u8]) -> Result<(), Error> {
    let layout = DexelLayout::read(bytes)?;
    check_in_place(bytes)?;
    verify_contents(&layout.head, &layout.sections, bytes)?;
    layout.view(bytes, false)?.check()
}

/// The model in `bytes`, a whole file, copied and [verified](super::verify). The bytes may have any alignment, and the
/// machine any byte order.
///
/// # Errors
/// [`Error::Format`] or [`Error::DamagedRays`]; [`Error::OutOfMemory`].
pub fn from_bytes(bytes: &[u8]) -> Result<TriDexel, Error> {
    // Refused before anything is allocated.
    let layout = DexelLayout::read(bytes)?;
    adopt(layout, Buffer::copy(bytes)?)
}

/// The model in `bytes`, a whole file that lives as long as the program (one that was linked into it, say), read where it
/// lies as by [`view`].
///
/// # Errors
/// As [`view`], and [`FormatError::Metadata`](crate::FormatError::Metadata).
pub fn from_static(bytes: &'static [u8]) -> Result<TriDexel, Error> {
    let layout = DexelLayout::read(bytes)?;
    check_in_place(bytes)?;
    let metadata = metadata(&layout.sections, bytes)?;
    Ok(TriDexel::attach(Arc::new(bytes), metadata, |bytes| layout.view(bytes, false))?)
}

/// The model in the file at `path`, read into memory and [verified](super::verify). Later changes of the file do not
/// matter. A pipe or device may be read too.
///
/// # Errors
/// [`Error::File`] with the path and one of these causes: as [`from_bytes`], and [`Error::Io`].
#[cfg(feature = "std")]
pub fn open(path: impl AsRef<Path>) -> Result<TriDexel, Error> {
    let path = path.as_ref();
    let read = || {
        let buffer = buffer::read(path, |head| head.demand_model(true))?;
        adopt(DexelLayout::read(buffer.bytes())?, buffer)
    };
    read().map_err(|error| error.of_file(path))
}

/// The model in the file at `path`, mapped into memory: nothing is copied, and only what is asked for is ever read from
/// disk. Header, section table, bounds, windows and metadata are checked, and nothing else: O(sections + objects), some
/// microseconds for a file of any size. What holds of damaged intervals is said [above](self).
///
/// # Errors
/// [`Error::File`] with the path and one of these causes: [`Error::Io`];
/// [`FormatError::NotRegular`](crate::FormatError::NotRegular) if there is no regular file at `path`; else as [`view`],
/// and [`FormatError::Metadata`](crate::FormatError::Metadata).
///
/// # Safety
/// As [`file::map`](super::map()): while the mapping lives, nobody may write to the file or make it shorter.
#[cfg(feature = "mmap")]
#[allow(unsafe_code)]
pub unsafe fn map(path: impl AsRef<Path>) -> Result<TriDexel, Error> {
    // SAFETY: the caller promises what `mapped` asks for.
    unsafe { mapped(path.as_ref(), false) }.map_err(|error| error.of_file(path.as_ref()))
}

/// As [`map`], but verifies all of the file first, in one scan: everything that [`verify`](super::verify) checks.
///
/// # Errors
/// As [`map`], and as [`verify`](super::verify).
///
/// # Safety
/// As [`map`]. What was verified may be changed afterwards by whoever breaks that promise.
#[cfg(feature = "mmap")]
#[allow(unsafe_code)]
pub unsafe fn map_verified(path: impl AsRef<Path>) -> Result<TriDexel, Error> {
    // SAFETY: the caller promises what `mapped` asks for.
    unsafe { mapped(path.as_ref(), true) }.map_err(|error| error.of_file(path.as_ref()))
}

/// # Safety
/// As [`map`].
#[cfg(feature = "mmap")]
#[allow(unsafe_code)]
unsafe fn mapped(path: &Path, verify: bool) -> Result<TriDexel, Error> {
    // SAFETY: the caller promises what `mapping` asks for.
    let Some(map) = unsafe { mapping(path) }? else {
        // Nothing can be mapped; the error is the one of any file that is too short.
        return from_bytes(&[]);
    };
    let layout = DexelLayout::read(&map)?;
    check_in_place(&map)?;
    let DexelLayout { head, sections, .. } = &layout;
    let metadata = if verify { verify_contents(head, sections, &map)? } else { metadata(sections, &map)? };
    attach(&layout, metadata, Arc::new(map), verify)
}

/// A model over a file in memory, once all of it is verified.
fn adopt(layout: DexelLayout, mut buffer: Buffer) -> Result<TriDexel, Error> {
    let metadata = verify_contents(&layout.head, &layout.sections, buffer.bytes())?;
    if cfg!(target_endian = "big") {
        swap_dexels(&layout.head.header, &layout.sections, buffer.bytes_mut())?;
    }
    attach(&layout, metadata, Arc::new(buffer), true)
}

/// The model in the bytes that `owner` has, checked if it is to be verified.
fn attach<C: AsRef<[u8]> + Send + Sync + 'static>(
    layout: &DexelLayout,
    metadata: crate::octree::Metadata,
    owner: Arc<C>,
    verify: bool,
) -> Result<TriDexel, Error> {
    TriDexel::attach(owner, metadata, |owner| {
        let view = layout.view(owner.as_ref(), verify)?;
        if verify {
            view.check()?;
        }
        Ok(view)
    })
}
