//! The ways in that need no operating system, and reading from paths.

use super::channel::{self, ChannelLayout};
#[cfg(feature = "std")]
use super::header::HEADER_LENGTH;
use super::header::Head;
use super::layout::Layout;
use super::section::{Kind, SECTION_REQUIRED, entries, read_table, section};
use super::swap::swap_bytes;
use crate::error::{Error, FormatError};
use crate::lattice::Frame;
use crate::memory;
use crate::octree::{Metadata, Octree, OctreeRef, Proof, Tag};
use alloc::sync::Arc;
use alloc::vec::Vec;
#[cfg(feature = "std")]
use std::{fs::File, io::Read, path::Path};

/// What the first bytes of a file say of it.
#[non_exhaustive]
#[derive(Debug, Clone, PartialEq)]
pub struct Probe {
    /// Major and minor version of the format.
    pub version: (u16, u16),
    /// Where the tree lies, and its depth.
    pub frame: Frame,
    /// The tag of the whole universe; BRANCH if it is cut.
    pub root: Tag,
    /// What is known of the space outside of the universe: EMPTY, FULL or PARTIAL.
    pub exterior: Tag,
    /// What the cells prove of the solid that the tree was made from.
    pub proof: Proof,
    /// Whether nothing is undecided.
    pub binary: bool,
    /// Elements, without bricks.
    pub elements: u64,
    /// Bricks.
    pub bricks: u64,
    /// Length of the file in bytes.
    pub file_len: u64,
    /// What the file consists of, in the order in which it lies there.
    pub sections: Vec<Section>,
}

/// A section of a file.
#[non_exhaustive]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Section {
    /// Number of its kind; see the [table](super#the-format).
    pub kind: u32,
    /// The object that it belongs to: 0 is the solid.
    pub owner: u32,
    /// Name of its kind, if this library knows it.
    pub name: Option<&'static str>,
    /// Where it begins in the file, in bytes.
    pub offset: u64,
    /// Its length in bytes.
    pub length: u64,
    /// Its length in elements.
    pub count: u64,
    /// Whether a reader must know the kind to read the file.
    pub required: bool,
}

/// Reads header and section table from `bytes`, the beginning of a file or all of it. Their checksums and
/// everything that can be known from them is checked; whether the rest of the file is there and good is not.
/// O(sections).
///
/// # Errors
/// [`Error::Format`]; among them [`FormatError::Length`] if `bytes` end before the section table does.
pub fn probe_bytes(bytes: &[u8]) -> Result<Probe, Error> {
    let head = Head::read(bytes)?;
    let raw = head.table(bytes)?;
    read_table(&head, raw)?;
    let mut sections = memory::with_capacity(head.header.section_count as usize)?;
    sections.extend(entries(raw).map(|entry| Section {
        kind: entry.kind,
        owner: entry.owner,
        name: entry.known().map(Kind::name),
        offset: entry.offset,
        length: entry.length,
        count: entry.count,
        required: entry.flags & SECTION_REQUIRED != 0,
    }));
    Ok(Probe {
        version: (head.header.major, head.header.minor),
        frame: head.frame,
        root: head.root,
        exterior: head.exterior,
        proof: head.proof,
        binary: head.header.brick_planes == 1 && head.root != Tag::Partial,
        elements: head.header.elements,
        bricks: head.header.bricks,
        file_len: head.header.file_length,
        sections,
    })
}

/// As [`probe_bytes`], reading from `reader` no more than header and section table.
///
/// # Errors
/// As [`probe_bytes`], and [`Error::Io`].
#[cfg(feature = "std")]
pub fn probe_from(mut reader: impl Read) -> Result<Probe, Error> {
    let mut bytes = Vec::new();
    reader.by_ref().take(HEADER_LENGTH as u64).read_to_end(&mut bytes)?;
    let table = Head::read(&bytes)?.table_range();
    reader.take(table.len() as u64).read_to_end(&mut bytes)?;
    probe_bytes(&bytes)
}

/// As [`probe_bytes`] for the file at `path`, whose length is checked too.
///
/// # Errors
/// [`Error::File`] with the path and one of these causes: as [`probe_bytes`], and [`Error::Io`].
#[cfg(feature = "std")]
pub fn probe(path: impl AsRef<Path>) -> Result<Probe, Error> {
    let path = path.as_ref();
    probe_path(path).map_err(|error| error.of_file(path))
}

#[cfg(feature = "std")]
fn probe_path(path: &Path) -> Result<Probe, Error> {
    let file = File::open(path)?;
    let found = regular_length(&file)?;
    let probe = probe_from(file)?;
    match found {
        Some(found) if found != probe.file_len => {
            Err(FormatError::Length { expected: probe.file_len, found }.into())
        }
        _ => Ok(probe),
    }
}

/// The tree in `bytes`, a whole file, read where it lies: no copy, no allocation.
///
/// Header, section table, bounds and level table are checked, and nothing else: O(sections + depth). Of a
/// file that is damaged elsewhere all queries are still memory-safe, and end after bounded work; see
/// [`OctreeRef`]. [`verify`] checks all of it.
///
/// The bytes must begin on an address that is a multiple of 8. `include_bytes!` does not see to that by
/// itself; a `#[repr(align(8))]` struct around the array does.
///
/// # Errors
/// [`Error::Format`], [`Error::Damaged`] if the level table contradicts the header,
/// [`FormatError::Endianness`] on big-endian machines.
pub fn view(bytes: &[u8]) -> Result<OctreeRef<'_>, Error> {
    Ok(viewed(bytes)?.1)
}

/// Checks everything that the format promises: what [`view`] checks, all checksums, that padding is zero,
/// that the metadata can be read, and that the tree and the channels are well-formed and in canonical form
/// ([`OctreeRef::check`], [`ChannelRef::check`](crate::ChannelRef::check)). Only whether a writer chose the
/// encoding of the bricks by the rule is not checked: any encoding is readable. O(n) in the lengths of all
/// sections, of which several may have the same bytes; needs what `view` needs of the bytes, and memory for
/// the metadata.
///
/// # Errors
/// [`Error::Format`] or [`Error::Damaged`]; [`Error::OutOfMemory`].
pub fn verify(bytes: &[u8]) -> Result<(), Error> {
    let (layout, tree) = viewed(bytes)?;
    verify_contents(&layout, bytes)?;
    // All records before any contents, so that every way in that verifies finds the same thing first.
    let channels = channel::read(&layout, bytes)?;
    tree.check()?;
    channels.iter().try_for_each(|(channel, _)| channel.verify(bytes))
}

/// The tree in `bytes`, a whole file, copied and [verified](verify). The bytes may have any alignment, and
/// the machine any byte order.
///
/// # Errors
/// As [`verify`].
pub fn from_bytes(bytes: &[u8]) -> Result<Octree, Error> {
    // Refused before anything is allocated.
    let layout = Layout::read(bytes)?;
    let mut buffer = Buffer::default();
    buffer.extend(bytes.len())?;
    buffer.bytes_mut().copy_from_slice(bytes);
    adopt(layout, buffer)
}

/// The tree in `bytes`, a whole file that lives as long as the program (one that was linked into it, say),
/// read where it lies as by [`view`].
///
/// # Errors
/// As [`view`], and [`FormatError::Metadata`].
pub fn from_static(bytes: &'static [u8]) -> Result<Octree, Error> {
    let (layout, _) = viewed(bytes)?;
    let metadata = metadata(&layout, bytes)?;
    let channels = channel::read(&layout, bytes)?;
    let owner = Arc::new(bytes);
    let octree = Octree::attach(owner.clone(), metadata, |bytes| layout.octree(bytes))?;
    with_channels(octree, owner, channels, false)
}

/// The tree in the file at `path`, read into memory and [verified](verify). Later changes of the file do not
/// matter. A pipe or device may be read too.
///
/// # Errors
/// [`Error::File`] with the path and one of these causes: as [`verify`], and [`Error::Io`].
#[cfg(feature = "std")]
pub fn open(path: impl AsRef<Path>) -> Result<Octree, Error> {
    let path = path.as_ref();
    open_path(path).map_err(|error| error.of_file(path))
}

#[cfg(feature = "std")]
fn open_path(path: &Path) -> Result<Octree, Error> {
    let mut file = File::open(path)?;
    let known = regular_length(&file)?;
    let mut start = Vec::new();
    file.by_ref().take(HEADER_LENGTH as u64).read_to_end(&mut start)?;
    let expected = Head::read(&start)?.header.file_length;
    match known {
        Some(found) if found != expected => return Err(FormatError::Length { expected, found }.into()),
        _ => {}
    }
    let length = usize::try_from(expected).map_err(|_| Error::OutOfMemory)?;
    let mut buffer = Buffer::default();
    let mut filled = start.len();
    // Where nobody knows the length beforehand, memory is only asked for as bytes arrive.
    let most = |filled: usize| if known.is_some() { length } else { filled.saturating_mul(2).max(1 << 16) };
    buffer.extend(length.min(most(0)))?;
    // A header's file is longer than the header.
    buffer.bytes_mut()[..filled].copy_from_slice(&start);
    while filled < length {
        if filled == buffer.length {
            buffer.extend(length.min(most(filled)))?;
        }
        match file.read(&mut buffer.bytes_mut()[filled..]) {
            Ok(0) => return Err(FormatError::Length { expected, found: filled as u64 }.into()),
            Ok(count) => filled += count,
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error.into()),
        }
    }
    if file.take(1).read_to_end(&mut start)? != 0 {
        return Err(FormatError::Length { expected, found: expected + 1 }.into());
    }
    adopt(Layout::read(buffer.bytes())?, buffer)
}

/// The length of a file that has one: not of a pipe or device.
#[cfg(feature = "std")]
fn regular_length(file: &File) -> Result<Option<u64>, Error> {
    let metadata = file.metadata()?;
    Ok(metadata.is_file().then_some(metadata.len()))
}

/// The tree in `bytes` and what was found on the way to it.
pub(super) fn viewed(bytes: &[u8]) -> Result<(Layout, OctreeRef<'_>), Error> {
    if cfg!(target_endian = "big") {
        return Err(FormatError::Endianness.into());
    }
    let layout = Layout::read(bytes)?;
    if bytes.as_ptr().align_offset(align_of::<u64>()) != 0 {
        return Err(FormatError::Alignment.into());
    }
    let tree = layout.octree(bytes)?;
    Ok((layout, tree))
}

/// The facts that the file carries along.
pub(super) fn metadata(layout: &Layout, bytes: &[u8]) -> Result<Metadata, Error> {
    Metadata::from_bytes(layout.sections.bytes(bytes, Kind::Metadata)?)
}

/// Everything but the tree itself: checksums, padding, metadata. The bytes are still in the file's order.
pub(super) fn verify_contents(layout: &Layout, bytes: &[u8]) -> Result<Metadata, Error> {
    let mut end = layout.head.table_range().end as u64;
    for entry in entries(layout.head.table(bytes)?).filter(|entry| entry.same == 0) {
        let padding = section(bytes, &(end..entry.offset))?;
        if let Some(&byte) = padding.iter().find(|&&byte| byte != 0) {
            return Err(FormatError::Field { name: "padding", value: byte.into() }.into());
        }
        if crc32fast::hash(section(bytes, &entry.range())?) != entry.crc {
            return Err(FormatError::Checksum { name: entry.name() }.into());
        }
        end = entry.range().end;
    }
    metadata(layout, bytes)
}

/// A file in memory that begins on a multiple of 8.
#[derive(Default)]
struct Buffer {
    words: Vec<u64>,
    length: usize,
}

impl Buffer {
    /// Grows to `length` bytes; those that are new are zero.
    fn extend(&mut self, length: usize) -> Result<(), Error> {
        let words = length.div_ceil(size_of::<u64>());
        let fresh = words.saturating_sub(self.words.len());
        self.words.try_reserve_exact(fresh)?;
        self.words.resize(words.max(self.words.len()), 0);
        self.length = length;
        Ok(())
    }

    fn bytes(&self) -> &[u8] {
        &bytemuck::cast_slice(&self.words)[..self.length]
    }

    fn bytes_mut(&mut self) -> &mut [u8] {
        &mut bytemuck::cast_slice_mut(&mut self.words)[..self.length]
    }
}

impl AsRef<[u8]> for Buffer {
    fn as_ref(&self) -> &[u8] {
        self.bytes()
    }
}

/// An octree over a file in memory, once all of it is verified.
fn adopt(layout: Layout, mut buffer: Buffer) -> Result<Octree, Error> {
    let metadata = verify_contents(&layout, buffer.bytes())?;
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
