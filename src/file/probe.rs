//! Probing: reads the header and the section table of a file of any kind.

#[cfg(feature = "std")]
use super::buffer::regular_length;
use super::form::Form;
#[cfg(feature = "std")]
use super::header::HEADER_LENGTH;
use super::header::Head;
use super::kind::{Column, Kind, SECTION_REQUIRED};
use super::object::Object;
use super::section::{Entry, entries, read_table};
use crate::dexel::DexelFormat;
use crate::error::Error;
#[cfg(feature = "std")]
use crate::error::FormatError;
use crate::lattice::Frame;
use crate::lattice::axes;
use crate::memory;
use crate::octree::{Proof, Tag};
use alloc::vec::Vec;
#[cfg(feature = "std")]
use std::{fs::File, io::Read, path::Path};

/// The contents of a file's header and section table.
#[non_exhaustive]
#[derive(Debug, Clone, PartialEq)]
pub struct Probe {
    /// Major and minor version of the format.
    pub version: (u16, u16),
    /// The frame of the solid, with its depth.
    pub frame: Frame,
    /// The tag of the whole universe; BRANCH if it is divided. EMPTY for a tri-dexel model.
    pub root: Tag,
    /// The tag of the space outside of the universe: EMPTY, FULL or PARTIAL. EMPTY for a tri-dexel model.
    pub exterior: Tag,
    /// The proofs of the cells about the solid from which the tree was made. A tri-dexel model proves
    /// nothing.
    pub proof: Proof,
    /// True if no cell is undecided.
    pub binary: bool,
    /// Number of elements, without bricks; 0 for a tri-dexel model.
    pub elements: u64,
    /// Number of bricks; 0 for a tri-dexel model.
    pub bricks: u64,
    /// The stored properties of a tri-dexel model; `None` if the file holds an octree.
    pub dexels: Option<DexelProbe>,
    /// Length of the file in bytes.
    pub file_len: u64,
    /// The sections, in the order of the file.
    pub sections: Vec<Section>,
}

/// The stored properties of a tri-dexel model, according to the header and section table.
#[non_exhaustive]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DexelProbe {
    /// The stored properties of each interval.
    pub format: DexelFormat,
    /// True for the directions that have rays: x, y, z.
    pub directions: [bool; 3],
    /// Number of rays in the window of each direction, including empty ones. (The sizes of the windows are
    /// checked only when the model is read.)
    pub rays: [u64; 3],
    /// Number of intervals of each direction.
    pub intervals: [u64; 3],
}

/// A section of a file.
#[non_exhaustive]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Section {
    /// Number of the section's kind; see the [table](super#the-format).
    pub kind: u32,
    /// The object that owns the section: 0 is the solid.
    pub owner: u32,
    /// Name of the kind, if this library knows it.
    pub name: Option<&'static str>,
    /// Offset of the section in the file, in bytes.
    pub offset: u64,
    /// Length of the section in bytes.
    pub length: u64,
    /// Number of elements.
    pub count: u64,
    /// True if a reader must know the kind to read the file.
    pub required: bool,
}

/// Reads header and section table from `bytes`, the beginning of a file or all of it. Their checksums are
/// checked, and everything that follows from them alone. The presence and the contents of the rest of the
/// file are not checked. O(sections).
///
/// # Errors
/// [`Error::Format`]; this includes [`FormatError::Length`] if `bytes` end before the section table does.
pub fn probe_bytes(bytes: &[u8]) -> Result<Probe, Error> {
    let head = Head::read(bytes)?;
    let raw = head.table(bytes)?;
    read_table(&head, raw)?;
    let (main, minor) = (Object::main(&head.header), head.header.minor);
    let mut sections = memory::with_capacity(head.header.section_count as usize)?;
    sections.extend(entries(raw).map(|entry| Section {
        kind: entry.kind,
        owner: entry.owner,
        name: entry.known(&main, minor).map(Kind::name),
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
        binary: head.header.brick_planes != 2 && head.root != Tag::Partial,
        elements: if head.form.is_some() { 0 } else { head.header.elements },
        bricks: if head.form.is_some() { 0 } else { head.header.bricks },
        dexels: head.form.map(|Form { format, directions }| DexelProbe {
            format,
            directions,
            rays: axes(|axis| {
                let of_kind =
                    |entry: &Entry| entry.known(&main, minor) == Some(Kind::along(axis, Column::Starts));
                entries(raw).find(of_kind).map_or(0, |entry| entry.count - 1)
            }),
            intervals: main.intervals(),
        }),
        file_len: head.header.file_length,
        sections,
    })
}

/// Probes a file as [`probe_bytes`] does, and reads only header and section table from `reader`.
///
/// # Errors
/// The errors of [`probe_bytes`], and [`Error::Io`].
#[cfg(feature = "std")]
pub fn probe_from(mut reader: impl Read) -> Result<Probe, Error> {
    let mut bytes = Vec::new();
    reader.by_ref().take(HEADER_LENGTH as u64).read_to_end(&mut bytes)?;
    let table = Head::read(&bytes)?.table_range();
    reader.take(table.len() as u64).read_to_end(&mut bytes)?;
    probe_bytes(&bytes)
}

/// Probes the file at `path` as [`probe_bytes`] does, and also checks the file's length.
///
/// # Errors
/// [`Error::File`] with the path and one of these causes: the errors of [`probe_bytes`], and [`Error::Io`].
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
