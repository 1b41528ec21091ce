//! Conversion from the file's byte order to that of a big-endian machine.

use super::channel::ChannelLayout;
use super::kind::{Element, Kind};
use super::layout::Layout;
use super::object::Object;
use super::wire::swap_all;
use crate::error::Error;
use crate::memory;
use crate::octree::Metadata;
use alloc::vec::Vec;

/// Reverses the bytes of every number in the sections of a solid and its channels. Several sections, also of
/// several objects, may share their bytes; these are reversed once.
///
/// # Errors
/// [`Error::OutOfMemory`].
pub(super) fn swap_bytes(
    layout: &Layout,
    channels: &[(ChannelLayout, Metadata)],
    bytes: &mut [u8],
) -> Result<(), Error> {
    let mut sections: Vec<_> = memory::with_capacity((1 + channels.len()) * Kind::MOST)?;
    sections.extend(layout.sections.numbers(&Object::main(&layout.head.header)));
    for (channel, _) in channels {
        sections.extend(channel.numbers());
    }
    // The check of the section table ensures that sections with the same bytes have the same elements.
    sections.sort_unstable_by_key(|(range, _)| range.start);
    sections.dedup_by_key(|(range, _)| range.start);
    for (range, element) in sections {
        // All of them lie in the file; this was checked.
        let Some(section) = bytes.get_mut(range.start as usize..range.end as usize) else { continue };
        match element {
            Element::Record => swap_all::<Object>(section),
            Element::U8 => {}
            Element::U16 => swap_all::<u16>(section),
            Element::U32 | Element::F32 => swap_all::<u32>(section),
            Element::U64 | Element::F64 => swap_all::<u64>(section),
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::counts::ENCODING_DICTIONARY;
    use super::super::header::{MAGIC, Model};
    use super::super::wire::Wire;
    use super::super::{channel, section};
    use super::*;

    /// Simulates on a little-endian machine how a big-endian machine reads a file.
    #[test]
    fn every_number_of_a_file_is_swapped_once() {
        let octree = include_bytes!("../../format_spec/vectors/valid/dictionary-certified.lfl");
        let octree = super::super::from_bytes(octree).unwrap();
        let mut metadata = Metadata::new();
        metadata.insert("units", "mm");
        let bytes = super::super::to_bytes(&octree.with_metadata(metadata)).unwrap();
        let layout = Layout::read(&bytes, Model::Octree).unwrap();
        assert_eq!(layout.head.header.brick_encoding, ENCODING_DICTIONARY);
        let mut swapped = bytes.clone();
        swap_bytes(&layout, &[], &mut swapped).unwrap();
        let head = layout.head.table_range().end;
        assert_eq!(swapped[..head], bytes[..head]);
        for kind in Kind::ALL.into_iter().take(10) {
            let size = match kind {
                Kind::Rel | Kind::Indices => 2,
                Kind::Metadata => 1,
                // The record is compared below.
                Kind::Objects => continue,
                _ => 8,
            };
            let section = layout.sections.bytes(&bytes, kind).unwrap();
            let reversed: Vec<u8> =
                section.chunks(size).flat_map(|number| number.iter().rev().copied()).collect();
            assert_eq!(layout.sections.bytes(&swapped, kind).unwrap(), reversed, "{kind:?}");
        }
        swap_bytes(&layout, &[], &mut swapped).unwrap();
        assert_eq!(swapped, bytes);
        // Sections that share their bytes: `rel` and the brick indices, `base` and the dictionary.
        let shared = include_bytes!("../../format_spec/vectors/valid/shared-sections.lfl");
        let both = Layout::read(shared, Model::Octree).unwrap();
        assert_eq!(both.sections.range(Kind::Base), both.sections.range(Kind::Entries));
        let mut swapped = shared.to_vec();
        swap_bytes(&both, &[], &mut swapped).unwrap();
        assert_eq!(both.sections.bytes(&swapped, Kind::Base).unwrap(), 1u64.to_be_bytes());
        // The structures themselves.
        let header = layout.head.header;
        assert_eq!(header.swap_bytes().file_length.to_be_bytes(), header.file_length.to_le_bytes());
        assert_eq!((header.swap_bytes().depth, header.swap_bytes().magic), (6, MAGIC));
        assert_eq!(header.swap_bytes().swap_bytes(), header);
        let object = Object::main(&header);
        assert_eq!(object.swap_bytes().bricks.to_be_bytes(), header.bricks.to_le_bytes());
        assert_eq!((object.swap_bytes().depth, object.swap_bytes().swap_bytes()), (6, object));
    }

    /// Sections of channels, some of which are shared with the solid or another channel.
    #[test]
    fn what_channels_share_is_swapped_once() {
        let bytes = include_bytes!("../../format_spec/vectors/valid/channels-shared.lfl");
        let layout = Layout::read(bytes, Model::Octree).unwrap();
        let channels = channel::read(&layout, bytes).unwrap();
        let table = layout.head.table(bytes).unwrap();
        let same = section::entries(table).filter(|entry| entry.same != 0 && entry.owner != 0).count();
        assert!(channels.len() > 1 && same > 3);
        let mut swapped = bytes.to_vec();
        swap_bytes(&layout, &channels, &mut swapped).unwrap();
        for entry in section::entries(table).filter(|entry| entry.kind != Kind::Objects as u32) {
            let part = |bytes: &[u8]| section::section(bytes, &entry.range()).unwrap().to_vec();
            let size = [8, 1, 2, 4, 8, 4, 8][entry.element_type as usize];
            let reversed: Vec<u8> =
                part(bytes).chunks(size).flat_map(|number| number.iter().rev().copied()).collect();
            assert_eq!(part(&swapped), reversed, "{} of {}", entry.kind, entry.owner);
        }
    }
}
