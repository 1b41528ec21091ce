//! Composition of a file from its header, its records and its sections.

use super::elements::{Elements, Sink};
use super::header::{HEADER_LENGTH, Header};
use super::kind::Kind;
use super::object::Object;
use super::section::{Entry, SECTION_ALIGNMENT};
use super::wire::Wire;
use crate::error::Error;
use crate::memory;
use crate::octree::Metadata;
use crate::octree::metadata::MetadataLimit;
use alloc::vec::Vec;
use bytemuck::Zeroable;
use core::mem::offset_of;

/// A function that writes a file into a given sink.
pub(super) type WriteFile<'w> = &'w dyn Fn(Sink<'_>) -> Result<(), Error>;

/// A function that receives the length of a file and a function that writes it.
pub(super) type Deliver<'d> = &'d mut dyn FnMut(u64, WriteFile<'_>) -> Result<(), Error>;

/// A section to write: its owner, its kind and its elements.
pub(super) type Section<'a> = (u32, Kind, Elements<'a>);

/// Lays out a file and calls `deliver` with its length and a function that writes it. The first section, the
/// records, is added to `sections`. The sections must be in the order of owners and kinds; sections without
/// elements are left out.
pub(super) fn compose(
    mut header: Header,
    objects: &[Object],
    sections: &[Section<'_>],
    deliver: Deliver<'_>,
) -> Result<(), Error> {
    let first = (0, Kind::Objects, Elements::Objects(objects));
    let present =
        || core::iter::once(&first).chain(sections).filter(|(_, _, elements)| elements.count() != 0);

    let head_length = HEADER_LENGTH + present().count() * size_of::<Entry>();
    let mut head = memory::filled(head_length, 0u8)?;
    let (start, table) = head.split_at_mut(HEADER_LENGTH);
    // Offsets cannot overflow: everything lies in memory.
    let mut end = head_length as u64;
    for (&(owner, kind, elements), raw) in present().zip(table.chunks_exact_mut(size_of::<Entry>())) {
        let mut crc = crc32fast::Hasher::new();
        elements.write(&mut |bytes| {
            crc.update(bytes);
            Ok(())
        })?;
        let (element, components) = kind.element(&objects[owner as usize]);
        let entry = Entry {
            kind: kind as u32,
            owner,
            element_type: element as u8,
            components,
            flags: kind.flags(),
            offset: end.next_multiple_of(SECTION_ALIGNMENT),
            length: elements.count() as u64 * elements.size() as u64,
            count: elements.count() as u64,
            crc: crc.finalize(),
            ..Entry::zeroed()
        };
        end = entry.range().end;
        header.section_count += 1;
        raw.copy_from_slice(bytemuck::bytes_of(&entry.ordered()));
    }
    header.file_length = end;
    header.table_crc = crc32fast::hash(table);
    start.copy_from_slice(bytemuck::bytes_of(&header.ordered()));
    header.header_crc = crc32fast::hash(&start[..offset_of!(Header, header_crc)]);
    start.copy_from_slice(bytemuck::bytes_of(&header.ordered()));

    deliver(end, &|sink| {
        sink(&head)?;
        let mut end = head_length;
        for (_, _, elements) in present() {
            let start = end.next_multiple_of(SECTION_ALIGNMENT as usize);
            sink(&[0; SECTION_ALIGNMENT as usize][..start - end])?;
            elements.write(sink)?;
            end = start + elements.count() * elements.size();
        }
        Ok(())
    })
}

/// Returns the metadata in the form of a file.
pub(super) fn bytes_of(metadata: &Metadata, limit: MetadataLimit) -> Result<Vec<u8>, Error> {
    limit.check(metadata.len_in_file())?;
    metadata.to_bytes()
}
