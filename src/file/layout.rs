//! All that must be known of a file to read its tree in place.

use super::counts::{Counts, ENCODING_RAW};
use super::field::illegal;
use super::header::Head;
use super::kind::Kind;
use super::object::{self, Object};
use super::section::{Sections, read_table};
use super::wire::{Wire, elements, wire_struct};
use crate::error::{Damage, Error, FormatError};
use crate::lattice::Frame;
use crate::octree::brick::{BrickArray, Bricks};
use crate::octree::view::{LevelCounts, MAX_ELEMENT_LEVELS, OctreeRef, element_levels};
use crate::octree::word::Planes;
use crate::octree::{Proof, Tag};
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
    pub sections: Sections,
    starts: Starts,
}

impl Layout {
    /// Checks header, section table, bounds, the records of objects, and that the level table's elements are
    /// the ones that are stored. O(sections + objects + depth); `bytes` are the whole file, of any alignment.
    pub(super) fn read(bytes: &[u8]) -> Result<Layout, Error> {
        let head = Head::read(bytes)?;
        head.demand_model(false)?;
        let (expected, found) = (head.header.file_length, bytes.len() as u64);
        if expected != found {
            return Err(FormatError::Length { expected, found }.into());
        }
        let sections = read_table(&head, head.table(bytes)?)?;
        object::check(&head.header, sections.bytes(bytes, Kind::Objects)?)?;
        let starts = starts(&head.header.counts(), sections.bytes(bytes, Kind::Levels)?)?;
        Ok(Layout { head, sections, starts })
    }

    /// The tree in `bytes`, whose numbers have this machine's order.
    pub(super) fn octree<'a>(&self, bytes: &'a [u8]) -> Result<OctreeRef<'a>, FormatError> {
        let Head { header, frame, root, exterior, proof, .. } = self.head;
        let tree = tree(&Object::main(&header), &self.sections, frame, &self.starts, bytes)?;
        Ok(OctreeRef { root, exterior, proof, ..tree })
    }
}

/// Where each element level of a tree begins.
pub(super) type Starts = [usize; MAX_ELEMENT_LEVELS + 1];

/// The numbers of a section, where they lie.
pub(super) fn cast<T: Pod>(bytes: &[u8]) -> Result<&[T], FormatError> {
    bytemuck::try_cast_slice(bytes).map_err(|_| FormatError::Alignment)
}

/// The arrays of an object with a tree, whose numbers have this machine's order, as a tree of cells that
/// prove nothing yet, with nothing outside.
pub(super) fn tree<'a>(
    object: &Object,
    sections: &Sections,
    frame: Frame,
    starts: &Starts,
    bytes: &'a [u8],
) -> Result<OctreeRef<'a>, FormatError> {
    fn array<'a, T: Pod>(
        object: &Object,
        sections: &Sections,
        bytes: &'a [u8],
    ) -> Result<BrickArray<'a, T>, FormatError> {
        let section = |kind| sections.bytes(bytes, kind);
        Ok(if object.brick_encoding == ENCODING_RAW {
            BrickArray::Raw(cast(section(Kind::Bricks)?)?)
        } else {
            BrickArray::Dictionary {
                indices: cast(section(Kind::Indices)?)?,
                entries: cast(section(Kind::Entries)?)?,
                segments: cast(section(Kind::Segments)?)?,
                shift: object.segment_shift,
            }
        })
    }
    let section = |kind| sections.bytes(bytes, kind);
    Ok(OctreeRef {
        frame,
        root: Tag::from_code(object.root),
        exterior: Tag::Empty,
        proof: Proof::CERTIFIED,
        planes: cast(section(Kind::Planes)?)?,
        rel: cast(section(Kind::Rel)?)?,
        base: cast(section(Kind::Base)?)?,
        bricks: match object.brick_planes {
            1 => Bricks::One(array(object, sections, bytes)?),
            _ => Bricks::Two(array(object, sections, bytes)?),
        },
        starts: *starts,
        table: Some(cast(section(Kind::Levels)?)?),
    })
}

/// Where each element level begins, from the level table: the elements of level e are the nodes of the
/// octree level at which their own cells lie. All reading code relies on what is checked here: the starts
/// ascend, bricks begin where elements end, and all elements and bricks belong to a level.
pub(super) fn starts(counts: &Counts, levels: &[u8]) -> Result<Starts, Error> {
    let &Counts { elements: elements_total, bricks, depth, root, .. } = counts;
    let count = element_levels(depth);
    let wrong = |level: usize| Error::Damaged(Damage::LevelTable { level: level as u8 });
    let total = elements_total.checked_add(bricks).and_then(|total| usize::try_from(total).ok());
    let total = total.ok_or(illegal("elements", elements_total))?;
    let mut nodes = [0u64; MAX_ELEMENT_LEVELS];
    for (level, counts) in elements::<LevelCounts>(levels).enumerate() {
        if level == 0 && counts.nodes != (root == Tag::Branch as u8) as u64 {
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
