//! The sections of a tree's arrays, for an octree or a channel.

use super::compose::Section;
use super::counts::{Counts, ENCODING_DICTIONARY, ENCODING_RAW};
use super::elements::Elements;
use super::field::illegal;
use super::kind::Kind;
use super::object::Object;
use super::section::Sections;
use super::wire::{Wire, elements, wire_struct};
use crate::error::{Damage, Error, FormatError};
use crate::lattice::Frame;
use crate::octree::brick::{BrickArray, Bricks, OwnedBricks};
use crate::octree::view::{LevelCounts, MAX_ELEMENT_LEVELS, OctreeRef, element_levels};
use crate::octree::word::Planes;
use crate::octree::{Proof, Tag};
use alloc::vec::Vec;
use bytemuck::Pod;
use core::mem::offset_of;

// The elements of sections have the layout of the structures in memory.
wire_struct!(Planes { lower, upper });
wire_struct!(LevelCounts { nodes, full, partial });

const _: () = {
    assert!(size_of::<Planes>() == 16 && align_of::<Planes>() == 8);
    assert!(offset_of!(Planes, lower) == 0 && offset_of!(Planes, upper) == 8);
    assert!(size_of::<LevelCounts>() == 24 && align_of::<LevelCounts>() == 8);
    assert!(offset_of!(LevelCounts, nodes) == 0);
    assert!(offset_of!(LevelCounts, full) == 8 && offset_of!(LevelCounts, partial) == 16);
};

/// The start of each element level of a tree.
pub(super) type Starts = [usize; MAX_ELEMENT_LEVELS + 1];

/// Returns a view of the arrays of an object with a tree, whose numbers have this machine's byte order. Its
/// exterior is EMPTY and its proof is that of certified cells; octrees replace both.
pub(super) fn view<'a>(
    object: &Object,
    sections: &Sections,
    frame: Frame,
    starts: &Starts,
    bytes: &'a [u8],
) -> Result<OctreeRef<'a>, FormatError> {
    fn bricks<'a, T: Pod>(
        object: &Object,
        sections: &Sections,
        bytes: &'a [u8],
    ) -> Result<BrickArray<'a, T>, FormatError> {
        Ok(if object.brick_encoding == ENCODING_RAW {
            BrickArray::Raw(sections.array(bytes, Kind::Bricks)?)
        } else {
            BrickArray::Dictionary {
                indices: sections.array(bytes, Kind::Indices)?,
                entries: sections.array(bytes, Kind::Entries)?,
                segments: sections.array(bytes, Kind::Segments)?,
                shift: object.segment_shift,
            }
        })
    }
    Ok(OctreeRef {
        frame,
        root: Tag::from_code(object.root),
        exterior: Tag::Empty,
        proof: Proof::CERTIFIED,
        planes: sections.array(bytes, Kind::Planes)?,
        rel: sections.array(bytes, Kind::Rel)?,
        base: sections.array(bytes, Kind::Base)?,
        bricks: match object.brick_planes {
            1 => Bricks::One(bricks(object, sections, bytes)?),
            _ => Bricks::Two(bricks(object, sections, bytes)?),
        },
        starts: *starts,
        table: Some(sections.array(bytes, Kind::Levels)?),
        is_linked: false,
        cuts: None,
    })
}

/// Returns the start of each element level, from the level table. The elements of level e are the nodes of
/// the octree level to which their own cells belong. All reading code relies on the checks made here: the
/// starts ascend, bricks begin where elements end, and all elements and bricks belong to a level.
pub fn starts(counts: &Counts, levels: &[u8]) -> Result<Starts, Error> {
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
        // In a tree of odd depth, the root element's own cell would be one level above the universe.
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

/// The encoding of bricks, as in a header or a record.
pub(super) struct Coding {
    pub planes: u8,
    pub encoding: u8,
    pub segment_shift: u8,
    pub entries: u64,
}

/// Appends the sections of a tree; returns the encoding of its bricks. If the file encodes the bricks in
/// another way than the tree does, `encoded` holds them.
pub(super) fn append<'a>(
    owner: u32,
    tree: &OctreeRef<'a>,
    levels: &'a [LevelCounts],
    encoded: &'a Option<OwnedBricks>,
    sections: &mut Vec<Section<'a>>,
) -> Coding {
    let bricks = encoded.as_ref().map_or(tree.bricks, OwnedBricks::view);
    let ([raw, indices, entries, segments], coding) = match bricks {
        Bricks::One(bricks) => brick_elements(&bricks, 1, Elements::U64),
        Bricks::Two(bricks) => brick_elements(&bricks, 2, Elements::Planes),
    };
    sections.extend([
        (owner, Kind::Levels, Elements::Levels(levels)),
        (owner, Kind::Planes, Elements::Planes(tree.planes)),
        (owner, Kind::Rel, Elements::U16(tree.rel)),
        (owner, Kind::Base, Elements::U64(tree.base)),
        (owner, Kind::Bricks, raw),
        (owner, Kind::Indices, indices),
        (owner, Kind::Entries, entries),
        (owner, Kind::Segments, segments),
    ]);
    coding
}

/// Returns raw bricks, indices, entries and segments. `elements` converts the arrays of bricks.
fn brick_elements<'a, T>(
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
