//! The bytes of a file: header, table and sections of a solid and its channels.

use super::counts::{ENCODING_DICTIONARY, ENCODING_RAW};
use super::header::{HEADER_LENGTH, Header, MAGIC, MAJOR, OLDEST_MINOR};
use super::object::{CHANNEL, CHANNEL_MINOR, Object};
use super::section::{Entry, Kind, SECTION_ALIGNMENT};
use super::wire::Wire;
use crate::error::Error;
use crate::memory;
use crate::octree::brick::{Brick, BrickArray, Bricks, OwnedBricks};
use crate::octree::dictionary;
use crate::octree::metadata::MetadataLimit;
use crate::octree::view::{LevelCounts, OctreeRef};
use crate::octree::word::Planes;
use crate::octree::{ChannelRef, Metadata, Octree};
use alloc::vec::Vec;
use bytemuck::Zeroable;
use core::mem::offset_of;

/// The elements of a section as they lie in memory.
#[derive(Clone, Copy)]
enum Elements<'a> {
    Planes(&'a [Planes]),
    U16(&'a [u16]),
    U64(&'a [u64]),
    Levels(&'a [LevelCounts]),
    Objects(&'a [Object]),
    Bytes(&'a [u8]),
    /// Values of so many bytes, made of numbers of so many bytes.
    Values {
        bytes: &'a [u8],
        value: usize,
        number: usize,
    },
}

/// Takes bytes of a file, in order.
pub(super) type Sink<'s> = &'s mut dyn FnMut(&[u8]) -> Result<(), Error>;

impl Elements<'_> {
    fn size(&self) -> usize {
        match self {
            Elements::Planes(_) => size_of::<Planes>(),
            Elements::U16(_) => size_of::<u16>(),
            Elements::U64(_) => size_of::<u64>(),
            Elements::Levels(_) => size_of::<LevelCounts>(),
            Elements::Objects(_) => size_of::<Object>(),
            Elements::Bytes(_) => 1,
            Elements::Values { value, .. } => *value,
        }
    }

    fn count(&self) -> usize {
        match self {
            Elements::Planes(elements) => elements.len(),
            Elements::U16(elements) => elements.len(),
            Elements::U64(elements) => elements.len(),
            Elements::Levels(elements) => elements.len(),
            Elements::Objects(elements) => elements.len(),
            Elements::Bytes(elements) => elements.len(),
            Elements::Values { bytes, value, .. } => bytes.len() / value,
        }
    }

    /// Hands the bytes to `sink` in the file's order.
    fn write(&self, sink: Sink<'_>) -> Result<(), Error> {
        match self {
            Elements::Planes(elements) => write_elements(elements, sink),
            Elements::U16(elements) => write_elements(elements, sink),
            Elements::U64(elements) => write_elements(elements, sink),
            Elements::Levels(elements) => write_elements(elements, sink),
            Elements::Objects(elements) => write_elements(elements, sink),
            Elements::Bytes(elements) => sink(elements),
            Elements::Values { bytes, .. } if cfg!(target_endian = "little") => sink(bytes),
            Elements::Values { bytes, number, .. } => bytes.chunks_exact(*number).try_for_each(|raw| {
                let mut swapped = [0; size_of::<u32>()];
                swapped[..*number].copy_from_slice(raw);
                swapped[..*number].reverse();
                sink(&swapped[..*number])
            }),
        }
    }
}

fn write_elements<T: Wire>(elements: &[T], sink: Sink<'_>) -> Result<(), Error> {
    if cfg!(target_endian = "little") {
        return sink(bytemuck::cast_slice(elements));
    }
    let mut swapped = [T::zeroed(); 256];
    for piece in elements.chunks(swapped.len()) {
        for (swapped, element) in swapped.iter_mut().zip(piece) {
            *swapped = element.ordered();
        }
        sink(bytemuck::cast_slice(&swapped[..piece.len()]))?;
    }
    Ok(())
}

/// Writes a file into whatever sink it is given.
type WriteFile<'w> = &'w dyn Fn(Sink<'_>) -> Result<(), Error>;

/// A channel, with what a file needs besides.
struct ChannelParts<'a> {
    view: &'a ChannelRef<'a>,
    metadata: Vec<u8>,
    levels: Vec<LevelCounts>,
    encoded: Option<OwnedBricks>,
}

/// A section that is to be written: its owner, the kind and the elements.
type Section<'a> = (u32, Kind, Elements<'a>);

/// Lays out the file of `octree` and tells `deliver` its length and how to write it.
pub(super) fn assemble(
    octree: &Octree,
    deliver: &mut dyn FnMut(u64, WriteFile<'_>) -> Result<(), Error>,
) -> Result<(), Error> {
    let tree = octree.view();
    // Thereby the links, too, are the ones that the planes determine.
    tree.check()?;
    let metadata = bytes_of(octree.metadata(), MetadataLimit::SOLID)?;
    let encoded = dictionary::encode(&tree.bricks)?;
    let mut channels = memory::with_capacity(octree.channels().len())?;
    for channel in octree.channels() {
        let view = channel.view()?;
        view.check()?;
        channels.push(ChannelParts {
            view,
            metadata: bytes_of(channel.metadata(), MetadataLimit::CHANNEL)?,
            levels: view.count_levels(),
            encoded: dictionary::encode(&view.tree.bricks)?,
        });
    }
    let mut header = Header {
        magic: MAGIC,
        major: MAJOR,
        minor: if channels.is_empty() { OLDEST_MINOR } else { CHANNEL_MINOR },
        header_length: HEADER_LENGTH as u32,
        origin: tree.frame.origin().map(f64::to_bits),
        edge: tree.frame.edge().to_bits(),
        depth: tree.frame.depth(),
        root: tree.root as u8,
        exterior: tree.exterior as u8,
        proof: tree.proof.bits(),
        displacement: tree.proof.displacement().to_bits(),
        elements: tree.element_count(),
        bricks: tree.brick_count(),
        ..Header::zeroed()
    };
    let (bricks, coding) = brick_sections(encoded.as_ref().map_or(tree.bricks, OwnedBricks::view));
    header.brick_planes = coding.planes;
    header.brick_encoding = coding.encoding;
    header.segment_shift = coding.segment_shift;
    header.dictionary_entries = coding.entries;

    let mut objects: Vec<Object> = memory::with_capacity(1 + channels.len())?;
    objects.push(Object::solid(&header));
    let mut sections: Vec<Section<'_>> = memory::with_capacity((1 + channels.len()) * Kind::MOST)?;
    // In ascending order, as they lie in the file: what is asked first lies together.
    sections.push((0, Kind::Metadata, Elements::Bytes(&metadata)));
    sections.extend(tree_sections(0, tree, octree.counts(), bricks));
    for (channel, owner) in channels.iter().zip(1..) {
        let ChannelParts { view, metadata, levels, encoded } = channel;
        let bricks = encoded.as_ref().map_or(view.tree.bricks, OwnedBricks::view);
        let (bricks, coding) = brick_sections(bricks);
        objects.push(record(&header, view, &coding));
        sections.push((owner, Kind::Metadata, Elements::Bytes(metadata)));
        sections.extend(tree_sections(owner, &view.tree, levels, bricks));
        let (value, number) = (view.value_type.size(), view.value_type.scalar().size());
        sections.extend([
            (owner, Kind::Values, Elements::Values { bytes: view.values, value, number }),
            (owner, Kind::ValueRel, Elements::U16(view.value_rel)),
            (owner, Kind::ValueBase, Elements::U64(view.value_base)),
        ]);
    }
    let first = (0, Kind::Objects, Elements::Objects(&objects));
    let present =
        || core::iter::once(&first).chain(&sections).filter(|(_, _, elements)| elements.count() != 0);

    let head_length = HEADER_LENGTH + present().count() * size_of::<Entry>();
    let mut head = memory::filled(head_length, 0u8)?;
    let (start, table) = head.split_at_mut(HEADER_LENGTH);
    // Offsets cannot overflow: all of it lies in memory.
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

fn bytes_of(metadata: &Metadata, limit: MetadataLimit) -> Result<Vec<u8>, Error> {
    limit.check(metadata.len_in_file())?;
    metadata.to_bytes()
}

/// The record of a channel of the solid that the header describes.
fn record(header: &Header, channel: &ChannelRef<'_>, coding: &Coding) -> Object {
    let ChannelRef { tree, value_type, .. } = channel;
    Object {
        kind: CHANNEL,
        parent: 0,
        depth: tree.frame.depth(),
        root: tree.root as u8,
        brick_planes: coding.planes,
        brick_encoding: coding.encoding,
        segment_shift: coding.segment_shift,
        value_type: value_type.scalar() as u8,
        components: value_type.components() as u8,
        origin: header.origin,
        edge: header.edge,
        elements: tree.element_count(),
        bricks: tree.brick_count(),
        dictionary_entries: coding.entries,
        values: channel.value_count(),
        ..Object::zeroed()
    }
}

/// The sections of a tree: those of its bricks are given (raw bricks, indices, entries, segments).
fn tree_sections<'a>(
    owner: u32,
    tree: &OctreeRef<'a>,
    levels: &'a [LevelCounts],
    [raw, indices, entries, segments]: [Elements<'a>; 4],
) -> [Section<'a>; 8] {
    [
        (owner, Kind::Levels, Elements::Levels(levels)),
        (owner, Kind::Planes, Elements::Planes(tree.planes)),
        (owner, Kind::Rel, Elements::U16(tree.rel)),
        (owner, Kind::Base, Elements::U64(tree.base)),
        (owner, Kind::Bricks, raw),
        (owner, Kind::Indices, indices),
        (owner, Kind::Entries, entries),
        (owner, Kind::Segments, segments),
    ]
}

/// How bricks are coded, as a record says it.
struct Coding {
    planes: u8,
    encoding: u8,
    segment_shift: u8,
    entries: u64,
}

/// The sections that bricks take (raw bricks, indices, entries, segments), and what a record says of them.
fn brick_sections(bricks: Bricks<'_>) -> ([Elements<'_>; 4], Coding) {
    fn of<'a, T: Brick>(
        bricks: &BrickArray<'a, T>,
        planes: u8,
        elements: fn(&'a [T]) -> Elements<'a>,
    ) -> ([Elements<'a>; 4], Coding) {
        match *bricks {
            BrickArray::Raw(raw) => (
                [elements(raw), Elements::U16(&[]), elements(&[]), Elements::U64(&[])],
                Coding { planes, encoding: ENCODING_RAW, segment_shift: 0, entries: 0 },
            ),
            BrickArray::Dictionary { indices, entries, segments, shift } => (
                [elements(&[]), Elements::U16(indices), elements(entries), Elements::U64(segments)],
                Coding {
                    planes,
                    encoding: ENCODING_DICTIONARY,
                    segment_shift: shift,
                    entries: entries.len() as u64,
                },
            ),
        }
    }
    match bricks {
        Bricks::One(bricks) => of(&bricks, 1, Elements::U64),
        Bricks::Two(bricks) => of(&bricks, 2, Elements::Planes),
    }
}
