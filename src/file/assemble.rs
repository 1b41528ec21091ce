//! The file of an octree and its channels: header, records and sections.

use super::compose::{Deliver, Section, bytes_of, compose};
use super::counts::{ENCODING_DICTIONARY, ENCODING_RAW};
use super::elements::Elements;
use super::header::{HEADER_LENGTH, Header, MAGIC, MAJOR, OLDEST_MINOR};
use super::kind::Kind;
use super::object::{CHANNEL, CHANNEL_MINOR, Object};
use crate::error::Error;
use crate::memory;
use crate::octree::brick::{Brick, BrickArray, Bricks, OwnedBricks};
use crate::octree::dictionary;
use crate::octree::metadata::MetadataLimit;
use crate::octree::view::{LevelCounts, OctreeRef};
use crate::octree::{ChannelRef, Octree};
use alloc::vec::Vec;
use bytemuck::Zeroable;

/// A channel, with what a file needs besides.
struct ChannelParts<'a> {
    view: &'a ChannelRef<'a>,
    metadata: Vec<u8>,
    levels: Vec<LevelCounts>,
    encoded: Option<OwnedBricks>,
}

/// Lays out the file of `octree` and tells `deliver` its length and how to write it.
pub(super) fn assemble(octree: &Octree, deliver: Deliver<'_>) -> Result<(), Error> {
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
    objects.push(Object::main(&header));
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
    compose(header, &objects, &sections, deliver)
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
