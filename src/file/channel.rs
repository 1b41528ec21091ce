//! Channels in a file.

use super::compose::{Section, bytes_of};
use super::elements::Elements;
use super::field::{demand, illegal};
use super::header::Header;
use super::kind::{Element, Kind};
use super::layout::Layout;
use super::object::{CHANNEL, CHANNEL_MINOR, Object};
use super::section::{Sections, entries};
use super::tree::{self, Starts, starts};
use super::wire::elements;
use crate::error::{Error, FormatError};
use crate::lattice::Frame;
use crate::memory;
use crate::octree::brick::OwnedBricks;
use crate::octree::metadata::MetadataLimit;
use crate::octree::view::LevelCounts;
use crate::octree::{Channel, ChannelRef, Metadata, ScalarType, Tag, ValueType, dictionary};
use alloc::sync::Arc;
use alloc::vec::Vec;
use bytemuck::Zeroable;
use core::ops::Range;

/// Maximum number of channels of a file; part of the format.
const MOST_CHANNELS: usize = 256;

/// Maximum number of bytes of a channel's metadata; part of the format. It bounds the work of mapping a file.
const MAX_METADATA: u64 = 1 << 16;
const _: () = assert!(MAX_METADATA == MetadataLimit::CHANNEL.bytes() as u64);

/// The data needed to read a channel in place.
#[derive(Debug, Clone)]
pub(super) struct ChannelLayout {
    object: Object,
    frame: Frame,
    value_type: ValueType,
    sections: Sections,
    starts: Starts,
}

/// Reads the channels of a file whose solid has been checked, in the order of the file, which is that of
/// their names.
pub(super) fn read(layout: &Layout, bytes: &[u8]) -> Result<Vec<(ChannelLayout, Metadata)>, Error> {
    let mut channels: Vec<(ChannelLayout, Metadata)> = Vec::new();
    if layout.head.header.minor < CHANNEL_MINOR {
        return Ok(channels);
    }
    let table = layout.head.table(bytes)?;
    let objects = elements::<Object>(layout.sections.bytes(bytes, Kind::Objects)?);
    for (object, owner) in objects.zip(0u32..).filter(|(object, _)| object.kind == CHANNEL) {
        if channels.len() == MOST_CHANNELS {
            return Err(illegal("channels", MOST_CHANNELS as u64 + 1).into());
        }
        let channel = ChannelLayout::read(layout, object, owner, table, bytes)?;
        let metadata = Metadata::from_bytes(channel.sections.bytes(bytes, Kind::Metadata)?)?;
        let name = metadata.get("name").unwrap_or("");
        if channels.last().is_some_and(|(_, last)| last.get("name").unwrap_or("") >= name) {
            return Err(illegal("name of channel", owner).into());
        }
        memory::push(&mut channels, (channel, metadata))?;
    }
    Ok(channels)
}

impl ChannelLayout {
    fn read(
        layout: &Layout,
        object: Object,
        owner: u32,
        table: &[u8],
        bytes: &[u8],
    ) -> Result<ChannelLayout, Error> {
        let header = &layout.head.header;
        demand("channel's parent", object.parent, 0u64)?;
        demand("channel's origin", u64::from(object.origin != header.origin), 0u64)?;
        demand("channel's edge", object.edge, header.edge)?;
        demand("channel's exterior", object.exterior, 0u64)?;
        demand("channel's proof", object.proof, 0u64)?;
        demand("channel's displacement", object.displacement, 0u64)?;
        demand("planes of a brick", object.brick_planes, 2u64)?;
        if object.extents != [0; 3] {
            return Err(illegal("channel's extents", object.extents[0]).into());
        }
        if !header.is_newer() {
            let Object { form, reserved, reserved_middle, reserved_tail, .. } = object;
            if form != 0 || reserved != [0; 2] || reserved_middle != 0 || reserved_tail != [0; 16] {
                return Err(illegal("reserved field", owner).into());
            }
        }
        if object.root > 3 || object.root == Tag::Partial as u8 {
            return Err(illegal("root tag", object.root).into());
        }
        let frame = layout.head.frame.with_depth(object.depth);
        let frame = frame.map_err(|_| illegal("depth", object.depth))?;
        let scalar = ScalarType::ALL.into_iter().find(|&scalar| scalar as u8 == object.value_type);
        let scalar = scalar.ok_or(illegal("value type", object.value_type))?;
        let value_type = ValueType::new(scalar, object.components);
        let value_type = value_type.map_err(|_| illegal("components", object.components))?;
        object.counts().check()?;
        let own = entries(table).filter(|entry| entry.owner == owner);
        let sections = Sections::of(&object, header.minor, MAX_METADATA, own)?;
        let starts = starts(&object.counts(), sections.bytes(bytes, Kind::Levels)?)?;
        Ok(ChannelLayout { object, frame, value_type, sections, starts })
    }

    /// Returns the channel in `bytes`, whose numbers have this machine's byte order.
    fn view<'a>(&self, bytes: &'a [u8]) -> Result<ChannelRef<'a>, FormatError> {
        Ok(ChannelRef {
            tree: tree::view(&self.object, &self.sections, self.frame, &self.starts, bytes)?,
            value_type: self.value_type,
            value_rel: self.sections.array(bytes, Kind::ValueRel)?,
            value_base: self.sections.array(bytes, Kind::ValueBase)?,
            values: self.sections.bytes(bytes, Kind::Values)?,
        })
    }

    /// Checks the whole channel in `bytes`.
    pub(super) fn verify(&self, bytes: &[u8]) -> Result<(), Error> {
        self.view(bytes)?.check()
    }

    /// Returns the channel in the bytes of `owner`. Its links are checked on first use unless all of it is
    /// `verified`.
    pub(super) fn attach<C: AsRef<[u8]> + Send + Sync + 'static>(
        &self,
        owner: Arc<C>,
        metadata: Metadata,
        verified: bool,
    ) -> Result<Channel, Error> {
        Ok(Channel::attach(owner, metadata, verified, |owner| self.view(owner.as_ref()))?)
    }

    /// Returns the ranges of the channel's sections and the types of their numbers.
    pub(super) fn numbers(&self) -> impl Iterator<Item = (Range<u64>, Element)> {
        self.sections.numbers(&self.object)
    }
}

/// A channel with the additional data that a file needs.
pub(super) struct PreparedChannel<'a> {
    view: &'a ChannelRef<'a>,
    metadata: Vec<u8>,
    levels: Vec<LevelCounts>,
    encoded: Option<OwnedBricks>,
}

impl<'a> PreparedChannel<'a> {
    /// Checks the whole of `channel`, and prepares it.
    pub(super) fn of(channel: &'a Channel) -> Result<PreparedChannel<'a>, Error> {
        let view = channel.view()?;
        view.check()?;
        Ok(PreparedChannel {
            view,
            metadata: bytes_of(channel.metadata(), MetadataLimit::CHANNEL)?,
            levels: view.count_levels(),
            encoded: dictionary::encode(&view.tree.bricks)?,
        })
    }

    /// Appends the sections of the channel, which is object `owner` of the file; returns its record.
    pub(super) fn append_sections<'s>(
        &'s self,
        owner: u32,
        header: &Header,
        sections: &mut Vec<Section<'s>>,
    ) -> Object {
        let ChannelRef { tree, value_type, values, value_rel, value_base } = self.view;
        sections.push((owner, Kind::Metadata, Elements::Bytes(&self.metadata)));
        let coding = tree::append(owner, tree, &self.levels, &self.encoded, sections);
        let (value, number) = (value_type.size(), value_type.scalar().size());
        sections.extend([
            (owner, Kind::Values, Elements::Values { bytes: values, value, number }),
            (owner, Kind::ValueRel, Elements::U16(value_rel)),
            (owner, Kind::ValueBase, Elements::U64(value_base)),
        ]);
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
            values: self.view.value_count(),
            ..Object::zeroed()
        }
    }
}
