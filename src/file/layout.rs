//! All that must be known of a file to read its tree in place.

use super::header::{ENCODING_RAW, Head, illegal};
use super::object::{self, Object};
use super::section::{Element, Kind, Table};
use super::wire::{Wire, elements, swap_all, wire_struct};
use crate::error::{Damage, Error, FormatError};
use crate::octree::Tag;
use crate::octree::brick::{BrickArray, Bricks};
use crate::octree::view::{LevelCounts, MAX_ELEMENT_LEVELS, OctreeRef, element_levels};
use crate::octree::word::Planes;
use bytemuck::Pod;
use core::mem::offset_of;

// The elements of sections are the structures in memory.
wire_struct!(Planes { lower, upper });
wire_struct!(LevelCounts { nodes, full, partial });

const _: () = {
    assert!(size_of::<Planes>() == 16 && align_of::<Planes>() == 8);
    assert!(offset_of!(Planes, lower) == 0 && offset_of!(Planes, upper) == 8);
    assert!(size_of::<LevelCounts>() == 24 && align_of::<LevelCounts>() == 8);
    assert!(offset_of!(LevelCounts, nodes) == 0);
    assert!(offset_of!(LevelCounts, full) == 8 && offset_of!(LevelCounts, partial) == 16);
};

/// All that must be known of a file to read its tree in place.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    pub head: Head,
    pub table: Table,
    starts: [usize; MAX_ELEMENT_LEVELS + 1],
}

impl Layout {
    /// Checks header, section table, bounds, the records of objects, and that the level table's elements are
    /// the ones that are stored. O(sections + objects + depth); `bytes` are the whole file, of any alignment.
    pub(super) fn read(bytes: &[u8]) -> Result<Layout, Error> {
        let head = Head::read(bytes)?;
        let (expected, found) = (head.header.file_length, bytes.len() as u64);
        if expected != found {
            return Err(FormatError::Length { expected, found }.into());
        }
        let table = Table::read(&head, head.table(bytes)?)?;
        object::check(&head.header, table.bytes(bytes, Kind::Objects)?)?;
        let starts = starts(&head, table.bytes(bytes, Kind::Levels)?)?;
        Ok(Layout { head, table, starts })
    }

    /// The tree in `bytes`, whose numbers have this machine's order.
    pub(super) fn octree<'a>(&self, bytes: &'a [u8]) -> Result<OctreeRef<'a>, FormatError> {
        fn cast<T: Pod>(bytes: &[u8]) -> Result<&[T], FormatError> {
            bytemuck::try_cast_slice(bytes).map_err(|_| FormatError::Alignment)
        }
        fn array<'a, T: Pod>(layout: &Layout, bytes: &'a [u8]) -> Result<BrickArray<'a, T>, FormatError> {
            let section = |kind| layout.table.bytes(bytes, kind);
            let header = &layout.head.header;
            Ok(if header.brick_encoding == ENCODING_RAW {
                BrickArray::Raw(cast(section(Kind::Bricks)?)?)
            } else {
                BrickArray::Dictionary {
                    indices: cast(section(Kind::Indices)?)?,
                    entries: cast(section(Kind::Entries)?)?,
                    segments: cast(section(Kind::Segments)?)?,
                    shift: header.segment_shift,
                }
            })
        }
        let section = |kind| self.table.bytes(bytes, kind);
        Ok(OctreeRef {
            frame: self.head.frame,
            root: self.head.root,
            exterior: self.head.exterior,
            proof: self.head.proof,
            planes: cast(section(Kind::Planes)?)?,
            rel: cast(section(Kind::Rel)?)?,
            base: cast(section(Kind::Base)?)?,
            bricks: match self.head.header.brick_planes {
                1 => Bricks::One(array(self, bytes)?),
                _ => Bricks::Two(array(self, bytes)?),
            },
            starts: self.starts,
            table: Some(cast(section(Kind::Levels)?)?),
        })
    }

    /// Reverses the bytes of every number in the solid's sections: from the file's order to that of a
    /// big-endian machine.
    pub(super) fn swap_bytes(&self, bytes: &mut [u8]) {
        for (i, kind) in Kind::ALL.into_iter().enumerate() {
            let range = self.table.range(kind);
            // What several sections share is turned once.
            if Kind::ALL[..i].iter().any(|&earlier| self.table.range(earlier) == range) {
                continue;
            }
            // All of them lie in the file, as `read` has checked.
            let Some(section) = bytes.get_mut(range.start as usize..range.end as usize) else { continue };
            match kind.element(self.head.header.brick_planes).0 {
                Element::Record => swap_all::<Object>(section),
                Element::U8 => {}
                Element::U16 => swap_all::<u16>(section),
                Element::U32 | Element::F32 => swap_all::<u32>(section),
                Element::U64 | Element::F64 => swap_all::<u64>(section),
            }
        }
    }
}

/// Where each element level begins, from the level table: the elements of level e are the nodes of the
/// octree level at which their own cells lie. All reading code relies on what is checked here: the starts
/// ascend, bricks begin where elements end, and all elements and bricks belong to a level.
fn starts(head: &Head, levels: &[u8]) -> Result<[usize; MAX_ELEMENT_LEVELS + 1], Error> {
    let (elements_total, bricks) = (head.header.elements, head.header.bricks);
    let depth = head.header.depth;
    let count = element_levels(depth);
    let wrong = |level: usize| Error::Damaged(Damage::LevelTable { level: level as u8 });
    let total = elements_total.checked_add(bricks).and_then(|total| usize::try_from(total).ok());
    let total = total.ok_or(illegal("elements", elements_total))?;
    let mut nodes = [0u64; MAX_ELEMENT_LEVELS];
    for (level, counts) in elements::<LevelCounts>(levels).enumerate() {
        if level == 0 && counts.nodes != (head.root == Tag::Branch) as u64 {
            return Err(wrong(0));
        }
        // Of an odd depth, the root element's own cell would lie one level above the universe.
        let padded = level + depth as usize % 2;
        let own = level == 0 || padded.is_multiple_of(2);
        if let Some(nodes) = nodes.get_mut(padded / 2).filter(|_| own && padded / 2 < count) {
            *nodes = counts.nodes;
        }
    }
    let mut starts = [total; MAX_ELEMENT_LEVELS + 1];
    starts[0] = 0;
    for e in 0..count {
        let level = (2 * e).saturating_sub(depth as usize % 2);
        let end = usize::try_from(nodes[e]).ok().and_then(|nodes| starts[e].checked_add(nodes));
        starts[e + 1] = end.filter(|&end| end <= total).ok_or(wrong(level))?;
    }
    // `elements` fits, because the total does.
    if starts[count] != total || starts[count - 1] != elements_total as usize {
        return Err(wrong(depth as usize));
    }
    Ok(starts)
}

#[cfg(test)]
mod tests {
    use super::super::header::{ENCODING_DICTIONARY, MAGIC};
    use super::*;
    use crate::control::Control;
    use crate::lattice::Frame;
    use crate::octree::Metadata;
    use crate::op::Rule;
    use crate::solid::Csg;
    use alloc::vec::Vec;

    /// What a big-endian machine does when it reads a file, seen from a little-endian one.
    #[test]
    fn every_number_of_a_file_is_swapped_once() {
        let frame = Frame::new([0.0; 3], 1.0, 7).unwrap();
        let ball = Csg::ball([0.5; 3], 0.45).unwrap();
        let ball = crate::op::build(&ball, &frame, Rule::Certified, &Control::threads(1)).unwrap();
        let mut metadata = Metadata::new();
        metadata.insert("units", "mm");
        let bytes = super::super::to_bytes(&ball.with_metadata(metadata)).unwrap();
        let layout = Layout::read(&bytes).unwrap();
        assert_eq!(layout.head.header.brick_encoding, ENCODING_DICTIONARY);
        let mut swapped = bytes.clone();
        layout.swap_bytes(&mut swapped);
        let head = layout.head.table_range().end;
        assert_eq!(swapped[..head], bytes[..head]);
        for kind in Kind::ALL {
            let size = match kind {
                Kind::Rel | Kind::Indices => 2,
                Kind::Metadata => 1,
                // The record is compared below.
                Kind::Objects => continue,
                _ => 8,
            };
            let section = layout.table.bytes(&bytes, kind).unwrap();
            let reversed: Vec<u8> =
                section.chunks(size).flat_map(|number| number.iter().rev().copied()).collect();
            assert_eq!(layout.table.bytes(&swapped, kind).unwrap(), reversed, "{kind:?}");
        }
        layout.swap_bytes(&mut swapped);
        assert_eq!(swapped, bytes);
        // Of sections that share their bytes, too: `rel` and the brick indices, `base` and the dictionary.
        let shared = include_bytes!("../../format_spec/vectors/valid/shared-sections.lfl");
        let both = Layout::read(shared).unwrap();
        assert_eq!(both.table.range(Kind::Base), both.table.range(Kind::Entries));
        let mut swapped = shared.to_vec();
        both.swap_bytes(&mut swapped);
        assert_eq!(both.table.bytes(&swapped, Kind::Base).unwrap(), 1u64.to_be_bytes());
        // And the structures themselves.
        let header = layout.head.header;
        assert_eq!(header.swap_bytes().file_length.to_be_bytes(), header.file_length.to_le_bytes());
        assert_eq!((header.swap_bytes().depth, header.swap_bytes().magic), (7, MAGIC));
        assert_eq!(header.swap_bytes().swap_bytes(), header);
        let object = Object::solid(&header);
        assert_eq!(object.swap_bytes().bricks.to_be_bytes(), header.bricks.to_le_bytes());
        assert_eq!((object.swap_bytes().depth, object.swap_bytes().swap_bytes()), (7, object));
    }
}
